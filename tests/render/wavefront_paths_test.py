#!/usr/bin/env python3
"""wavefront_paths_test.py BIN EXAMPLES: the picture of raytracer/examples/wavefront-paths.c is the general device
program's in every bit, as are its rays by kind, with several waves, with and without its sort, for all that it
renders."""
import functools
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402

BIN, EXAMPLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
call = functools.partial(checking.call, BIN)
BOX = pathlib.Path(__file__).resolve().parent / "box.obj"
LOOK = ["--view", BOX.with_suffix(".view"), "--size", "20x13", "-q"]  # an incomplete tile

# Options of the scene, and of the picture.
PICTURES = [
    ("paths", ["--material", "red=mirror", "--material", "white=ggx:0.3", "--nodes", "quantised"],
     ["--paths", "4", "--samples", "2"]),
    ("direct", ["--material", "red=glass", "--normals", "smooth", "--nodes", "binary"],
     ["--light=0.3,1.5,0.4", "--light=-0.5,0.5,0.6", "--occlusion", "2", "--one-sided", "--samples", "3"]),
    ("emission", ["--material", "white=emit:1,0.5,2"], ["--paths", "2"])]


def compile_program(name, *options):
    done = subprocess.run([BIN / "clang", "--target=trax", "-std=c17", "-O3", "-Wall", "-Wextra", "-Werror",
                           "-DQUEUES=2", "-DTRAX_TREE_DEPTH=TRAX_SCENE_DEFAULT_DEPTH", "-DWAVE=200u", *options, "-I",
                           EXAMPLES.parent / "include", "-I", EXAMPLES.parent, EXAMPLES / "wavefront-paths.c", "-o",
                           name], capture_output=True, text=True, check=False)
    equal(done.returncode, 0, name, done.stderr)


def render(name, *words):
    """The picture's bytes, and its rays by kind."""
    call("trax-render", f"{name}.trax", *LOOK, *words, "--config", "2x32", "-o", "x.pfm", "--stats", "x.json")
    found = json.loads(pathlib.Path("x.json").read_text())
    return pathlib.Path("x.pfm").read_bytes(), {key: found[key] for key in ("rays", "rays_by_kind") if key in found}


def pictures():
    compile_program("sorted.elf")
    compile_program("unsorted.elf", "-DSORTED=0")
    for name, scene, picture in PICTURES:
        call("trax-scene", BOX, "-q", *scene, "-o", f"{name}.trax")
        general = render(name, *picture, "--no-specialise")
        for program in ("sorted.elf", "unsorted.elf") if name == "paths" else ("sorted.elf",):
            check(render(name, *picture, "--program", program) == general, name, program)
    call("trax-scene", BOX, "-q", "-o", "plain.trax")
    done = call("trax-render", "plain.trax", *LOOK, "--program", "sorted.elf", "-o", "x.png", status=1)
    check("pictures with paths, materials or lights" in done.stderr, done.stderr)


sys.exit(checking.run(pictures))
