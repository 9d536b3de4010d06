#!/usr/bin/env python3
"""Takes one precaution at a time out of the device program, in a copy, and says which cases of the extreme suite notice.

    mutants.py SCRATCH [--build build] [--only NAME]

Needs a finished build, which is not changed. Exit status 0 if every mutant fails in the case that is there for it.
"""

import argparse
import pathlib
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
METHODS = ["watertight", "moller-trumbore", "stack-1", "stack-2", "stack-4"]

# Name, file of raytracer/device, text, what it becomes, the case that must fail.
MUTANTS = [
    ("zero-outside", "triangle.h", " && a_bits << 1 != 0 && b_bits << 1 != 0", "", "axis-plus-zero"),
    ("any-determinant", "triangle.h", "LEAST_DETERMINANT_BITS 0x00800000", "LEAST_DETERMINANT_BITS 1", "vanishing"),
    ("no-doubt", "triangle.h", "UNITS_OF_DOUBT 4", "UNITS_OF_DOUBT 0", "duplicates-turned"),
    ("last-of-equals", "triangle.h", "!comes_first(triangle, hit->triangle)", "false", "duplicates"),
    ("shear", "triangle.h", "ray->shear_u * bw", "ray->shear_u * aw", "soup"),
    ("direction-of-zero", "ray.h", "* 0x1p-30f", "* 0", "axis-plus-zero"),
    ("far-planes", "ray.h", "far_origin_x = ox - margin_x", "far_origin_x = ox + margin_x", "closed-globe"),
    ("length-of-direction", "ray.h", "return bits_float(larger(0x7F000000 - exponent, 0x00800000))",
     "return exponent ? 1.0f : 1.0f", "directions-10^-20"),
    ("stack-dropped", "traverse.h", "entry.enter >= limit", "entry.enter >= 0", "soup"),
    ("ring-of-old", "stack.h", "(*top)->reference = 0;", ";", "soup"),
    ("trail-not-cut", "stack.h", "(trail->second & -trail->level) ^", "trail->second ^", "closed-globe"),
    ("lost-for-good", "traverse.h", "entry.reference = find_again(layout, scene, root, &trail);\n", "return hit->triangle != NULL;\n", "soup"),
    ("one-word", "stack.h", "trail->second = trail->upper_second;", "trail->second = 0;", "deepest"),
    ("no-offset", "shade.h", "float offset = bound * inverse_length", "float offset = 0 * inverse_length", "grazing-shadows"),
    ("no-step-back", "shade.h", "bits_float(0x7E800000 - far) * bound", "bits_float(0x7E800000 - far) * 0", "corners-dark"),
    ("no-slack", "shade.h", "LIGHT_SLACK 64", "LIGHT_SLACK 0", "light-on-surface"),
]


def link_command(build):
    """How ninja links render-extreme, as words."""
    commands = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "bin/render-extreme"], check=True,
                              capture_output=True, text=True).stdout.splitlines()
    return shlex.split(commands[-1].split(" && ")[1])


def make(mutant, folder, build):
    """Compile the mutant's query programs and the suite with them; the suite's path."""
    _, file, text, other, _ = mutant
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "raytracer/device", folder / "raytracer/device")
    shutil.copytree(ROOT / "tests/render/extreme", folder / "tests/render/extreme")
    source = folder / "raytracer/device" / file
    if source.read_text().count(text) != 1:
        sys.exit(f"mutants.py: error: {file}: not exactly once there: {text}")
    source.write_text(source.read_text().replace(text, other))
    query = str(folder / "tests/render/extreme/query.c")
    include = ["-I", str(ROOT / "raytracer/include")]
    link = link_command(build)
    for method in METHODS:
        macro = "-DTRAX_TRIANGLE=TRAX_" + method.upper().replace("-", "_")
        if method.startswith("stack-"):
            macro = "-DTRAX_STACK_ENTRIES=" + method.removeprefix("stack-")
        subprocess.run([build / "bin/clang", "--target=trax", "-std=c17", "-O3", macro, *include, query, "-o",
                        folder / f"query-{method}.elf"], check=True)
        subprocess.run(["cc", "-std=gnu17", "-O3", "-ffp-contract=off", macro, *include, "-I", str(ROOT / "runtime/include"),
                        "-DQUERY_FUNCTION=query_" + method.replace("-", "_"), "-c", query, "-o", folder / f"{method}.o"], check=True)
        link = [str(folder / f"{method}.o") if f"extreme-{method}.dir" in word else word for word in link]
    shutil.copy(build / "lib/trax/trax-raytracer.elf", folder)
    link[link.index("-o") + 1] = str(folder / "render-extreme")
    subprocess.run(link, check=True, cwd=build)
    return folder / "render-extreme"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scratch", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--only", help="the mutant of this name")
    options = parser.parse_args()
    chosen = [mutant for mutant in MUTANTS if options.only in (None, mutant[0])]
    if not chosen:
        sys.exit(f"mutants.py: error: no mutant is called {options.only}")
    missed = 0
    for mutant in chosen:
        name, case = mutant[0], mutant[-1]
        folder = (options.scratch / name).resolve()
        suite = make(mutant, folder, options.build.resolve())
        run = subprocess.run([suite, "--program-directory", folder, "--case", case], capture_output=True, text=True, timeout=600)
        said = sorted({line.split(": ", 2)[2] for line in run.stderr.splitlines() if line.startswith(("FAILED: ", "render-extreme: error: "))})
        missed += not said
        print(f"{name}: {case}: {'; '.join(said) if said else 'NOT NOTICED'}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} noticed")
    sys.exit(missed > 0)


if __name__ == "__main__":
    main()
