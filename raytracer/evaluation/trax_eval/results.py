"""results.json: every run of every sweep in a folder of results, in the form that ../README.md describes."""

import dataclasses
import datetime
import os
import shlex

from .finished import error_of, result_of
from .jobs import read_csv
from .pictures import pixels_that_differ
from .refits import add_rebuilding
from .scenes import order_options
from .sweep import CHIPS, option_of
from .util import Problem, hash_value, read_json, read_sealed, remark, shown, write_json, write_sealed
from .values import ratio, values_of

FORMAT, VERSION = "trax-eval-results", 2
CATALOGUES = ("programs", "scenes", "workloads")
# Statistics that only the run's own file has.
LEFT_OUT = ("tms", "channels", "instructions_by_operation", "identity")
SERIES_ROWS, SERIES_BEGIN = 2000, 500
SERIES_COLUMNS = ("issued", "icache_bank_conflict", "fp_add_conflict", "fp_mul_conflict", "dcache_bank_conflict",
                  "wait_memory", "halted")


def effective(point, tools):
    """Returns the settings without those that the machine has anyway, so that equal machines have equal names."""
    kept = []
    for pair in point.settings:
        if pair[0].startswith("trax-render --sample-") and point.mode == "exact":  # all of it is simulated
            continue
        if not option_of(pair[0]):
            rest = tuple(other for other in point.machine() if other[0] != pair[0])
            base = tuple(other for other in point.program.settings if other[0] == pair[0])
            without, whole = (tools.configuration(point.chip_file, some) for some in (rest + base, point.machine()))
            if without == whole:
                continue
        kept.append(pair)
    return dict(kept)


def preset_of(point, tools):
    """The point by the name that the paper's tables have for its machine, or as it is: 1x32 with chip.tps_per_tm=48 is
    1x48."""
    name = "x".join(map(str, tools.shape(point.chip_file, point.machine())))
    other = dataclasses.replace(
        point, chip=name, config="",
        settings=tuple(pair for pair in point.settings if pair[0] not in ("chip.tms", "chip.tps_per_tm")))
    same = name in CHIPS and tools.configuration(name, other.machine()) == tools.configuration(
        point.chip_file, point.machine())
    return other if same else point


def machine_of(point, tools):
    return {"config": point.chip, "set": effective(point, tools), "machine": dict(point.machine())}


def plan_file(out, sweep):
    """The sweep's requests. Exact runs stay in the results beside estimates of the same sweep."""
    modes = {"quick"} if sweep.quick else {point.mode for point in sweep.points} - {"exact"}
    return out / "sweeps" / ".".join([sweep.name, *sorted(modes), "json"])


def references(sweep, keys):
    """Point -> key of the run whose picture its own is compared with: that of the sweep's reference, otherwise as alike
    as there is."""
    found = {}
    for point in sweep.points if sweep.reference else ():
        same = [
            other for other in sweep.points if sweep.reference in (other.variant, other.program.name) and
            (other.scene, other.workload) == (point.scene, point.workload)
        ]

        def likeness(other):
            return other.chip == point.chip, len(set(other.settings) & set(point.settings)), \
                other.program is point.program

        if same:
            found[point] = keys[max(same, key=likeness)][0]
    return found


def write_plan(out, sweep, keys, tools, statistics):
    """Writes a sweep's requests, so that results.json can be made of all sweeps in the folder. keys: point -> key, or
    the reason why there is none. statistics: point -> those of its scene."""
    points, compared = [], references(sweep, keys)
    for point in sweep.points:
        key, reason = keys[point]
        scene, workload = sweep.scenes[point.scene], sweep.workloads[point.workload]
        order = order_options(tools.value(point.chip_file, point.machine(),
                                          "dcache.bytes")) if point.program.specialised else []
        imported = point.options("trax-scene", workload)
        points.append({
            "scene": point.scene, "view": scene["view"], "program": point.program.name,
            **machine_of(point, tools), "preset": machine_of(preset_of(point, tools), tools),
            "size": [int(side) for side in point.size.split("x")], "mode": point.mode, "workload": point.workload,
            "variant": point.variant, "chip_file": point.chip_file, "import": [*order, *imported] if imported else [],
            "options": point.options("trax-render",
                                     workload), "elf": None if point.program.specialised else str(point.program.source),
            "plain": point.program.plain, "reference": compared.get(point), "key": key, "error": reason,
            "statistics": statistics[point]
        })
    used = {point.workload for point in sweep.points}
    write_sealed(
        plan_file(out, sweep), {
            "name": sweep.name, "title": sweep.title, "x": sweep.x, "y": sweep.y, "y_per": sweep.y_per or None,
            "claim": sweep.claim, "file": sweep.file, "variants": sweep.variants, "reference": sweep.reference or None,
            "table": sweep.table, "programs": [{"name": program.name, "title": program.title}
                                               for program in sweep.programs],
            "scenes": [{name: scene[name] for name in ("name", "title", "licence", "paper")}
                       for scene in sweep.scenes.values()],
            "workloads": [{name: workload[name] for name in ("name", "title")}
                          for name, workload in sweep.workloads.items() if name and name in used], "points": points
        })


def repeat_command(point, result):
    """The command that makes this run alone; of a program that is compiled or changed, from the inputs that were
    made."""
    machine = ["--config", point.get("chip_file", point["config"])]
    for name, value in point["machine"].items():
        machine += ["--set", f"{name}={shown(value)}"]
    if not point.get("plain", True):
        return shlex.join([
            "trax-sim", f"inputs/{hash_value(result['job']['inputs'])}/manifest.json", *machine, "--stats", "stats.json"
        ]) if result else ""
    imported = ["trax-scene", *point.get("import", []), "MESHES", "-o", "scene.trax"]
    words = [
        "trax-render", "scene.trax" if point.get("import") else "SCENE", "--size", "x".join(map(str, point["size"])),
        *machine
    ]
    words += ["--view", point["view"]] if point["view"] else []
    words += ["--program", point["elf"]] if point.get("elf") else []
    words += ["--sampled"] if point["mode"] == "quick" else []
    words += point.get("options", [])
    render = shlex.join([*words, "--stats", "stats.json", "-o", "picture.png"])
    return f"{shlex.join(imported)} && {render}" if point.get("import") else render


def thin_series(path, threads):
    """Columns and at most SERIES_ROWS rows of a time series: the end of each interval, shares of its thread-cycles, and
    of the instructions that threads asked their cache for the share that a conflict refused. The beginning keeps every
    interval, what follows is joined."""
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
            shares = [
                sum(float(one[place[name]]) for one in group) / (cycles * threads) if cycles else None
                for name in chosen
            ]
            refused, issued = (sum(float(one[place[name]]) for one in group)
                               for name in ("icache_bank_conflict", "issued"))
            result.append([int(row[place["end"]]), ratio(refused, refused + issued), *shares])
            group = []
    return ["cycle", "fetch_refused", *chosen], result


def compared(out, result, reference):
    """Counts the pixels that differ from those of the run with the key `reference`."""
    other, _ = found_of(out, reference) if reference else (None, None)
    if not other or not result["picture"] or not other[0]["picture"]:
        return {}
    return {
        "picture.pixels_that_differ": pixels_that_differ(*(out / "pictures" / f"{one['picture']}.png"
                                                           for one in (result, other[0])))
    }


def catalogue(plans, kind):
    """Returns the plans' programs, scenes or workloads, each once."""
    return list({one["name"]: one for plan in reversed(plans) for one in reversed(plan.get(kind, []))}.values())[::-1]


def found_of(out, key):
    """Returns (value of result_of, None), or (None, a sentence about the damage)."""
    try:
        return result_of(out, key), None
    except Problem as problem:
        return None, f"{problem}; the command of its sweep makes it anew"


def run_of(out, tools, areas, point):
    """Returns a run's record, made of its files. Its machine has the paper's name, whatever the sweep calls it."""
    point = point | point.get("preset", {})
    run = {
        name: point[name] for name in ("key", "scene", "view", "size", "program", "config", "set", "machine", "mode")
    }
    found, damaged = found_of(out, point["key"]) if point["key"] else (None, None)
    run |= {
        "workload": point.get("workload", ""), "variant": point.get("variant", ""), "experiments": [], "points": [],
        "status": "missing", "command": repeat_command(point, found and found[0])
    }
    error = damaged or point["error"] or (error_of(out, point["key"]) if point["key"] else None)
    if found:
        result, host = found
        statistics = result["statistics"]
        series = out / "runs" / f"{point['key']}.csv"
        run |= {
            "status": "done", "json": f"runs/{point['key']}.json",
            "csv": f"runs/{series.name}" if series.exists() else None,
            "picture": f"pictures/{result['picture']}.png" if result["picture"] else None,
            "host_seconds": host.get("host_seconds"), "host": host or None,
            "stats": {name: value for name, value in statistics.items() if name not in LEFT_OUT
                      }, "values": values_of(result, areas) | compared(out, result, point.get("reference")) | {
                f"scene.{name}": value for name, value in point.get("statistics", {}).items()
            }
        }
    elif error:
        run |= {"status": "failed", "error": error}
    return run


def is_foreign(path):
    """Returns whether the file is JSON, but no plan."""
    try:
        value = read_json(path)
    except Problem:
        return False
    return not isinstance(value, dict) or not isinstance(value.get("points"), list)


def collect(out, tools, areas, command, seconds):
    """Writes results.json from the sweeps and runs of the folder, and returns its value."""
    runs, sweeps, series, plans = {}, [], [], []
    for path in sorted((out / "sweeps").glob("[!.]*.json")):
        try:
            plan = read_sealed(path)
        except Problem as problem:
            if is_foreign(path):
                raise Problem(f"{path}: trax-eval has not written this; -o is to be a folder of its own") from None
            remark(f"{problem}; the runs of that sweep are left out until its command comes again")
            continue
        if not any(sweep["name"] == plan["name"] for sweep in sweeps):
            sweeps.append({name: value for name, value in plan.items() if name not in ("points", *CATALOGUES)})
        plans.append(plan)
        for number, point in enumerate(plan["points"]):
            label = point["key"] or f"{plan['name']}-{number}"
            if label not in runs:
                runs[label] = run_of(out, tools, areas, point)
            run, named = runs[label], {
                "experiment": plan["name"], "variant": point.get("variant", ""),
                **{name: point[name] for name in ("config", "set", "machine")}
            }
            if plan["name"] not in run["experiments"]:
                run["experiments"].append(plan["name"])
            if named not in run["points"]:
                run["points"].append(named)
    add_rebuilding(plans, runs)
    for run in runs.values():
        if run.get("csv"):
            columns, rows = thin_series(out / run["csv"], run["stats"]["threads"])
            series.append({
                "name": run["experiments"][0], "title": f"{run['scene']}, {run['config']}, {run['program']}",
                "run": run["key"], "columns": columns, "rows": rows
            })
    value = {
        "format": FORMAT, "version": VERSION, "trax": tools.version(), "command": command,
        "created": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "host": {"processors": os.cpu_count()}, "host_seconds": round(seconds, 1), "runs": list(runs.values()),
        "sweeps": sweeps, "series": series, **{kind: catalogue(plans, kind) for kind in CATALOGUES}
    }
    write_json(out / "results.json", value)
    return value
