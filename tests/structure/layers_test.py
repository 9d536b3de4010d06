"""The folders of the emulator and of the ray tracer include one another as the tables of docs/architecture.md allow.

  layers_test.py SOURCE

The packages of trax-eval import one another in the same way. Each table is read from its chapter. It has a row for each
folder, and the second column names the folders that the folder may include. Rows go from the top layer to the bottom
one, and a row names only folders of lower rows, so there is no circle. The test adds forbidden includes and imports to
copies of files of each folder and checks that they are noticed."""

import os
import re
import sys

SOURCE = sys.argv[1]
PAGE = "docs/architecture.md"
# Part, its chapter, the fewest folders and files that prove anything.
PARTS = [("emulator", "## The emulator's layers", 10, 100), ("raytracer", "## The ray tracer's rooms", 6, 100),
         ("raytracer/evaluation", "## The packages of trax-eval", 3, 30)]
C, PYTHON = (".c", ".cpp", ".h"), (".py",)
# Headers that other parts offer to the ray tracer as trax/*.h.
PUBLIC = {"emulator": "emulator/include/trax", "base": "emulator/base/include/trax", "isa": "isa/include/trax",
          "runtime": "runtime/include"}


def table(chapter):
    """Folder: those it may include, from the top layer to the bottom."""
    with open(os.path.join(SOURCE, PAGE), encoding="utf-8") as page:
        text = page.read()
    text = text[text.index(chapter) :].split("\n## ")[0]
    rows = re.findall(r"^\| `(\w+)/` \| ([^|]*) \|", text, re.M)
    names = [name for name, _ in rows]
    return {name: names[i + 1 :] if below == "all below" else re.findall(r"`(\w+)/?`", below)
            for i, (name, below) in enumerate(rows)}


def sources(part, folders, endings):
    """(folder, path, text) of every file of these folders with one of the endings."""
    for folder in folders:
        for place, _, files in os.walk(os.path.join(SOURCE, part, folder)):
            for name in sorted(files):
                if name.endswith(endings):
                    path = os.path.join(place, name)
                    with open(path, encoding="utf-8") as file:
                        yield folder, os.path.relpath(path, SOURCE), file.read()


class Part:
    def __init__(self, name, chapter):
        self.name = name
        self.allowed = table(chapter)
        self.files = list(sources(name, sorted(os.listdir(os.path.join(SOURCE, name))), C))
        self.headers = {}  # name: folders that have such a file
        for folder, path, _ in self.files:
            self.headers.setdefault(os.path.basename(path), set()).add(folder)

    def folder_of(self, path, include):
        """The owner of a header: a folder of the part, or one of PUBLIC; "" if it has none. None for headers that need
        no permission: the system's, generated ones and, in the emulator, the public ones."""
        first = include.split("/")[0]
        if self.name == "emulator":  # "fast/chip.h", not "trax/files.h" or a file beside it
            return first if "/" in include and first != "trax" else None
        if first == "trax":
            found = [public for public, place in PUBLIC.items()
                     if os.path.exists(os.path.join(SOURCE, place, include[5:]))]
            return (found or ["include"])[0]
        beside = os.path.normpath(os.path.join(os.path.dirname(path), include))
        if os.path.exists(os.path.join(SOURCE, beside)):
            return beside.split(os.sep)[1]
        if "/" in include:  # "layouts/records.h"
            return first if os.path.exists(os.path.join(SOURCE, self.name, include)) else ""
        return next(iter(self.headers.get(include, ())), None)

    def check(self, files):
        """What is wrong, in lines."""
        order = list(self.allowed)
        wrong = [f"{PAGE}: {name}/ may include {other}/, which stands above it"
                 for name, below in self.allowed.items() for other in below
                 if other in order and order.index(other) < order.index(name)]
        for folder, path, text in files:
            if folder not in self.allowed:
                wrong.append(f"{path}: {folder}/ is not in the table")
                continue
            for include in self.included(text):
                owner = self.folder_of(path, include)
                if owner not in (None, folder, *self.allowed[folder]):
                    wrong.append(f"{path}: {folder}/ may not include {include}")
        return wrong

    def included(self, text):
        return map("".join, re.findall(r'^#include "([^"]+)"|^#include <(trax/[^>]+)>', text, re.M))

    def unnoticed(self):
        """Which include that is added to a file of a folder, and forbidden there, is not noticed: in lines."""
        order = list(self.allowed)
        for i, name in enumerate(order):
            own, path, text = next(one for one in self.files if one[0] == name)
            if self.name == "emulator":
                added = [f"{other}/x.h" for other in reversed(order[:i]) if other not in self.allowed[name]][:1]
            else:
                near = {name, *self.allowed[name]}
                others = (header for header, folders in self.headers.items()
                          if header.endswith(".h") and not folders & near)
                added = ["machine/machine.h", "program/program.h", next(others)]
            for include in added:
                if not self.check([(own, path, f'#include "{include}"\n' + text)]):
                    yield f"{path}: an include of {include} is not noticed"


class Packages(Part):
    """Packages of Python: a folder each, and an import for an include."""

    def __init__(self, name, chapter):
        self.name, self.allowed = name, table(chapter)
        self.files = list(sources(name, self.allowed, PYTHON))

    def folder_of(self, path, include):
        return include if include in self.allowed else None

    def included(self, text):
        lines = re.findall(r"^ *(?:from|import) +(.*)", text, re.M)
        return [name for line in lines for name in re.findall(r"(?:^|, *)(\w+)", line.split(" import ")[0])]

    def unnoticed(self):
        order = list(self.allowed)
        for i, name in enumerate(order[1:], 1):
            for line in (f"import {order[i - 1]}\n", f"    from {order[i - 1]}.x import y\n"):
                if not self.check([(name, name, line)]):
                    yield f"{name}: {line!r} is not noticed"


def main():
    failed = False
    for name, chapter, folders, files in PARTS:
        part = (Packages if "packages" in chapter else Part)(name, chapter)
        wrong = part.check(part.files) + list(part.unnoticed())
        if len(part.allowed) < folders or len(part.files) < files:
            wrong.append(f"{len(part.allowed)} rows and {len(part.files)} files of {name}/ prove too little")
        for line in wrong:
            print(line)
        failed = failed or bool(wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
