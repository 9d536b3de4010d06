#!/usr/bin/env python3
"""docs/tutorial.md and docs/extending.md by doing them: tutorial_test.py SOURCE BUILD [--update] [--whole COPY]

Files and commands are taken from the pages, in their order, as tests/docs/blocks.py says. Files go to out/tutorial, and
commands begin in the top folder. Blocks of `sh whole` and `text whole` need changed sources built anew.

Without --whole the instruction's patch is applied to a copy of the files that it changes, and of these everything is
made that takes no compiler: tables, manual, patterns. --whole COPY clones the sources into the folder COPY, builds
them, and does all that the pages say (some ten minutes). --update writes into the pages what the commands have
printed."""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "docs")]
from blocks import Failure, check_parts, compare, read_blocks, run_commands  # noqa: E402
from png_files import read_png  # noqa: E402

PAGES = ("docs/tutorial.md", "docs/extending.md")


PICTURES = {"boxes.png": "docs/tutorial.png", "evening.png": "docs/tutorial-evening.png"}


def same_pictures(folder, source):
    """The pictures of the page show what the program makes."""
    for made, shown in PICTURES.items():
        if read_png((folder / made).read_bytes()) != read_png((source / shown).read_bytes()):
            raise Failure(f"{shown} is not the picture that the tutorial's program makes")


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise Failure(
            f"{' '.join(map(str, command))}: status {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return done.stdout


def check_figure(source, text):
    """The figure's cycles are those of the pages, all of the tutorial's are there, and bars are as long as they say."""
    bars = re.findall(r'width="(\d+)" height="\d+"/><text [^>]*>(\d[\d,]+)</text>',
                      (source / "docs/tutorial.svg").read_text())
    figures = {figure.replace(",", ""): int(width) for width, figure in bars}
    wrong = [figure for figure in figures if not re.search(rf"\b{figure}\b", text)]
    if wrong or not figures:
        raise Failure(f"docs/tutorial.svg has {' '.join(wrong) or 'no figures'}, which the pages do not print")
    printed = re.findall(r"^(?:  cycles +|.*: )(\d+)(?: cycles)?$", (source / PAGES[0]).read_text(), re.M)
    missing = [cycles for cycles in printed if cycles not in figures]
    if missing or len(printed) < 5:
        raise Failure(f"docs/tutorial.svg lacks {' '.join(missing) or 'figures'}, which the tutorial prints")
    scales = [width / int(figure) for figure, width in figures.items()]
    if max(scales) > 1.01 * min(scales):
        raise Failure("docs/tutorial.svg has bars that are not as long as they say")


def check_changes(source, build, scratch):
    """The instruction's patch: it applies, the tables made of them have the new instructions and are otherwise the
    same, patterns and tests are accepted."""
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
    for what, old in (("instructions", build / "isa/include/trax/instructions.inc"),
                      ("semantics", build / "isa/include/trax/semantics.inc"),
                      ("manual", source / "docs/isa.md")):
        out = scratch / what
        template = ["-template", tree / "isa/isa.md.in"] if what == "manual" else []
        run(build / "tests/bin/trax-isa-gen", f"-gen={what}", *template, "-I", tree / "isa", "-I", include,
            tree / "isa/Isa.td", "-o", out)
        made[what] = out.read_text()
        lost = [line for line in old.read_text().splitlines() if line not in set(made[what].splitlines())]
        if what != "manual" and lost:
            raise Failure(f"the changes alter other instructions, too: {lost[:3]}")
        for name in ("fmaxmin", "fminmax"):
            if name not in made[what].lower():
                raise Failure(f"{what}: has no {name}")
    for table in ("dag-isel", "asm-matcher", "disassembler"):  # the others are made of the same fields
        run("llvm-tblgen-19", f"-gen-{table}", "-I", include, "-I", tree / "llvm-target", "-I", tree / "isa",
            tree / "llvm-target/Trax.td", "-o",
            scratch / table)
    if "Trax::FMAXMIN" not in (scratch / "dag-isel").read_text():
        raise Failure("the compiler has no pattern for fmaxmin")

    check = ("import sys; sys.path.insert(0, sys.argv[1]); from description import read_instructions; "
             "from instructions import check_rows; check_rows(read_instructions(sys.argv[2]))")
    run(sys.executable, "-B", "-c", check, tree / "tests/isa/suite", scratch / "instructions")
    without = subprocess.run([sys.executable, "-B", "-c", check, str(source / "tests/isa/suite"),
                              str(scratch / "instructions")], capture_output=True, text=True)
    if "fmaxmin (FMAXMIN) has no test: add a row to tests/isa/suite/instructions.py" not in without.stderr:
        raise Failure(f"without its row the suite says: {without.stderr}")
    for name in ("FMAXMIN", "FMINMAX"):  # from the class follow unit, latency and energy
        if not re.search(rf"\b{name}\b[^\n]*TRAX_IS_COMPARE", made["instructions"]):
            raise Failure(f"{name} is no comparison in the table of instructions")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--whole", type=pathlib.Path, metavar="COPY")
    options = parser.parse_args()
    source, build = options.source.resolve(), options.build.resolve()
    try:
        texts = [(source / name).read_text() for name in PAGES]
        lines = [text.count("\n") for text in texts]
        blocks = [read_blocks(text) for text in texts]
        every = blocks[0] + [(words, text, line + lines[0]) for words, text, line in blocks[1]]
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
            printed, errors = run_commands(every, root, root / "out/tutorial",
                                           ("sh", "whole") if options.whole else ("sh",))
            if errors:
                raise Failure(f"the commands wrote to standard error:\n{errors[-2000:]}")
            if options.update:
                for made, shown in PICTURES.items():
                    shutil.copy(root / "out/tutorial" / made, source / shown)
            new, compared = compare("".join(texts), every, printed, options.update)
            same_pictures(root / "out" / "tutorial", source)
            check_parts(every, source)
            check_figure(source, new)
            check_changes(source, build, scratch)
            if options.update:
                at = new.index(texts[1].split("\n")[0] + "\n")
                for name, text in zip(PAGES, (new[:at], new[at:])):
                    (source / name).write_text(text)
    except Failure as failure:
        print(f"{' and '.join(PAGES)} (lines go on from one to the next): {failure}", file=sys.stderr)
        return 1
    print(f"{len(printed)} blocks of commands, {compared} texts compared")
    return 0 if compared >= 5 else 1


if __name__ == "__main__":
    sys.exit(main())
