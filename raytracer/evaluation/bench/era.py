#!/usr/bin/env python3
"""What the era program would scale like, had it been written otherwise where the paper's text leaves it open.

    raytracer/evaluation/bench/era.py SCENES_DIRECTORY [--size 640x360] [--configs 1x32,8x64] [--only CHOICE;...] [--scene NAME] [--jobs N] [--bin build/bin]

SCENES_DIRECTORY is lean.py's. Each choice changes a line or two of raytracer/examples/1-plain.c, the arrays that it reads, the tree or the data cache. A row for each
scene and choice: million rays a second on the first chip, its speed-up to the last one, adds and multiplications and bytes a ray there. A
choice whose picture is another one than the era program's is marked; those by which a ray may meet another one of two surfaces at one place are."""

import array
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from scenes import ROOT, arguments, files_of  # first: it says where trax_eval is
from trax_eval.manifest import buffer_options, read_manifest

SCENES = ["conference", "crytek-sponza", "dragon", "forest"]
NODE_WORDS, TRIANGLE_WORDS = 8, 10  # of trax/plain_scene.h
COUNT, FIRST = 6, 7

# --- changes of the source: (what is there, what takes its place)

TILES = [("render(frame, pixel % frame->width, pixel / frame->width)", "render(frame, x, y)"),
         ("frame->width * frame->height;", "frame->width * ((frame->height + 7) & ~7u);"),
         ("    trax_store_nt((unsigned *)image.data + pixel,",
          """    unsigned column = pixel / 64 % (frame->width / 8), row = pixel / 64 / (frame->width / 8);
    unsigned x = column * 8 + pixel % 8, y = row * 8 + pixel / 8 % 8;
    if (y >= frame->height)
      continue;
    trax_store_nt((unsigned *)image.data + y * frame->width + x,""")]
EVERY_HIT = [("  if (cosine > 0) {\n    ray", "  {\n    ray"), ("    if (!hit.triangle)\n      light +=", "    if (!hit.triangle && cosine > 0)\n      light +=")]
ANY_HIT = [("  const struct trax_plain_triangle *triangle; /* NULL", "  bool any;\n  const struct trax_plain_triangle *triangle; /* NULL"),
           ("struct hit hit = {INFINITY, NULL};", "struct hit hit = {INFINITY, false, NULL};"), ("(struct hit){square * inverse, NULL}", "(struct hit){square * inverse, true, NULL}"),
           ("hit_triangle(ray, &triangles[node->first + i], hit);", "hit_triangle(ray, &triangles[node->first + i], hit);\n      if (hit->any && hit->triangle)\n        return;")]
UNORDERED = [("bool second = enter1 < enter0;", "bool second = false;")]
AT_VISIT = [("    if (node->count < 0) {\n      float enter0, enter1;\n      unsigned first = node->first;", "    float enter;\n    if (!hit_box(ray, node, hit->distance, &enter)) {\n    } else if (node->count < 0) {\n      unsigned first = node->first;"),
            (re.compile(r"      bool hit0 = hit_box.*?\n    \} else \{", re.S), "      stack[top++] = first + 1;\n      number = first;\n      continue;\n    } else {"),
            ("stack[TRAX_PLAIN_MAX_DEPTH]", "stack[TRAX_PLAIN_MAX_DEPTH + 1]")]
RECORD = "struct record {\n  float v0[3], v1[3], v2[3];\n  %s};\n%s\nstruct ray {"
LONG_RECORD = [("struct ray {", RECORD % ("unsigned material, padding[2];\n", "")), ("const struct trax_plain_triangle *", "const struct record *")]
SHORT_RECORD = [("struct ray {", RECORD % ("", "struct trax_buffer materials;")), ("const struct trax_plain_triangle *", "const struct record *"),
                ("triangle->material", "((const unsigned *)materials.data)[triangle - (const struct record *)plain_triangles.data]")]


# --- changes of the arrays; words are little endian, as is the host (x86-64)


def words(path):
    values = array.array("I")
    values.frombytes(path.read_bytes())
    return values


def siblings_apart(folder):
    """The root, and behind it the pairs: every pair is in two lines of 64 bytes."""
    nodes = words(folder / "nodes.bin")
    for place in range(0, len(nodes), NODE_WORDS):
        if nodes[place + COUNT] == 0xFFFFFFFF:
            nodes[place + FIRST] -= 1
    (folder / "nodes.bin").write_bytes((nodes[:NODE_WORDS] + nodes[2 * NODE_WORDS:]).tobytes())


def long_record(folder):
    triangles, padding = words(folder / "triangles.bin"), array.array("I", (0, 0))
    record = array.array("I")
    for place in range(0, len(triangles), TRIANGLE_WORDS):
        record += triangles[place:place + TRIANGLE_WORDS] + padding
    (folder / "triangles.bin").write_bytes(record.tobytes())


def short_record(folder):
    triangles = words(folder / "triangles.bin")
    (folder / "materials.bin").write_bytes(triangles[TRIANGLE_WORDS - 1::TRIANGLE_WORDS].tobytes())
    vertices = array.array("I")
    for place in range(0, len(triangles), TRIANGLE_WORDS):
        vertices += triangles[place:place + TRIANGLE_WORDS - 1]
    (folder / "triangles.bin").write_bytes(vertices.tobytes())


class Choice:
    """Of nothing changed: the era program."""

    def __init__(self, name, source=(), arrays=None, tree=(), settings=()):
        self.name, self.source, self.arrays, self.tree, self.settings = name, source, arrays, tuple(tree), settings


CHOICES = [
    Choice("as chosen"),
    Choice("siblings in two lines", arrays=siblings_apart),
    Choice("tiles of 8x8 pixels", TILES),
    Choice("a shadow ray from every hit", EVERY_HIT),
    Choice("shadow rays to any hit", ANY_HIT),
    Choice("children not ordered", UNORDERED),
    Choice("boxes tested when visited", AT_VISIT),
    Choice("triangles of 48 bytes", LONG_RECORD, long_record),
    Choice("triangles of 36 bytes, materials apart", SHORT_RECORD, short_record),
    Choice("spatial splits", tree=["--splits"]),
    Choice("leaves of 1", tree=["--leaf", "1"]),
    Choice("leaves of 7", tree=["--leaf", "7"]),
    Choice("cache lines of 32 bytes", settings=["dcache.line_bytes=32"]),
    Choice("a cache of 4 ways", settings=["dcache.ways=4"]),
    Choice("floats compared on adders", settings=["fpu.compare_units=false"]),
]


def compiled(source, changes, output, compiler):
    for old, new in changes:
        count = len(old.findall(source)) if isinstance(old, re.Pattern) else source.count(old)
        if not count:
            sys.exit(f"era.py: error: raytracer/examples/1-plain.c has no longer: {getattr(old, 'pattern', old)}")
        source = old.sub(lambda _: new, source) if isinstance(old, re.Pattern) else source.replace(old, new)
    beside = output.with_suffix(".c")
    beside.write_text(source)
    subprocess.run([compiler, "--target=trax", "-std=c17", "-O3", "-Wall", "-Wextra", "-Werror", "-I", ROOT / "raytracer/include", beside, "-o", output], check=True)


def simulate(options, folder, config, choice):
    """The statistics and the picture's bytes."""
    given = buffer_options(read_manifest(folder))
    if (folder / "materials.bin").exists():
        given += ["--bind", "materials=materials.bin"]
    settings = [part for setting in ["fpu.compare_units=true", *choice.settings] for part in ("--set", setting)]
    outputs = [f"{config}.json", f"{config}.raw"]
    subprocess.run([options.bin / "trax-sim", "--quiet", "--config", config, *settings, "--host-threads", "1", *given, "--stats", outputs[0], "--dump", f"image={outputs[1]}",
                    "program.elf"], cwd=folder, check=True)
    return json.loads((folder / outputs[0]).read_text()), (folder / outputs[1]).read_bytes()


def measure(options, scratch, scene, choice, stored):
    folder = scratch / f"{scene}-{choice.name.replace(' ', '-')}"
    subprocess.run([options.bin / "trax-render", stored, "--view", scene, "--size", options.size, "--program", options.bin.parent / "lib/trax/trax-era.elf",
                    "--prepare", folder, "--quiet"], check=True)
    for file in folder.glob("*.bin"):
        file.chmod(0o644)
    if choice.source:
        compiled((ROOT / "raytracer/examples/1-plain.c").read_text(), choice.source, folder / "program.elf", options.bin / "clang")
    if choice.arrays:
        choice.arrays(folder)
    found = [simulate(options, folder, config, choice) for config in options.configs]
    for file in folder.iterdir():
        file.unlink()
    return [statistics for statistics, _ in found], {picture for _, picture in found}


def main():
    parser = arguments(__doc__, "640x360")
    parser.add_argument("--configs", default="1x32,8x64")
    parser.add_argument("--only", help="choices, separated by ';'")
    parser.add_argument("--scene", choices=SCENES)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    options.bin, options.configs = options.bin.resolve(), options.configs.split(",")
    chosen = [choice for choice in CHOICES if not options.only or choice.name in [CHOICES[0].name, *options.only.split(";")]]
    if options.only and len(chosen) != 1 + len(set(options.only.split(";")) - {CHOICES[0].name}):
        sys.exit(f"era.py: error: --only: the choices are {', '.join(choice.name for choice in CHOICES)}")
    first, last = options.configs[0], options.configs[-1]
    print(f"| scene | choice | {first}: MRPS | speed-up of {last} | adds and multiplications/ray | bytes/ray on {last} | pixels that differ |\n| --- | --- |" + " --- |" * 5, flush=True)
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        scratch = pathlib.Path(name)
        for scene in [options.scene] if options.scene else SCENES:
            stored = {}
            for choice in chosen:
                if choice.tree not in stored:
                    stored[choice.tree] = scratch / f"{scene}-{len(stored)}.trax"
                    subprocess.run([options.bin / "trax-scene", "--quiet", "--nodes", "binary", "--passes", "0",
                                    *([] if "--splits" in choice.tree else ["--splits=1"]), *choice.tree,
                                    *files_of(options.scenes, scene), "-o", stored[choice.tree]], check=True)
            runs = [pool.submit(measure, options, scratch, scene, choice, stored[choice.tree]) for choice in chosen]
            for choice, run in zip(chosen, runs):
                (one, *_, many), pictures = run.result()[0] if len(options.configs) > 1 else run.result()[0] * 2, run.result()[1]
                if len(pictures) != 1:
                    sys.exit(f"era.py: error: {scene}, {choice.name}: the chips' pictures differ")
                picture = memoryview(pictures.pop()).cast("I")
                expected = picture if choice is CHOICES[0] else expected
                differ = sum(a != b for a, b in zip(picture, expected))
                print(f"| {scene} | {choice.name} | {one['mrps']:.2f} | {many['mrps'] / one['mrps']:.2f} | {many['flops'] / many['rays']:,.0f} | "
                      f"{many['memory']['bytes'] / many['rays']:.0f} | {differ} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
