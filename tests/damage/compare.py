"""Runs that must agree: of two engines on random machines, and of a command in two environments."""
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import tempfile

import mutate
from runs import CRASHED, run, with_message


def keys_of(binaries):
    """(key, bounds or None for a boolean, is a power of two) of the machine's keys, from --help-config. Those of warps
    are left out: the engines that are compared have none."""
    text = subprocess.run([binaries / "trax-sim", "--help-config"], capture_output=True, text=True, check=True).stdout
    for key, rest in re.findall(r"^(?!simt)([a-z0-9_]+\.[a-z0-9_]+) +(.*)$", text, re.MULTILINE):
        bounds = re.search(r"; (0 or )?(power of two, )?([0-9.]+) to ([0-9.]+)", rest)
        if bounds:
            yield key, (float(bounds[3]), float(bounds[4])), bool(bounds[2])
        elif "true or false" in rest:
            yield key, None, False


def setting(rng, keys):
    key, bounds, is_power = rng.choice(keys)
    if not bounds:
        return f"{key}={rng.choice(('true', 'false'))}"
    low, high = bounds
    if rng.random() < 0.1:
        return f"{key}={rng.choice(mutate.NUMBERS)}"
    usual = min(high, rng.choice((2, 3, 4, 7, 8, 16, 33, 64, 100, 1000, 4096)))
    value = rng.choice((low, high, low + 1, usual, low))
    value = 2 ** rng.randrange(max(1, int(high).bit_length())) if is_power and rng.random() < 0.8 else value
    return f"{key}={value:g}" if value < 1e5 else f"{key}={int(value)}"


def settings(binaries, good, number, seed, keys):
    """A machine by chance: the same in both engines, or refused by both in the same words."""
    rng = random.Random(f"{seed} settings {number}")
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"settings-{number}-"))
    words = ["--config", rng.choice(("1x32", "2x48", "4x32", "8x64")), "--max-cycles", "3000"]
    words += ["--quiet", "--alloc", "image=64"]
    if rng.random() < 0.4:
        words += ["--set", "memory.model=dram"]
    for _ in range(1 if number % 4 == 0 else rng.choice((1, 2, 3, 5))):
        words += ["--set", setting(rng, keys)]
    results = []
    for engine in ("fast", "reference"):
        stats = folder / f"{engine}.json"
        command = ["trax-sim", *words, "--engine", engine, "--stats", str(stats), str(good / "program.elf")]
        try:
            result = run(binaries, command, folder)
        except subprocess.TimeoutExpired:
            return "does not end", folder, command, None
        if CRASHED.search(result.stderr) or result.returncode not in (0, 1, 124):
            return with_message(f"status {result.returncode}", result), folder, command, None
        figures = json.loads(stats.read_text()) if stats.exists() else {}
        for name in ("host_seconds", "instructions_per_host_second", "engine", "host"):
            figures.pop(name, None)
        results.append((result.returncode, result.stdout, result.stderr, figures))
    return None if results[0] == results[1] else "the engines differ", folder, command, results[0][0]


# What the environment may change nothing of: the files {o} and {o}2 of each command.
USUAL = [
    ["clang", "--target=trax", "-O1", "program.c", "-o", "{o}"],
    ["clang", "--target=trax", "-O1", "-S", "program.c", "-o", "{o}"],
    ["trax-ld", "object.o", "-e", "main", "-o", "{o}", "-Map={o}2"],
    ["trax-mc", "text.s", "-filetype=obj", "-o", "{o}"],
    ["trax-objdump", "-d", "object.o"],
    ["trax-sim", "--quiet", "--alloc", "image=64", "--dump", "image={o}", "program.elf"],
    ["trax-scene", "-q", "mesh.obj", "-o", "{o}"],
    ["trax-scene", "-q", "mesh.gltf", "-o", "{o}"],
    ["trax-render", "-q", "--size", "5x3", "--config", "1x32", "scene.trax", "-o", "{o}", "--write-view", "{o}2"],
    ["trax-compare", "picture.png", "picture.exr"],
    ["trax-eval", "sweep.json", "--dry-run"],
]
VARIABLES = "HOME TMPDIR PATH XDG_CACHE_HOME LC_ALL LANG TERM COLUMNS PWD LOGNAME SHELL TZ".split()
TEXTS = ["", "/nowhere", "/dev/null", "/proc", "relative", "a b\nc", "$(false)", "de_DE.UTF-8", "\udcff", "x" * 5000]


def environment(binaries, good, number, seed):
    """A command in an odd environment has the result of the usual one, or refuses; it never succeeds with another."""
    rng = random.Random(f"{seed} environment {number}")
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"environment-{number}-"))
    variables, closed = dict(os.environ), []
    if rng.random() < 0.6:
        for name in rng.sample(VARIABLES, rng.choice((1, 1, 2, 4))):
            value = rng.choice([None, *TEXTS])
            variables.pop(name, None)
            if value is not None:
                variables[name] = value
    else:
        closed = rng.sample((0, 1, 2), rng.choice((1, 2, 3)))
    command, results = rng.choice(USUAL), []
    for odd in (False, True):
        place = folder / ("odd" if odd else "usual")
        shutil.copytree(good, place)
        words = [word.format(o="output") for word in command]
        result = run(binaries, words, place, variables if odd else None, closed if odd else ())
        files = [(place / name).read_bytes() if (place / name).exists() else None for name in ("output", "output2")]
        results.append((result, files))
    (usual, expected), (odd, found) = results
    fault = None
    if usual.returncode != 0:
        fault = with_message(f"status {usual.returncode} in the usual environment", usual)
    elif odd.returncode not in (0, 1) or CRASHED.search(odd.stderr):
        fault = with_message(f"status {odd.returncode}", odd)
    elif odd.returncode == 0 and (found != expected or 1 not in closed and odd.stdout != usual.stdout):
        fault = with_message("another result", odd)
    elif any(file not in (None, good_one) for file, good_one in zip(found, expected)):
        fault = with_message("a refusal leaves another output", odd)
    elif odd.returncode == 1 and closed and not (1 in closed and usual.stdout):
        fault = with_message("refuses although only streams are closed that it does not need", odd)
    changes = [f"{name}={variables.get(name)!r}" for name in VARIABLES if variables.get(name) != os.environ.get(name)]
    return fault, folder, [*words, "without", *closed, *changes], odd.returncode
