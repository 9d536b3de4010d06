#!/usr/bin/env python3
"""docs/tutorial.md by doing it: tutorial_test.py SOURCE BUILD [--update] [--whole COPY]

Files and commands are taken from the page, in its order. Blocks of it, by what stands behind the three backticks:

    c boxes.c (any language and a name)   a file in out/tutorial
    sh                                    commands of one shell, which begins in the top folder
    text                                  what the commands before print
    c of PATH (any language)              a part of that file of the sources
    sh whole, text whole                  the same as sh and text, with changed sources built anew

Without --whole the instruction's patch is applied to a copy of the files that it changes, and of these everything is made that takes no compiler:
tables, manual, patterns. --whole COPY clones the sources into the folder COPY, builds them, and does all that the page says (some ten minutes).
--update writes into the page what the commands have printed."""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zlib

MARK = "@@@ tutorial block "


class Failure(Exception):
    pass


def read_blocks(page):
    """(information, text, line) of each fenced block."""
    blocks, inside = [], None
    for number, line in enumerate(page.splitlines(keepends=True), 1):
        if inside is None and line.startswith("```"):
            inside = (line[3:].strip(), [], number)
        elif inside is not None and line.rstrip("\n") == "```":
            blocks.append((inside[0], "".join(inside[1]), inside[2]))
            inside = None
        elif inside is not None:
            inside[1].append(line)
    if inside:
        raise Failure(f"the block of line {inside[2]} has no end")
    for words, _, line in blocks:
        if words.split()[:1] not in (["sh"], ["text"]) and len(words.split()) != 2 and words.split()[1:-1] != ["of"]:
            raise Failure(f"line {line}: a block of \"{words}\": neither commands, what they print, a file nor a part of one")
    return blocks


def run_commands(blocks, root, whole):
    """What each block of commands printed, by its line."""
    folder = root / "out" / "tutorial"
    folder.mkdir(parents=True, exist_ok=True)
    script = ["set -e -o pipefail"]
    for words, text, line in blocks:
        kind = words.split()
        if kind[0] == "sh" and (whole or kind[-1] != "whole"):
            script += [f"echo '{MARK}{line}'", text]
        elif kind[0] not in ("sh", "text") and len(kind) == 2:
            (folder / kind[1]).write_text(text)
    environment = {**os.environ, "LC_ALL": "C"}
    done = subprocess.run(["bash", "-c", "\n".join(script)], cwd=root, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    printed = {}
    for part in done.stdout.split(MARK)[1:]:
        line, _, text = part.partition("\n")
        printed[int(line)] = text
    if done.returncode != 0:
        raise Failure(f"the commands of line {max(printed, default=0)} ended with status {done.returncode}:\n{printed.get(max(printed, default=0), '')[-2000:]}"
                      f"{done.stderr[-2000:]}")
    if done.stderr:
        raise Failure(f"the commands wrote to standard error:\n{done.stderr[-2000:]}")
    return printed


def compare(page, blocks, printed, update):
    """Blocks of text against what the commands before them printed; the page as it should be."""
    lines, wrong, compared, shift = page.splitlines(keepends=True), [], 0, 0
    for (before, _, at), (words, text, line) in zip(blocks, blocks[1:]):
        if words.split()[0] != "text" or at not in printed:
            continue
        if before.split()[0] != "sh":
            raise Failure(f"line {line}: no commands stand before this text")
        compared += 1
        if printed[at] != text:
            wrong.append(f"line {line}: the page has\n{text}but the commands of line {at} print\n{printed[at]}")
            start, old, new = line + shift, text.splitlines(keepends=True), printed[at].splitlines(keepends=True)
            lines[start:start + len(old)] = new
            shift += len(new) - len(old)
    if wrong and not update:
        raise Failure("\n".join(wrong))
    return "".join(lines), compared


def same_picture(folder, source):
    """The picture of the page shows what the program makes."""
    def pixels(path):
        data, at, packed = path.read_bytes(), 8, b""
        while at < len(data):
            length = int.from_bytes(data[at:at + 4], "big")
            if data[at + 4:at + 8] == b"IDAT":
                packed += data[at + 8:at + 8 + length]
            at += 12 + length
        return zlib.decompress(packed)
    if pixels(folder / "boxes.png") != pixels(source / "docs" / "tutorial.png"):
        raise Failure("docs/tutorial.png is not the picture that the tutorial's program makes")


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}: status {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return done.stdout


def check_parts(blocks, source):
    """What the page shows of files is in them."""
    for words, text, line in blocks:
        if words.split()[1:-1] == ["of"] and text not in (source / words.split()[2]).read_text():
            raise Failure(f"line {line}: this is no part of {words.split()[2]}")


def check_changes(source, build, scratch):
    """The instruction's patch: it applies, the tables made of them have the new instructions and are otherwise the same, patterns and tests are accepted."""
    patch = (source / "tests/tutorial/instruction.patch").read_text()
    changed = re.findall(r"^\+\+\+ b/(\S+)", patch, re.M)
    tree = scratch / "changed"
    for folder in ("isa", "llvm-target", "tests/isa/suite"):
        shutil.copytree(source / folder, tree / folder, ignore=shutil.ignore_patterns("__pycache__"))
    for name in changed:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / name, tree / name)
    run("git", "apply", "--whitespace=error", "-", input=patch, cwd=tree)

    include = re.search(r"-I (\S*llvm\S*/include)", run("ninja", "-C", build, "-t", "commands", "isa-manual"))[1]
    made = {}
    for what, old in (("instructions", build / "isa/include/trax/instructions.inc"), ("semantics", build / "isa/include/trax/semantics.inc"),
                      ("manual", source / "docs/isa.md")):
        out = scratch / what
        template = ["-template", tree / "isa/isa.md.in"] if what == "manual" else []
        run(build / "bin/trax-isa-gen", f"-gen={what}", *template, "-I", tree / "isa", "-I", include, tree / "isa/Isa.td", "-o", out)
        made[what] = out.read_text()
        lost = [line for line in old.read_text().splitlines() if line not in set(made[what].splitlines())]
        if what != "manual" and lost:
            raise Failure(f"the changes alter other instructions, too: {lost[:3]}")
        for name in ("fmaxmin", "fminmax"):
            if name not in made[what].lower():
                raise Failure(f"{what}: has no {name}")
    for table in ("dag-isel", "asm-matcher", "instr-info", "disassembler", "emitter"):
        run("llvm-tblgen-19", f"-gen-{table}", "-I", include, "-I", tree / "llvm-target", "-I", tree / "isa", tree / "llvm-target/Trax.td", "-o",
            scratch / table)
    if "Trax::FMAXMIN" not in (scratch / "dag-isel").read_text():
        raise Failure("the compiler has no pattern for fmaxmin")

    check = "import sys; sys.path.insert(0, sys.argv[1]); from description import read_instructions; from instructions import check_rows; " \
            "check_rows(read_instructions(sys.argv[2]))"
    run(sys.executable, "-B", "-c", check, tree / "tests/isa/suite", scratch / "instructions")
    without = subprocess.run([sys.executable, "-B", "-c", check, str(source / "tests/isa/suite"), str(scratch / "instructions")], capture_output=True, text=True)
    if "fmaxmin (FMAXMIN) has no test: add a row to tests/isa/suite/instructions.py" not in without.stderr:
        raise Failure(f"without its row the suite says: {without.stderr}")
    for name in ("FMAXMIN", "FMINMAX"):  # from the class follow unit, latency and energy
        if not re.search(rf"\b{name}\b[^\n]*TRAX_IS_COMPARE", made["instructions"]):
            raise Failure(f"{name} is no comparison in the table of instructions")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--whole", type=pathlib.Path, metavar="COPY")
    options = parser.parse_args()
    source, build = options.source.resolve(), options.build.resolve()
    path = source / "docs" / "tutorial.md"
    try:
        page = path.read_text()
        blocks = read_blocks(page)
        with tempfile.TemporaryDirectory() as folder:
            scratch = pathlib.Path(folder)
            if options.whole:
                root = options.whole.resolve()
                run("git", "clone", "-q", "--no-hardlinks", source, root)
                for name in run("git", "-C", source, "ls-files", "-mo", "--exclude-standard").split():
                    if (source / name).exists():  # what is not committed yet
                        (root / name).parent.mkdir(parents=True, exist_ok=True)
                        shutil.copy(source / name, root / name)
                run("cmake", "--preset", "release", cwd=root)
                run("ninja", "-C", root / "build")
            else:
                root = scratch / "root"
                root.mkdir()
                (root / "build").symlink_to(build)
                (root / "raytracer").symlink_to(source / "raytracer")
            printed = run_commands(blocks, root, bool(options.whole))
            if options.update:
                shutil.copy(root / "out/tutorial/boxes.png", source / "docs" / "tutorial.png")
            new, compared = compare(page, blocks, printed, options.update)
            same_picture(root / "out" / "tutorial", source)
            check_parts(blocks, source)
            check_changes(source, build, scratch)
            if options.update:
                path.write_text(new)
    except Failure as failure:
        print(f"docs/tutorial.md: {failure}", file=sys.stderr)
        return 1
    print(f"{len(printed)} blocks of commands, {compared} texts compared")
    return 0 if compared >= 5 else 1


if __name__ == "__main__":
    sys.exit(main())
