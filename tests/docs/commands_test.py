"""Commands of the pages: commands_test.py SOURCE BUILD [--update] [PAGE...]

- A block of `sh` is run, the blocks of each page in a folder of its own. A block of `text` behind it is what it prints
  (blocks.py has the kinds).
- In a block of `sh long`, and in `code` that is a command, the program and its options must exist. A command of
  trax-render is also started without its files: the missing file must be its only fault.

Small meshes and programs stand in for the reader's files that the pages name. --update writes the commands' output into
the pages. tests/tutorial tests the tutorial's two pages."""

import functools
import json
import lzma
import math
import pathlib
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile

from blocks import Failure, check_parts, compare, kind, pages, read_blocks, run_commands

TUTORIAL = ("docs/tutorial.md", "docs/extending.md")
LINKED = ("build", "raytracer", "emulator", "llvm-target", "tests", "isa", "runtime")
HELLO = ('#include <stdio.h>\n#include <trax.h>\nint main(void) {\n  if (trax_thread() == 0)\n'
         '    printf("threads: %u\\n", trax_threads());\n}\n')

# --- stand-ins ---


def ball():
    """Vertices and triangles of a small ball."""
    rows, columns = 8, 12
    points = [(math.sin(math.pi * i / rows) * math.cos(2 * math.pi * j / columns), math.cos(math.pi * i / rows),
               math.sin(math.pi * i / rows) * math.sin(2 * math.pi * j / columns)) for i in range(rows + 1)
              for j in range(columns)]
    faces = []
    for i in range(rows):
        for j in range(columns):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            faces += [(a, b, a + columns), (b, b + columns, a + columns)]
    return points, faces


def glb(points, faces):
    data = b"".join([struct.pack("<3f", *point) for point in points] + [struct.pack("<3H", *face) for face in faces])
    data += bytes(-len(data) % 4)
    vertices = 12 * len(points)
    low, high = [min(axis) for axis in zip(*points)], [max(axis) for axis in zip(*points)]
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "buffers": [{"byteLength": len(data)}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "bufferViews": [{"buffer": 0, "byteLength": vertices},
                        {"buffer": 0, "byteOffset": vertices, "byteLength": 6 * len(faces)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": low,
                       "max": high},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(faces), "type": "SCALAR"}]
    }).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text + struct.pack("<2I", len(data), 0x004E4942) + data
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


def make_stand_ins(root, binaries):
    """For all pages: each gets a copy."""
    points, faces = ball()
    corners = [tuple(i + 1 for i in face) for face in faces]
    obj = "".join(["v %g %g %g\n" % point for point in points] + ["f %d %d %d\n" % corner for corner in corners])
    head = ["ply", "format ascii 1.0", f"element vertex {len(points)}", *(f"property float {axis}" for axis in "xyz"),
            f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    ply = "\n".join([*head, *("%g %g %g" % point for point in points), *("3 %d %d %d" % face for face in faces), ""])
    for name in ("bunny.obj", "my-mesh.obj"):
        (root / name).write_text(obj)
    for name in ("conference.ply.xz", "dragon.ply.xz"):
        (root / name).write_bytes(lzma.compress(ply.encode()))
    (root / "my-scene.glb").write_bytes(glb(points, faces))
    for name in ("hello.c", "program.c"):
        (root / name).write_text(HELLO)
    clang = [binaries / "clang", "--target=trax", "-O2", "-g", "hello.c"]
    subprocess.run([*clang, "-o", "hello"], cwd=root, check=True)
    subprocess.run([*clang, "-c", "-o", "a.o"], cwd=root, check=True)
    (root / "program").write_bytes((root / "hello").read_bytes())
    subprocess.run(["ar", "rc", "lib.a", "a.o"], cwd=root, check=True)


# --- commands that are not run ---


@functools.cache
def help_of(program):
    """A text that has the program's options."""
    done = subprocess.run([program, "--help"], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60,
                          check=False)
    text = done.stdout + done.stderr
    if set(re.findall(r"--[a-z][\w-]*", text)) - {"--help"}:
        return text
    # A test's program has no help: take its strings and their ends.
    words = re.findall(rb"([a-z][a-z-]+)(?=\0)", program.read_bytes())
    return " ".join(f"--{word[at:].decode()}" for word in set(words) if len(word) < 40 for at in range(len(word) - 2))


@functools.cache
def options_in(text):
    return set(re.findall(r"(?<![\w-])--[a-z][\w-]*", text)) | {"--help", "--version"}


class Commands:
    def __init__(self, source, build):
        self.source, self.build, self.binaries = source, build, build / "bin"
        self.checked = self.started = 0

    @functools.cached_property
    def targets(self):
        listed = subprocess.run(["ninja", "-C", str(self.build), "-t", "targets", "all"], capture_output=True,
                                text=True, check=True).stdout
        return {line.split(": ")[0] for line in listed.splitlines()}

    @functools.cached_property
    def evaluation(self):
        return help_of(self.binaries / "trax-eval") + "".join(
            path.read_text() for path in (self.source / "raytracer/evaluation").rglob("*.py"))

    def options_of(self, word):
        """The text in which options of the command must stand; None: its options are not ours; Failure: no such
        program."""
        if word in ("clang", "clang++", "trax-clang", "trax-clang++", "build/bin/clang"):
            return None
        if "/" not in word and word.startswith("trax-") and (self.binaries / word).exists():
            word = f"build/bin/{word}"
        if word in ("trax-eval", "build/bin/trax-eval"):
            return self.evaluation
        if word.startswith(("build/bin/", "build/tests/bin/")):
            program = self.build / word[len("build/"):]
            if not program.exists():
                raise Failure(f"there is no {word}")
            return help_of(program)
        if re.match(r"(\./)?[\w/.-]+\.(py|sh)$", word) and "/" in word:
            script = self.source / word
            if not script.exists():
                raise Failure(f"there is no {word}")
            return "".join(path.read_text() for path in script.parent.glob(f"*{script.suffix}")) + script.read_text()
        return None

    def check(self, command):
        """What is wrong with one command; None if nothing, or if it is none."""
        try:
            words = shlex.split(command, comments=True)
        except ValueError:
            return None
        while words and re.fullmatch(r"[A-Z_]+=\S*", words[0]):
            del words[0]
        if len(words) < 2:
            return None
        try:
            if words[0] == "ninja":
                wrong = [word for at, word in enumerate(words[1:], 1)
                         if not word.startswith("-") and words[at - 1] not in ("-C", "-j") and not word.isupper()
                         and word not in self.targets]
                self.checked += 1
                return f"`{command}`: no target {wrong[0]}" if wrong else None
            if words[:2] == ["cmake", "--preset"]:
                presets = json.loads((self.source / "CMakePresets.json").read_text())["configurePresets"]
                self.checked += 1
                return None if words[2] in {preset["name"] for preset in presets} else f"`{command}`: no such preset"
            text = self.evaluation if words[:2] == ["trax-sim", "compare"] else self.options_of(words[0])
        except Failure as failure:
            return f"`{command}`: {failure}"
        if text is None:
            return None
        self.checked += 1
        for word in words[1:]:
            if word in ("--", "|", ">", "&&", ";"):
                break
            option = word.split("=")[0].rstrip(",.")
            if re.fullmatch(r"--[a-z][\w-]*", option) and option not in options_in(text):
                return f"`{command}`: {words[0]} has no {option}"
        return None

    def start(self, command):
        """What trax-render says of a command before it looks for meshes; None if nothing. Words in capitals are
        values."""
        if not re.match(r"(build/bin/)?trax-render [^-]", command) or "..." in command:
            return None
        words = [re.sub(r"\b(N|SEED)\b", "1", word) for word in shlex.split(command, comments=True)[1:]]
        made = ["missing.obj"] if words[0].startswith("generate:") else []
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([self.binaries / "trax-render", *made, *words], cwd=folder, capture_output=True,
                                  text=True, stdin=subprocess.DEVNULL, timeout=60, check=False)
        self.started += 1
        looked = done.returncode == 1 and "No such file" in done.stderr
        return None if looked else f"`{command}`: {done.stderr.strip() or done.returncode}"

    def of_page(self, text, blocks):
        """What is wrong with the commands of a page that are not run."""
        prose, inside = [], False
        for line in text.split("\n"):
            if line.startswith("```"):
                inside = not inside
            elif not inside:
                prose.append(line)
        commands = [re.sub(r"\s+", " ", code) for code in re.findall(r"`([^`]+)`", "\n".join(prose))]
        for words, block, _ in blocks:
            if kind(words, block) == "long" and not words.startswith("text"):
                joined = block.replace("\\\n", " ")
                lines = joined.split("\n")
                if words.startswith("console"):
                    lines = [lines[0][2:]]
                commands += [part for line in lines for part in re.split(r"\s+(?:&&|\|\||\||;)\s+", line)
                             if part and not part.startswith("#")]
        return [fault for command in commands for fault in (self.check(command) or self.start(command),) if fault]


def main():
    words = [word for word in sys.argv[1:] if word != "--update"]
    source, build = pathlib.Path(words[0]).resolve(), pathlib.Path(words[1]).resolve()
    update, wrong, ran, compared = len(words) + 1 < len(sys.argv), [], 0, 0
    commands = Commands(source, build)
    scratch = tempfile.TemporaryDirectory()
    stand_ins = pathlib.Path(scratch.name)
    make_stand_ins(stand_ins, commands.binaries)
    for page in pages(source):
        name = str(page.relative_to(source))
        if words[2:] and name not in words[2:]:
            continue
        text = page.read_text(encoding="utf-8")
        blocks = read_blocks(text)
        wrong += [f"{name}: {fault}" for fault in commands.of_page(text, blocks)]
        if name in TUTORIAL or not any(kind(block[0], block[1]) == "sh" for block in blocks):
            continue
        try:
            with tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                for part in LINKED:
                    (root / part).symlink_to(build if part == "build" else source / part)
                shutil.copytree(stand_ins, root, dirs_exist_ok=True)
                printed, _ = run_commands(blocks, root, root, ("sh",), [commands.binaries])
            ran += len(printed)
            new, count = compare(text, blocks, printed, update)
            compared += count
            check_parts(blocks, source)
            if new != text:
                page.write_text(new, encoding="utf-8")
        except Failure as failure:
            wrong.append(f"{name}: {failure}")
    for bad in ("trax-sim --no-such-option x", "build/bin/no-such-program x", "tests/none.py x",
                "ninja -C build no-such-target", "cmake --preset none"):
        if not commands.check(bad):
            wrong.append(f"`{bad}` is not noticed")
    for fault in wrong:
        print(fault)
    print(
        f"{ran} blocks ran, {compared} texts compared, {commands.checked} commands whose options were looked up, "
        f"{commands.started} started, {len(wrong)} faults"
    )
    return 1 if wrong or (not words[2:] and (ran < 10 or commands.checked < 100 or commands.started < 8)) else 0


if __name__ == "__main__":
    sys.exit(main())
