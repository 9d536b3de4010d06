#!/usr/bin/env python3
"""Takes one precaution at a time out of the device program, in a copy, and says which cases of the extreme suite
notice.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there

Exit status 0 if every mutant fails in the case that is there for it.
"""

import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = map(str, (HERE.parent, HERE.parents[1]))
from device_copy import DEVICE, changed_copy, first_in  # noqa: E402
from mutation import ROOT, Mutant, command, compile_as, main  # noqa: E402

TESTS = "tests/render/extreme"

# Name, file of raytracer/device, text, what it becomes, the case that must fail.
MUTANTS = [
    ("zero-outside", "triangle.h", " && a_bits << 1 != 0 && b_bits << 1 != 0", "", "closed-globe"),
    ("any-determinant", "triangle.h", "LEAST_DETERMINANT_BITS 0x00800000", "LEAST_DETERMINANT_BITS 1",
     "needle-behind-light"),
    ("no-doubt", "triangle.h", "UNITS_OF_DOUBT 4", "UNITS_OF_DOUBT 0", "duplicates-turned"),
    ("last-of-equals", "triangle.h", "!comes_before(triangle, hit)", "false", "duplicates"),
    ("shear", "triangle.h", "- ray->origin.x - ray->shear_u * w;", "- ray->origin.x - ray->shear_v * w;", "soup"),
    ("direction-of-zero", "ray.h", "* 0x1p-30f", "* 0", "axis-plus-zero"),
    ("far-planes", "../layouts/binary/planes.h", "far_origin = minus(origin, margin)",
     "far_origin = plus(origin, margin)", "closed-globe"),
    ("length-of-direction", "ray.h", "return bits_float(larger(0x7F000000 - exponent, 0x00800000))",
     "return exponent ? 1.0f : 1.0f", "directions-10^-20"),
    ("stack-dropped", "traverse.h", "top->enter >= limit", "top->enter >= 0", "soup"),
    ("no-offset", "shade.h", "times(bound * inverse_length, n)", "times(0 * inverse_length, n)", "grazing-shadows"),
    ("no-step-back", "shade.h", "bits_float(0x7E800000 - far) * bound", "bits_float(0x7E800000 - far) * 0",
     "corners-dark"),
    ("exact-bound", "exact.h", "* 0x1p-17f + 0x1p-38f", "* 0", "tiny-1e16"),
    ("exact-scale", "exact.h", "bits_float(0x7F000000 - (size & 0x7F800000))", "1.0f", "tiny-1e18"),
    ("exact-borrow", "exact.h", "carry = turned ? *at != 0 : both == 0;", "carry = 0;", "room-1e18"),
    ("exact-order", "exact.h", "sign ^ odd << 31", "sign", "room-1e9"),
    ("exact-side", "exact.h", "exactly_turned(&direction.x, v0)", "~float_bits(dot(n, minus(a, eye))) & SIGN_BIT",
     "oblique"),
    ("exact-point", "exact.h", "bound = way_bound, base = eye, inside = way", "bound = bound", "picture-both"),
    ("exact-way", "exact.h", "#define aim_at_light aim_at_light_exactly\n", "", "tiny-lit"),
    ("far-start", "exact.h", "OFFSET_PER_WAY 0x1p-19f", "OFFSET_PER_WAY 0x1p-12f", "low-step"),
    ("instance-margin", "instance.h", "instance->stretch * world->margin", "0 * world->margin", "instances-1e-3"),
    ("no-slack", "aim.h", "LIGHT_SLACK 64", "LIGHT_SLACK 0", "light-on-surface"),
]


MADE = set()  # folders: without a mutant, one serves all cases


def make(folder, build, mutant):
    """Compiles the query programs and the suite with them."""
    changed_copy(folder, TESTS, mutant)
    query = TESTS + "/query.c"
    for program in (build / "lib/trax").glob("query-*.elf"):
        compile_as(build, f"lib/trax/{program.name}", ROOT / query, folder / query, folder / program.name,
                   *first_in(folder))
    for program in ("trax-raytracer.elf", "trax-raytracer-exact.elf"):
        shutil.copy(build / "lib/trax" / program, folder)
    link = command(build, "tests/bin/render-extreme")
    for i, word in enumerate(link):
        if word.endswith("/query.c.o"):
            link[i] = folder / f"{i}.o"
            compile_as(build, word, ROOT / query, folder / query, link[i], *first_in(folder))
    link[link.index("-o") + 1] = folder / "render-extreme"
    subprocess.run(link, check=True, cwd=build)


def noticed(folder, build, mutant):
    """Returns what the suite says of the mutant's case, with as many rays as the test takes."""
    if folder not in MADE:
        make(folder, build, mutant)
        MADE.add(folder)
    run = subprocess.run([folder / "render-extreme", "--program-directory", folder, "--case", mutant.case,
                          "--rays", "60"], capture_output=True, text=True, timeout=600, check=False)
    said = {line.split(": ", 2)[2]
            for line in run.stderr.splitlines() if line.startswith(("FAILED: ", "render-extreme: error: "))}
    return sorted(said) + ([f"ends by signal {-run.returncode}"] if run.returncode < 0 else [])


if __name__ == "__main__":
    LIST = [Mutant(file, text, other, name, case) for name, file, text, other, case in MUTANTS]
    sys.exit(main(__doc__, DEVICE, LIST, noticed, unchanged=lambda mutant: mutant.case))
