"""trax-eval space SWEEP.json: a design space by sampled runs, and exactly where its front may be."""

import dataclasses

from report import own
from report.results import Results
from trax_eval.planner import check_names
from trax_eval.sweep import read_sweep
from trax_eval.util import Problem

HELP = """\
usage: trax-eval space [OPTION...] SWEEP.json [SCENES]

Estimates every run of a sweep by sampling. Then it makes those exactly that may be on the front of rate and area: by
the intervals of the estimates, no other run of the same scene and rays has certainly more rays on no larger an area.
--report writes the page with the fronts. Finished runs are kept, as with trax-eval SWEEP.json. The options are those of
trax-eval, but --all, --mode and --prepare.
"""
AREA = "values.area_units"


def may_be_on_front(runs):
    """The runs of one scene and workload that no other certainly beats."""
    known = [(run, *(run.interval() or (run.get("mrps"), ) * 2), run.get(AREA)) for run in runs
             if run.get("mrps") is not None and run.get(AREA) is not None]
    return [run for run, _, high, area in known
            if not any(other_area <= area and low >= high and (other_area, low) != (area, high)
                       for _, low, _, other_area in known)]


def front_keys(results, keys):
    """The keys among these of runs that may be on the front."""
    runs = [run for run in results.runs if run.done and run.key in keys]
    return {run.key for some in own.groups(runs).values() for run in may_be_on_front(some)}


def check(options, files):
    for name, given in (("--all", options.all), ("--mode", options.mode), ("--prepare", options.prepare)):
        if given:
            raise Problem(f"space: {name} is not for it")
    if len(files) != 1:
        raise Problem("space: expected one sweep")


def explore(options, files, runs_of):
    """runs_of(sweep) makes a sweep's runs: (status, value of results.json, [(sweep, keys of its points)])."""
    check(options, files)
    check_names(options, [read_sweep(files[0], programs=options.programs)])
    chosen = {
        "programs": options.programs, "chips": options.chip, "only_scenes": options.scene,
        "only_variants": options.variant
    }
    exact = read_sweep(files[0], size=options.size, mode="exact", **chosen)
    if not exact.points:
        raise Problem(f"{files[0]}: has no runs")
    # Pictures are not made smaller if a size is given.
    status, value, plans = runs_of(read_sweep(files[0], size=exact.points[0].size, mode="quick", **chosen))
    if options.dry_run:
        return status
    estimated, results = {key: point for _, keys in plans for point, (key, _) in keys.items() if key}, Results(value)
    unknown = sum(run.done and run.key in estimated and run.get(AREA) is None for run in results.runs)
    if unknown:
        print(f"{unknown} of {len(estimated)} runs are on no front: no area is known of their caches", flush=True)
    wanted = {dataclasses.replace(estimated[key], mode="exact") for key in front_keys(results, estimated)}
    if not wanted:
        return status
    exact.points = [point for point in exact.points if point in wanted]
    print(f"{len(exact.points)} of {len(estimated)} runs may be on the front, and are made exactly", flush=True)
    return max(status, runs_of(exact)[0])
