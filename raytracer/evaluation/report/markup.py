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


MISSING = Html('<span class="missing" title="not measured">–</span>')


def figure(value, digits=3):
    """A number for reading: so many significant digits, thousands apart, a true minus."""
    if value is None:
        return MISSING
    if value == int(value) and abs(value) < 10 ** 15:
        text = f"{value:,.0f}"
    elif abs(value) >= 10 ** digits:
        text = f"{value:,.0f}"
    elif abs(value) < 1e-4:
        text = f"{value:.{digits - 1}e}"
    else:
        text = f"{value:.{digits}g}"
        if "e" in text:
            text = f"{value:,.0f}"
        whole = text.lstrip("-").split(".")
        if digits > len(text.replace(".", "").lstrip("-0")) and abs(value) < 10 ** (digits - 1):  # 4.9 beside 4.94: 4.90
            text = f"{value:.{digits - len(whole[0]) if whole[0] != '0' else digits}f}"
    return Html(text.replace("-", "−"))


def published(value):
    """As the paper has it: no digit more, and none less."""
    return MISSING if value is None else Html(escape(getattr(value, "text", f"{value:g}")))


def percent(value, signed=False, digits=0):
    if value is None:
        return MISSING
    text = f"{100 * value:{'+' if signed else ''},.{digits}f}"
    if not text.strip("+-0."):
        text = text.lstrip("+-")
    return Html(text.replace("-", "−") + "\u00a0%")


def seconds(value):
    if value is None:
        return MISSING
    for unit, size, least in (("h", 3600, 7200), ("min", 60, 120), ("s", 1, 0.1)):
        if value >= least:
            return Html(f"{value / size:.1f}\u00a0{unit}")
    return Html(f"{1000 * value:.0f}\u00a0ms")


def cell(shown, value=None, **attributes):
    """A table's cell; value is what it is sorted by, and a cell of a number without one is missing."""
    return el("td", shown, data_value=None if value is None else repr(float(value) if isinstance(value, float) else value), **attributes)


def number_cell(value, shown=None, below=None, **attributes):
    content = figure(value) if shown is None else shown
    if below is not None:
        content = join([content, el("small", below)])
    attributes["class_"] = ("n " + attributes.get("class_", "")).strip()
    return cell(content, value, **attributes)


def table(identity, caption, head, rows, foot=None, note=None):
    """A sortable table. head: (text, kind) with kind "n" for numbers, "t" for text, None if it is not to be sorted by."""
    columns = []
    for label, kind in head:
        if kind:
            columns.append(el("th", el("button", label, type="button"), scope="col", class_=kind, aria_sort="none"))
        else:
            columns.append(el("th", label, scope="col"))
    parts = [el("caption", caption), el("thead", el("tr", *columns)), el("tbody", *(el("tr", *row) for row in rows))]
    if foot:
        parts.append(el("tfoot", *(el("tr", *row) for row in foot)))
    shown = el("div", el("table", *parts, id=identity), class_="scroll", tabindex="0", role="region", aria_label=caption)
    return join([shown, el("p", note, class_="note") if note else None])
