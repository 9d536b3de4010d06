"""Figures as SVG for the page. Colours are classes of the style sheet, so they follow light and dark, and each mark has
its value as a title."""

import math

from .markup import Html, el

WIDTH, HEIGHT = 460, 300
TOP, RIGHT, LETTER = 10, 14, 6.4  # LETTER: the mean width of a letter
# The shape of each kind of mark, one unit large, and the size at which all look alike.
CIRCLE = '<circle r="1" fill="{}" stroke="{}"/>'
MARKS = {
    "dot": (CIRCLE.format("currentColor", "none"), 3.4),
    "circle": (CIRCLE.format("none", "currentColor"), 3.8),
    "square": ('<rect x="-1" y="-1" width="2" height="2" fill="currentColor"/>', 2.9),
    "triangle": ('<path d="M0,-1.33 L-1.33,0.67 L1.33,0.67 z" fill="currentColor"/>', 3.6),
    "diamond": ('<path d="M0,-1.4 L1.4,0 L0,1.4 L-1.4,0 z" fill="currentColor"/>', 3.8),
}


def can_be_drawn(value):
    """Returns whether a figure is known and lies in the range that axes can have."""
    return value is not None and (value == 0 or 1e-100 < abs(value) < 1e100)


def log_ticks(values):
    """1, 2, 5, 10, ... for a logarithmic axis over these values."""
    values = [value for value in values if value and value > 0]
    if not values:
        return None
    powers = range(math.floor(math.log10(min(values))), math.ceil(math.log10(max(values))) + 1)
    return [(digit * 10.0**power, f"{digit * 10.0 ** power:g}") for power in powers for digit in (1, 2, 5)]


class Axis:
    """The range of an axis, and its ticks: (value, text). low may be above high: then the axis is upside down."""
    def __init__(self, low, high, ticks=None, log=False, base=10):
        self.low, self.high, self.scale = low, high, math.log if log else float
        chosen = ticks or (self.powers(base) if log else self.steps())
        self.ticks = [(value, text) for value, text in chosen if min(low, high) <= value <= max(low, high)]

    @classmethod
    def around(cls, values, ticks=None, log=False, base=10, from_zero=False):
        """An axis with room around the values."""
        low, high = min(values), max(values)
        if log:
            return cls(low / 1.25, high * 1.25, ticks, log, base)
        low = 0 if from_zero and low >= 0 else low
        room = 0.06 * (high - low) or abs(high) or 1
        return cls(low if low == 0 else low - room, high + room, ticks)

    def place(self, value):
        """0 at the low end, 1 at the high end."""
        return (self.scale(value) - self.scale(self.low)) / (self.scale(self.high) - self.scale(self.low))

    def steps(self):
        """Returns at most seven ticks: multiples of 1, 2 or 5 times a power of ten."""
        unit = 10.0**math.floor(math.log10((self.high - self.low) / 5))
        step = next(step for step in (unit, 2 * unit, 5 * unit, 10 * unit) if (self.high - self.low) / step <= 6.5)
        counts = range(math.ceil(self.low / step), math.floor(self.high / step) + 1)
        return [(count * step, f"{count * step:,.10g}") for count in counts]

    def powers(self, base):
        first, last = math.ceil(math.log(self.low, base)), math.floor(math.log(self.high, base))
        if last <= first + (base == 10):
            return log_ticks((self.low, self.high))
        return [(float(base)**power, f"{float(base) ** power:g}")
                for power in range(first, last + 1, 1 + (last - first) // 8)]


def widest(ticks):
    return max((len(text) for _, text in ticks), default=0)


class Plane:
    """Two axes with labels. x(value) and y(value) are places in the picture."""
    def __init__(self, across, up, x_label, y_label, height):
        self.across, self.up, self.x_label, self.y_label, self.height = across, up, x_label, y_label, height
        self.left = 16 + (18 if y_label else 0) + 7 * widest(up.ticks)  # wide letters, too: the left end is not cut
        ticks = sorted(across.ticks)
        self.slanted = any(
            self.x(right[0]) - self.x(left[0]) < LETTER * (len(left[1]) + len(right[1])) / 2 + 2
            for left, right in zip(ticks, ticks[1:]))
        self.bottom = height - (40 if not self.slanted else round(34 + LETTER * widest(ticks) / 2))

    def x(self, value):
        return self.left + (WIDTH - RIGHT - self.left) * self.across.place(value)

    def y(self, value):
        return self.bottom + (TOP - self.bottom) * self.up.place(value)

    def frame(self):
        """Grid, axes, ticks and labels."""
        right = WIDTH - RIGHT
        for value, text in self.across.ticks:
            x = f"{self.x(value):.1f}"
            yield el("path", d=f"M{x},{self.bottom} V{TOP}", class_="grid")
            yield el("text", text,
                     transform=f"translate({x},{self.bottom + 16})" + (" rotate(-30)" if self.slanted else ""),
                     text_anchor="end" if self.slanted else "middle")
        for value, text in self.up.ticks:
            y = self.y(value)
            yield el("path", d=f"M{self.left},{y:.1f} H{right}", class_="grid")
            yield el("text", text, transform=f"translate({self.left - 6},{y + 4:.1f})", text_anchor="end")
        yield el("path", d=f"M{self.left},{TOP} V{self.bottom} H{right}", class_="axis")
        yield el("text", self.x_label, transform=f"translate({(self.left + right) // 2},{self.height - 6})",
                 text_anchor="middle")
        if self.y_label:
            yield el("text", self.y_label, transform=f"translate(14,{(TOP + self.bottom) // 2}) rotate(-90)",
                     text_anchor="middle")


class Series:
    """points: (x, y, what to say of it); missing ones (None) break the line."""
    def __init__(self, label, style, points, mark="dot", line=True, dashed=False):
        self.label, self.style, self.mark, self.line, self.dashed = label, style, mark, line, dashed
        self.points = [(x, y, str(tip)) for x, y, tip in points]

    def known(self):
        return [point for point in self.points if can_be_drawn(point[0]) and can_be_drawn(point[1])]


class Lines:
    """Marks and lines over two axes; x_ticks: (value, text) where the axis is to have them."""
    def __init__(self, identity, title, x, y, series, log_x=False, x_ticks=None, from_zero=True, base=10, log_y=False):
        self.identity, self.title, self.x, self.y, self.series = identity, title, x, y, series
        self.log_x, self.log_y, self.x_ticks, self.from_zero, self.base = log_x, log_y, x_ticks, from_zero, base
        self.height = HEIGHT

    def drawn(self, series):
        return [(x, y, tip) for x, y, tip in series.known() if (x > 0 or not self.log_x) and (y > 0 or not self.log_y)]

    def empty(self):
        return not any(self.drawn(series) for series in self.series)

    def marks(self):
        return [(series.style, series.mark, series.label) for series in self.series if self.drawn(series)]

    def elements(self):
        points = [point for series in self.series for point in self.drawn(series)]
        across = Axis.around([point[0] for point in points], self.x_ticks, self.log_x, self.base, self.from_zero)
        up = Axis.around([point[1] for point in points], None, self.log_y, from_zero=self.from_zero)
        plane = Plane(across, up, self.x, self.y, self.height)
        shown = [*plane.frame()]
        for series in self.series:
            shown += self.line(series, plane) if series.line else []
            if not series.line or len(self.drawn(series)) <= 40:  # more marks would hide the line
                shown += [mark(series.style, series.mark, plane.x(x), plane.y(y)) for x, y, _ in self.drawn(series)]
        return shown + [
            el("circle", el("title", tip), class_="hit", cx=f"{plane.x(x):.1f}", cy=f"{plane.y(y):.1f}", r="7",
               tabindex="0") for x, y, tip in points
        ]

    def line(self, series, plane):
        drawn, text, begun = set(self.drawn(series)), "", False
        for point in series.points:
            if point in drawn:
                text += f"{'L' if begun else 'M'}{plane.x(point[0]):.1f},{plane.y(point[1]):.1f} "
            begun = point in drawn
        return [
            el("path", d=text.strip(), class_=f"s{series.style}", stroke_dasharray="8,5" if series.dashed else None)
        ] if text else []


class Bars:
    """Horizontal bars in parts. bars: (name, [(style, length, what to say of it)]), from the top; parts without a
    length are missing."""
    def __init__(self, identity, title, x, bars, labels):
        self.identity, self.title, self.x, self.labels = identity, title, x, labels
        self.bars = [(str(name), [part for part in parts if can_be_drawn(part[1]) and part[1] > 0])
                     for name, parts in bars]
        self.height = 80 + 18 * len(self.bars)

    def empty(self):
        return not any(parts for _, parts in self.bars)

    def marks(self):
        used = {style for _, parts in self.bars for style, _, _ in parts}
        return [(style, "square", label) for style, label in self.labels if style in used]

    def elements(self):
        across = Axis(0, max(sum(length for _, length, _ in parts) for _, parts in self.bars))
        up = Axis(len(self.bars) - 0.4, -0.6, [(row, name) for row, (name, _) in enumerate(self.bars)])
        plane = Plane(across, up, self.x, "", self.height)
        shown = [*plane.frame()]
        for row, (_, parts) in enumerate(self.bars):
            left, above, below = 0.0, f"{plane.y(row - 0.38):.1f}", f"{plane.y(row + 0.38):.1f}"
            for style, length, tip in parts:
                x, end = f"{plane.x(left):.1f}", f"{plane.x(left + length):.1f}"
                shown.append(
                    el("polygon", el("title", tip), class_=f"s{style}",
                       points=f"{x},{above} {end},{above} {end},{below} {x},{below}", tabindex="0"))
                left += length
        return shown


def mark(style, kind, x, y):
    size = MARKS[kind][1]
    return el("use", href=f"#mark-{kind}", transform=f"translate({x:.1f},{y:.1f}) scale({size})", class_=f"s{style}",
              stroke_width=f"{1.5 / size:.2f}")


def shapes():
    """The shapes of marks, once in a page or picture."""
    return el("defs", *(el("g", Html(shape), id=f"mark-{kind}") for kind, (shape, _) in MARKS.items()))


def draw(figure):
    """A figure as HTML. Without a point it says that nothing was measured."""
    if figure.empty():
        content = el("p", "Nothing was measured.", class_="missing")
    else:
        content = el("svg", *figure.elements(), viewBox=f"0 0 {WIDTH} {figure.height}", role="img",
                     aria_label=figure.title)
    keys = [
        el("li", el("svg", mark(style, kind, 7, 7), viewBox="0 0 14 14", class_="mark", aria_hidden="true"), label)
        for style, kind, label in figure.marks()
    ]
    return el("figure", el("figcaption", figure.title), content,
              el("ul", *keys, class_="key") if len(keys) > 1 else None, id=figure.identity)
