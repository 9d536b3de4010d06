"""No command destroys what it was given: no output is an input, and no file is written twice, however their paths are
spelled.

Usage: files_test.py BIN VERSION
"""

import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path[:0] = [os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", name) for name in ("", "evaluation")]
from inside import Inside  # noqa: E402
from png_files import png_of  # noqa: E402
from common import BIN, TEST_BIN, accepted, end, fail, refused  # noqa: E402

PICTURE = png_of([b"\x80\x40\x20" * 4] * 4)
INPUT, TWICE = "is an input and the output", "is written twice"
# A mesh's references are known when it has been read; an ending that no writer has is refused before.
INPUT_OR_ENDING = (INPUT, "there is no writer for .")


def write(path, data):
    with open(path, "wb") as file:
        file.write(data.encode() if isinstance(data, str) else data)


def spellings(path):
    """Other names of a file of this folder, with what makes them."""
    name = path.replace("/", "_")
    if os.path.exists(path):
        if os.path.exists(f"hard-{name}") and not os.path.samefile(path, f"hard-{name}"):
            os.remove(f"hard-{name}")
        if not os.path.exists(f"hard-{name}"):
            os.link(path, f"hard-{name}")
        yield f"hard-{name}"
    if not os.path.lexists(f"soft-{name}"):
        os.symlink(path, f"soft-{name}")
    yield from (f"soft-{name}", f"./{path}", f".//{path}", f"folder/../{path}", f"other/{path}", os.path.abspath(path),
                f"//{os.path.abspath(path)}")


def outputs_onto(inputs, outputs, program, *words, message=INPUT):
    """Every output onto every input, in one spelling each, and the first output in all of them."""
    for path in inputs:
        for number, output in enumerate(outputs):
            names = list(spellings(path))
            for name in [path, *names] if number == 0 else [path, names[number % len(names)]]:
                refused(message, program, *words, *output(name))


def pairs_of(outputs, program, *words):
    """Every two outputs into one file, which exists or not."""
    write("there", "kept")
    for target in ("there", "absent"):
        names = [target, *spellings(target)]
        for first, one in enumerate(outputs):
            for second, other in enumerate(outputs[:first]):
                refused(TWICE, program, *words, *one(target), *other(names[(first + second) % len(names)]))
    os.remove("there")


def option(name, *more):
    return lambda path: [*more, f"--{name}", path]


def simulator():
    subprocess.run([f"{TEST_BIN}/emulator-programs", "."], check=True)
    write("in.bin", "0123456789abcdef")
    write("chip.cfg", accepted("trax-sim", "--print-config").stdout)
    words = ["--config", "chip.cfg", "--bind", "input=in.bin", "--alloc", "output=16", "copy.elf"]
    windowed = ("--window", "0:10")
    outputs = [option("report"), option("stats"), option("signature"), option("explore"), option("profile"),
               option("profile-folded"),
               option("heat"), option("heat-lines"), option("waits"), option("items"),
               option("ray-kinds"), option("ray-cycles"),
               option("series"), option("trace"),
               option("perfetto", *windowed), option("post-mortem"), option("checkpoint"),
               lambda path: ["--dump", f"output={path}"]]
    outputs_onto(["copy.elf", "chip.cfg", "in.bin"], outputs, "trax-sim", *words)
    pairs_of([
        lambda path, one=one: [word for word in one(path) if word not in windowed]
        for one in outputs if one("")[0] != "--window"], "trax-sim", *words)
    accepted("trax-sim", "--checkpoint", "state", "--checkpoint-at", "5", "hello.elf")
    for path in ("state", "./state"):
        refused(INPUT, "trax-sim", "--resume", "state", "--stats", path, "hello.elf")
        refused(INPUT, "trax-sim", "--resume", "state", "--checkpoint", path, "hello.elf")
    refused(INPUT, "trax-sim", "--scene", "in.bin", "--stats", "./in.bin", "hello.elf")
    # Devices and pipes take any number of outputs, and so does standard output under any of its names.
    for path in ("/dev/null", "-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
        accepted("trax-sim", "--report", path, "--stats", path, "--post-mortem", "/dev/null", "hello.elf")
    with open("all.txt", "w") as file:
        subprocess.run([f"{BIN}/trax-sim", "--report", "/dev/stdout", "--stats", "-", "--post-mortem", "/dev/fd/1",
                        "hello.elf"], stdout=file, check=True)
    with open("all.txt") as file:
        text = file.read()
    if not text.startswith("hello") or '"cycles"' not in text or len(text) < 2000:
        fail(f"standard output that is a file lost something: {text[:300]}")
    with open("all.txt", "a") as file:
        ended = subprocess.run([f"{BIN}/trax-sim", "--report", "-", "--stats", "all.txt", "hello.elf"], stdout=file,
                               stderr=subprocess.PIPE, text=True)
    if ended.returncode != 1 or TWICE not in ended.stderr:
        fail(f"standard output and --stats in one file: {ended}")


def meshes():
    write("wood.png", PICTURE)
    write("mask.png", PICTURE)
    write("a.mtl", "newmtl m\nmap_Kd wood.png\nmap_d mask.png\n")
    write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n")
    corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    write("b.bin", corners + struct.pack("<6f", 0, 0, 1, 0, 0, 1))
    write("b.gltf", json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}],
        "images": [{"uri": "wood.png"}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                       "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "buffers": [{"byteLength": 60, "uri": "b.bin"}]}))
    accepted("trax-scene", "-q", "a.obj", "-o", "a.trax")
    write(
        "a.view",
        "eye = [0.2, 0.2, 3.0];\ndirection = [0.0, 0.0, -1.0];\nup = [0.0, 1.0, 0.0];\nfov = 40.0;\nlight = [1.0, 1.0, "
        "5.0];\n"
    )


def scenes():
    outputs = [option("output"), lambda path: ["-o", "new.trax", "--stats-json", path]]
    outputs_onto(["a.obj", "a.mtl", "wood.png", "mask.png"], outputs, "trax-scene", "-q", "a.obj")
    outputs_onto(["b.gltf", "b.bin", "wood.png"], outputs, "trax-scene", "-q", "b.gltf")
    outputs_onto(["a.trax"], [option("stats-json")], "trax-scene", "--check", "a.trax")
    pairs_of([option("output"), option("stats-json")], "trax-scene", "-q", "a.obj")
    accepted("trax-scene", "-q", "a.obj", "-o", "/dev/null", "--stats-json", "/dev/null")
    # The list of what was read, and looked for, by each reader; and a name that has to be escaped.
    outputs_onto(["a.mtl", "wood.png"], [lambda path: ["-o", "new.trax", "--list-files", path]], "trax-scene", "-q",
                 "a.obj")
    write("c\\\n.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    accepted("trax-scene", "-q", "a.obj", "b.gltf", "c\\\n.obj", "-o", "new.trax", "--list-files", "list")
    with open("list") as file:
        listed = [line.rstrip("\n").split("  ", 1) for line in file]
    names = [name for _, name in listed]
    if sorted(set(names)) != sorted(["a.obj", "a.mtl", "wood.png", "mask.png", "b.gltf", "b.bin", "c\\\\\\n.obj",
                                     "none.mtl"]) or not all(
            len(digest) == (1 if name == "none.mtl" else 33 if "\\" in name else 32) for digest, name in listed):
        fail(f"--list-files wrote {listed}")


def renderer():
    words = ["--size", "8x6", "--view", "a.view", "-q"]
    pictures = [option("output"), lambda path: ["-o", "new.png", "--write-view", path]]
    figures = [lambda path,
               name=name: ["-o", "new.png", f"--{name}",
                           path] for name in ("stats", "explore", "cost-picture", "cost-values")]
    outputs_onto(["a.obj", "a.view"], pictures + figures, "trax-render", "a.obj", *words)
    outputs_onto(["a.mtl", "wood.png", "mask.png"], pictures + figures, "trax-render", "a.obj", *words,
                 message=INPUT_OR_ENDING)
    outputs_onto(["wood.png", "mask.png"], pictures + figures[:2], "trax-render", "a.obj", *words)
    outputs_onto(["a.mtl"], figures[:2], "trax-render", "a.obj", *words)
    outputs_onto(["b.gltf"], pictures + figures[:1], "trax-render", "b.gltf", *words)
    outputs_onto(["b.bin"], pictures + figures[:1], "trax-render", "b.gltf", *words, message=INPUT_OR_ENDING)
    outputs_onto(["b.bin"], figures[:1], "trax-render", "b.gltf", *words)
    outputs_onto(["wood.png"], pictures + figures[:1], "trax-render", "b.gltf", *words)
    outputs_onto(["a.trax"], pictures + figures[:1], "trax-render", "a.trax", *words)
    shutil.copy(f"{BIN}/../lib/trax/trax-raytracer.elf", "device.elf")
    outputs_onto(["device.elf", "chip.cfg"], pictures + figures[:1], "trax-render", "a.obj", *words, "--program",
                 "device.elf", "--config", "chip.cfg")
    # A program is a hidden input, too.
    os.link(f"{BIN}/../lib/trax/trax-raytracer.elf",
            "general.elf") if os.stat(BIN).st_dev == os.stat(".").st_dev else None
    if os.path.exists("general.elf"):
        refused(INPUT, "trax-render", "a.obj", *words, "--no-specialise", "-o", "new.png", "--stats", "general.elf")
        os.remove("general.elf")
    outputs = [option("output"), option("write-view"), option("stats"), option("explore"),
               option("cost-picture"), option("cost-values")]
    write("there.png", "kept")
    for target in ("there.png", "absent.png"):
        for first, one in enumerate(outputs):
            for second, other in enumerate(outputs[:first]):
                given = [] if second == 0 else ["-o", "new.png"]
                refused(TWICE, "trax-render", "a.obj", *words, *given, *one(target),
                        *other(list(spellings(target))[(first + second) % 7]))
    # The folder of --keep and --prepare has files of known names.
    for name, keep in (("keep", ["-o", "new.png"]), ("prepare", [])):
        os.makedirs(name, exist_ok=True)
        shutil.copy("a.trax", f"{name}/scene.trax")
        refused(INPUT, "trax-render", f"./{name}/scene.trax", *words, *keep, f"--{name}", name)
        shutil.copy("device.elf", f"{name}/program.elf")
        refused(INPUT, "trax-render", "a.obj", *words, *keep, "--program", f"{name}/program.elf", f"--{name}",
                f"other/{name}")
    os.makedirs("bench", exist_ok=True)
    shutil.copy("chip.cfg", "bench/chip.json")
    refused(INPUT, "trax-render", "a.obj", "-q", "--config", "bench/chip.json", "--hits", "./bench/chip.json")
    # Endings that no writer has, and no name at all.
    for name in ("x.jpg", "x.obj", "x.trax", "x.PNGS", "x.view", "folder.d/x.p", "x.1"):
        refused("there is no writer for .", "trax-render", "a.obj", *words, "-o", name)
    refused("there is no writer for .exr, only for .png", "trax-render", "a.obj", *words, "-o", "x.png",
            "--cost-picture", "y.exr")
    refused("there is no writer for .exr, only for .csv and .pfm", "trax-render", "a.obj", *words, "-o", "x.png",
            "--cost-values", "y.exr")
    for spelled in (["-o", ""], ["-o", "x.png", "--stats="], ["--output="]):
        refused("the value is empty", "trax-render", "a.obj", *words, *spelled)
    # Several outputs into what is no file; an ending in capitals; a name without one is a PNG.
    accepted("trax-render", "a.obj", *words, "-o", "/dev/null", "--stats", "/dev/null", "--cost-picture", "/dev/null",
             "--write-view", "/dev/null")
    accepted("trax-render", "a.obj", *words, "--engine", "native", "-o", "BIG.PNG")
    accepted("trax-render", "a.obj", *words, "--engine", "native", "-o", "folder.d/plain")
    with open("folder.d/plain", "rb") as file:
        if file.read(4) != b"\x89PNG":
            fail("a name without an ending is no PNG")
    ended = subprocess.run([f"{BIN}/trax-render", "a.obj", *words, "--engine", "native", "-o", "/dev/stdout"],
                           capture_output=True)
    if ended.returncode != 0 or not ended.stdout.startswith(b"\x89PNG"):
        fail(f"-o /dev/stdout: {ended}")
    # An image that is not there is no input: nothing is destroyed.
    write("lost.mtl", "newmtl m\nmap_Kd lost.png\n")
    write("lost.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
    accepted("trax-render", "lost.obj", *words, "--engine", "native", "-o", "lost.png")


def toolchain():
    clang = ["--target=trax", "-ffreestanding"]
    write("m.c", "int main(void) { return 0; }\n")
    write("n.s", '.include "inc.s"\nnop\n')
    write("inc.s", "nop\n")
    write("m.ll", "define i32 @main() {\n  ret i32 0\n}\n")
    accepted("clang", *clang, "-c", "m.c", "-o", "m.o")
    accepted("clang", *clang, "-c", "m.c", "-o", "order.o")
    subprocess.run(["ar", "rc", "libm2.a", "order.o"], check=True)
    write("order", "main\n")
    write("response", "m.o\n")
    outputs = [lambda path: ["-o", path], lambda path: ["-o", "new", "-Map", path]]
    outputs_onto(["m.o", "libm2.a", "order", "response"], outputs, "trax-ld", "--error-limit=1", "@response", "-e",
                 "main", "-L.", "-lm2", "--symbol-ordering-file=order")
    pairs_of([lambda path: ["-o", path], option("Map")], "trax-ld", "m.o", "-e", "main")
    outputs_onto(["n.s", "inc.s"], [lambda path: ["-o", path]], "trax-mc", "n.s")
    outputs_onto(["m.ll"], [lambda path: ["-o", path]], "trax-llc", "m.ll")
    with open("inc.s") as file:
        refused(INPUT, "trax-mc", "-", "-o", "./inc.s", stdin=file)
    outputs_onto(["m.c"], [lambda path: ["-o", path], lambda path: ["-MD", "-o", "new.o", "-MF", path]], "clang",
                 *clang, "-c", "m.c")
    outputs_onto(["m.o"], [lambda path: ["-o", path]], "clang", *clang, "m.o")
    os.makedirs("folder/deep", exist_ok=True)
    write("folder/deep/m.c", "int other;\n")
    refused(TWICE, "clang", *clang, "-c", "m.c", "folder/deep/m.c")
    accepted("clang", *clang, "-c", "m.c", "-o", "/dev/null", "-MD", "-MF", "/dev/null")


def evaluation():
    sweep = {"name": "small", "scenes": [{"name": "a", "meshes": ["a.obj"], "view": "bunny"}], "programs": "ours",
             "chips": ["1x32"], "size": "8x6"}
    os.makedirs("out/sweeps", exist_ok=True)
    for name in ("out/results.json", "out/sweeps/small.json"):
        write(name, json.dumps(sweep))
        refused(INPUT, "trax-eval", "-q", f"./{name}", ".", "-o", "other/out")
        os.remove(name)
    write("results.json", "{}")
    refused(INPUT, "trax-eval", "report", "results.json", "-o", "results.json")
    inside = Inside(pathlib.Path(BIN).resolve())
    for name in spellings("results.json"):
        refused(INPUT, inside, "report", "results.json", "-o", name)
    for name in ("html", "picture", "cost-picture"):
        refused(f"--{name} is given twice", "trax-sim", "compare", "results.json", "results.json", f"--{name}", "a",
                f"--{name}", "b")
    for words in (["report", "results.json"], ["small.json", "."], ["fetch-scenes"]):
        refused("--output is given twice", "trax-eval", *words, "-o", "a", "--output", "b")
    for words in (["small.json", ".", "-o", ""], ["report", "results.json", "-o", ""]):
        refused("is empty", "trax-eval", *words)


with tempfile.TemporaryDirectory() as directory:
    os.chdir(directory)
    os.environ["XDG_CACHE_HOME"] = f"{directory}/cache"
    os.makedirs("folder")
    os.makedirs("folder.d")
    os.symlink(".", "other")
    for part in (simulator, meshes, scenes, renderer, toolchain, evaluation):
        part()
    os.chdir("/")
end()
