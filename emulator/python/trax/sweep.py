"""Runs of one program on several machines, and tables of runs."""

import concurrent.futures
import itertools
import json
import os
import threading

from ._library import TraxError
from .config import Config
from .machine import Machine, flat


def sweep(program, chips=(None, ), settings=None, jobs=None, setup=None, **run):
    """Runs a program or manifest on every chip with every combination of settings.

    chips: presets, files, Configs. settings: {key: list of values}. jobs: runs at the same time (default: the
    processors), each with one host thread. setup: called with each Machine before it runs, to bind its buffers.
    run: further arguments of Machine.run. Returns a pandas.DataFrame, a row for each run in the order of the
    combinations: chip, the settings, then every figure by its name. Errors: the first one of any run."""
    axes = {"chip": chips, **(settings or {})}
    for name, values in axes.items():
        if isinstance(values, (str, Config)) or not hasattr(values, "__iter__"):
            raise TraxError(f"sweep: {name}: expected a list of values, not {values!r}")
    points = [dict(zip(axes, values)) for values in itertools.product(*axes.values())]

    running, ended = set(), threading.Event()

    def work(point):
        machine = Machine(program, point["chip"], {key: value for key, value in point.items() if key != "chip"})
        running.add(machine)
        if ended.is_set():  # while the machine was made
            machine.interrupt()
        try:
            if setup is not None:
                setup(machine)
            return point | machine.run(threads=1, **run).figures()  # a Run would keep its machine's memory
        finally:
            running.discard(machine)

    import pandas
    with concurrent.futures.ThreadPoolExecutor(jobs or len(os.sched_getaffinity(0))) as pool:
        try:
            return pandas.DataFrame(list(pool.map(work, points)))
        except BaseException:  # what is under way ends, and nothing else begins
            ended.set()
            pool.shutdown(wait=False, cancel_futures=True)
            for machine in list(running):
                machine.interrupt()
            raise


def table(runs, points=None):
    """A pandas.DataFrame with a row for each Run and a column for each figure. points: for each run a dictionary that
    comes first in its row."""
    import pandas
    rows = [run.figures() for run in runs]
    return pandas.DataFrame([point | row for point, row in zip(points, rows)] if points else rows)


def results(path):
    """The runs of a results.json of trax-eval as a pandas.DataFrame: a row for each run with scene, program, chip,
    workload, size, variant, mode, its settings, derived values and statistics."""
    import pandas
    try:
        with open(path, encoding="utf-8") as file:
            return pandas.DataFrame([row_of(run) for run in json.load(file)["runs"]])
    except OSError as error:
        raise TraxError(f"{path}: {error.strerror}") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise TraxError(f"{path}: is no results.json of trax-eval ({type(error).__name__}: {error})") from error


def row_of(run):
    row = {name: run.get(name) for name in ("scene", "program", "config", "workload", "variant", "mode", "status")}
    row |= dict(zip(("width", "height"), run["size"])) | run.get("set", {})
    figures = flat(run.get("values") or {}) | flat(run.get("stats") or {})
    return row | {name: figure for name, figure in figures.items() if name not in row}
