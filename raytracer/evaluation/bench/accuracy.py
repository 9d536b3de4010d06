#!/usr/bin/env python3
"""Error against run time (trax-render --bench-accuracy) of the conference and of the generated forest, and their tables and diagrams
in docs/accuracy.md.

    raytracer/evaluation/bench/accuracy.py SCENES_DIRECTORY --output DIR [--size 320x180] [--page docs/accuracy.md] [--bin build/bin]

SCENES_DIRECTORY is lean.py's. What was measured stays in DIR, so that a run that was stopped goes on. With --page
the tables stand between the page's marks, and the diagrams beside it.
"""

import pathlib
import shutil
import subprocess
import sys

from scenes import arguments, files_of

SCENES = ["conference", "forest"]


def marks(name):
    return f"<!-- accuracy.py {name}: begin -->\n", f"<!-- accuracy.py {name}: end -->\n"


def into_page(page, name, folder):
    text = page.read_text(encoding="utf-8")
    begin, end = marks(name)
    if begin not in text or end not in text:
        sys.exit(f"accuracy.py: error: {page}: the marks for {name} are missing")
    picture = page.parent / f"accuracy-{name}.svg"
    shutil.copyfile(folder / "accuracy.svg", picture)
    table = (folder / "accuracy.md").read_text(encoding="utf-8")
    block = f"{table}\n![error against cycles, bytes and energy, {name}]({picture.name})\n"
    new = page.with_name(page.name + ".new")
    new.write_text(text.split(begin)[0] + begin + block + end + text.split(end)[1], encoding="utf-8")
    new.rename(page)


def main():
    parser = arguments(__doc__, "320x180")
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--page", type=pathlib.Path)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name in SCENES:
        folder = options.output / name
        command = [options.bin / "trax-render", "--bench-accuracy", *files_of(options.scenes, name), "--view", name, "--size", options.size, "-o", folder]
        if subprocess.run(command, check=False).returncode != 0:
            sys.exit(1)
        if options.page:
            into_page(options.page, name, folder)


main()
