#!/usr/bin/env python3
"""What the paper's workload would take, were the device program's traversal or its triangles otherwise.

    raytracer/evaluation/bench/variants.py SCENES_DIRECTORY|MESH order|triangles [--size 320x180] [--configs 4x32,8x64] [--only VARIANT;...] [--scene NAME]
                                [--jobs N] [--bin build/bin]

SCENES_DIRECTORY holds the meshes of trax-eval's scenes; a mesh is framed as a whole. order: which child of a node is visited first (order_variants.py). triangles: what a triangle is
in memory, and which test it is for (triangle_variants.py). Each variant changes lines of a copy of raytracer/device and, where it must, the scene. A row for
each scene and variant; then the cycles as parts of those of the program as it is, for each scene and chip, their geometric mean and the greatest. Pixels are
compared with that program's picture; exit status 1 if some differ where the variant should not change any."""

import concurrent.futures
import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from device_scene import Scene
from order_variants import ORDERS
from scenes import ROOT, SCENES, arguments, find
from trax_eval.manifest import buffer_options, read_manifest
from triangle_variants import TRIANGLES

GROUPS = {"order": ORDERS, "triangles": TRIANGLES}
CACHED_CODE = 4096  # bytes, as in render/specialise.c


def sources(variant, folder):
    """The device program's source with the variant's changes."""
    folder.mkdir()
    texts = {path.name: path.read_text() for path in (ROOT / "raytracer/device").iterdir()}
    for name, old, new in variant.source:
        text = texts[name]
        texts[name] = old.sub(new, text) if isinstance(old, re.Pattern) else text.replace(old, new)
        if texts[name] == text:
            sys.exit(f"variants.py: error: {variant.name}: raytracer/device/{name} has no longer: {getattr(old, 'pattern', old)}")
    for name, text in texts.items():
        (folder / name).write_text(text)


def program_bytes(cache):
    """Of the program that was used last: bytes of code and of main's frame, which is its only one."""
    elf = max(cache.glob("*.elf"), key=lambda path: path.stat().st_mtime_ns).read_bytes()
    table, = struct.unpack_from("<I", elf, 32)
    entry, count, names = struct.unpack_from("<HHH", elf, 46)
    sections = [struct.unpack_from("<10I", elf, table + number * entry) for number in range(count)]
    code = sum(size for _, kind, flags, _, _, size, *_ in sections if kind == 1 and flags & 4)
    stack = 0
    for name, _, _, _, offset, size, *_ in sections:
        start = sections[names][4] + name
        if elf[start:elf.index(b"\0", start)] == b".stack_sizes":
            at, end = offset, offset + size
            while at < end:
                at, shift, frame = at + 4, 0, 0
                while True:
                    frame |= (elf[at] & 127) << shift
                    at, shift = at + 1, shift + 7
                    if not elf[at - 1] & 128:
                        break
                stack = max(stack, frame)
    return code, stack


def compiled(options, folder, source, constants):
    """The program, and how many bytes of code and of stack it takes; as render/specialise.c does it. Every program has a folder of its own."""
    program = folder / "program.elf"
    for how in ([], ["-O2"]):
        subprocess.run([options.bin / "clang", "--target=trax", "-std=c17", "-O3", "-g", *how, "-I", source, "-I", ROOT / "raytracer/include", "-include", constants,
                        source / "main.c", "-o", program], check=True)
        sizes = program_bytes(folder)
        if sizes[0] <= CACHED_CODE:
            break
    return program, sizes


def end_of(program):
    """Where buffers begin: behind what is loaded."""
    elf = program.read_bytes()
    table, = struct.unpack_from("<I", elf, 28)
    entry, count = struct.unpack_from("<HH", elf, 42)
    segments = [struct.unpack_from("<8I", elf, table + number * entry) for number in range(count)]
    return max(address + size + 63 & ~63 for kind, _, address, _, _, size, *_ in segments if kind == 1)


def measure(options, prepared, variant, folder):
    """For each chip statistics, picture, and bytes of scene, code and stack."""
    sources(variant, folder)
    runs = []
    for config in options.configs:
        work, place = folder / config, prepared / config
        work.mkdir()
        program, sizes = compiled(options, work, folder, place / "constants.h")
        scene = Scene(place / "scene.trax")
        scene.move(end_of(program))
        if variant.scene:
            variant.scene(scene)
        (work / "scene.trax").write_bytes(scene.words.tobytes())
        manifest = read_manifest(place)
        given = buffer_options(manifest)
        for buffer in manifest["buffers"]:
            if "file" in buffer and buffer["symbol"] != "scene":
                (work / buffer["file"]).write_bytes((place / buffer["file"]).read_bytes())
        subprocess.run([options.bin / "trax-sim", "--quiet", "--config", config, "--host-threads", "1", *given, "--stats", "stats.json", "--dump", "image=image.raw",
                        "program.elf"], cwd=work, check=True)
        runs.append((json.loads((work / "stats.json").read_text()), (work / "image.raw").read_bytes(), 4 * len(scene.words), *sizes))
        for file in work.iterdir():
            file.unlink()
    return runs


def prepare(options, scratch, scene, meshes):
    """For each chip what the specialised program reads, and its constants."""
    folder = scratch / scene
    folder.mkdir()
    subprocess.run([options.bin / "trax-scene", "--quiet", *meshes, "-o", folder / "file.trax"], check=True)
    view = ["--view", scene] if options.scenes.is_dir() else []
    for config in options.configs:
        cache = folder / f"{config}-cache"
        subprocess.run([options.bin / "trax-render", folder / "file.trax", *view, "--size", options.size, "--config", config, "--cache", cache,
                        "--prepare", folder / config, "--quiet"], check=True)
        constants, = cache.glob("*.h")
        constants.rename(folder / config / "constants.h")
    return folder


def scenes_of(options):
    """Names and meshes."""
    if not options.scenes.is_dir():
        return [("mesh", [options.scenes])]
    return [(name, [find(options.scenes, mesh) for mesh in meshes]) for name, meshes in SCENES if options.scene in (None, name)]


def main():
    parser = arguments(__doc__, "320x180")
    parser.add_argument("group", choices=list(GROUPS))
    parser.add_argument("--configs", default="4x32,8x64")
    parser.add_argument("--only", help="variants, separated by ';'")
    parser.add_argument("--scene", choices=[name for name, _ in SCENES])
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    options.bin, options.configs = options.bin.resolve(), options.configs.split(",")
    group = GROUPS[options.group]
    wanted = options.only.split(";") if options.only else [variant.name for variant in group]
    if unknown := set(wanted) - {variant.name for variant in group}:
        sys.exit(f"variants.py: error: --only {unknown.pop()}: the variants are {'; '.join(variant.name for variant in group)}")
    chosen = [variant for variant in group if variant is group[0] or variant.name in wanted]
    scenes = scenes_of(options)
    cycles, wrong = {}, 0
    print(options.size)
    print("| scene | variant | bytes of scene | code | stack | " + " | ".join(f"{config}: MRPS | bytes/ray | instructions/ray" for config in options.configs)
          + " | pixels that differ |\n| --- | --- |" + " --- |" * (4 + 3 * len(options.configs)), flush=True)
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        scratch = pathlib.Path(name)
        for scene, meshes in scenes:
            prepared = prepare(options, scratch, scene, meshes)
            pending = [pool.submit(measure, options, prepared, variant, prepared / f"variant{number}") for number, variant in enumerate(chosen)]
            expected = None
            for variant, result in zip(chosen, pending):
                runs = result.result()
                pictures = [memoryview(picture).cast("I") for _, picture, *_ in runs]
                expected = expected or pictures[0]
                differ = max(sum(a != b for a, b in zip(picture, expected)) for picture in pictures)
                wrong += differ > 0 and not variant.other
                cycles[variant.name, scene] = [run["cycles"] for run, *_ in runs]
                cells = [f"{run['mrps']:.2f} | {run['memory']['bytes'] / run['rays']:.0f} | {run['instructions'] / run['rays']:.0f}" for run, *_ in runs]
                size, code, stack = runs[-1][2:]
                print(f"| {scene} | {variant.name} | {size:,} | {code:,} | {stack} | {' | '.join(cells)} | {differ} |", flush=True)
            for file in [path for path in prepared.rglob("*") if path.is_file()]:
                file.unlink()
    print(f"\n{options.size}: cycles as parts of the first's, {' and '.join(options.configs)}\n| variant | " + " | ".join(scene for scene, _ in scenes)
          + " | geometric mean | greatest |\n| --- |" + " --- |" * (len(scenes) + 2))
    for variant in chosen:
        parts = [[now / first for now, first in zip(cycles[variant.name, scene], cycles[group[0].name, scene])] for scene, _ in scenes]
        every = [part for row in parts for part in row]
        print(f"| {variant.name} | " + " | ".join(", ".join(f"{part:.3f}" for part in row) for row in parts)
              + f" | {math.exp(sum(map(math.log, every)) / len(every)):.3f} | {max(every):.3f} |")
    print(f"pictures that differ though they should not: {wrong}")
    return 1 if wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except subprocess.CalledProcessError as failed:  # it said why
        sys.exit(f"variants.py: error: {pathlib.Path(failed.cmd[0]).name} failed")
