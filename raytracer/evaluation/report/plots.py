"""Figures by gnuplot, as SVG for the page: colours become classes of the style sheet, so that they follow light and dark, and every
mark has its value as a title. gnuplot lays out axes and marks; what it writes besides is left away."""

import math
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree

from .markup import Html, el

WIDTH, HEIGHT = 460, 300
_SVG = "{http://www.w3.org/2000/svg}"
_LINK = "{http://www.w3.org/1999/xlink}href"
# In the script a class is a colour: red 200, blue its number. These are drawn otherwise than marks.
_AXIS, _GRID = "#010101", "#020202"
# gnuplot's point types and the sizes at which they look alike.
MARKS = {"dot": (7, 0.75), "circle": (6, 0.85), "square": (5, 0.65), "triangle": (9, 0.8), "diamond": (13, 0.85)}


class PlotError(Exception):
    """gnuplot is not there, or did not do what it was asked; the message says which."""


class Series:
    """points: (x, y, what to say of it); missing ones (None) break the line."""

    def __init__(self, label, style, points, mark="dot", line=True, dashed=False):
        self.label, self.style, self.mark, self.line, self.dashed = label, style, mark, line, dashed
        self.points = [(x, y, str(tip)) for x, y, tip in points]

    def known(self):
        return [point for point in self.points if point[0] is not None and point[1] is not None]


class Lines:
    """Marks and lines over two axes; x_ticks: (value, text) where the axis is to have them."""

    def __init__(self, identity, title, x, y, series, log_x=False, x_ticks=None, from_zero=True, base=10, log_y=False):
        self.log_y = log_y
        self.identity, self.title, self.x, self.y, self.series = identity, title, x, y, series
        self.log_x, self.x_ticks, self.from_zero, self.base = log_x, x_ticks, from_zero, base
        self.height = HEIGHT

    def tips(self):
        return [tip for series in self.series for _, _, tip in self._drawn(series)]

    def _drawn(self, series):
        return [(x, y, tip) for x, y, tip in series.known() if (x > 0 or not self.log_x) and (y > 0 or not self.log_y)]

    def empty(self):
        return not self.tips()

    def marks(self):
        return [(series.style, series.mark, series.label) for series in self.series if self._drawn(series)]

    def script(self):
        points = [point for series in self.series for point in self._drawn(series)]
        lines = [f"set xlabel {_quoted(self.x)}", f"set ylabel {_quoted(self.y)}"]
        for axis, log, place in (("x", self.log_x, 0), ("y", self.log_y, 1)):
            low, high = min(p[place] for p in points), max(p[place] for p in points)
            if log:
                lines.append(f"set logscale {axis} {self.base if axis == 'x' else 10}")
                lines += ["set format y '%g'"] if axis == "y" else []
                lines.append(f"set {axis}range [{low / 1.25!r}:{high * 1.25!r}]")
            else:
                low = 0 if self.from_zero and low >= 0 else low
                room = 0.06 * (high - low) or abs(high) or 1
                lines.append(f"set {axis}range [{low if low == 0 else low - room!r}:{high + room!r}]")
        if self.x_ticks:
            lines.append("set xtics (" + ", ".join(f"{_quoted(text)} {value!r}" for value, text in self.x_ticks) + ")")
        plots, number = [], 0
        for index, series in enumerate(self.series):
            drawn = set(self._drawn(series))
            if not drawn:
                continue
            block = []
            for point in series.points:
                if point in drawn:
                    block.append(f"{point[0]!r} {point[1]!r} {number}")
                    number += 1
                else:
                    block.append("")
            lines += [f"$d{index} << END", *block, "END"]
            colour = f'"#c800{series.style:02x}"'
            if series.line:
                plots.append(f"$d{index} using 1:2 with lines lc rgb {colour} lw 2{' dt 2' if series.dashed else ''}")
            kind, size = MARKS[series.mark]
            if not (series.line and len(drawn) > 40):  # so many are the line
                plots.append(f"$d{index} using 1:2 with points pt {kind} ps {size} lw 1.5 lc rgb {colour}")
            plots.append(f"$d{index} using 1:2:3 with labels hypertext point pt 7 ps 1.4 lc rgb \"#ff000000\"")
        return lines + ["plot " + ", ".join(plots)]


    def text(self, width=72, height=16):
        """The marks on a grid of letters, for the command's output."""
        drawn = [series for series in self.series if self._drawn(series)]
        along, up = (math.log if log else float for log in (self.log_x, self.log_y))
        points = [(letter, along(x), up(y)) for letter, series in zip(_LETTERS, drawn) for x, y, _ in self._drawn(series)]
        (left, right), (low, high) = ((min(values), max(values)) for values in zip(*(point[1:] for point in points)))
        low = 0 if self.from_zero and low >= 0 and not self.log_y else low
        grid = [[" "] * width for _ in range(height)]
        for letter, x, y in points:
            column, row = (round((value - first) / ((last - first) or 1) * (cells - 1)) for value, first, last, cells in ((x, left, right, width), (y, low, high, height)))
            grid[height - 1 - row][column] = letter if grid[height - 1 - row][column] in (" ", letter) else "+"
        edges = {row: f"{math.exp(edge) if self.log_y else edge:.4g}" for row, edge in ((0, high), (height - 1, low))}
        names = [f"{text}" for _, text in self.x_ticks or []] or [f"{point:.4g}" for point in sorted({point[0] for series in drawn for point in self._drawn(series)})]
        lines = [self.title, ""] + [f"{edges.get(row, ''):>10} |{''.join(cells).rstrip()}" for row, cells in enumerate(grid)]
        lines += [" " * 11 + "+" + "-" * width, f"{'':12}{names[0]}{names[-1]:>{max(1, width - len(names[0]))}}   {self.x}"]
        return "\n".join(lines + [f"{'':12}{letter}  {series.label}" for letter, series in zip(_LETTERS, drawn)] + ([f"{'':12}+  several"] if any("+" in row for row in grid) else []))


_LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"


class Bars:
    """Horizontal bars in parts. bars: (name, [(style, length, what to say of it)]), from the top; parts without a length are missing."""

    def __init__(self, identity, title, x, bars, labels):
        self.identity, self.title, self.x, self.labels = identity, title, x, labels
        self.bars = [(str(name), [part for part in parts if part[1] is not None and part[1] > 0]) for name, parts in bars]
        self.height = 80 + 18 * len(self.bars)

    def tips(self):
        return [tip for _, parts in self.bars for _, _, tip in parts]

    def empty(self):
        return not self.tips()

    def marks(self):
        used = {style for _, parts in self.bars for style, _, _ in parts}
        return [(style, "square", label) for style, label in self.labels if style in used]

    def script(self):
        count = len(self.bars)
        lines = [f"set xlabel {_quoted(self.x)}", f"set yrange [{count - 0.4}:-0.6]"]
        longest = max(sum(length for _, length, _ in parts) for _, parts in self.bars)
        lines.append(f"set xrange [0:{longest!r}]")
        lines.append("set ytics (" + ", ".join(f"{_quoted(name)} {row}" for row, (name, _) in enumerate(self.bars)) + ")")
        block = []
        for row, (_, parts) in enumerate(self.bars):
            left = 0.0
            for style, length, _ in parts:
                block.append(f"{left + length / 2!r} {row} {left!r} {left + length!r} {row - 0.38} {row + 0.38} {0xc80000 + style}")
                left += length
        return lines + ["$b << END", *block, "END", "plot $b using 1:2:3:4:5:6:7 with boxxyerror fs solid 1 noborder lc rgb variable"]


def _quoted(text):
    return "'" + str(text).replace("'", "''").replace("\n", " ").replace("\r", " ") + "'"


def version_of(program):
    """What the program says that it is; versions lay figures out differently."""
    try:
        return " ".join(subprocess.run([program, "--version"], capture_output=True, text=True, timeout=60).stdout.split())
    except (OSError, subprocess.TimeoutExpired):
        return ""  # run_gnuplot says what is wrong


def run_gnuplot(figures, folder, program):
    script = ["set encoding utf8", "unset key"]
    for index, figure in enumerate(figures):
        script += ["reset", "unset key", f"set terminal svg size {WIDTH},{figure.height} noenhanced font 'sans-serif,12'", f"set output '{index}.svg'",
                   f"set border 3 lw 1 lc rgb '{_AXIS}'", "set tics nomirror out scale 0.4", f"set grid lt 1 lw 0.5 lc rgb '{_GRID}'",
                   *figure.script(), "unset output"]
    environment = {**os.environ, "LC_ALL": "C", "GNUTERM": "svg"}
    try:
        done = subprocess.run([program, "-"], input="\n".join(script) + "\n", cwd=folder, env=environment, capture_output=True, text=True,
                              timeout=300)
    except FileNotFoundError:
        raise PlotError(f"{program} is not installed; on Debian it is the package gnuplot-nox") from None
    except subprocess.TimeoutExpired:
        raise PlotError(f"{program} did not end within 300 s") from None
    if done.returncode != 0:
        raise PlotError(f"{program} failed: {' '.join(done.stderr.split())[:400]}")


def _style(colour):
    """The class of a colour of the script, or None for what has none."""
    found = re.fullmatch(r"rgb\(\s*(\d+),\s*(\d+),\s*(\d+)\)", colour or "")
    red, green, blue = (int(text) for text in found.groups()) if found else (0, 0, 0)
    return {1: "axis", 2: "grid", 200: f"s{blue}"}.get(red)


def _short(path):
    return re.sub(r"(\d+\.\d)\d", r"\1", " ".join(path.split()))


def elements_of(svg, tips):
    """The page's elements of what gnuplot drew. Marks' titles are found by number, bars' by their order."""
    shown = []
    bars = iter(tips)

    def walk(node, inherited, tip):
        kind = node.tag.removeprefix(_SVG)
        if kind in ("defs", "title", "desc"):
            return
        here = {**inherited, **{key: node.get(key) for key in ("stroke", "fill", "stroke-width", "font-size", "text-anchor", "transform") if node.get(key)}}
        if node.get("onmousemove"):
            tip = tips[int(re.search(r"'\s*(\d+)\s*'", node.get("onmousemove")).group(1))]
        if kind == "path":
            style = _style(node.get("stroke") or inherited.get("stroke"))
            if style:
                dashed = node.get("stroke-dasharray") if style != "grid" else None
                shown.append(el("path", d=_short(node.get("d")), class_=style, stroke_dasharray=dashed))
        elif kind in ("polygon", "rect") and _style(node.get("fill")):
            shown.append(el("polygon", el("title", next(bars, "")), class_=_style(node.get("fill")),
                            points=_short(node.get("points") or ""), tabindex="0"))
        elif kind == "use":
            where, size = re.match(r"translate\(([^)]*)\) scale\(([^)]*)\)", node.get("transform")).groups()
            x, y = where.split(",")
            if tip is not None:
                shown.append(el("circle", el("title", tip), class_="hit", cx=x, cy=y, r="7", tabindex="0"))
            elif _style(node.get("color")):
                shown.append(el("use", href="#mark" + node.get(_LINK)[len("#gpPt"):], transform=_short(node.get("transform")),
                                class_=_style(node.get("color")), stroke_width=f"{1.5 / float(size):.2f}"))
        elif kind == "text":
            text = "".join(node.itertext()).strip()
            if text:
                shown.append(el("text", text, transform=here.get("transform"), text_anchor=here.get("text-anchor")))
        for child in node:
            walk(child, here, tip)

    walk(svg, {}, None)
    return shown


def draw(figures, program="gnuplot"):
    """The figures as HTML, by identity; one without a point says that nothing was measured."""
    drawn = {}
    filled = [figure for figure in figures if not figure.empty()]
    with tempfile.TemporaryDirectory() as folder:
        if filled:
            run_gnuplot(filled, folder, program)
        for index, figure in enumerate(filled):
            try:
                root = xml.etree.ElementTree.parse(os.path.join(folder, f"{index}.svg")).getroot()
            except (OSError, xml.etree.ElementTree.ParseError) as error:
                raise PlotError(f"{program} wrote no figure \"{figure.title}\": {error}") from None
            tips = figure.tips()
            elements = elements_of(root, tips)
            titles = sum("<title>" in element for element in elements)
            if titles != len(tips):
                raise PlotError(f"{program} drew {titles} of {len(tips)} values of \"{figure.title}\"")
            drawn[figure.identity] = _framed(figure, el("svg", *elements, viewBox=f"0 0 {WIDTH} {figure.height}", role="img",
                                                        aria_label=figure.title))
    for figure in figures:
        if figure.empty():
            drawn[figure.identity] = _framed(figure, el("p", "Nothing was measured.", class_="missing"))
    return drawn


def _framed(figure, content):
    keys = [el("li", _key(style, mark), label) for style, mark, label in figure.marks()]
    return el("figure", el("figcaption", figure.title), content, el("ul", *keys, class_="key") if len(keys) > 1 else None, id=figure.identity)


def _key(style, mark):
    return el("svg", el("use", href=f"#mark{MARKS[mark][0] - 1}", transform="translate(7,7) scale(4)", class_=f"s{style}", stroke_width="0.4"),
              viewBox="0 0 14 14", class_="mark", aria_hidden="true")


def marks():
    """The shapes that the figures use, once in a page."""
    circle = Html('<circle r="1" fill="{}" stroke="{}"/>')
    shapes = {5: circle.format("none", "currentColor"), 6: circle.format("currentColor", "none"),
              4: '<rect x="-1" y="-1" width="2" height="2" fill="currentColor"/>',
              8: '<path d="M0,-1.33 L-1.33,0.67 L1.33,0.67 z" fill="currentColor"/>',
              12: '<path d="M0,-1.4 L1.4,0 L0,1.4 L-1.4,0 z" fill="currentColor"/>'}
    symbols = [el("g", Html(shape), id=f"mark{number}") for number, shape in shapes.items()]
    return el("svg", el("defs", *symbols), width="0", height="0", aria_hidden="true", class_="shapes")


def log_ticks(values):
    """1, 2, 5, 10, ... for a logarithmic axis over these values."""
    values = [value for value in values if value and value > 0]
    if not values:
        return None
    powers = range(math.floor(math.log10(min(values))), math.ceil(math.log10(max(values))) + 1)
    return [(digit * 10.0 ** power, f"{digit * 10.0 ** power:g}") for power in powers for digit in (1, 2, 5)]
