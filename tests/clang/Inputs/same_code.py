"""Compiles sources with and without -g, and compares the instructions: same_code.py CLANG OBJDUMP SOURCE-TREE FOLDER"""

import pathlib
import subprocess
import sys

clang, objdump, tree, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
SOURCES = ("llvm-target/bench/kernels/tree.c", "llvm-target/bench/kernels/quicksort.c",
           "llvm-target/bench/kernels/hash_table.c",
           "llvm-target/bench/kernels/ray_traversal.c", "tests/clang/struct-passing.cpp")
COMPILATIONS = [*((source, "-O2") for source in SOURCES),
                (SOURCES[0], "-O0"), (SOURCES[-1], "-O0"), (SOURCES[0], "-Os")]
folder.mkdir(parents=True, exist_ok=True)
differing = []
for source, level in COMPILATIONS:
    for name, flags in (("without", []), ("with", ["-g"])):
        subprocess.run([clang, "--target=trax", level, *flags, "-w", "-I", tree / "raytracer/device", "-I",
                        tree / "raytracer/include", "-I", tree / "raytracer", "-c", tree / source, "-o",
                        folder / f"{name}.o"], check=True)
    done = subprocess.run([objdump, "-d", folder / "without.o", folder / "with.o"], capture_output=True, text=True,
                          check=True)
    without, listing = done.stdout.split(f"{folder}/with.o:", 1)
    without = without.split(f"{folder}/without.o:", 1)[1]
    if without.strip() != listing.strip():
        differing.append(f"{source} {level}")
for name in differing:
    print(name)
print(f"{len(COMPILATIONS)} compilations, {len(differing)} differ")
sys.exit(1 if differing else 0)
