"""Sweep files: which keys take which values, on which scenes, by which programs. The format is in ../README.md."""

import dataclasses
import difflib
import itertools
import math
import pathlib
import re

from .scenes import CATALOGUE, SETS
from .util import Problem, TEXT_LIMIT, canonical, read_json
from .workloads import PAPER, find_workload

CHIPS = "1x32 1x48 2x32 1x64 2x48 4x32 2x64 6x32 4x48 8x32 4x64 6x48 8x48 6x64 8x64".split()  # in the order of Table 2
# Of each program what its machine has beside what the sweep sets. The era program compares floats as floats; that the adders
# did that too cannot be, with the paper's figures (docs/evaluation.md, "The era program").
PROGRAMS = {"ours": (), "era": (("fpu.compare_units", True),)}
MODES = ("exact", "quick")
# Of pictures with fewer pixels than this so many slots must be simulated that little is saved (docs/sampling.md): --quick makes them smaller instead,
# by so much that all experiments take less than ten minutes on two cores.
QUICK_PIXELS, QUICK_SIDE = 640 * 360, 0.4


@dataclasses.dataclass(frozen=True)
class Point:
    """One run that a sweep asks for, before anything is known of the bytes that it works on."""

    scene: str
    program: str
    chip: str
    settings: tuple  # of (key, value)
    size: str
    mode: str
    series: int  # cycles of an interval of the time series; 0: none
    lockstep: bool  # what the pixels would take on a SIMD machine
    ray_kinds: bool = False  # what the rays of each kind took, and with lockstep would take on one
    workload: str = PAPER

    def machine(self):
        """All changes of the chip's configuration; of the same key the sweep's."""
        return tuple({**dict(PROGRAMS[self.program]), **dict(self.settings)}.items())


@dataclasses.dataclass
class Sweep:
    """What a file asks for."""

    name: str
    title: str
    claim: str
    x: str
    y: str
    y_per: str
    file: str
    scenes: dict  # name -> what CATALOGUE has for it
    points: list
    workloads: dict  # name -> workloads.read_workload
    in_all: bool  # one of those that --all runs
    quick: bool  # made for --quick


def quoted(names):
    return ", ".join(f'"{name}"' for name in names)


class Reader:
    """One sweep file; what is wrong with it is reported with the file's name and the key."""

    def __init__(self, path, value):
        self.path, self.value = path, value

    def fail(self, key, message):
        raise Problem(f"{self.path}: {key}: {message}" if key else f"{self.path}: {message}")

    def text(self, key, default):
        value = self.value.get(key, default)
        if not isinstance(value, str):
            self.fail(key, f"expected a text, is {canonical(value)}")
        return value

    def strings(self, key, default, allowed=None):
        value = self.value.get(key, default)
        if isinstance(value, str):
            value = [value]
        if not isinstance(value, list) or not value or not all(isinstance(item, str) for item in value):
            self.fail(key, f"expected a list of texts, is {canonical(value)}")
        for item in value:
            if allowed and item not in allowed:
                self.fail(key, f'"{item}" is unknown; allowed are {quoted(allowed)}')
        if len(set(value)) != len(value):
            self.fail(key, "the same value is there twice")
        return value

    def settings(self):
        """Every combination of the values: a list of tuples of (key, value)."""
        groups = self.value.get("set", {})
        groups = groups if isinstance(groups, list) else [groups]
        combinations = []
        for group in groups or [{}]:
            if not isinstance(group, dict):
                self.fail("set", f"expected an object of keys and values, is {canonical(group)}")
            axes = []
            for key, values in group.items():
                values = values if isinstance(values, list) else [values]
                if not values or not all(isinstance(value, (bool, int, float)) or isinstance(value, str) and value.isalpha() for value in values):
                    self.fail(f"set.{key}", f"expected a number, a word or a list of them, is {canonical(group[key])}")
                axes.append([(key, value) for value in values])
            if len(combinations) + math.prod(map(len, axes)) > MOST_RUNS:
                self.fail("set", f"more than {MOST_RUNS} combinations")
            combinations += itertools.product(*axes)
        return [tuple(combination) for combination in combinations]

    def flag(self, key, default=False):
        value = self.value.get(key, default)
        if type(value) is not bool:
            self.fail(key, f"expected true or false, is {canonical(value)}")
        return value

    def workloads(self):
        if "workloads" not in self.value:
            return {PAPER: {"name": PAPER, "title": "", "render": [], "scene": []}}
        chosen = {}
        for name in self.strings("workloads", None):
            try:
                workload = find_workload(name, pathlib.Path(self.path).parent)
            except Problem as problem:
                self.fail("workloads", str(problem))
            if workload["name"] in chosen:
                self.fail("workloads", f'"{workload["name"]}" is there twice')
            chosen[workload["name"]] = workload
        return chosen

    def scenes(self):
        value = self.value["scenes"]
        chosen = {}
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, dict):
                for key in item:
                    if key not in ("name", "meshes", "view"):
                        self.fail("scenes", f'unknown key "{key}"; allowed are "name", "meshes", "view"')
                name, meshes, view = item.get("name"), item.get("meshes"), item.get("view")
                if not isinstance(name, str) or not re.fullmatch(r"[\w.+-]+", name):
                    self.fail("scenes", "name: expected letters, digits and . + - _")
                if not isinstance(meshes, list) or not meshes or not all(isinstance(mesh, str) for mesh in meshes):
                    self.fail("scenes", f"{name}: meshes: expected a list of files")
                if view is not None and not isinstance(view, str):
                    self.fail("scenes", f"{name}: view: expected a file or the name of one that comes with trax")
                new = {name: {"meshes": meshes, "view": view}}
            elif isinstance(item, str) and item in SETS:
                new = {name: CATALOGUE[name] for name in SETS[item]}
            elif isinstance(item, str) and item in CATALOGUE:
                new = {item: CATALOGUE[item]}
            else:
                self.fail("scenes", f"{canonical(item)} is unknown; allowed are {quoted([*SETS, *CATALOGUE])}, and objects with name, meshes, view")
            for name in new:
                if name in chosen:
                    self.fail("scenes", f'"{name}" is there twice')
            chosen.update(new)
        if not chosen:
            self.fail("scenes", "is empty")
        return chosen


MOST_RUNS = 100000  # of one sweep: all combinations of a few long lists take all memory
KEYS = ("name", "title", "claim", "x", "y", "y_per", "scenes", "programs", "chips", "set", "size", "mode", "series", "lockstep",
        "workloads", "ray_kinds", "all")


def parse_size(text):
    """(width, height), or None."""
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    return size if 0 < max(size) <= 16384 else None


def read_sweep(path, *, size=None, mode=None, programs=None):
    """The sweep in a file. size, mode and programs: what the command line says instead of the file. With the mode "quick" a small picture, whose size
    the command line does not say, has a sixth of its pixels, and is simulated exactly."""
    value = read_json(path, TEXT_LIMIT)
    reader = Reader(path, value)
    if not isinstance(value, dict):
        reader.fail(None, "expected an object")
    for key in value:
        if key not in KEYS:
            near = difflib.get_close_matches(key, KEYS, 1)
            reader.fail(None, f'unknown key "{key}"' + (f', did you mean "{near[0]}"?' if near else "") + f" Allowed are {quoted(KEYS)}")
    name = reader.text("name", "")
    if not re.fullmatch(r"[\w.+-]+", name):
        reader.fail("name", "expected letters, digits and . + - _")
    missing = [key for key in ("scenes", "chips") if key not in value]
    if missing:
        reader.fail(None, f"it is no sweep without {' and '.join(map(quoted, ([key] for key in missing)))}: what is rendered, and on which chips")
    chosen_size = reader.text("size", size or "1280x720")
    if not parse_size(chosen_size):
        reader.fail("size", f'expected "WIDTHxHEIGHT", each 1 to 16384, is "{chosen_size}"')
    chosen_mode = mode or reader.strings("mode", "exact", MODES)[0]
    series = value.get("series", 0)
    if type(series) is not int or not 0 <= series <= 10**9:
        reader.fail("series", f"expected the cycles of an interval, 1 to 1000000000, or 0 for no series, is {canonical(series)}")
    lockstep, ray_kinds, workloads = reader.flag("lockstep"), reader.flag("ray_kinds"), reader.workloads()
    if series or lockstep or ray_kinds or list(workloads) != [PAPER]:  # every cycle is needed
        if "mode" in value and chosen_mode != "exact" and not mode:
            reader.fail("mode", 'series, lockstep, ray_kinds and workloads need "exact"')
        chosen_mode = "exact"
    if mode == "quick" and not size and not lockstep and not ray_kinds and math.prod(parse_size(chosen_size)) < QUICK_PIXELS:
        chosen_mode = "exact"
        chosen_size = "x".join(str(max(1, round(QUICK_SIDE * side))) for side in parse_size(chosen_size))
    scenes = reader.scenes()
    chips = reader.strings("chips", None)
    chips = CHIPS if chips == ["paper"] else chips
    ours_only = ray_kinds or list(workloads) != [PAPER]
    chosen_programs = reader.strings("programs", ["ours"] if ours_only else list(PROGRAMS), tuple(PROGRAMS))
    if ours_only and chosen_programs != ["ours"]:
        reader.fail("programs", 'workloads and ray_kinds need "ours": the era program has the paper\'s rays only, and does not tell where they begin')
    if programs:
        chosen_programs = [program for program in chosen_programs if program in programs]
    settings = reader.settings()
    runs = len(scenes) * len(chosen_programs) * len(chips) * len(settings) * len(workloads)
    if runs > MOST_RUNS:
        reader.fail(None, f"it asks for {runs} runs; at most {MOST_RUNS} are allowed")
    points = [
        Point(scene, program, chip, settings, size or chosen_size, chosen_mode, series, lockstep, ray_kinds, workload)
        for workload, scene, program, chip, settings in itertools.product(workloads, scenes, chosen_programs, chips, settings)
    ]
    return Sweep(name, reader.text("title", name), reader.text("claim", ""), reader.text("x", "threads"), reader.text("y", "mrps"),
                 reader.text("y_per", ""), str(path), scenes, points, workloads, reader.flag("all", True), mode == "quick")
