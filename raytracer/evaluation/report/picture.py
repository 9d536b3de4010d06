"""A figure as a file of SVG that stands alone, for pages of docs."""

import pathlib
import re

from .markup import el
from .plots import WIDTH, mark, shapes

_STYLE = pathlib.Path(__file__).with_name("page.css").read_text()


def _colour(name):
    """A colour of the page, for light and for dark."""
    light, dark = re.search(rf"--{name}: (?:light-dark\()?(#\w+)(?:, (#\w+))?", _STYLE).groups()
    return light, dark or light


def standalone(figure):
    """A file of SVG: the figure as in the page, with its key below and no titles of marks."""
    elements = [
        re.sub(r"<title>.*?</title>| tabindex=\"0\"", "", element) for element in figure.elements()
        if not element.startswith("<circle")
    ]
    across = 3 if all(len(label) <= 20 for *_, label in figure.marks()) else 2
    for place, (style, kind, label) in enumerate(figure.marks()):
        where = f"translate({14 + 450 // across * (place % across)},{figure.height + 12 + 18 * (place // across)})"
        elements.append(el("g", mark(style, kind, 0, 0), el("text", label, x="10", y="4"), transform=where))
    height = figure.height + 12 + 18 * -(-len(figure.marks()) // across)

    def rules(place):
        """Colours for light (0) or dark (1); the reader's choice decides."""
        used = {int(style) for style in re.findall(r'class="s(\d+)"', "".join(elements))}
        colours = "".join(f".s{style}{{color:{_colour(f's{style}')[place]}}}" for style in sorted(used))
        ink, line, ground = (_colour(name)[place] for name in ("soft", "line", "ground"))
        return f"svg{{background:{ground}}}text{{fill:{ink}}}.axis{{stroke:{ink}}}.grid{{stroke:{line}}}{colours}"

    style = (
        "text{font:12px sans-serif}path{fill:none;stroke-width:2}g "
        "path{fill:currentColor;stroke:none}path.axis{stroke-width:1}path.grid{stroke-width:.6}"
        "path[class^=s]{stroke:currentColor}polygon{fill:currentColor}"
        + rules(0) + "@media (prefers-color-scheme:dark){" + rules(1) + "}")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" '
        f'height="{height}">\n<style>{style}</style>\n{shapes()}\n'
        + "\n".join("".join(elements[place:place + 12]) for place in range(0, len(elements), 12)) + "\n</svg>\n")
