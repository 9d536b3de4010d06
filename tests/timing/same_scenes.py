#!/usr/bin/env python3
"""Two installations, the same bytes: inputs, statistics, pictures, traces and profiles of the five scenes, for both
programs, on four chips with and without a second-level cache.

    same_scenes.py OLD_BIN NEW_BIN SCENES [--size 160x90] [--only EXPRESSION] [--jobs N]

Each run is made twice by each: whole, and its first cycles with everything that explains a run. Both run the inputs
that OLD_BIN prepared. What depends on the host is left out, and names that changed are mapped by the tables here. Ends
with status 1 if anything differs."""

import argparse
import concurrent.futures
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import interrupts  # noqa: E402

# What the old installation calls it: what the new one does. Of the JSON (a path, and a mapping of its values) and of
# CSV files.
JSON_NAMES = {
    "configuration.dcache.lru": ("configuration.dcache.replacement", {False: "fifo", True: "lru"}),
    "configuration.l2.lru": ("configuration.l2.replacement", {False: "fifo", True: "lru"}),
}
CSV_NAMES = {}
# What only the new one has: paths of the JSON, and names of columns.
ADDED = re.compile(
    r"(tms\.\d+\.)?(tps\.\d+\.)?(rays_by_kind\.|simt\.|dcache\.broadcast$|cause(s|_percent)\.(lockstep|divergence)$)|"
    r"lockstep$|divergence$|"
    r"configuration\.(simt\.|dram\.|memory\.model$|memory\.atomic_interval_cycles$|dcache\.fill_cycles$)"
)
OF_THE_HOST = {"program", "host_seconds", "instructions_per_host_second"}

SCENES = {
    "conference": ["conference.ply"], "crytek-sponza": ["crytek-sponza.ply"],
    "dragon": ["dragon.ply", "dragon_box.obj"], "forest": ["generate:forest"], "sibenik": ["sibenik.ply"]
}
CHIPS = {"1x32": ["--config", "1x32"], "4x32": ["--config", "4x32"], "8x64": ["--config", "8x64"],
         "16x64": ["--config", "8x64", "--set", "chip.tms=16"]}
CACHES = {"": [], " with l2": ["--set", "l2.bytes=262144"]}
WHOLE = ["--stats", "--series"]
EXPLAINED = [
    *WHOLE, "--profile", "--profile-folded", "--heat", "--heat-lines", "--items", "--post-mortem",
    "--trace", "--perfetto"
]
FIRST = ["--max-cycles", "12000", "--window", "10000:10600"]  # of the explained run


class Problem(Exception):
    pass


def run(command, folder, expected=0):
    done = subprocess.run(list(map(str, command)),
                          cwd=folder,
                          capture_output=True,
                          text=True,
                          errors="replace",
                          check=False)
    if done.returncode != expected:
        raise Problem(f"{shlex.join(map(str, command))}: exit status {done.returncode}: {done.stderr[-500:]}")


def prepare(installation, scenes, scene, program, size, folder):
    meshes = []
    for name in SCENES[scene]:
        places = [
            path for path in (os.path.join(scenes, name), os.path.join(scenes, name + ".xz")) if os.path.exists(path)
        ]
        meshes += [name] if name.startswith("generate:") else places[:1] or [os.path.join(scenes, name)]
    options = ["--program", os.path.join(installation, "..", "lib", "trax", "trax-era.elf")] if program == "era" else []
    run([
        os.path.join(installation, "trax-render"), *meshes, "--view", scene, "--size", size, *options, "--prepare",
        folder, "--quiet"
    ], scenes)


def program_options(folder):
    """The buffers, as options of trax-sim: of the manifest, or of the run.sh that installations before it wrote."""
    manifest = os.path.join(folder, "manifest.json")
    if os.path.exists(manifest):
        with open(manifest, encoding="utf-8") as file:
            buffers = json.load(file)["buffers"]
        return [word for buffer in buffers for word in
                (["--bind", f"{buffer['symbol']}={os.path.join(folder, buffer['file'])}"] if "file" in buffer else
                 ["--alloc", f"{buffer['symbol']}={buffer['bytes']}"])]
    with open(os.path.join(folder, "run.sh"), encoding="utf-8") as script:
        words = shlex.split(script.read().splitlines()[-1])
    found = []
    for option, value in zip(words, words[1:]):
        if option == "--bind":
            symbol, _, file = value.partition("=")
            found += [option, f"{symbol}={os.path.join(folder, file)}"]
        elif option == "--alloc":
            found += [option, value]
    return found


def files_of(installation, inputs, machine, files, more, folder, status):
    """Runs it; the bytes of all that it wrote."""
    os.makedirs(folder, exist_ok=True)
    outputs = [word for option in files for word in (option, option[2:])]
    run([
        os.path.join(installation, "trax-sim"), *machine, *program_options(inputs), *outputs, *more, "--dump",
        "image=picture", "--host-threads", "1", "--quiet",
        os.path.join(inputs, "program.elf")
    ], folder, status)
    contents = {}
    for name in [option[2:] for option in files] + ["picture"]:
        path = os.path.join(folder, name)
        if os.path.exists(path):
            with open(path, "rb") as file:
                contents[name] = file.read()
            os.remove(path)
    return contents


def flat(value, path=""):
    """{path: value} of JSON."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if items is None:
        return {path: value}
    return {
        inner: leaf
        for name, part in items for inner, leaf in flat(part, f"{path}.{name}" if path else str(name)).items()
    }


def mapped(statistics):
    found = {}
    for path, value in statistics.items():
        name, values = JSON_NAMES.get(path, (path, {}))
        found[name] = values.get(value, value) if values else value
    return found


def without_added(content, names):
    """A table without the columns that only the new installation has."""
    rows = [row.split(b",") for row in content.split(b"\n")]
    added = {place for place, word in enumerate(rows[0]) if word.decode() not in names and ADDED.match(word.decode())}
    return b"\n".join(b",".join(cell for place, cell in enumerate(row) if place not in added)
                      for row in rows) if added else content


def differences(name, old, new):
    """Of a file: what differs, in words; empty if nothing does."""
    if name == "stats":
        one, other = (flat(json.loads(content)) for content in (old, new))
        one = mapped(one)
        paths = [
            path for path in sorted(one.keys() | other.keys())
            if path not in OF_THE_HOST and not (path not in one and ADDED.match(path))
        ]
        missing = object()
        wrong = [path for path in paths if one.get(path, missing) != other.get(path, missing)]
        return [f"{path}: {one.get(path, 'nothing')}, {other.get(path, 'nothing')}" for path in wrong]
    if name in ("series", "items", "heat", "heat-lines"):
        head, newline, rest = old.partition(b"\n")
        names = [CSV_NAMES.get(word, word) for word in head.decode().split(",")]
        old, new = ",".join(names).encode() + newline + rest, without_added(new, names)
    if old == new:
        return []
    lines = list(zip(old.split(b"\n"), new.split(b"\n")))
    first = next((i for i, (one, other) in enumerate(lines) if one != other), len(lines))
    pair = lines[first] if first < len(lines) else (b"", b"")
    return [f"line {first + 1} of {len(old.split(chr(10).encode()))}: {pair[0][:100]!r}, {pair[1][:100]!r}"]


def loaded(content):
    """What a machine sees of an ELF file: the entry and the segments. The rest has the installation's paths."""
    entry, headers = struct.unpack_from("<2I", content, 24)
    size, count = struct.unpack_from("<2H", content, 42)
    segments = [struct.unpack_from("<8I", content, headers + i * size) for i in range(count)]
    return entry, [(fields[2:], content[fields[1] : fields[1] + fields[4]]) for fields in segments if fields[0] == 1]


def compare_inputs(old, new):
    """Lines for what the new installation prepares in another way."""
    found = []
    for name in sorted(set(os.listdir(old)) | set(os.listdir(new))):
        contents = []
        for folder in (old, new):
            path = os.path.join(folder, name)
            with open(path if os.path.exists(path) else os.devnull, "rb") as file:
                contents.append(file.read())
        if all(content.startswith(b"\x7fELF") for content in contents):
            contents = [loaded(content) for content in contents]
        if contents[0] != contents[1]:
            found.append(f"{name} is another one")
    return found


class Comparison:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.runs = self.files = self.bytes = self.differing = 0

    def tell(self, where, name, found):
        self.differing += bool(found)
        for line in found[:5]:
            print(f"{where}: {name}: {line}", flush=True)
        if len(found) > 5:
            print(f"{where}: {name}: {len(found) - 5} more", flush=True)

    def inputs(self, scene, program):
        places = [os.path.join(self.folder, which, scene, program) for which in ("old", "new")]
        for installation, place in zip((self.options.old, self.options.new), places):
            os.makedirs(os.path.dirname(place), exist_ok=True)
            prepare(installation, self.options.scenes, scene, program, self.options.size, place)
        self.files += len(os.listdir(places[0]))
        self.tell(f"{scene}, {program}", "inputs", compare_inputs(*places))
        return places[0]

    def pair(self, where, inputs, machine, explained):
        files, more, status = (EXPLAINED, FIRST, 124) if explained else (WHOLE, [], 0)
        folder = os.path.join(self.folder, re.sub(r"\W+", "-", where) + str(explained))
        pair = [
            files_of(os.path.abspath(installation), inputs, machine, files, more, os.path.join(folder, which), status)
            for installation, which in ((self.options.old, "old"), (self.options.new, "new"))
        ]
        self.runs += 1
        for name in sorted(pair[0].keys() | pair[1].keys()):
            old, new = (contents.get(name) for contents in pair)
            self.files += 1
            self.bytes += len(old or b"")
            self.tell(
                where + (", explained" if explained else ""), name,
                differences(name, old, new) if old is not None and new is not None else ["is written by one only"])
        missing = {option[2:] for option in files} - pair[0].keys() - {"post-mortem"}
        self.tell(where, "files", [f"{name} is not written" for name in sorted(missing)])

    def all(self):
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            runs = []
            for scene in SCENES:
                for program in ("ours", "era"):
                    wanted = [(f"{scene}, {program}, {chip}{cache}", [*CHIPS[chip], *CACHES[cache]]) for chip in CHIPS
                              for cache in CACHES]
                    wanted = [(where, machine) for where, machine in wanted if re.search(self.options.only, where)]
                    if not wanted:
                        continue
                    inputs = self.inputs(scene, program)
                    runs += [
                        pool.submit(self.pair, where, inputs, machine, explained) for where, machine in wanted
                        for explained in (False, True)
                    ]
            for one in runs:
                one.result()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("old", type=os.path.abspath, help="the folder of the programs of the one installation")
    parser.add_argument("new", type=os.path.abspath, help="of the other")
    parser.add_argument("scenes", type=os.path.abspath, help="the folder of the scenes' meshes")
    parser.add_argument("--size", default="160x90", help="of the pictures (default %(default)s)")
    parser.add_argument("--only", default="", help="runs in whose name it is found, as 'dragon, era, 4x32 with l2'")
    parser.add_argument("--jobs", type=int, default=1, help="pairs of runs at once (default %(default)s)")
    options = parser.parse_args()
    interrupts.end_by_signals()
    begin = time.monotonic()
    try:
        with tempfile.TemporaryDirectory(prefix="same-scenes.") as folder:
            comparison = Comparison(options, folder)
            comparison.all()
    except Problem as problem:
        sys.exit(f"same_scenes.py: error: {problem}")
    print(
        f"{comparison.runs} pairs of runs, {comparison.files} files, {comparison.bytes:,} bytes: "
        f"{comparison.differing} differ; {time.monotonic() - begin:.0f} s")
    return 1 if comparison.differing or not comparison.runs else 0


if __name__ == "__main__":
    sys.exit(main())
