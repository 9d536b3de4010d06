"""results.json: every run of every sweep in a folder of results, in the form that ../README.md describes."""

import dataclasses
import datetime
import os
import shlex

from .jobs import error_of, read_csv, result_of
from .sweep import CHIPS, PROGRAMS
from .util import Problem, read_json, write_json
from .values import ratio, values_of

FORMAT, VERSION = "trax-eval-results", 1
LEFT_OUT = ("tms", "channels", "instructions_by_operation", "identity")  # of the statistics: the run's own file has them
SERIES_ROWS, SERIES_BEGIN = 2000, 500
SERIES_COLUMNS = ("issued", "icache_bank_conflict", "fp_add_conflict", "fp_mul_conflict", "dcache_bank_conflict", "wait_memory", "halted")


def effective(point, tools):
    """Without settings that are what the machine has anyway, so that equal machines are called equal."""
    kept = []
    for pair in point.settings:
        rest = tuple(other for other in point.machine() if other[0] != pair[0])
        base = tuple(other for other in PROGRAMS[point.program] if other[0] == pair[0])
        if tools.configuration(point.chip, rest + base) != tools.configuration(point.chip, rest + (pair,)):
            kept.append(pair)
    return dict(kept)


def preset_of(point, tools):
    """The point by the name that the paper's tables have for its machine, or as it is: 1x32 with chip.tps_per_tm=48 is 1x48."""
    name = "x".join(map(str, tools.shape(point.chip, point.machine())))
    other = dataclasses.replace(point, chip=name, settings=tuple(pair for pair in point.settings if pair[0] not in ("chip.tms", "chip.tps_per_tm")))
    same = name in CHIPS and tools.configuration(name, other.machine()) == tools.configuration(point.chip, point.machine())
    return other if same else point


def machine_of(point, tools):
    return {"config": point.chip, "set": effective(point, tools), "machine": dict(point.machine())}


def plan_file(out, sweep):
    modes = {"quick"} if sweep.quick else {point.mode for point in sweep.points} - {"exact"}
    return out / "sweeps" / ".".join([sweep.name, *sorted(modes), "json"])  # exact runs stay in the results beside estimates of the same sweep


def write_plan(out, sweep, keys, tools):
    """What a sweep asks for, so that results.json can be made of all sweeps in the folder. keys: point -> key, or the reason why there is none."""
    points = []
    for point in sweep.points:
        key, reason = keys[point]
        points.append({"scene": point.scene, "view": sweep.scenes[point.scene]["view"], "program": point.program, **machine_of(point, tools),
                       "preset": machine_of(preset_of(point, tools), tools), "size": [int(side) for side in point.size.split("x")], "mode": point.mode, "workload": point.workload,
                       "options": options_of(sweep, point), "key": key,
                       "error": reason})
    write_json(plan_file(out, sweep), {"name": sweep.name, "title": sweep.title, "x": sweep.x, "y": sweep.y, "y_per": sweep.y_per or None,
                                                       "claim": sweep.claim, "file": sweep.file, "points": points})


def options_of(sweep, point):
    """What trax-render is told of the workload, for meshes."""
    workload = sweep.workloads[point.workload]
    return [*workload["scene"], *workload["render"], *(["--mark-rays"] if point.ray_kinds else [])]


def repeat_command(point, tools):
    """The command that makes this run alone."""
    words = ["trax-render", "SCENE", "--size", "x".join(map(str, point["size"])), "--config", point["config"]]
    words += ["--view", point["view"]] if point["view"] else []
    for key, value in point["machine"].items():
        words += ["--set", f"{key}={str(value).lower() if isinstance(value, bool) else value}"]
    words += ["--program", tools.era_program()] if point["program"] == "era" else []
    words += ["--sampled"] if point["mode"] == "quick" else []
    words += point.get("options", [])
    return shlex.join([*words, "--stats", "stats.json", "-o", "picture.png"])


def thin_series(path, threads):
    """Columns and at most SERIES_ROWS rows of a time series: the end of each interval, shares of its thread-cycles, and of the instructions that
    threads asked their cache for the share that a conflict refused. The beginning keeps every interval, what follows is joined."""
    names, rows = read_csv(path)
    place = {name: index for index, name in enumerate(names)}
    chosen = [name for name in SERIES_COLUMNS if name in place]
    result, group = [], []
    chip = [row for row in rows if row[place["tm"]] == "all"]
    step = -(-(len(chip) - SERIES_BEGIN) // (SERIES_ROWS - SERIES_BEGIN)) if len(chip) > SERIES_ROWS else 1
    for index, row in enumerate(chip):
        group.append(row)
        if index < SERIES_BEGIN or len(group) == step or index == len(chip) - 1:
            cycles = sum(float(one[place["end"]]) - float(one[place["begin"]]) for one in group)
            shares = [sum(float(one[place[name]]) for one in group) / (cycles * threads) if cycles else None for name in chosen]
            refused, issued = (sum(float(one[place[name]]) for one in group) for name in ("icache_bank_conflict", "issued"))
            result.append([int(row[place["end"]]), ratio(refused, refused + issued), *shares])
            group = []
    return ["cycle", "fetch_refused", *chosen], result


def run_of(out, tools, areas, point):
    """What is known of a run, from its files. Its machine has the paper's name, whatever the sweep calls it."""
    point = point | point.get("preset", {})
    run = {name: point[name] for name in ("key", "scene", "view", "size", "program", "config", "set", "machine", "mode")}
    run |= {"workload": point.get("workload", ""), "experiments": [], "points": [], "status": "missing", "command": repeat_command(point, tools)}
    found = result_of(out, point["key"]) if point["key"] else None
    error = point["error"] or (error_of(out, point["key"]) if point["key"] else None)
    if found:
        result, host = found
        statistics = result["statistics"]
        series = out / "runs" / f"{point['key']}.csv"
        run |= {"status": "done", "json": f"runs/{point['key']}.json", "csv": f"runs/{series.name}" if series.exists() else None,
                "picture": f"pictures/{result['picture']}.png" if result["picture"] else None, "host_seconds": host.get("host_seconds"), "host": host or None,
                "stats": {name: value for name, value in statistics.items() if name not in LEFT_OUT}, "values": values_of(result, areas)}
    elif error:
        run |= {"status": "failed", "error": error}
    return run


def collect(out, tools, areas, command, seconds):
    """Writes results.json from the sweeps and runs of the folder, and returns its value."""
    runs, sweeps, series = {}, [], []
    for path in sorted((out / "sweeps").glob("[!.]*.json")):
        plan = read_json(path)
        if not isinstance(plan, dict) or not isinstance(plan.get("points"), list):
            raise Problem(f"{path}: trax-eval has not written this; -o is to be a folder of its own")
        if not any(sweep["name"] == plan["name"] for sweep in sweeps):
            sweeps.append({name: value for name, value in plan.items() if name != "points"})
        for number, point in enumerate(plan["points"]):
            label = point["key"] or f"{plan['name']}-{number}"
            if label not in runs:
                runs[label] = run_of(out, tools, areas, point)
            run, named = runs[label], {"experiment": plan["name"], **{name: point[name] for name in ("config", "set", "machine")}}
            if plan["name"] not in run["experiments"]:
                run["experiments"].append(plan["name"])
            if named not in run["points"]:
                run["points"].append(named)
    for run in runs.values():
        if run.get("csv"):
            columns, rows = thin_series(out / run["csv"], run["stats"]["threads"])
            series.append({"name": run["experiments"][0], "title": f"{run['scene']}, {run['config']}, {run['program']}", "run": run["key"],
                           "columns": columns, "rows": rows})
    value = {"format": FORMAT, "version": VERSION, "trax": tools.version(), "command": command,
             "created": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
             "host": {"processors": os.cpu_count()}, "host_seconds": round(seconds, 1), "runs": list(runs.values()), "sweeps": sweeps, "series": series}
    write_json(out / "results.json", value)
    return value
