"""A comparison as a page: the style and the parts of the page of --explore, and compare.js; and as a part of a page of
--explore."""

import base64
import html
import json
import re

from trax_eval.util import Problem

from .figures import SECTIONS

BEGIN, END = "<!-- against -->", "<!-- end of against -->"
SCRIPTS, IMAGES = "script-src 'unsafe-inline'", "; img-src data:"  # of the page's security policy


def value_of(folders, pictures):
    images = {name: {which: "data:image/png;base64," + base64.b64encode(png).decode() for which, png in made.items()}
              for name, made in pictures.items()}
    titles = {name: title for name, title, *_ in SECTIONS}
    return json.dumps({**folders, "images": images, "titles": titles}, allow_nan=False).replace("<", "\\u003c")


def page(folders, pictures, data):
    def part(name):
        return (data / "compare" / name).read_text()

    text = part("page.html")
    for mark, content in (("style", part("page.css") + part("compare.css")), ("data", value_of(folders, pictures)),
                          ("scripts", part("data.js") + part("navigation.js") + 'const prefix = "";\n' +
                           part("compare.js") + part("start.js"))):
        text = text.replace(f"<!-- {mark} -->", content)
    return text


def without(text):
    """A page of --explore without what add_to_page has added."""
    return re.sub(f"{BEGIN}.*?{END}", "", text, flags=re.DOTALL).replace(SCRIPTS + IMAGES, SCRIPTS)


def add_to_page(text, name, result, pictures, data):
    """A page of --explore with a section that compares its run with the one of `name`; an earlier one is replaced."""
    def part(name):
        return (data / "compare" / name).read_text()

    head, sections = (re.search(f"<{tag}[^>]*>(.*?)</{tag}>", part("page.html"), re.DOTALL)[1]
                      for tag in ("header", "main"))
    body = re.sub(r"<h1>.*?</h1>", "", head) + re.sub(r'<p id="failure">.*?</p>', "", sections, flags=re.DOTALL)
    body = re.sub(r' data-title="[^"]*"', "", body.replace("section", "div")).replace("h2>", "h3>")
    style = "".join(rule.replace("#", "#against-", 1) + "\n" for rule in part("page.css").splitlines()
                    if rule.startswith(("#figures", "#brief"))) + part("compare.css")
    title = html.escape(name.encode(errors="replace").decode())
    shown = body.replace('id="', 'id="against-')
    value = value_of({"runs": {"": result}}, {"": pictures})
    text = without(text)
    for place, added in (
            ('<section id="causes"', f'<style>{style}</style><section id="against" data-title="Differences">'
             f"<h2>Against {title}</h2>{shown}</section>"),
            ("</body>", f'<script type="application/json" id="against-data">{value}</script><script>(() => {{\n'
             f'const prefix = "against-";\n{part("compare.js")}drawComparison();\n}})();</script>')):
        if text.count(place) != 1:
            raise Problem(f"the page has no {place}")
        text = text.replace(place, BEGIN + added + END + place)
    return text.replace(SCRIPTS, SCRIPTS + IMAGES, 1)
