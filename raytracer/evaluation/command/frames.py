"""trax-render --frames with --at X:Y: each frame of a sequence with a new tree and with the first frame's, refitted.
The frames are sweeps, one for each curve, whose runs are the same. None has the name of one that comes with trax, so
that the report is about them alone."""

import csv
import io
import math
import os
import pathlib
import re

from trax_eval.refits import AT, FROM, NAME, moment
from trax_eval.sweep import read_sweep
from trax_eval.tools import run_tool
from trax_eval.util import Problem, check_files, read_json, write_file, write_json

from .main import parse

NEW, REFITTED = "new trees", "refitted"
CURVES = {
    "curve-cycles": ("Cycles of a frame", "cycles"), "curve-rays": ("Rays of a frame", "rays"),
    "curve-rate": ("Rays a second", "mrps"), "curve-bytes": ("Bytes of a ray", "values.bytes_per_ray"),
    "curve-sah": ("Visits that SAH expects", "values.scene.bvh.sah_nodes"),
    "curve-rebuild": ("When to rebuild", f"values.{NAME}")
}
VIEW = ("view", "eye", "look-at", "up", "fov", "light", "orbit")
HERE = ("at", "frames", "no-refit", "output", "size", "config", "set", "quiet")  # neither program gets them
BOTH = ("smooth", )


def moments(text, count):
    """count moments from X to Y of the text "X:Y"; whole ones as whole numbers."""
    first, last = map(moment, text.split(":"))
    if not math.isfinite(last - first):
        raise Problem(f"--at: {text} are too far apart")
    found = [first + (last - first) * i / (count - 1) for i in range(count)]
    return [int(one) if one == int(one) else one for one in found]


class Sequence:
    """A command line of trax-render."""
    def __init__(self, arguments, tools):
        words, self.meshes = tools.words("trax-render", arguments)
        given = [word[2:].partition("=") for word in words]
        self.values = {name: value for name, _, value in given}
        if not {"frames", "output"} <= self.values.keys() or ":" not in self.values.get("at", ""):
            raise Problem("expected trax-render's words: --frames, --at X:Y and -o")
        chip = self.values.get("config", "4x32")
        self.chip = os.path.abspath(chip) if os.path.isfile(chip) else chip
        settings = tuple(value.partition("=")[::2] for name, _, value in given if name == "set")
        tools.configuration(self.chip, settings)  # before anything is written
        self.settings = {key: tools.value(self.chip, settings, key) for key, _ in settings}
        self.folder = pathlib.Path(self.values["output"])
        self.moments = moments(self.values["at"], int(self.values["frames"]))
        self.scene, self.render, self.view = [], [], []
        for word, (name, _, value) in zip(words, given):
            use = self.use(tools, word)
            word = f"--{name}={os.path.abspath(value)}" if use == "reads" else word
            if name in VIEW:
                self.view.append(word)
            elif name not in HERE and self.takes(tools, "trax-scene", word):
                self.scene.append(word)
            if name in BOTH or name not in (*VIEW, *HERE) and word not in self.scene:
                self.render.append(word)

    @staticmethod
    def takes(tools, program, word):
        try:
            return bool(tools.given(program, program, (word, )))
        except Problem:
            return False

    @staticmethod
    def use(tools, word):
        return dict(tools.given("--frames", "trax-render", (word, ))).get(word[2:].partition("=")[0], "")

    def refits(self):
        """Whether trees are refitted, too: instances are not."""
        return not ("no-refit" in self.values or "instances" in self.values or
                    any(mesh.endswith(".instances") for mesh in self.meshes))

    def write_view(self, tools):
        """The view of the first frame, for all."""
        path = self.folder / "frames.view"
        run = run_tool([
            tools.path("trax-render"), *self.meshes, f"--at={self.moments[0]}", *self.scene, *self.view, "--quiet",
            f"--write-view={path}"
        ])
        if run.returncode != 0:
            raise Problem(run.stderr.strip().removeprefix("trax-render: error: ") or "trax-render failed")
        return str(path.resolve())

    def write_sweeps(self, view):
        """Returns the sweeps' files."""
        write_json(self.folder / "program.json", {
            "name": "frames", "title": "Our program", "like": "ours", "scene": self.scene, "render": self.render,
            "set": self.settings
        })
        variants = [{"name": NEW, AT: self.moments}]
        if self.refits():
            variants.append({"name": REFITTED, AT: self.moments, FROM: self.moments[0]})
        paths = []
        for name, (title, figure) in CURVES.items():
            if name == "curve-rebuild" and not self.refits():
                continue
            paths.append(self.folder / f"{name}.json")
            write_json(paths[-1], {
                "name": name, "title": title, "scenes": [{
                    "name": re.sub(r"%(0\d)?d|\W+", "-", pathlib.Path(self.meshes[0]).stem).strip("-") or "frames",
                    "meshes": [mesh if mesh.startswith("generate:") else os.path.abspath(mesh)
                               for mesh in self.meshes], "view": view
                }], "programs": "program.json", "chips": self.chip,
                "size": self.values.get("size", "1280x720"), "set": variants, "reference": NEW, "x": AT, "y": figure,
                "table": {"rows": AT, "columns": "variant", "values": [figure]}
            })
        return paths

    def outputs(self, number, variant):
        """(picture, statistics)"""
        name = f"frame-{number:04d}" + ("" if variant == NEW else f"-{variant}")
        return self.folder / f"{name}.png", self.folder / f"{name}.json"

    def write_frame(self, number, run, point):
        """Writes the files of a finished frame, and returns its row of frames.csv."""
        picture, statistics = self.outputs(number, point["variant"])
        if point["variant"] == NEW:
            write_file(picture, (self.folder / run["picture"]).read_bytes())
        write_json(statistics, read_json(self.folder / run["json"])["statistics"])
        stats, values = run["stats"], run["values"]
        return [number, point["set"][AT], point["variant"], stats["cycles"], stats["rays"], stats["mrps"],
                values["bytes_per_ray"], values.get("scene.bvh.sah_nodes"),
                values.get(NAME) if point["variant"] == REFITTED else None]

    def write_frames(self, results):
        """Writes the files of all finished frames, and frames.csv."""
        rows = []
        for run in results["runs"]:
            for point in run["points"]:
                if run["status"] != "done" or point["experiment"] != next(iter(CURVES)):
                    continue
                for number, moment_of in enumerate(self.moments, 1):
                    if moment_of == point["set"][AT]:
                        rows.append(self.write_frame(number, run, point))
        text = io.StringIO()
        columns = ["frame", "at", "tree", "cycles", "rays", "mrps", "bytes_per_ray", "sah_nodes", NAME]
        csv.writer(text, lineterminator="\n").writerows([columns, *sorted(rows, key=lambda row: (row[0], row[2]))])
        write_file(self.folder / "frames.csv", text.getvalue())


def main(arguments, tools, runs_of):
    """runs_of(options, files, sweeps): make_runs of main.py."""
    sequence = Sequence(arguments, tools)
    if sequence.folder.exists() and not sequence.folder.is_dir():
        raise Problem(f"{sequence.folder}: is no folder")
    check_files([mesh for mesh in sequence.meshes if os.path.exists(mesh)], [
        path for number in range(1, len(sequence.moments) + 1) for variant in (NEW, REFITTED)
        for path in sequence.outputs(number, variant)
    ])
    sequence.folder.mkdir(parents=True, exist_ok=True)
    files = sequence.write_sweeps(sequence.write_view(tools))
    options = parse(["-o", str(sequence.folder), "--report", *(["--quiet"] if "quiet" in sequence.values else [])])
    status, results, _ = runs_of(options, files, [read_sweep(path) for path in files])
    sequence.write_frames(results)
    return status
