"""The difference of two runs, as a value that JSON can have. Everything that is signed is B less A."""

import math
import os
import re

from trax_eval.pictures import png

from .figures import SECTIONS
from .runs import HOST, HOW, flat, is_number

ROUNDING = 1e-9  # relative: of sums of floats


def less(b, a):
    return b - a if is_number(a) and is_number(b) else None


def described(run):
    stats, chip = run.stats, run.stats["configuration"].get("chip", {})
    sampled = stats.get("sampled")
    return {
        "file": str(run.path), "program": stats.get("program"), "trax_sim": stats.get("trax_sim"),
        "chip": f"{chip.get('tms')}x{chip.get('tps_per_tm')}", "status": stats.get("status"),
        "cycles": stats["cycles"], "milliseconds": 1e3 * stats["seconds"] if is_number(stats.get("seconds")) else None,
        "interval": [sampled["cycles_low"], sampled["cycles_high"]] if sampled else None
    }


def cycles_of(a, b):
    """The difference of cycles. An interval of sampled runs takes their errors as independent."""
    difference, interval = b["cycles"] - a["cycles"], None
    ends = [run["interval"] or [run["cycles"], run["cycles"]] for run in (a, b)]
    sampled = [which for which, (low, high) in zip("AB", ends) if low != high]
    if sampled:
        below = math.hypot(ends[0][1] - a["cycles"], b["cycles"] - ends[1][0])
        above = math.hypot(a["cycles"] - ends[0][0], ends[1][1] - b["cycles"])
        interval = [difference - below, difference + above]
    return {
        "a": a["cycles"], "b": b["cycles"], "difference": difference,
        "relative": difference / a["cycles"] if a["cycles"] else None, "interval": interval,
        "sampled": sampled,
        "within_noise": interval and interval[0] <= 0 <= interval[1]
    }


def contributions(tables, threads, total, meaning=None):
    """Rows of {name: {cause: thread-cycles}} in the cycles of a mean thread, whose differences add up to `total`, the
    difference of cycles."""
    rows, (a, b) = [], tables
    for name in a.keys() | b.keys():
        parts = {cause: b.get(name, {}).get(cause, 0) / threads[1] - a.get(name, {}).get(cause, 0) / threads[0]
                 for cause in a.get(name, {}).keys() | b.get(name, {}).keys()}
        ends = [sum(table.get(name, {}).values()) / count for table, count in zip(tables, threads)]
        if not any(parts.values()):
            continue
        row = {"name": name, "a": ends[0], "b": ends[1], "difference": ends[1] - ends[0]}
        if meaning:
            row["meaning"] = meaning(f"causes.{name}")
        else:
            cause = max(sorted(parts), key=lambda one: abs(parts[one]))
            row |= {"cause": cause, "cause_difference": parts[cause]}
        rows.append(row)
    rest = total - math.fsum(row["difference"] for row in rows)
    if abs(rest) > ROUNDING * math.fsum(row["a"] + row["b"] for row in rows):
        rows.append({"name": "(charged to nothing)", "a": None, "b": None, "difference": rest})
    return sorted(rows, key=lambda row: (-abs(row["difference"]), row["name"]))


def kinds_of(a, b, threads, total, causes):
    tables = [{name: {cause: row.get(cause, 0) for cause in causes} for name, row in run.kinds.items()}
              for run in (a, b)]
    rows = contributions(tables, threads, total)
    for row in rows:
        for end, run in (("a", a), ("b", b)):
            kind = run.kinds.get(row["name"])
            row[f"rays_{end}"] = kind and kind["rays"]
            row[f"cycles_per_ray_{end}"] = kind["thread_cycles"] / kind["rays"] if kind and kind["rays"] else None
    return rows


def figures_of(a, b, figures):
    """(configuration, sections): every member of the statistics that differs, but for causes, and what only one has."""
    leaves = [{name: value for name, value in flat(run.stats) if name not in HOST} for run in (a, b)]
    found = {name: [] for name, *_ in SECTIONS} | {"configuration": []}
    for name in leaves[0].keys() | leaves[1].keys():
        ends = [side.get(name) for side in leaves]
        same = ends[0] == ends[1] and isinstance(ends[0], bool) == isinstance(ends[1], bool)
        if name.startswith("causes.") or same and all(name in side for side in leaves):
            continue
        row = {"name": name, "a": ends[0], "b": ends[1], "difference": less(ends[1], ends[0])}
        only = [which for which, side in zip("ab", leaves) if name in side]
        row |= {"only_in": only[0]} if len(only) == 1 else {}
        if name.startswith("configuration."):
            found["configuration"].append(row | {"name": name.removeprefix("configuration.")})
        else:
            found[figures.section(name)].append(row | {"unit": figures.unit(name), "meaning": figures.meaning(name)})
    orders = {name: order for name, _, order, _ in SECTIONS}
    for name, rows in found.items():
        rows.sort(key=lambda row: (-weight(row, orders.get(name)), row["name"]))
    return found.pop("configuration"), found


def weight(row, order):
    if row["difference"] is None or order is None:
        return math.inf
    whole = max(abs(row["a"]), abs(row["b"])) if order == "relative" else 1
    return abs(row["difference"]) / (whole or 1)


def pictures_of(a, b):
    """Counts, and pictures of the differences as PNGs (bytes)."""
    (width, height, one), (*size, other) = a.picture, b.picture
    if [width, height] != size:
        return {"sizes": [[width, height], size]}, {}
    each = [max(abs(x - y) for x, y in zip(one[at:at + 3], other[at:at + 3]))
            if one[at:at + 3] != other[at:at + 3] else 0 for at in range(0, len(one), 3)] if one != other else []
    counts = {"pixels": width * height, "different": sum(value > 0 for value in each), "largest": max(each, default=0)}
    made = {}
    if counts["different"]:
        made["pixels"] = shaded([value * 255 // counts["largest"] for value in each], width, height)
    if a.costs is not None and b.costs is not None:
        costs = [[sum(values) for values in zip(*run.costs.values())] or [0] * (width * height) for run in (a, b)]
        change = [y - x for x, y in zip(*costs)]
        most = max(map(abs, change), default=0)
        if most:
            place = max(range(len(change)), key=lambda at: (abs(change[at]), -at))
            counts["cost"] = {"pixels_less": sum(value < 0 for value in change),
                              "pixels_more": sum(value > 0 for value in change),
                              "largest": {"x": place % width, "y": place // width, "a": costs[0][place],
                                          "b": costs[1][place], "difference": change[place]}}
            made["cost"] = shaded([round(255 * value / most) for value in change], width, height)
    return counts, made


def shaded(values, width, height):
    """A PNG: nothing is transparent, more is orange, less is blue (the page's colours of memory and caches)."""
    colours = [bytes((200, 82, 0, value)) if value >= 0 else bytes((0, 114, 178, -value)) for value in range(-255, 256)]
    pixels = b"".join(colours[value + 255] for value in values)
    return png({"width": width, "height": height, "layout": "rgba uint8"}, pixels)


def warnings_of(a, b):
    """Reasons why the runs may not be comparable."""
    found = [note for run in (a, b) for note in run.notes]
    for run in (a, b):
        stats = run.stats
        if stats.get("status") != "finished":
            found.append(f"{run.path}: the run did not finish ({stats.get('status')}): its figures are partial")
        if abs(sum(stats["causes"].values()) - stats["thread_cycles"]) > ROUNDING * stats["thread_cycles"]:
            found.append(f"{run.path}: its causes do not add up to its thread-cycles")
        elif stats["thread_cycles"] != stats["threads"] * stats["cycles"]:
            found.append(f"{run.path}: thread_cycles is not threads times cycles")
    for name, text in (("trax_sim", "versions of trax-sim"), ("program", "programs"), ("items", "numbers of items"),
                       ("rays", "numbers of rays")):
        ends = [run.stats.get(name) for run in (a, b)]
        ends = [os.path.basename(str(end)) for end in ends] if name == "program" else ends
        if ends[0] != ends[1]:
            compiled = name == "program" and all(re.fullmatch(r"[0-9a-f]{32}\.elf", end) for end in ends)
            found.append(f"the runs have different {text}: " +
                         ("trax-render compiles one for each picture and number of TMs" if compiled else
                          f"{ends[0]} and {ends[1]}"))
    return found


def compare(a, b, figures):
    """The comparison of two runs, and its pictures."""
    ends = [described(run) for run in (a, b)]
    threads = [run.stats["threads"] for run in (a, b)]
    cycles = cycles_of(*ends)
    configuration, sections = figures_of(a, b, figures)
    causes = a.stats["causes"].keys() | b.stats["causes"].keys()
    tables = [{cause: {cause: value} for cause, value in run.stats["causes"].items()} for run in (a, b)]
    result = {
        "a": ends[0], "b": ends[1], "warnings": warnings_of(a, b), "cycles": cycles, "configuration": configuration,
        "causes": contributions(tables, threads, cycles["difference"], figures.meaning),
    }
    if not any(run.stats["thread_cycles"] for run in (a, b)):
        result["warnings"].append("neither run has cycles: the functional engine has no time")
    missing, pictures = {}, {}
    for name, parts in (("profile", ("functions", "lines")), ("kinds", ("kinds",)), ("picture", ("pictures",)),
                        ("costs", ())):
        without = [which for which, run in (("A", a), ("B", b)) if getattr(run, name) is None]
        if without:
            missing[name] = f"{' and '.join(without)} {'have' if len(without) == 2 else 'has'} none ({HOW[name]})"
        elif name == "profile":
            for part in parts:
                result[part] = contributions([run.profile[part] for run in (a, b)], threads, cycles["difference"])
        elif name == "kinds":
            result["kinds"] = kinds_of(a, b, threads, cycles["difference"], causes)
        elif name == "picture":
            result["pictures"], pictures = pictures_of(a, b)
    return result | {"sections": sections, "missing": missing}, pictures
