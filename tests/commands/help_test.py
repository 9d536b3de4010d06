#!/usr/bin/env python3
"""What programs say of themselves stands in the pages as they say it: help_test.py BIN SOURCE [--update]

In a fenced block that begins with `$ PROGRAM OPTION...`, all that follows is what this command prints. --update puts it
there (`ninja update-docs`)."""

import difflib
import pathlib
import re
import shlex
import subprocess
import sys

BLOCK = re.compile(r"(?<=^```\n)\$ (trax-.*)\n((?:(?!```$).*\n)*)", re.MULTILINE)
LEAST = 3  # blocks: one that is not found any more must not go unnoticed


def printed(binaries, command):
    program, *words = shlex.split(command)
    return subprocess.run([binaries / program, *words], capture_output=True, text=True, check=True, timeout=60).stdout


def main():
    binaries, source = map(pathlib.Path, sys.argv[1:3])
    stale = found = 0
    for page in [source / "README.md", *sorted((source / "docs").rglob("*.md"))]:
        text = page.read_text()
        found += len(BLOCK.findall(text))
        expected = BLOCK.sub(lambda block: f"$ {block[1]}\n{printed(binaries, block[1])}", text)
        if text == expected:
            continue
        if "--update" in sys.argv[3:]:
            page.write_text(expected)
            continue
        stale += 1
        sys.stdout.writelines(difflib.unified_diff(text.splitlines(True), expected.splitlines(True), str(page),
                                                   "what is printed"))
    if stale or found < LEAST:
        sys.exit(f"{stale} pages are not what programs print, run `ninja update-docs`; {found} blocks")


main()
