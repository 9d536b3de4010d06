"""HTML from Python: every text is escaped, unless it is Html already."""

import html as _html


class Html(str):
    """Text that is markup."""


def escape(value):
    return value if isinstance(value, Html) else Html(_html.escape(str(value), quote=True))


def join(parts, between=""):
    return Html(escape(between).join(escape(part) for part in parts if part is not None))


def el(name, /, *content, **attributes):
    """An element. An attribute None is left out, True has no value; class_ and data_value are class and data-value."""
    opened = "<" + name
    for key, value in attributes.items():
        if value is None or value is False:
            continue
        key = key.rstrip("_").replace("_", "-")
        opened += f" {key}" if value is True else f' {key}="{_html.escape(str(value), quote=True)}"'
    if name in ("br", "img", "meta", "col", "hr"):
        return Html(opened + ">")
    return Html(f"{opened}>{join(content)}</{name}>")


def _cell(cell, numeric):
    """A cell of a Table. Numbers have a true minus; a missing figure is shown as missing."""
    def figures(text):
        return text.replace("-", "−") if numeric else text

    shown = el("span", "–", class_="missing", title=cell.title or "not measured") if cell.shown is None else figures(
        cell.shown)
    if cell.link and cell.shown is not None:
        shown = el("a", shown, href=cell.link, title=cell.title or None)
    elif cell.identity:
        shown = el("span", shown, id=cell.identity, class_=cell.style, title=cell.title)
    elif "code" in cell.style.split() and cell.shown is not None:
        shown = el("code", shown)
    parts = [shown or None, *(el("a", text, href=address) for text, address in cell.links)]
    style = " ".join(part for part in ("n" if numeric else "", "" if cell.identity else cell.style) if part)
    return el(
        "td", join(parts, " "),
        el("small", figures(cell.below)) if cell.below else None, class_=style or None, data_value=None
        if cell.value is None else repr(float(cell.value) if not isinstance(cell.value, str) else cell.value))


SHADES = ("Below a figure: its deviation from the paper's. Green: within 10 %; blue: above, deep blue by more than "
          "half; orange: below, deep orange by more than half.")


def table(made, prefix=""):
    """A sortable table of a Table; prefix: of its id."""
    columns = [
        el("th", el("button", label, type="button"), scope="col", class_=kind, aria_sort="none") if kind else el(
            "th", label, scope="col") for label, kind in made.columns
    ]
    parts = [
        el("caption", made.title),
        el("thead", el("tr", *columns)),
        el("tbody",
           *(el("tr", *(_cell(cell, kind == "n") for cell, (_, kind) in zip(row, made.columns))) for row in made.rows))
    ]
    shown = el("div", el("table", *parts, id=prefix + made.identity), class_="scroll", tabindex="0", role="region",
               aria_label=made.title)
    shaded = any(cell.style.startswith(("near", "high", "low")) for row in made.rows for cell in row)
    note = " ".join(text for text in (made.note, SHADES if shaded else "") if text)
    notes = [el("li", el("b", what), f": {text}") for what, text in made.notes]
    below = [el("p", note, class_="note") if note else None, el("ul", *notes, class_="note") if notes else None]
    return join([shown, *below])
