"""A table as data, built once: text for the command's output, Markdown for the pages of docs. markup.py writes it as
HTML."""

import math
import textwrap


def number(value, digits=3):
    """A number for reading: so many significant digits, thousands apart, whole numbers as they are; None if there is
    none."""
    if value is None:
        return None
    if isinstance(value, int) or abs(value) >= 10**digits or value == 0:
        return f"{value:,.0f}"
    if abs(value) < 1e-4:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    if "e" in text:
        return f"{value:,.0f}"
    whole = text.lstrip("-").split(".")[0]
    if digits > len(text.replace(".", "").lstrip("-0")):  # 4.9 beside 4.94: 4.90
        return f"{value:.{digits - (len(whole) if whole != '0' else 1 + math.floor(math.log10(abs(value))))}f}"
    return text


def percent(value, signed=False, digits=0):
    if value is None:
        return None
    text = f"{100 * value:{'+' if signed else ''},.{digits}f}"
    return (text if text.strip("+-0.") else text.lstrip("+-")) + "\u00a0%"


def seconds(value):
    if value is None:
        return None
    for unit, size, least in (("h", 3600, 7200), ("min", 60, 120), ("s", 1, 0.1)):
        if value >= least:
            return f"{number(value / size)}\u00a0{unit}"
    return f"{number(1000 * value)}\u00a0ms"


def between(interval):
    """The two ends of an interval, with as many digits as tell them apart."""
    digits = next((digits for digits in (3, 4, 5) if len({number(end, digits) for end in interval}) > 1), 6)
    return [number(end, digits) for end in interval]


class Cell:
    """shown: the text, None if nothing was measured; value: what the page sorts by; below: what stands beside it,
    smaller; links: (text, address); style, title, link, identity: of the page alone."""
    def __init__(self, shown, value=None, below="", style="", title="", link="", links=(), identity=""):
        self.value = float(value) if isinstance(value, int) and abs(value) < 1 << 53 else value
        self.shown, self.below, self.style = shown, below, style
        self.title, self.link, self.links, self.identity = title, link, links, identity


def words(text, **more):
    return Cell(str(text), str(text), **more)


def figure(value, digits=3, **more):
    return Cell(number(value, digits), value, **more)


def share(value, digits=0, **more):
    return Cell(percent(value, digits=digits), value, **more)


def duration(value):
    return Cell(seconds(value), value)


EMPTY = Cell("")


class Table:
    """columns: (title, kind), kind "n" for numbers, "t" for text, None where the page does not sort. rows: lists of
    cells. notes: (of what, text), what is too long for a cell."""
    def __init__(self, identity, title, columns, rows, note="", notes=()):
        self.identity, self.title, self.columns, self.rows = identity, title, columns, rows
        self.note, self.notes = note, notes

    def measured(self):
        """Returns the table without rows that have no measured figure."""
        def is_there(cell):
            return cell.value is not None and cell.style != "paper"

        rows = [row for row in self.rows if any(map(is_there, row[2:])) or all(cell.shown is not None for cell in row)]
        return Table(self.identity, self.title, self.columns, rows, self.note, self.notes)

    def without_empty(self):
        """Returns the table without columns in which nothing was measured."""
        kept = [place for place in range(len(self.columns))
                if any(row[place].shown or row[place].links for row in self.rows)]
        return Table(self.identity, self.title, [self.columns[place] for place in kept],
                     [[row[place] for place in kept] for row in self.rows], self.note, self.notes)

    def lines(self, padded):
        """Lines of Markdown; padded: to be read as plain text."""
        def plain(cell):
            text = "-" if cell.shown is None else " ".join([cell.shown, *(text for text, _ in cell.links)])
            text = f"{text} ({cell.below})" if cell.below else text
            return text.replace("\u00a0", " ").replace("\n", " ").replace("|", "\\|")

        rows = [[title.replace("|", "\\|") for title, _ in self.columns],
                *([plain(cell) for cell in row] for row in self.rows)]
        widths = [max(len(row[place]) for row in rows) if padded else 0 for place in range(len(self.columns))]
        numeric = [kind == "n" for _, kind in self.columns]
        shown = [
            "| " + " | ".join(
                text.rjust(width) if right else text.ljust(width)
                for text, width, right in zip(row, widths, numeric)) + " |" for row in rows
        ]
        rule = "|" + "|".join("-" * (width + 2) for width in widths) + "|" if padded else "|" + " --- |" * len(widths)
        return [shown[0], rule, *shown[1:]]

    def text(self):
        notes = [f"{what}: {text}" for what, text in self.notes]
        below = [textwrap.fill(text, 120) for text in (self.note, *notes) if text]
        return "\n".join([self.title, "", *self.lines(True), *(["", *below] if below else []), "", ""])

    def markdown(self):
        notes = [f"- *{what}.* {text}." for what, text in self.notes]
        return "\n".join([*self.lines(False), "", *notes, *([""] if notes else [])])
