"""A comparison as a page: the style and the parts of the page of --explore, and compare.js."""

import base64
import json

from .figures import SECTIONS


def page(folders, pictures, data):
    def part(name):
        return (data / "compare" / name).read_text()

    images = {name: {which: "data:image/png;base64," + base64.b64encode(png).decode() for which, png in made.items()}
              for name, made in pictures.items()}
    titles = {name: title for name, title, *_ in SECTIONS}
    value = json.dumps({**folders, "images": images, "titles": titles}, allow_nan=False).replace("<", "\\u003c")
    text = part("page.html")
    for mark, content in (("style", part("page.css") + part("compare.css")), ("data", value),
                          ("scripts", part("data.js") + part("navigation.js") + part("compare.js"))):
        text = text.replace(f"<!-- {mark} -->", content)
    return text
