"""The member `table` of a sweep: which tables its runs have (../README.md, "Tables"). The report draws them."""

from .util import Problem

AS = ("change", "times", "percent", "figure")  # how a figure is compared; the first is the default
SUMMARIES = ("geometric mean", "least", "greatest")


LISTS = ("each", "rows", "columns", "mean", "values", "summary")


def listed(value):
    return value if isinstance(value, list) else [value]


def is_text(value):
    return isinstance(value, str)


def is_figure(value):
    return is_text(value) or isinstance(value, dict) and is_text(value.get("name"))


def is_place(value):
    return isinstance(value, (str, int, float))


def is_choice(value):
    return isinstance(value, dict) and all(is_place(one) for some in value.values() for one in listed(some))


TEXT = is_text, "expected a text"
FLAG = (lambda value: isinstance(value, bool)), "expected true or false"
NAMES = (lambda value: all(map(is_text, listed(value)))), "expected names"
CHOICE = is_choice, "expected an object of axes and values"
COMPARED = (lambda value: value in AS), f"allowed are {', '.join(AS)}"
# The members of a table, and those of an object in its `values`: the test of each, and what its error says.
OF_TABLE = {
    "id": TEXT, "title": TEXT, "each": NAMES, "rows": NAMES, "columns": NAMES, "mean": NAMES, "where": CHOICE,
    "only": CHOICE, "as": COMPARED,
    "values": (lambda value: all(map(is_figure, listed(value))), "expected names"),
    "relative": (lambda value: is_choice(value) and all(map(is_place, value.values())), CHOICE[1]),
    "summary": (lambda value: all(one in SUMMARIES for one in listed(value)), f"allowed are {', '.join(SUMMARIES)}"),
}
OF_VALUE = {
    "name": TEXT, "per": TEXT, "title": TEXT, "percent": FLAG, "paper": FLAG, "as": COMPARED,
    "digits": (lambda value: type(value) is int and 1 <= value <= 15, "expected a number from 1 to 15"),
}


def check(given, members, where):
    for key, value in given.items():
        if key not in members:
            raise Problem(f'{where}: unknown key "{key}"; allowed are {", ".join(members)}')
        is_good, message = members[key]
        if not is_good(value):
            raise Problem(f"{where}.{key}: {message}")


def checked(given, where):
    """One description, with a list for each single word. A wrong member is a Problem."""
    check(given, OF_TABLE, where)
    spec = {key: listed(value) if key in LISTS else value for key, value in given.items()}
    for value in spec.get("values", []):
        if isinstance(value, dict):
            check(value, OF_VALUE, f"{where}.values")
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
