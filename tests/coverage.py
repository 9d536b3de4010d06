#!/usr/bin/env python3
"""Which lines have run: of each room, a folder of the sources, the lines with code and those that ran at least once.

  tests/coverage.py [BUILD]           after the tests of a build by `cmake --preset coverage` (default: build-coverage)
  tests/coverage.py --files ROOM      the room's files, and their lines that did not run

Only what the build has compiled counts. gcov comes with the compiler. Remove the files *.gcda to begin again.
"""

import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
ROOMS = ("emulator", "isa", "llvm-target", "raytracer", "runtime")
AT_ONCE = 40  # notes for one gcov


def lines_of(build):
    """{file: {line: how often it ran}}, relative to the source; a header is in several objects."""
    source = pathlib.Path(json_source(build))
    counts = collections.defaultdict(lambda: collections.defaultdict(int))
    notes = sorted(build.rglob("*.gcno"))
    with tempfile.TemporaryDirectory() as folder:
        for first in range(0, len(notes), AT_ONCE):
            done = subprocess.run(["gcov", "--json-format", "--stdout", *notes[first:first + AT_ONCE]], cwd=folder,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
            for text in done.stdout.splitlines():
                found = json.loads(text)
                for file in found["files"]:
                    path = pathlib.Path(found["current_working_directory"], file["file"]).resolve()
                    if path.is_relative_to(source) and path.relative_to(source).parts[0] in ROOMS:
                        for line in file["lines"]:
                            counts[str(path.relative_to(source))][line["line_number"]] += line["count"]
    return counts


def json_source(build):
    """The folder that the build was configured from."""
    for line in (build / "CMakeCache.txt").read_text().splitlines():
        if line.startswith("CMAKE_HOME_DIRECTORY:"):
            return line.partition("=")[2]
    sys.exit(f"coverage.py: error: {build}/CMakeCache.txt names no source")


def ranges(numbers):
    """1 2 3 7 as 1-3 7."""
    found = []
    for number in sorted(numbers):
        if found and found[-1][1] == number - 1:
            found[-1][1] = number
        else:
            found.append([number, number])
    return " ".join(str(first) if first == last else f"{first}-{last}" for first, last in found)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=SOURCE / "build-coverage")
    parser.add_argument("--files", metavar="ROOM", help="a folder's files, with the lines that did not run")
    options = parser.parse_args()
    if not (options.build / "CMakeCache.txt").exists():
        sys.exit(f"coverage.py: error: {options.build}: no build: cmake --preset coverage")
    counts = lines_of(options.build.resolve())
    rows = collections.defaultdict(lambda: [0, 0])
    for name, lines in sorted(counts.items()):
        room = str(pathlib.PurePath(name).parent)
        if options.files is None or options.files == room:
            for key in (name if options.files else room, "total"):
                rows[key][0] += sum(count > 0 for count in lines.values())
                rows[key][1] += len(lines)
    for key, (ran, known) in rows.items():
        missed = [line for line, count in counts.get(key, {}).items() if count == 0]
        if key != "total":
            print(f"{key:34} {ran:6} of {known:6} lines {100 * ran / known:6.1f} %  {ranges(missed)}".rstrip())
    ran, known = rows["total"]
    print(f"{'total':34} {ran:6} of {known:6} lines {100 * ran / max(known, 1):6.1f} %")


if __name__ == "__main__":
    main()
