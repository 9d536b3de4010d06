"""A figure as a file of SVG that stands alone, for pages of docs."""

import re

from .markup import el
from .plots import WIDTH, mark, shapes

# The page's colours (page.css) that figures use, for a picture that stands alone; it follows the reader's light or
# dark.
_COLOURS = {
    0: ("#1c1c1a", "#ecece6"), 1: ("#0072b2", "#56b4e9"), 2: ("#c85200", "#f08a4b"), 3: ("#007f5f", "#4cc9a0"),
    4: ("#a3568a", "#d79ac2"), 5: ("#8a6d00", "#e0c040"), 6: ("#3d7f9f", "#8fc7de"), 7: ("#a8a8a0", "#6b6b65"),
    10: ("#2a9d74", ) * 2, 11: ("#7cc0ea", ) * 2, 12: ("#0072b2", "#2a8fd0"), 13: ("#c85200", "#d5642a"),
    14: ("#e69f00", ) * 2, 15: ("#e8d44d", ) * 2, 16: ("#b877a0", "#c58ab0"), 17: ("#8a7a6a", "#9a8a7a"),
    18: ("#d4d4ce", "#4a4a46")
}


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
        used = {int(style) for style in re.findall(r'class="s(\d+)"', "".join(elements))}
        colours = "".join(f".s{style}{{color:{_COLOURS[style][place]}}}" for style in sorted(used))
        ink, line, ground = (("#5f5f59", "#d9d9d3", "#ffffff"), ("#a3a39b", "#3a3a37", "#171716"))[place]
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
