#!/usr/bin/env python3
"""Finds the programs that keep every byte since an earlier library. Today's compiler compiles both.

    same_bytes.py --build build --against COMMIT --work DIR

Prints the functions and objects of the earlier libc.a that are no longer the same, and a line for each program of
tests/c and raytracer/examples and for the ray tracer in each layout of nodes: "same", or which of those it has. A
program that differs without any is an error. So is one in which only division has changed, and which differs with the
earlier division, too. DIR keeps a work tree with the commit's runtime/ and its build. Exit status: 0 without errors.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

from unused_test import members, run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from elf_files import ALLOC, ElfFile  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
LLVM = pathlib.Path("/usr/lib/llvm-19/bin")
DIVISION = ("divsi.c.o", "divdi.c.o")  # every printf has it
LAYOUTS = ("binary", "quantised", "wide4", "wide4-quantised", "wide8")


def parts(body):
    """Yields each loaded section of an object: name, contents with relocations, and the symbols that it defines."""
    elf = ElfFile(body)
    for number, section in enumerate(elf.sections):
        if section.flags & ALLOC and section.size:
            contents = section.size, section.alignment, elf.contents(section), list(elf.relocations(number))
            yield section.name, contents, [symbol.name for symbol in elf.symbols
                                           if symbol.section == number and symbol.name]


def library(archive, folder):
    """Unpacks it. Paths of its objects, and for each (object, section) what it has, and its symbols."""
    folder.mkdir(parents=True)
    paths, found = [], {}
    for path, body in members(archive, folder):
        paths.append(path)
        for section, contents, defined in parts(body):
            known, symbols = found.setdefault((path.name, section), ([], set()))
            known.append(contents)
            symbols.update(defined)
    return paths, found


def build_earlier(build, commit, work):
    """Today's tree with the commit's runtime/, and the compiler and the library in it."""
    tree = work / "tree"
    if not tree.exists():
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--detach", tree, "HEAD"], check=True)
        subprocess.run(["git", "-C", tree, "rm", "-rq", "runtime"], check=True)
        subprocess.run(["git", "-C", tree, "checkout", commit, "--", "runtime"], check=True)
    rules = tree / "runtime/CMakeLists.txt"
    if "-mstack=either" not in rules.read_text():  # objects say which stack they are for
        rules.write_text(rules.read_text().replace("--target=trax ", "--target=trax -mstack=either ", 1))
    subprocess.run(["cmake", "--preset", "release"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-C", "build", "clang", "trax-ld", "trax-runtime"], cwd=tree, check=True)
    for program in ("trax-render", "trax-sim"):
        shutil.copy(build / "bin" / program, tree / "build/bin")
    shutil.copytree(build / "share", tree / "build/share", dirs_exist_ok=True)  # views: another one is another program
    return tree / "build"


def loaded(program):
    """The bytes without debug information and symbols, and the names of the latter."""
    symbols = set(run(LLVM / "llvm-nm", "-j", program).stdout.decode().split())
    subprocess.run([LLVM / "llvm-objcopy", "--strip-all", program], check=True)
    return program.read_bytes(), symbols


def compiled(build, source, output, *further):
    """None if the library lacks something."""
    made = run(build / "bin/clang", "--target=trax", "-O2", "-w", "-mstack=global", "-I", ROOT / "raytracer/include",
               "-std=c++20" if source.suffix == ".cpp" else "-std=gnu17", *further, source, "-o", output)
    return None if made.returncode else loaded(output)


def prepared(build, layout, work):
    """The ray tracer's program for paths."""
    folder = work / f"prepared-{build.parent.name}"
    subprocess.run([build / "bin/trax-render", "generate:forest", "--nodes", layout, "--size", "8x8", "--paths", "4",
                    "--cache", work / f"cache-{build.parent.name}", "--prepare", folder], check=True,
                   stdout=subprocess.DEVNULL)
    return loaded(folder / "program.elf")


def judge(name, old, new, changed, with_old_division):
    """A row of the table, and whether it is an error."""
    if new is None or old is None:
        return f"{name}: {'needs other flags' if new is None else 'the earlier library lacks what it uses'}", False
    if old[0] == new[0]:
        return f"{name}: same", False
    has = sorted({changed[symbol] for symbol in old[1] & set(changed)})
    if not has:
        return f"{name}: DIFFERS, and has no changed part", True
    if not set(has) - set(DIVISION) and with_old_division()[0] != old[0]:
        return f"{name}: DIFFERS by more than division", True
    return f"{name}: {' '.join(has) if set(has) - set(DIVISION) else 'division'}", False


def compare(build, earlier, work):
    """Prints both tables. Returns the number of errors."""
    old_paths, old = library(earlier / "lib/trax/libc.a", work / "old")
    new_paths, new = library(build / "lib/trax/libc.a", work / "new")
    same = {part for part in old if part in new and new[part][0] == old[part][0]}
    elsewhere = set().union(*(old[part][1] for part in same))
    changed = {symbol: part[0] for part in old if part not in same for symbol in old[part][1] - elsewhere}
    print(f"{len(same)} of {len(old)} parts of the earlier library are the same; not so:")
    for name in sorted({part[0] for part in old if part not in same}):
        print(f"  {name}: {' '.join(sorted(part[1] for part in old if part[0] == name and part not in same))}")
    (work / "mixed").mkdir()
    division = {path.name: path for path in old_paths if path.name in DIVISION}
    run(LLVM / "llvm-ar", "rcsD", work / "mixed/libc.a", *(division.get(path.name, path) for path in new_paths))
    sources = [*(ROOT / "tests/c").glob("*.c*"), *(ROOT / "raytracer/examples").glob("*.c")]
    rows = []
    for source in sorted(path for path in sources if path.suffix in (".c", ".cpp")):
        rows.append(judge(source.name, compiled(earlier, source, work / "a"), compiled(build, source, work / "b"),
                          changed, lambda: compiled(build, source, work / "c", "-L", work / "mixed")))
    for layout in LAYOUTS:
        rows.append(judge(f"ray tracer, {layout}", prepared(earlier, layout, work), prepared(build, layout, work),
                          changed, lambda: (None, )))
    print("\n".join(row for row, _ in rows))
    same, division = (sum(row.endswith(end) for row, _ in rows) for end in (": same", ": division"))
    errors = sum(wrong for _, wrong in rows)
    print(f"{len(rows)} programs, {same} the same, {division} but for division, {errors} errors")
    return errors


def main():
    parser = argparse.ArgumentParser(description="Compare programs with those of an earlier library.")
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--against", required=True, metavar="COMMIT")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    options = parser.parse_args()
    build, work = options.build.resolve(), options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    earlier = build_earlier(build, options.against, work)
    with tempfile.TemporaryDirectory(prefix="trax-bytes-") as name:
        sys.exit(bool(compare(build, earlier, pathlib.Path(name))))


if __name__ == "__main__":
    main()
