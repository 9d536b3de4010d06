#!/usr/bin/env python3
"""Compile libc++'s headers, but for those that are not available: all in one file, in the order of their names. With
TRAX_LEVELS=all in the environment, in the opposite one and each alone, too. Exit status 0 if all compile.

    cxx_headers.py CLANG++ --target=trax
"""

import os
import subprocess
import sys


def is_missing(name, directories):
    """Whether the file of this name only reports an error."""
    found = next(path for path in (os.path.join(directory, name) for directory in directories) if os.path.exists(path))
    with open(found, encoding="utf-8") as file:
        return f"<{name}> is not available" in file.read()


def main():
    compiler = sys.argv[1:]

    def compile_headers(names, *options):
        text = "".join(f"#include <{name}>\n" for name in names)
        return subprocess.run([*compiler, "-std=c++23", *options, "-x", "c++", "-"], input=text, capture_output=True,
                              text=True, check=False)

    directories = [
        line.strip() for line in compile_headers([], "-v", "-fsyntax-only").stderr.splitlines()
        if line.startswith(" /")]
    folder = next(directory for directory in directories if os.path.exists(os.path.join(directory, "vector")))
    names = [name for name in sorted(os.listdir(folder)) if "." not in name and not name.startswith("_")]
    names = [name for name in names if os.path.isfile(os.path.join(folder, name))]
    names = [name for name in names if not is_missing(name, directories)]
    groups = [names]
    if os.environ.get("TRAX_LEVELS") == "all":
        groups += [names[::-1], *([name] for name in names)]
    failed = 0
    for group in groups:
        done = compile_headers(group, "-fsyntax-only")
        if done.returncode:
            failed += 1
            print(f"<{group[0]}> and {len(group) - 1} more:\n{done.stderr}")
    if len(names) < 70:
        print(f"only {len(names)} headers found in {folder}")
    return 1 if failed or len(names) < 70 else 0


if __name__ == "__main__":
    sys.exit(main())
