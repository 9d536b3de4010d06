#!/usr/bin/env python3
"""Programs that use none of the library's parts for parallel programs, POSIX and wide characters have no byte of them.

    unused_test.py BIN LIB SOURCES AR

Links programs of SOURCES/tests/c with the library and with one that lacks those parts: the executables must be the
same. A program that needs one of the parts must not link without it, so that the list of parts is known to count.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

HEAP = ["heap/malloc", "heap/runs"]
PARTS = [*(f"parallel/{name}" for name in ("conditions", "for", "tasks", "team", "threads")),
         *(f"openmp/{name}" for name in ("kmpc", "loops", "omp")),
         *(f"posix/{name}" for name in ("folders", "more_files", "paths", "search", "strptime", "uchar", "variables",
                                        "wide", "wide_format", "wide_streams")),
         "stdio/ext", "stdlib/profile", "stdlib/quick_exit"]

# The parts that each program needs.
PROGRAMS = {
    "minimal.c": None,
    "snprintf.c": None,
    "complex_numbers.c": None,
    "math_functions.c": None,
    "sorting.c": None,
    "memory.c": None,
    "threads.c": None,
    "atomic_single.c": None,
    "thread_local_values.c": None,
    "setjmp_longjmp.c": None,
    "overflow_checks.c": None,
    "cxx_language.cpp": "heap/malloc",  # operator new
    "heap_errors.c": "heap/malloc",
    "parallel.c": "parallel/for",
    "wide_streams.c": "posix/wide_streams",
}


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, check=False, **options)


def members(archive, folder):
    """Unpacks an archive, whose members' names repeat; a path and the bytes of each."""
    data, at, names = archive.read_bytes(), 8, b""
    while at < len(data):
        name, size = data[at:at + 16].rstrip(), int(data[at + 48:at + 58])
        body = data[at + 60:at + 60 + size]
        at += 60 + size + size % 2
        if name == b"//":
            names = body
        elif name[:1] == b"/" and name[1:].isdigit():
            name = names[int(name[1:]):].split(b"/\n")[0]
        if name in (b"/", b"//"):
            continue
        path = folder / str(at) / name.rstrip(b"/").decode()
        path.parent.mkdir()
        path.write_bytes(body)
        yield path, body


def reduced(library, without, folder, archiver):
    """A library without these sources, which the debug information names."""
    kept, found = [], set()
    (folder / "members").mkdir(parents=True)
    for path, body in members(library / "libc.a", folder / "members"):
        source = [part for part in without
                  if path.name == part.split("/")[1] + ".c.o" and f"runtime/{part}.c\0".encode() in body]
        found.update(source)
        if not source:
            kept.append(path)
    if found != set(without):
        sys.exit(f"libc.a has no {', '.join(sorted(set(without) - found))}")
    run(archiver, "rcsD", folder / "libc.a", *kept)
    return folder


def main():
    binaries, library, sources, archiver = map(Path, sys.argv[1:5])
    failures = []
    with tempfile.TemporaryDirectory(prefix="trax-unused-") as name:
        work = Path(name)
        lacks_all = reduced(library, [*HEAP, *PARTS], work / "all", archiver)
        lacks_parts = reduced(library, PARTS, work / "parts", archiver)
        for program, need in PROGRAMS.items():
            compile_command = [binaries / "clang", "--target=trax", "-O2", "-w", "-mstack=global",
                               "-std=c++20" if program.endswith("cpp") else "-std=gnu17"]
            made = run(*compile_command, "-c", sources / "tests/c" / program, "-o", work / "program.o")

            def link(folder):
                done = run(*compile_command, work / "program.o", "-L", folder, "-o", work / "program")
                return (work / "program").read_bytes() if done.returncode == 0 else None

            if made.returncode != 0:
                sys.exit(made.stderr.decode())
            whole, without_all, without_parts = link(library), link(lacks_all), link(lacks_parts)
            if whole is None:
                failures.append(f"{program} does not link")
            elif need and without_all is not None:
                failures.append(f"{program} links without {need}")
            elif not need and without_all != whole:
                failures.append(f"{program} needs a part or changes without them")
            elif (need in (None, *HEAP)) != (without_parts == whole):
                how = "changes" if without_parts else "does not link"
                failures.append(f"{program}: with the heap alone of the parts it {how}")
    print("\n".join(failures) or f"{len(PROGRAMS)} programs have what they use")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
