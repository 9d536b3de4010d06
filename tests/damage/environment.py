"""A command in an odd environment, which must agree with the usual one."""
import os
import pathlib
import random
import shutil
import tempfile

from runs import CRASHED, run, with_message

# Commands whose files {o} and {o}2 do not depend on the environment.
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
