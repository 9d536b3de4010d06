#!/usr/bin/env python3
"""docs/gallery.md has the figures and the pictures of this build: gallery.py SOURCE BUILD [--update FOLDER [NAME...]]

The commands of the page, without the cost of pixels, give its cycles, rays and energy and the left halves of its
pictures: the one of EMULATED, and with TRAX_SCENES=DIR all of them (DIR has the meshes of `trax-eval fetch-scenes`).
Without it the native twin renders those of NATIVE. README shows the page's first picture and says its cycles.

--update runs the commands as they stand and writes figures and pictures. Results go to FOLDER; those that are there are
not made again. It takes minutes of a processor."""

import json
import os
import pathlib
import re
import resource
import shlex
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from png_files import png_of, read_png  # noqa: E402

PAGE, PICTURES, GAP = "docs/gallery.md", "docs/gallery", 8
EMULATED, NATIVE = ("forest-plain",), ("room", "bunny")
BUNNY = "/usr/share/glmark2/models/bunny.obj"
ENTRY = re.compile(r"^!\[[^\]]*\]\(gallery/([\w-]+)\.png\)\n\n\*([^*\n]*)\*\n\n```sh long\n(.*?)^```$", re.M | re.S)


def caption(statistics, seconds):
    energy = {name: f"{float(f'{1000 * value:.3g}'):g} mJ" for name, value in statistics["energy"].items()}
    return (f"{statistics['cycles']:,} cycles ({statistics['seconds'] * 1000:.1f} ms), {statistics['rays']:,} rays; "
            f"{energy['total']} in the chip, {energy['off_chip']} in off-chip memory; "
            f"{seconds} s of the host")


class Gallery:
    def __init__(self, source, build):
        self.source, self.build = source, build
        self.scenes = os.environ.get("TRAX_SCENES")
        self.text = (source / PAGE).read_text()
        self.entries = [(name, said, shlex.split(command.replace("\\\n", " ")))
                        for name, said, command in ENTRY.findall(self.text)]

    def words(self, words):
        """The command for this build: the forest that it has made, and the places of meshes. A smooth forest is made
        anew."""
        places = {"bunny.obj": BUNNY}
        if "--smooth" not in words:
            places["generate:forest"] = str(self.build / "tests/forest.trax")
        if self.scenes:
            for path in pathlib.Path(self.scenes).resolve().iterdir():
                places[f"SCENES/{path.name}"] = str(path)
        return [str(self.build / "bin" / words[0]), *(places.get(word, word) for word in words[1:])]

    def run(self, words, folder):
        """Runs a command in a folder that has the room; what it left there, and its time on a processor."""
        if not (folder / "room").exists():
            subprocess.run([self.build / "tests/bin/render-gallery", "room"], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([*self.words(words), "--quiet"], cwd=folder, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def check(self, folder):
        """What is wrong."""
        wrong = []
        for name, said, words in self.entries:
            is_emulated = name in EMULATED or bool(self.scenes)
            if not is_emulated and name not in NATIVE:
                continue
            more = ["--stats", f"{name}.json"] if is_emulated else ["--engine", "native"]
            self.run([*words[:words.index("--cost-picture")], *more], folder)
            if is_emulated:
                seconds = re.search(r"(\d+) s of the host$", said)
                right = caption(json.loads((folder / f"{name}.json").read_text()), seconds[1] if seconds else "?")
                if said != right:
                    wrong.append(f"{PAGE}, {name}: the page has\n  {said}\nand the command gives\n  {right}")
            made, shown = (read_png(path.read_bytes())[2]
                           for path in (folder / f"{name}.png", self.source / PICTURES / f"{name}.png"))
            if len(made) != len(shown) or any(b[:len(a)] != a or len(b) != 2 * len(a) + 3 * GAP
                                              for a, b in zip(made, shown)):
                wrong.append(f"{PICTURES}/{name}.png: its left half is not what the command renders")
        return wrong

    def named(self):
        """What is wrong with README's first picture."""
        readme = (self.source / "README.md").read_text()
        name, said, _ = self.entries[0]
        cycles = said.split(" cycles")[0]
        needed = (f"({PICTURES}/{name}.png)", f"{cycles} cycles")
        return [f"README.md does not have {text}, as the first picture of {PAGE}" for text in needed
                if text not in readme]

    def update(self, folder, names):
        folder.mkdir(parents=True, exist_ok=True)
        for name, said, words in self.entries:
            if names and name not in names:
                continue
            if not (folder / f"{name}.time").exists():
                seconds = self.run([*words, "--stats", f"{name}.json"], folder)
                (folder / f"{name}.time").write_text(str(seconds))
            seconds = round(float((folder / f"{name}.time").read_text().split()[0]))
            new = caption(json.loads((folder / f"{name}.json").read_text()), seconds)
            self.text = self.text.replace(f"gallery/{name}.png)\n\n*{said}*", f"gallery/{name}.png)\n\n*{new}*")
            both = (read_png((folder / f"{name}{part}.png").read_bytes())[2] for part in ("", "-cost"))
            rows = [left + b"\xff" * (3 * GAP) + right for left, right in zip(*both)]
            (self.source / PICTURES / f"{name}.png").write_bytes(png_of(rows, best=True))
        (self.source / PAGE).write_text(self.text)


def main():
    gallery = Gallery(*(pathlib.Path(word).resolve() for word in sys.argv[1:3]))
    if sys.argv[3:4] == ["--update"]:
        gallery.update(pathlib.Path(sys.argv[4]).resolve(), sys.argv[5:])
        return 0
    wrong = [] if len(gallery.entries) == 6 else [f"{PAGE} has {len(gallery.entries)} pictures with commands, not 6"]
    with tempfile.TemporaryDirectory() as folder:
        wrong += gallery.check(pathlib.Path(folder)) + gallery.named()
    for fault in wrong:
        print(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
