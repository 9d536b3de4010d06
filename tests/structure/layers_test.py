"""The emulator's folders include one another as the table of docs/architecture.md, "The emulator's layers", allows.

  layers_test.py SOURCE

The table is read from the page: a row for each folder, and in its second column the folders that it may include. Rows stand
from the top layer to the bottom one, so a folder may only name those below it: there is no circle. The test also sees that
it can fail: with an include added that looks up, to a copy of each folder's first file."""

import os
import re
import sys

SOURCE = sys.argv[1]
PAGE = os.path.join(SOURCE, "docs", "architecture.md")
ROOT = os.path.join(SOURCE, "emulator")
CHAPTER = "## The emulator's layers"


def table():
    """Folder: those it may include, from the top layer to the bottom."""
    with open(PAGE, encoding="utf-8") as page:
        text = page.read()
    chapter = text[text.index(CHAPTER):]
    chapter = chapter[: chapter.find("\n## ", 1)]
    rows = re.findall(r"^\| `(\w+)/` \| ([^|]*) \|", chapter, re.M)
    names = [name for name, _ in rows]
    return {name: names[i + 1 :] if below == "all below" else re.findall(r"`(\w+)/`", below)
            for i, (name, below) in enumerate(rows)}


def includes(text):
    """Folders of the emulator that a file names: "fast/chip.h", not "trax/files.h" or a file beside it."""
    return re.findall(r'^#include "(\w+)/', text, re.M)


def sources():
    """(folder, path, text) of all that is compiled."""
    for folder in sorted(os.listdir(ROOT)):
        for place, _, files in os.walk(os.path.join(ROOT, folder)):
            for name in sorted(files):
                if name.endswith((".c", ".h")):
                    path = os.path.join(place, name)
                    with open(path, encoding="utf-8") as file:
                        yield folder, os.path.relpath(path, SOURCE), file.read()


def check(allowed, files):
    """What is wrong, in lines."""
    wrong = []
    order = list(allowed)
    for name, below in allowed.items():
        wrong += [f"docs/architecture.md: {name}/ may include {other}/, which stands above it" for other in below
                  if other in order and order.index(other) < order.index(name)]
    for folder, path, text in files:
        if folder not in allowed:
            wrong.append(f"{path}: {folder}/ is not in the table")
            continue
        wrong += [f"{path}: {folder}/ may not include {other}/" for other in includes(text)
                  if other not in (folder, "trax") and other not in allowed[folder]]
    return wrong


def main():
    allowed = table()
    files = list(sources())
    wrong = check(allowed, files)
    for line in wrong:
        print(line)
    if len(allowed) < 10 or len(files) < 100:
        print(f"{len(allowed)} rows and {len(files)} files are too few to prove anything")
        return 1
    order = list(allowed)
    for i, name in enumerate(order[1:], 1):  # an include that looks up is noticed in each
        above = next((other for other in reversed(order[:i]) if other not in allowed[name]), None)
        some = next((folder, path, text) for folder, path, text in files if folder == name)
        if above and not check(allowed, [(name, some[1], f'#include "{above}/x.h"\n' + some[2])]):
            wrong.append(name)
            print(f"an include of {above}/ in {some[1]} is not noticed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
