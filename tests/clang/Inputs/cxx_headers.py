#!/usr/bin/env python3
"""Compile each of libc++'s headers alone, but for those that are not available. Exit status 0 if all compile.

    cxx_headers.py CLANG++ --target=trax
"""

import os
import subprocess
import sys


def main():
    compiler = sys.argv[1:]
    described = subprocess.run([*compiler, "-std=c++23", "-v", "-fsyntax-only", "-x", "c++", "-"], input="", capture_output=True,
                               text=True, check=True).stderr
    directories = [line.strip() for line in described.splitlines() if line.startswith(" /")]
    headers = next(directory for directory in directories if os.path.exists(os.path.join(directory, "vector")))
    names = [name for name in sorted(os.listdir(headers)) if "." not in name and not name.startswith("_")]
    names = [name for name in names if os.path.isfile(os.path.join(headers, name))]
    failed = count = 0
    for name in names:
        done = subprocess.run([*compiler, "-std=c++23", "-fsyntax-only", "-x", "c++", "-"], input=f"#include <{name}>\n",
                              capture_output=True, text=True, check=False)
        if f"<{name}> is not available" in done.stderr:
            continue
        count += 1
        if done.returncode:
            failed += 1
            print(f"<{name}>:\n{done.stderr}")
    if count < 70:
        print(f"only {count} headers found in {headers}")
    return 1 if failed or count < 70 else 0


if __name__ == "__main__":
    sys.exit(main())
