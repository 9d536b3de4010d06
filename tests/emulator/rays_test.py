#!/usr/bin/env python3
"""rays_test.py TRAX_SIM RAYS: --ray-kinds against the run's trace and statistics, from both engines and on machines
with and without a second-level cache; --ray-cycles against --ray-kinds, also of warps."""
import collections
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402

SIM, PROGRAM = (str(pathlib.Path(p).resolve()) for p in sys.argv[1:3])
KINDS = ["primary", "shadow", "occlusion", "diffuse", "glossy", "mirror", "glass", "other"]
ITEMS = 300


def run(directory, engine, *options):
    directory.mkdir(exist_ok=True)
    result = subprocess.run([SIM, "--quiet", "--engine", engine, "--stats", "stats.json", "--alloc",
                             f"results={4 * ITEMS}", *options, PROGRAM],
                            cwd=directory, capture_output=True, text=True, timeout=120)
    equal((result.returncode, result.stderr), (0, ""), directory, options)
    return json.loads((directory / "stats.json").read_text())


def rows(path):
    return list(csv.DictReader(path.open()))


def counted_kind(code, operand):
    """The kind of the rays that a trap counts, if it is one."""
    if code == "rays":
        return "other" if operand else None
    kinds = [kind for number, kind in enumerate(KINDS) if operand >> 4 * number & 15]
    return kinds[0] if len(kinds) == 1 else None


def read_trace(path):
    """{kind: {what: how many}}, from the lines of the trace alone. A cycle belongs to the instruction that a thread
    issues in it or waits for."""
    counts = collections.defaultdict(collections.Counter)
    kind, until = {}, collections.Counter()
    for line in path.read_text().splitlines()[1:]:
        match = re.match(r" *(\d+) +(\d+) +\S+ +(\w+) ", line)
        cycle, thread = int(match[1]), match[2]
        if match[3] == "arrival":
            continue
        before = kind.get(thread, "none")
        counts[before]["thread_cycles"] += cycle - until[thread]
        until[thread] = cycle + 1
        trap = re.search(r"  trap r\d+, (\w+) +(\w{8})", line)
        new = counted_kind(trap[1], int(trap[2], 16)) if trap and trap[1] in ("rays", "kinds") else None
        now = kind[thread] = new or before
        counts[now]["thread_cycles"] += 1
        counts[now]["issued"] += 1
        for name, pattern in (("flops", r"  f(add|sub|mul) "), ("dcache.misses", r" miss\b"),
                              ("dcache.hits", r"  lw .* hit\b"), ("fp_mul.operations", r"  fmul ")):
            counts[now][name] += re.search(pattern, line) is not None
        if trap and trap[1] == "items":
            kind[thread] = "none"
    return counts


def check_kinds(directory, stats, counts, line_bytes):
    table = {row["kind"]: row for row in rows(directory / "kinds")}
    equal(list(table), KINDS + ["none", "rest", "all"], "rows")
    for kind in KINDS + ["none"]:
        row = table[kind]
        equal(int(row["rays"]), stats["rays_by_kind"].get(kind, 0), "rays", kind)
        for what in ("issued", "flops", "dcache.misses", "dcache.hits", "fp_mul.operations"):
            equal(int(row[what]), counts[kind][what], what, "of", kind)
        if kind != "none":  # where a thread's end is, which the trace does not show
            equal(int(row["thread_cycles"]), counts[kind]["thread_cycles"], "thread-cycles of", kind)
        equal(int(row["memory.data_read_bytes"]), line_bytes * counts[kind]["dcache.misses"], "bytes of", kind)
    for what, total in table["all"].items():
        parts = [float(table[kind][what]) for kind in KINDS + ["none", "rest"]] if what != "kind" else []
        if what not in ("kind", "mrps", "utilisation", "bytes_per_ray", "energy_per_ray"):
            check(abs(sum(parts) - float(total)) <= 1e-6 * float(total), what, "adds up to", sum(parts), "not", total)
            check(min(parts) >= 0, what, "of a kind is negative", parts)
    # Only lines of the instruction cache, combined stores and what a second-level cache does are nobody's.
    for what, value in table["rest"].items():
        if what not in ("kind", "bytes", "energy", "memory.instruction_read_bytes", "memory.written_bytes"):
            equal(float(value), 0, "the rest of", what)
    everything = table["all"]
    equal([int(everything["rays"]), int(everything["thread_cycles"])], [stats["rays"], stats["thread_cycles"]], "all")
    check(abs(float(everything["mrps"]) - stats["mrps"]) < 1e-5 * stats["mrps"], "mrps", everything["mrps"],
          stats["mrps"])
    check(abs(float(everything["energy"]) - stats["energy"]["total"]) < 1e-8 * stats["energy"]["total"], "energy")
    diffuse = table["diffuse"]
    seconds = stats["seconds"] * int(diffuse["thread_cycles"]) / stats["thread_cycles"]
    check(abs(float(diffuse["mrps"]) * 1e6 * seconds / int(diffuse["rays"]) - 1) < 1e-5, "a kind's rate")
    check(float(diffuse["energy"]) > 0 and float(table["rest"]["energy"]) > 0, "energy of kinds")


def check_cycles(directory, stats, machine):
    """--ray-cycles has the thread-cycles of --ray-kinds, from any number of host threads, and changes nothing."""
    kinds = {row["kind"]: row for row in rows(directory / "kinds")}
    for threads in (1, 2):
        place = directory / str(threads)
        same = run(place, "fast", *machine, "--ray-cycles", "cycles", "--host-threads", str(threads))
        for name in ("cycles", "causes", "memory", "rays_by_kind"):
            equal(same[name], stats[name], "with --ray-cycles", name)
        table = rows(place / "cycles")
        equal([(row["part"], row["weight"], row["kind"]) for row in table],
              [("all", "1", kind) for kind in KINDS + ["none"]], "rows of --ray-cycles")
        for row in table:
            for what in ("rays", "thread_cycles", *stats["causes"]):
                equal(int(row[what]), int(kinds[row["kind"]][what]), what, "of", row["kind"], threads, "host threads")


def check_warps(directory, machine):
    """The same of lanes of warps. A width of 1 has the cycles of the fast engine."""
    for width in (1, 4):
        place = directory / f"warps-{width}"
        run(place, "simt", *machine, "--set", f"simt.width={width}", "--ray-kinds", "kinds", "--ray-cycles", "cycles")
        kinds = {row["kind"]: row for row in rows(place / "kinds")}
        for row in rows(place / "cycles"):
            for what in set(row) - {"part", "weight", "kind"}:
                equal(int(row[what]), int(kinds[row["kind"]][what]), what, "of", row["kind"], "in warps of", width)
    equal((directory / "warps-1/cycles").read_text(), (directory / "1/cycles").read_text(), "warps of 1")


def check_refusals(directory):
    """Only two engines count them, and from the beginning on."""
    run(directory, "fast", "--checkpoint", "state", "--checkpoint-at", "100")
    for words, message in ((["--engine", "reference"], "--ray-cycles needs the engine fast"),
                           (["--engine", "functional"], "--ray-cycles needs the engine fast"),
                           (["--resume", "state"], "--resume: the cycles of rays before the checkpoint are not known")):
        result = subprocess.run([SIM, *words, "--ray-cycles", "refused", "--alloc", f"results={4 * ITEMS}", PROGRAM],
                                cwd=directory, capture_output=True, text=True, timeout=120)
        check(result.returncode == 1 and message in result.stderr, words, result.returncode, result.stderr)
        check(not (directory / "refused").exists(), words, "left an output")


def main(directory):
    files = ["--ray-kinds", "kinds", "--trace", "trace"]
    chip = ["--set", "chip.tms=2", "--set", "chip.tps_per_tm=8"]
    machines = {"plain": (chip, 64), "l2": ([*chip, "--set", "l2.bytes=65536", "--set", "dcache.line_bytes=32"], 32)}
    for name, (machine, line_bytes) in machines.items():
        both = {engine: run(directory / f"{name}-{engine}", engine, *machine,
                            *files) for engine in ("fast", "reference")}
        equal((directory / f"{name}-fast/kinds").read_text(), (directory / f"{name}-reference/kinds").read_text(),
              "engines")
        stats = both["fast"]
        for engine in ("reference", "functional"):
            other = both.get(engine) or run(directory / f"{name}-{engine}", engine, *machine)
            equal((stats["rays_by_kind"], stats["rays"]), (other["rays_by_kind"], other["rays"]), engine)
        sixths = [slot % 4 for slot in range(ITEMS)]
        expected = {"primary": ITEMS, "shadow": sum(sixths), "diffuse": 2 * sum(sixths), "occlusion": 15 * ITEMS,
                    "other": 9 * ITEMS + 3 * (ITEMS // 5)}
        equal(stats["rays_by_kind"], {kind: expected.get(kind, 0) for kind in KINDS}, "counters")
        equal(stats["rays"], sum(expected.values()), "rays")
        counts = read_trace(directory / f"{name}-fast/trace")
        check_kinds(directory / f"{name}-fast", stats, counts, line_bytes)
        check_cycles(directory / f"{name}-fast", stats, machine)
        check_warps(directory / f"{name}-fast", machine)
        tms = {kind: sum(tm["rays_by_kind"][kind] for tm in stats["tms"]) for kind in KINDS}
        equal(tms, stats["rays_by_kind"], "TMs")
    check_refusals(directory / "refusals")
    series = run(directory / "series", "fast", *chip, "--series", "series", "--series-interval", "100")
    table = [row for row in rows(directory / "series" / "series") if row["tm"] == "all"]
    for kind in KINDS:
        equal(sum(int(row[f"rays_by_kind.{kind}"]) for row in table), series["rays_by_kind"][kind], "series", kind)


with tempfile.TemporaryDirectory() as temporary:
    main(pathlib.Path(temporary))
sys.exit(checking.failures != 0)
