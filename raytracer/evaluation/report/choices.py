"""How the verdicts on the paper's claims depend on choices that the paper leaves open: the claims, judged anew by the
runs of each variant of the sweep `verdicts`, and with each other view of the dragon."""

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


def _choices(results, program):
    """(name, results of this choice alone): as the program has it, with another view of the dragon, and as each variant
    has it."""
    own = Results(results.document, [run for run in results.runs if run.program == program and not run.variant])
    made = [("as chosen", own)]
    dragon = results.columns["dragon"]
    for view in [scene for scene, column in results.stands_for.items() if column == "dragon" and scene != dragon]:
        if any(run.scene == view and run.done for run in own.runs):
            other = copy.copy(own)
            other.columns = own.columns | {"dragon": view}
            other.papers = list(other.columns.values())
            made.append((view, other))
    runs = results.of_sweep(SWEEP)
    for variant in dict.fromkeys(run.variant for run in runs):
        made.append((variant, Results(results.document, [_plain(run) for run in runs if run.variant == variant])))
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
    runs = results.of_sweep(SWEEP)
    program = runs[0].program if runs else None
    if program is None:
        return None
    choices = _choices(results, program)
    judged = [claims(some, paper, [program]) for _, some in choices]
    rows = []
    for same in zip(*judged):
        verdicts = [claim.verdicts[program] for claim in same]
        if sum(found != NOT_MEASURED for _, found in verdicts) > 1:  # else no choice says anything about it
            rows.append([words(same[0].title), Cell(same[0].paper), *(_cell(*verdict) for verdict in verdicts)])
    width = _width(runs)
    note = f"{program}; a choice of the machine on {', '.join(dict.fromkeys(run.config for run in runs))} alone."
    note += f" These rates are estimates, of plus and minus {percent(width, digits=1)} at most." if width else ""
    columns = [("claim", "t"), ("paper", None), *((name, "t") for name, _ in choices)]
    return Table("verdicts-choices", "How the verdicts depend on free choices", columns, rows, note)
