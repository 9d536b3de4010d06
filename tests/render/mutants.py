#!/usr/bin/env python3
"""Breaks the shading in the device program, one line at a time, and says whether the tests of shading notice.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there

Embree's pictures stay as they are.
"""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutation import ROOT, Mutant, compile_as, link_as, main  # noqa: E402
from device_copy import DEVICE, changed_copy, first_in  # noqa: E402

COMPILED = "tests/render/CMakeFiles/render-light-test.dir/light_test.c.o"
TESTS = [("render-light-test", "tests/render/light_test.c", []),
         ("render-shading-test", "raytracer/device/main.c", ["-Dmain=trax_twin", "-DTRAX_TWIN"])]
SECONDS = 120

# Name, file of raytracer/device, text, what it becomes.
MUTANTS = [
    ("sampler-order", "sampler.h", "& 0xFFFFu", "& 0xFFFu & 0x7FFu | 1"),
    ("sampler-pascal", "sampler.h", "x ^= x >> 2 & 0x3333u;", ""),
    ("sampler-dimension", "sampler.h", "hash_word(key + dimension * 0x9E3779B9u)", "hash_word(key)"),
    ("sampler-middle", "sampler.h", "^ first.x ^ 0x80000000u", "^ first.x"),
    ("disk-octants", "material.h", "steep ? (struct place){across, along} : (struct place){along, across}",
     "(struct place){along, across}"),
    ("fresnel-half", "material.h", "return 0.5f * (across * across + along * along);", "return across * across;"),
    ("total-reflection", "material.h", "if (float_bits(square) <= 0)\n    return 1;",
     "if (float_bits(square) <= 0)\n    return 0;"),
    ("mirror-length", "material.h", "times(2 * dot(normal, view), normal)",
     "times(1.999f * dot(normal, view), normal)"),
    ("mirror-inwards", "material.h", "return float_bits(dot(at->flat, way)) > 0 ? way : reflected(at->view, at->flat);",
     "return way;"),
    ("glass-ratio", "path.h", "bool turned = surface->turned;", "bool turned = !surface->turned;"),
    ("glass-tint", "path.h", "    if (through)\n      path->next_throughput",
     "    if (!through)\n      path->next_throughput"),
    ("glass-origin", "path.h", "through ? surface->behind : surface->start", "surface->start"),
    ("schlick-power", "material.h", "return square * square * rest;", "return square * square;"),
    ("facets-square", "material.h", "square_roughness / (shape * shape)", "square_roughness / shape"),
    ("masking", "material.h", "0.5f / (cosine * smith_view + view * smith(cosine, square))", "0.25f / (cosine * view)"),
    ("layer-density", "material.h", "*pdf = share * (d * 0.5f / (view + smith_view)) + (1 - share) * cosine;",
     "*pdf = (d * 0.5f / (view + smith_view));"),
    ("layer-energy", "material.h", "filtered(at->diffuse, below)", "at->diffuse"),
    ("rectangle-sides", "light.h", "if (float_bits(cosine) <= 0)\n      return false;", ""),
    ("rectangle-cosine", "light.h", "falloff *= cosine;", ""),
    ("falloff", "aim.h", "return inverse * inverse;", "return inverse;"),
    ("emitter-search", "light.h", "cumulative <= pick", "cumulative > pick"),
    ("emitter-point", "light.h", "float side = root(place.x);", "float side = place.x;"),
    ("emitter-density", "light.h", "at_least(choices * cosine, 0x1p-40f)", "at_least(cosine, 0x1p-40f)"),
    ("bound", "light.h", "at_most(at_least(value, 0), TRAX_MAX_RADIANCE)", "value"),
    ("texture-half", "texture.h", "(float)(int32_t)(1u << log2_width) - 0.5f", "(float)(int32_t)(1u << log2_width)"),
    ("texture-floor", "texture.h", "return whole - (value < (float)whole);", "return whole;"),
    ("texture-clamp", "texture.h", "number < 0 ? 0 : number > last ? last : number", "number & last"),
    ("texture-gamma", "texture.h", "{red * red, green * green, blue * blue}", "{255 * red, 255 * green, 255 * blue}"),
    ("metal-texture", "path.h", "if (metal)", "if (0)"),
    ("hole-distance", "path.h", "path->travelled += bits_float(hit->distance_bits);", ""),
    ("hole-shadow", "path.h", "    path->distance_bits = arrival.distance_bits;\n  }", "  }"),
    ("holes-solid", "path.h", "|| path->holes >= MOST_HOLES", "|| path->holes >= 1"),
    ("balance", "path.h", "share *= own / at_least(own + other, 0x1p-120f);", ""),
    ("lamp-from-start", "path.h", "pick.y, path->point, place", "pick.y, path->start, place"),
    ("chance-from-start", "path.h", "minus(surface->point, path->point)", "minus(surface->point, path->start)"),
    ("chance-uncorrected", "path.h", "share = at_most(own * facing", "share = 1 + 0 * at_most(own * facing"),
    ("balance-shadow", "path.h", "cosine / (arrival.pdf + pdf)", "cosine / arrival.pdf"),
    ("choices", "path.h", "float scale = cosine * choices;", "float scale = cosine;"),
    ("depth", "path.h", "path->depth >= RUN_PATH(run)->max_depth", "path->depth > RUN_PATH(run)->max_depth"),
    ("roulette", "path.h", "throughput = times(1 / chance, throughput);", ""),
    ("background", "path.h", "add_to(&path->light, path->throughput, far);", "path->light = plus(path->light, far);"),
    ("ambient", "path.h", "float ambient = run->ambient + dot(path->at.normal, load_vector(run->fill));",
     "float ambient = run->ambient;"),
    ("last-sample", "path.h", "++path->sample < run->samples", "++path->sample + 1 < run->samples"),
]


def first_failure(program):
    """Returns the first test of the program that fails, of which no more is run."""
    with subprocess.Popen(["prlimit", f"--cpu={SECONDS}", program], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace") as run:
        for line in run.stdout:
            if line.startswith("[  FAILED  ]"):
                run.kill()
                return line.split("] ")[1].strip()
    return f"{program.name} ends with status {run.returncode}" if run.returncode else None


def noticed(folder, build, mutant):
    """Returns the first test that fails in a copy of the device program."""
    changed_copy(folder, "tests/render", mutant)
    for test, program, macros in TESTS:
        made = folder / f"{test}.o"
        compile_as(build, COMPILED, ROOT / "tests/render/light_test.c", folder / program, made, *macros,
                   *first_in(folder), "-ffp-contract=off", "-fcommon", "-O1")  # the twin takes long to optimise
        link_as(build, f"tests/bin/{test}", folder / test, [made], without=["light_test.c.o"])
        if found := first_failure(folder / test):
            return [found]
    return []


if __name__ == "__main__":
    LIST = [Mutant(file, text, other, name) for name, file, text, other in MUTANTS]
    sys.exit(main(__doc__, DEVICE, LIST, noticed))
