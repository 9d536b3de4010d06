#!/usr/bin/env python3
"""traces_test.py SOURCE BIN: --memory-trace and --ray-trace against the statistics and against each other's formats, by
the scripts of docs/traces.md."""
import collections
import contextlib
import csv
import functools
import importlib
import io
import json
import math
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

SOURCE, BIN = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
sys.path[:0] = [str(SOURCE / "tests" / folder) for folder in ("docs", "report", "")]
import checking  # noqa: E402
import explore_page  # noqa: E402
from blocks import read_blocks  # noqa: E402
from checking import check  # noqa: E402

WIDTH, HEIGHT = 16, 10
PICTURE = ["--view", "forest", "--size", f"{WIDTH}x{HEIGHT}", "--quiet"]
SIZE = ["forest.trax", *PICTURE]  # its tree is built once
MOST_LINES = 30  # of a reader in the page
call = functools.partial(checking.call, BIN)


def readers():
    """The modules that the page has as files."""
    sys.path.insert(0, os.getcwd())
    modules = []
    for words, text, line in read_blocks((SOURCE / "docs/traces.md").read_text()):
        if words.startswith("python "):
            name = words.split()[1]
            check(text.count("\n") <= MOST_LINES, f"docs/traces.md, line {line}: {text.count(chr(10))} lines")
            pathlib.Path(name).write_text(text)
            modules.append(importlib.import_module(name.removesuffix(".py")))
    check(len(modules) == 3, "docs/traces.md has", len(modules), "scripts")
    return modules[0], modules[2]


def load(path):
    return json.loads(pathlib.Path(path).read_text())


def without_host(stats):
    host = ("host_", "instructions_per_host", "fast_path")
    return {key: value for key, value in stats.items() if not key.startswith(host)}


# --- memory ---

MACHINES = {
    "limit": [],
    "lists": ["memory.channels=2", "memory.atomic_latency_cycles=30", "memory.min_transfer_bytes=32"],
    "l2": ["l2.bytes=65536", "l2.line_bytes=128", "memory.interleave_bytes=256"],
    "dram": ["memory.model=dram", "dram.preset=lpddr3-1600", "memory.channels=2"],
    "dram-l2": ["memory.model=dram", "l2.bytes=65536"],
}


def settings(keys):
    return [word for key in keys for word in ("--set", key)]


def check_memory(reader, name, keys):
    sim = ["trax-sim", "kept/manifest.json", *settings(keys)]
    call(*sim, "--memory-trace", "fast.bin", "--stats", "with.json")
    call(*sim, "--stats", "without.json")
    check(without_host(load("with.json")) == without_host(load("without.json")), name, "other statistics with a trace")
    others = [["--engine", "reference"]]
    if name in ("limit", "dram-l2"):
        others += [["--host-threads", "3"], ["--profile", "profile.txt"]]
    for engine in others:
        call(*sim, *engine, "--memory-trace", "other.bin")
        check(
            pathlib.Path("fast.bin").read_bytes() == pathlib.Path("other.bin").read_bytes(), name, "differs with",
            engine)

    transfers, memory = list(reader.read("fast.bin")), load("with.json")["memory"]
    check(len(transfers) == memory["transfers"] and len(transfers) > 100, name, len(transfers), memory["transfers"])
    check(sum(transfer.bytes for transfer in transfers) == memory["bytes"], name, "bytes")
    check(transfers == sorted(transfers, key=lambda transfer: (transfer.cycle, transfer.channel)), name, "order")
    moved = collections.Counter()
    for transfer in transfers:
        moved[reader.KINDS[transfer.kind]] += transfer.bytes
        check((transfer.tm < 0) == (transfer.kind == 5), name, "TM of", transfer)
    if "l2" in name:
        check(moved["l2_line"] == load("with.json")["l2"]["read_bytes"], name, moved)
    else:
        check(moved["data_line"] == memory["data_read_bytes"], name, moved)
        check(moved["instruction_line"] == memory["instruction_read_bytes"], name, moved)
    check(moved["write"] == memory["written_bytes"], name, moved)

    check_places(name, sim, reader, transfers)
    call(*sim, "--memory-trace", "fast.csv")
    with open("fast.csv", newline="") as file:
        rows = [(*map(int, (row["cycle"], row["address"], row["bytes"], row["tm"])), reader.KINDS.index(row["kind"]),
                 int(row["channel"])) for row in csv.DictReader(file)]
    check(rows == transfers, name, "CSV and binary differ")
    check_others(name, sim, keys, transfers)


def table(path, **columns):
    with open(path, newline="") as file:
        return [{name: kind(row[name]) for name, kind in columns.items()} for row in csv.DictReader(file)]


def check_places(name, sim, reader, transfers):
    """Addresses, TMs and cycles against other reports of the run."""
    call(*sim, "--heat-lines", "heat.csv", "--series", "series.csv", "--series-interval", "97")

    def asked(kind, of):
        return collections.Counter(of(transfer) for transfer in transfers if reader.KINDS[transfer.kind] == kind)

    tms = load("with.json")["tms"]
    if "l2" not in name:
        lines = table("heat.csv", address=lambda text: int(text, 16), atomics=int, loads=int, hits=int, misses=int,
                      merged=int)
        counts = {
            "atomic": lambda line: line["atomics"] if name != "dram" else 0,  # which moves nothing in DRAM
            "load": lambda line: line["loads"] - line["hits"] - line["misses"] - line["merged"],
            "data_line": lambda line: line["misses"]}
        for kind, count in counts.items():
            counted = {line["address"]: count(line) for line in lines if count(line)}
            check(asked(kind, lambda transfer: transfer.address // 64 * 64) == counted, name, kind, "by address")
        for kind, cache in (("data_line", "dcache"), ("instruction_line", "icache")):
            misses = {tm["tm"]: tm[cache]["misses"] for tm in tms}
            check(asked(kind, lambda transfer: transfer.tm) == misses, name, cache, "misses of TMs")
    if "dram" not in name:  # there the statistics count a transfer when the DRAM serves it
        moved = collections.Counter()
        for transfer in transfers:
            moved[transfer.cycle // 97] += transfer.bytes
        rows = table("series.csv", tm=str, begin=int, **{"memory.bytes": lambda text: int(text or 0)})
        counted = {row["begin"] // 97: row["memory.bytes"] for row in rows if row["tm"] == "all"}
        check({begin: count for begin, count in counted.items() if count} == moved, name, "bytes of intervals")


def check_others(name, sim, keys, transfers):
    """The formats of other simulators."""
    dram = "memory.model=dram" in keys
    machine = call("trax-sim", *settings(keys), "--print-config").stdout
    key = lambda name: int(re.search(rf"{name} = (\d+)", machine)[1])  # noqa: E731
    block = key("burst_length") * key("bus_bits") // 8 if dram else 64
    expected = [(transfer.kind == 3, transfer.address // block * block + at, transfer.cycle)
                for transfer in transfers for at in range(0, transfer.bytes, block)]
    ticks = (key("mtps"), 2 * key("clock_mhz")) if dram else (1, 1)

    def convert(form, pattern, status=0):
        """Converts as the page's command does, which docs-commands runs."""
        out, reason = io.StringIO(), None
        try:
            with contextlib.redirect_stdout(out):
                sys.modules["memory_trace_for"].main(form, "fast.bin", machine)
        except SystemExit as ended:
            reason = ended.code
        lines = [re.fullmatch(pattern, line) for line in out.getvalue().splitlines()]
        check(bool(reason) == bool(status) and all(lines), name, form, reason)
        return lines, reason

    lines, _ = convert("dramsim3", r"0x([0-9A-F]+) (READ|WRITE) (\d+)")
    check([(line[2] == "WRITE", int(line[1], 16), int(line[3])) for line in lines] == [
        (write, address, -(-cycle * ticks[0] // ticks[1])) for write, address, cycle in expected
    ], name, "dramsim3 differs")
    lines, _ = convert("loadstore", r"(LD|ST) 0x([0-9a-f]+)")
    check([(line[1] == "ST", int(line[2], 16)) for line in lines] == [entry[:2] for entry in expected], name,
          "loadstore differs")
    lines, refusal = convert("readwrite", r"(R|W) (\d+),(\d+),(\d+),(\d+),(\d+)", status=0 if dram else 1)
    if not dram:
        check("memory.model = dram" in refusal and not lines, name, refusal)
        return
    check(len(lines) == len(expected), name, "readwrite")
    banks = int(re.search(r"ranks = .*\n *banks = (\d+)", machine)[1])
    counts = {"channel": key("channels"), "rank": key("ranks"), "bank": banks, "row": 2**32,
              "column": key("row_bytes") // block}
    mapping = re.search(r'mapping = "(.*)"', machine)[1].split(":")
    check([line[1] == "W" for line in lines] == [write for write, _, _ in expected], name, "reads and writes")
    for line, (_, address, _) in zip(lines, expected):
        place = place_of(address // block, mapping, counts)
        if place != tuple(map(int, line.groups()[1:])):
            check(False, name, "place of", hex(address), line[0], "not", place)
            break


def place_of(burst, mapping, counts):
    """(channel, rank, bank, row, column) of a burst, by timing-memory.md, "Mapping"."""
    place, known = dict.fromkeys(counts, 0), dict.fromkeys(counts, 0)
    left = {name: count.bit_length() - 1 for name, count in counts.items()}
    widths = [re.fullmatch(r"([a-z]+)(\d*)", part).groups() for part in mapping]
    for name, width in widths:
        left[name] -= int(width or 0)
    for name, width in reversed(widths):
        bits = int(width) if width else left[name]
        place[name] |= (burst & (1 << bits) - 1) << known[name]
        known[name] += bits
        burst >>= bits
    return tuple(place.values())


def memory(reader):
    call("trax-render", *SIZE, "--config", "1x32", "--set", "chip.tms=2", "--set", "chip.tps_per_tm=8", "-o", "m.png",
         "--keep", "kept", "--memory-trace", "render.csv")
    call("trax-sim", "kept/manifest.json", "--memory-trace", "sim.csv")
    check(
        pathlib.Path("render.csv").read_text() == pathlib.Path("sim.csv").read_text(),
        "trax-render's and trax-sim's traces differ")
    for name, keys in MACHINES.items():
        check_memory(reader, name, keys)
    for words in (["trax-sim", "kept/manifest.json"], ["trax-render", *SIZE]):
        done = call(*words, "--memory-trace", "no.bin", "--memory-trace-format", "dramsim3", status=1)
        check("memory_trace_for.py" in done.stderr and not pathlib.Path("no.bin").exists(), done.stderr)
    call("trax-sim", "kept/manifest.json", "--engine", "functional", "--memory-trace", "f.bin", status=1)
    check(not pathlib.Path("f.bin").exists(), "the functional engine left a trace")


# --- rays ---

PICTURES = {
    "paper": [],
    "samples": ["--samples", "3"],
    "paths": ["--paths", "3", "--samples", "2", "--one-sided"],
    "occlusion": ["--occlusion", "3"],
    "mirrors": [],  # of a scene of them
}


def check_rays(reader, name, words):
    render = ["trax-render", "mirrors.trax" if name == "mirrors" else "forest.trax", *PICTURE, *words]
    call(*render, "-o", "with.png", "--stats", "with.json", "--ray-trace", "rays.bin")
    call(*render, "-o", "without.png", "--stats", "without.json")
    check(
        pathlib.Path("with.png").read_bytes() == pathlib.Path("without.png").read_bytes(), name,
        "another picture with a trace")
    check(without_host(load("with.json")) == without_host(load("without.json")), name, "other statistics with a trace")
    call(*render, "-o", "native.png", "--engine", "native", "--threads", "3", "--ray-trace", "other.bin")
    check(
        pathlib.Path("rays.bin").read_bytes() == pathlib.Path("other.bin").read_bytes(), name,
        "differs with engine native")

    rays = list(reader.read("rays.bin"))
    counts = collections.Counter(reader.KINDS[ray.kind] for ray in rays)
    expected = {kind: count for kind, count in load("with.json")["rays_by_kind"].items() if count}
    check(("mirror" in expected) == (name == "mirrors"), name, expected)
    check(dict(counts) == expected, name, counts, expected)
    check(any(ray.hit for ray in rays) and not all(ray.hit for ray in rays), name, "hits")
    for ray in rays:
        check(ray.triangle == 2**32 - 1 or ray.hit, name, "a triangle without a hit", ray)
        check(ray.x < WIDTH and ray.y < HEIGHT and ray.nodes > 0 and ray.distance <= ray.interval[1], name, ray)

    call(*render, "--engine", "native", "--ray-trace", "rays.csv")
    with open("rays.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    counted = "x", "y", "sample", "hit", "nodes", "triangles"
    check([(row["kind"], *(int(row[word]) for word in counted), row["triangle"]) for row in rows] ==
          [(reader.KINDS[ray.kind], *(getattr(ray, word) for word in counted),
            "" if ray.triangle == 2**32 - 1 else str(ray.triangle)) for ray in rays], name, "CSV and binary differ")
    places = [f"{what}_{axis}" for what in ("origin", "direction")
              for axis in "xyz"] + ["begin", "end", "distance", "weight1", "weight2"]
    for row, ray in zip(rows, rays):
        written = [float(row[place] or 0) for place in places]
        check(
            all(
                abs(a - b) <= 1e-8 * abs(a)
                for a, b in zip(written, (*ray.origin, *ray.direction, *ray.interval, ray.distance, *ray.weights))),
            name, row, ray)
    return rays


def check_way(rays):
    """Rays from the eye begin there, those to the light where the ray before them hit, and each visits what its pixel's
    do in --explore."""
    eye = list(
        map(float,
            re.search(r"eye = \[(.*)\]", (SOURCE / "raytracer/views/forest.view").read_text())[1].split(",")))
    for before, ray in zip([None, *rays], rays):
        expected = eye if ray.kind == 0 else [
            origin + before.distance * way for origin, way in zip(before.origin, before.direction)
        ]
        check(math.dist(ray.origin, expected) <= 1e-4 * math.hypot(*expected), "origin of", ray, "not", expected)
    call("trax-render", *SIZE, "-o", "p.png", "--explore", "p.html")
    columns = explore_page.unpack(pathlib.Path("p.html"))[1]
    for what in ("nodes", "triangles"):
        visited = collections.Counter()
        for ray in rays:
            visited[ray.y * WIDTH + ray.x] += getattr(ray, what)
        check([visited[place] for place in range(WIDTH * HEIGHT)] == columns[f"counts.{what}"], what, "of pixels")


def check_numbers(reader):
    """Triangles have their numbers in the mesh, whose order is not the tree's: squares in a row, of two each."""
    order = random.Random(1).sample(range(16), 16)
    with open("row.obj", "w") as file:
        for left in order:
            file.write(f"v {left} 0 0\nv {left + 1} 0 0\nv {left + 1} 1 0\nv {left} 1 0\nf -4 -3 -2\nf -4 -2 -1\n")
    call("trax-render", "row.obj", "--eye", "8,0.5,9", "--look-at", "8,0.5,0", "--fov", "85", "--size", "96x64",
         "--engine", "native", "--quiet", "--ray-trace", "row.bin")
    seen = set()
    for ray in reader.read("row.bin"):
        x, y = (origin + ray.distance * way for origin, way in zip(ray.origin[:2], ray.direction[:2]))
        if ray.kind == 0 and ray.hit and min(abs(x % 1 - y), x % 1, 1 - x % 1) > 1e-4:
            seen.add(ray.triangle)
            check(ray.triangle == 2 * order.index(int(x)) + (y > x % 1), "the triangle of", ray)
    check(len(seen) == 32, "triangles seen:", seen)


def rays(reader):
    for name, words in PICTURES.items():
        traced = check_rays(reader, name, words)
        if name == "paper":
            check_way(traced)
    check_numbers(reader)
    for words, message in ((["--sampled"], "leaves out"), (["--engine", "embree"], "Embree"),
                           (["--prepare", "d"], "--prepare")):
        out = [] if "--prepare" in words else ["-o", "q.png"]
        done = call("trax-render", *SIZE, *words, *out, "--ray-trace", "no.bin", status=1)
        check(message in done.stderr and not pathlib.Path("no.bin").exists(), words, done.stderr)
    call("trax-render", *SIZE, "-o", "same.bin.png", "--ray-trace", "same.bin.png", status=1)


def interrupted(option):
    """Ctrl-C leaves no file, and one of that name stays."""
    pathlib.Path("old.csv").write_text("old")
    words = ["-o", "i.png"] if option == "--memory-trace" else []
    run = subprocess.Popen(
        [BIN / "trax-render", *SIZE[:3], "--size", "2000x1000", "--samples", "16", *words, option, "old.csv"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL)
    while run.poll() is None and not [
            path for path in pathlib.Path().iterdir() if path.name.startswith("old.csv") and path.name != "old.csv"
    ]:
        time.sleep(0.05)
    run.send_signal(signal.SIGINT)
    check(run.wait(60) == -signal.SIGINT, option, "status", run.returncode)
    check(pathlib.Path("old.csv").read_text() == "old", option, "the file of before is gone")
    left = [path.name for path in pathlib.Path().iterdir() if path.name.startswith((".old", "old.csv"))]
    check(left == ["old.csv"], option, "left", left)


def traces():
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell's background jobs ignore it, and their children would too
    pathlib.Path("forest.trax").symlink_to(BIN.parent / "tests/forest.trax")
    call("trax-scene", "generate:forest", "--material", "mirror", "--splits=1", "--passes", "0", "-o", "mirrors.trax",
         "--quiet")
    memory_reader, ray_reader = readers()
    memory(memory_reader)
    rays(ray_reader)
    interrupted("--memory-trace")
    interrupted("--ray-trace")


sys.exit(checking.run(traces))
