"""The member `table` of a sweep: which tables its runs have (../README.md, "Tables"). The report draws them."""

from .util import Problem

KEYS = ("id", "title", "each", "rows", "columns", "values", "mean", "where", "only", "relative", "as", "summary")
AS = ("change", "times", "percent", "figure")  # how a figure is compared; the first is the default
SUMMARIES = ("geometric mean", "least", "greatest")
LISTS = ("each", "rows", "columns", "mean", "values", "summary")


def is_value(entry, key):
    return isinstance(entry, str) or key == "values" and isinstance(entry, dict) and isinstance(entry.get("name"), str)


def checked(given, where):
    """One description, with a list for each single word. A wrong member is a Problem."""
    for key in given:
        if key not in KEYS:
            raise Problem(f'{where}: unknown key "{key}"; allowed are {", ".join(KEYS)}')
    spec = {key: [value] if key in LISTS and not isinstance(value, list) else value for key, value in given.items()}
    for key in LISTS:
        if not all(is_value(entry, key) for entry in spec.get(key, [])):
            raise Problem(f"{where}.{key}: expected names")
    for key in ("where", "only", "relative"):
        if not isinstance(spec.get(key, {}), dict):
            raise Problem(f"{where}.{key}: expected an object of axes and values")
    for one in [spec, *(value for value in spec.get("values", []) if isinstance(value, dict))]:
        if one.get("as", AS[0]) not in AS:
            raise Problem(f"{where}.as: allowed are {', '.join(AS)}")
    if any(name not in SUMMARIES for name in spec.get("summary", [])):
        raise Problem(f"{where}.summary: allowed are {', '.join(SUMMARIES)}")
    if not all(isinstance(spec.get(key, ""), str) for key in ("id", "title")):
        raise Problem(f"{where}: id and title are texts")
    return spec


def descriptions(sweep):
    """The tables that a sweep describes; empty if it describes none."""
    given = sweep.get("table")
    given = given if isinstance(given, list) else [] if given is None else [given]
    where = f"sweep \"{sweep.get('name')}\": table"
    if not all(isinstance(spec, dict) for spec in given):
        raise Problem(f"{where}: expected an object or a list of objects")
    specs = [checked(spec, f"{where}[{place}]") for place, spec in enumerate(given)]
    identities = [spec.get("id") for spec in specs if spec.get("id")]
    if len(set(identities)) < len(identities):
        raise Problem(f"{where}: two have the same id")
    return specs
