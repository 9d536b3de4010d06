"""How the verdicts on the paper's claims depend on choices that the paper leaves open: the claims, judged anew by the
runs of each variant of the sweep `verdicts`."""

import copy

from .assertions import NOT_MEASURED
from .claims import UNKNOWN, claims
from .results import Results, ratio
from .table import Cell, Table, percent, words
from .tables import VERDICTS

SWEEP = "verdicts"


def _plain(run):
    """The run as if its variant's machine were the program's own."""
    run = copy.copy(run)
    run.set = {}
    return run


def _choices(results, sweep):
    """(name, results of this choice alone) for each variant, then for another view of the dragon, where there is
    one."""
    runs = results.of_sweep(SWEEP)
    made = []
    for variant in sweep.get("variants") or []:
        some = Results(results.document, [_plain(run) for run in runs if run.variant == variant])
        made.append((variant, some))
    dragon = results.columns["dragon"]
    views = [scene for scene, column in results.stands_for.items() if column == "dragon" and scene != dragon]
    for view in views:
        first = sweep["variants"][0] if sweep.get("variants") else ""
        some = Results(results.document, [_plain(run) for run in runs if run.variant == first])
        if not any(run.scene == view and run.done for run in some.runs):
            continue
        some.columns = some.columns | {"dragon": view}
        some.papers = list(some.columns.values())
        made.append((f"{first}, {view}", some))
    return made


def _cell(verdict, found):
    short = found.partition("; ")[0]
    text, style = VERDICTS[verdict]
    if verdict == UNKNOWN and found != NOT_MEASURED and not found.startswith("measured on"):
        text = "✓ as far as measured"
    return Cell(text, verdict, short, style)


def _width(runs):
    """The greatest relative half width of the rates' intervals."""
    halves = [ratio(interval[1] - interval[0], 2 * run.get("mrps")) for run in runs
              if run.done and run.is_estimate() and (interval := run.interval())]
    return max((half for half in halves if half is not None), default=None)


def table(results, paper):
    """Returns the table of the sweep's program; None if the sweep was not run."""
    sweep = next((sweep for sweep in results.sweeps if sweep.get("name") == SWEEP), None)
    choices = _choices(results, sweep) if sweep else []
    program = next((run.program for _, some in choices for run in some.runs), None)
    if program is None:
        return None
    judged = [claims(some, paper, [program]) for _, some in choices]
    rows = []
    for same in zip(*judged):
        verdicts = [claim.verdicts[program] for claim in same]
        if any(found != NOT_MEASURED for _, found in verdicts):
            rows.append([words(same[0].title), Cell(same[0].paper), *(_cell(*verdict) for verdict in verdicts)])
    chips = dict.fromkeys(run.config for _, some in choices for run in some.runs)
    width = _width([run for _, some in choices for run in some.runs])
    note = f"{program}, on {', '.join(chips)} alone. " + (
        f"Rates are estimates; the widest of their intervals is plus and minus {percent(width, digits=1)}." if width else
        "")
    columns = [("claim", "t"), ("paper", None), *((name, "t") for name, _ in choices)]
    return Table("verdicts-choices", "How the verdicts depend on free choices", columns, rows, note)
