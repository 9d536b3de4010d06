"""The verdicts on the paper's claims under choices that the paper leaves open: the claims are judged again by the
runs with another view of the dragon, and by those of SWEEPS that make one of CHOICES."""

import copy

from .assertions import NOT_MEASURED
from .claims import UNKNOWN, claims
from .results import Results, ratio
from .table import Cell, Table, percent, words
from .tables import VERDICTS

SWEEP = "verdicts"  # whose first program is judged
SWEEPS = {SWEEP, "compare-units", "special-unit"}
CHOICES = {
    "floats compared on adders": {"fpu.compare_units": False}, "FPDIV/iSQRT taken for 8 cycles": {
        "special.pipelined": False
    }
}


def _as_chosen(run, choice):
    """The run as if the choice were the program's own, if it makes this choice and no other; else None."""
    others = {key: value for key, value in run.set.items() if key != "memory.bandwidth_gbps"}
    if run.workload or others != choice or not SWEEPS & set(run.experiments):
        return None
    run = copy.copy(run)
    run.set = {key: value for key, value in run.set.items() if key not in choice}
    return run


def _choices(results, program):
    """(name, results of this choice alone): as the program has it, with another view of the dragon, and as CHOICES
    have it."""
    runs = [run for run in results.runs if run.program == program and run.done]
    made = [("as chosen", Results(results.document, [run for run in runs if not run.variant]))]
    own, dragon = made[0][1], results.columns["dragon"]
    for view in [scene for scene, column in results.stands_for.items() if column == "dragon" and scene != dragon]:
        if any(run.scene == view for run in own.runs):
            other = copy.copy(own)
            other.columns = own.columns | {"dragon": view}
            other.papers = list(other.columns.values())
            made.append((view, other))
    for name, choice in CHOICES.items():
        some = [other for run in runs if (other := _as_chosen(run, choice))]
        made += [(name, Results(results.document, some))] if some else []
    return made


def _cell(verdict, found):
    if not _is_measured(found):
        return Cell(None)
    text, style = VERDICTS[verdict]
    return Cell("✓ as far as measured" if verdict == UNKNOWN else text, verdict, found.partition("; ")[0], style)


def _is_measured(found):
    """The choice must be on all scenes: a verdict on some of them is not comparable."""
    return found != NOT_MEASURED and not found.startswith("measured on")


def _width(runs):
    """The greatest relative half width of the rates' intervals."""
    halves = [ratio(interval[1] - interval[0], 2 * run.get("mrps")) for run in runs
              if run.is_estimate() and (interval := run.interval())]
    return max((half for half in halves if half is not None), default=None)


def table(results, paper):
    """Returns the table; None if nothing was chosen otherwise."""
    program = next((run.program for run in results.of_sweep(SWEEP)), None)
    choices = _choices(results, program)
    if len(choices) < 2:
        return None
    judged = [claims(some, paper, [program]) for _, some in choices]
    rows = []
    for same in zip(*judged):
        verdicts = [claim.verdicts[program] for claim in same]
        if any(_is_measured(found) for _, found in verdicts[1:]):
            rows.append([words(same[0].title), Cell(same[0].paper), *(_cell(*verdict) for verdict in verdicts)])
    width = _width([run for _, some in choices[1:] for run in some.runs])
    note = f"{program}; of a choice what was measured."
    note += f" Estimated rates are within plus and minus {percent(width, digits=1)}." if width else ""
    columns = [("claim", "t"), ("paper", None), *((name, "t") for name, _ in choices)]
    return Table("verdicts-choices", "How the verdicts depend on free choices", columns, rows, note)
