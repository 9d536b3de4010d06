"""Sweep files: which keys take which values, on which scenes, by which programs. The format is in ../README.md."""

import dataclasses
import itertools
import math
import pathlib
import re

from .fields import Fields, quoted
from .programs import Program, find_programs
from .scenes import find_scenes, inline_scene
from .table_spec import descriptions
from .util import Problem, TEXT_LIMIT, canonical, read_json
from .workloads import PAPER, find_workload, no_workload

CHIPS = "1x32 1x48 2x32 1x64 2x48 4x32 2x64 6x32 4x48 8x32 4x64 6x48 8x48 6x64 8x64".split()  # in the order of Table 2
PAPERS_PROGRAMS = "paper"  # the set that a sweep has which names no programs
MODES = ("exact", "quick")
WORD = r"[A-Za-z][\w.:-]*"  # of a key whose values are words
# --quick: so that all experiments take less than nine minutes on two cores. Of pictures with fewer pixels than
# QUICK_PIXELS so many slots must be simulated that little is saved (docs/sampling.md): they become narrow instead, and
# all of them is simulated. Larger ones are sampled.
QUICK_PIXELS, QUICK_WIDTH, QUICK_SIDE = 640 * 360, 80, 2 / 3
MOST_RUNS = 100000  # of one sweep: all combinations of a few long lists take all memory
KEYS = ("name", "title", "claim", "x", "y", "y_per", "scenes", "programs", "chips", "set", "size", "mode", "series",
        "workloads", "ray_kinds", "ray_cycles", "reference", "error", "hits", "table", "all")
# Keys of `set` may be options of these programs: "trax-scene --leaf". Sweeps, programs and workloads may neither have
# options that trax-eval sets itself, nor options that write files (the programs' tables tell which: Tools.given).
TAKEN = {
    "trax-scene": ("check", "stats", "quiet"),
    "trax-render": ("size", "frames", "show", "config", "set", "engine", "threads", "compare", "source", "program",
                    "sampled", "rays", "quiet", "pixel", "explore-against", "source-folder", "cost")
}
VARIANT_KEYS = ("name", "program")  # of an object in the list `set`, beside keys that are set


def option_of(key):
    """(program, name) of a key of `set` that is an option, else None."""
    match = re.fullmatch(r"([\w-]+) --([\w-]+)", key)
    return match.groups() if match else None


def option_words(name, value):
    """An option as it is given; false leaves it out."""
    return [] if value is False else [f"--{name}"] if value is True else [f"--{name}={value}"]


def without_option(words, name):
    """Returns the words without the option and its values."""
    kept, dropped = [], False
    for word in words:
        if word.startswith("--"):
            dropped = word.split("=")[0] == f"--{name}"
        if not dropped:
            kept.append(word)
    return kept


@dataclasses.dataclass(frozen=True)
class Point:
    """One run that a sweep asks for, before anything is known of the bytes that it works on."""

    scene: str
    program: Program
    chip: str
    settings: tuple  # of (key, value)
    size: str
    mode: str
    series: int  # cycles of an interval of the time series; 0: none
    ray_kinds: bool = False  # what the rays of each kind took
    workload: str = PAPER
    config: str = ""  # the chip for trax-sim, if its name is not
    variant: str = ""
    error: bool = False  # how far the picture is off
    hits: bool = False  # which triangles it shows
    ray_cycles: bool = False  # how long the rays of each kind took, without what else they cost

    @property
    def chip_file(self):
        return self.config or self.chip

    def machine(self):
        """Returns all changes of the chip's configuration; those of the sweep go before the program's."""
        return tuple(
            {**dict(self.program.settings),
             **{key: value for key, value in self.settings if not option_of(key)}}.items())

    def options(self, tool, workload):
        """Returns the options for trax-scene or trax-render: the program's and the workload's, replaced by the
        sweep's."""
        words = [
            *(self.program.scene if tool == "trax-scene" else self.program.render),
            *workload["scene" if tool == "trax-scene" else "render"]
        ]
        marked = (self.ray_kinds or self.ray_cycles) and self.program.specialised
        words += ["--mark-rays"] if tool == "trax-render" and marked else []
        for key, value in self.settings:
            if (option := option_of(key)) and option[0] == tool:
                words = [*without_option(words, option[1]), *option_words(option[1], value)]
        return words


@dataclasses.dataclass
class Sweep:
    """The contents of a sweep file."""

    name: str
    title: str
    claim: str
    x: str
    y: str
    y_per: str
    file: str
    scenes: dict  # name -> scenes.scene_of
    programs: list  # of Program
    points: list
    workloads: dict  # name -> workloads.read_workload
    variants: list  # their names
    reference: str  # the variant or program whose pictures the others' are compared with
    table: dict | list | None  # what its tables show, for the report
    in_all: bool  # one of those that --all runs
    quick: bool  # made for --quick


class Reader(Fields):
    """One sweep file."""
    @property
    def folder(self):
        return pathlib.Path(self.path).parent

    def found(self, key, find, name):
        """Looks up a name in a file beside the sweep or in the installation, by `find`."""
        try:
            return find(name, self.folder)
        except Problem as problem:
            self.fail(key, str(problem))

    def axis(self, place, key, values):
        values = values if isinstance(values, list) else [values]
        option = option_of(key)
        if option:
            if option[0] not in TAKEN:
                self.fail(place, f'"{option[0]}" is no program whose options can be set; {quoted(TAKEN)} are')
            if not values or not all(
                    isinstance(value, (bool, int, float)) or isinstance(value, str) and value for value in values):
                self.fail(
                    place,
                    f"expected a text, a number, true (given), false (left out) or a list of them, is "
                    f"{canonical(values)}"
                )
        elif not values or not all(
                isinstance(value, (bool, int, float)) or isinstance(value, str) and re.fullmatch(WORD, value)
                for value in values):
            self.fail(place, f"expected a number, a word or a list of them, is {canonical(values)}")
        return [(key, value) for value in values]

    def variants(self):
        """Returns every combination of the values: a list of (variant, its program or None, tuple of (key, value))."""
        groups = self.value.get("set", {})
        groups = groups if isinstance(groups, list) else [groups]
        combinations, names = [], []
        for group in groups or [{}]:
            if not isinstance(group, dict):
                self.fail("set", f"expected an object of keys and values, is {canonical(group)}")
            name, program = group.get("name", ""), group.get("program")
            if "name" in group and (not isinstance(name, str) or not re.fullmatch(r"[^\n|]{1,100}", name)):
                self.fail("set", f"name: expected a text of at most 100 characters, without |, is {canonical(name)}")
            if name and name in names:
                self.fail("set", f'the variant "{name}" is there twice')
            names.append(name)
            if program is not None:
                if not isinstance(program, str):
                    self.fail("set.program", f"expected the name of a program or NAME.json, is {canonical(program)}")
                program, *others = self.found("set.program", find_programs, program)
                if others:
                    self.fail("set.program", "is a set of programs; a variant has one")
            axes = [self.axis(f"set.{key}", key, values) for key, values in group.items() if key not in VARIANT_KEYS]
            if len(combinations) + math.prod(map(len, axes)) > MOST_RUNS:
                self.fail("set", f"more than {MOST_RUNS} combinations")
            combinations += [(name, program, settings) for settings in itertools.product(*axes)]
        return combinations

    def workloads(self):
        if "workloads" not in self.value:
            return {PAPER: no_workload()}
        chosen = {}
        for name in self.strings("workloads", None):
            workload = self.found("workloads", find_workload, name)
            if workload["name"] in chosen:
                self.fail("workloads", f'"{workload["name"]}" is there twice')
            chosen[workload["name"]] = workload
        return chosen

    def programs(self, rays):
        """rays: those alone that take workloads and tell where rays begin."""
        given = self.strings("programs", PAPERS_PROGRAMS)
        chosen = {}
        for name in given:
            for program in self.found("programs", find_programs, name):
                if program.name in chosen:
                    self.fail("programs", f'"{program.name}" is there twice')
                chosen[program.name] = program
        if "programs" not in self.value and rays:
            return [program for program in chosen.values() if program.rays]
        return list(chosen.values())

    def scenes(self):
        value = self.value["scenes"]
        chosen = {}
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, dict):
                new = [inline_scene(self.path, item)]
            elif isinstance(item, str):
                new = self.found("scenes", find_scenes, item)
            else:
                self.fail("scenes",
                          f"expected names of scenes and objects with name, meshes, view, is {canonical(item)}")
            for scene in new:
                if scene["name"] in chosen:
                    self.fail("scenes", f'"{scene["name"]}" is there twice')
                chosen[scene["name"]] = scene
        if not chosen:
            self.fail("scenes", "is empty")
        return chosen

    def chips(self):
        """Name to what trax-sim --config is given; files beside the sweep come first."""
        names = self.strings("chips", None)
        return {
            name: str((self.folder / name).resolve()) if self.folder.joinpath(name).is_file() else ""
            for name in (CHIPS if names == ["paper"] else names)
        }


def parse_size(text):
    """(width, height), or None."""
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    return size if 0 < max(size) <= 16384 else None


def quick_size(text, mode):
    """The size and the mode of a picture that --quick makes instead."""
    width, height = parse_size(text)
    if width * height < QUICK_PIXELS:
        scale, mode = min(1, QUICK_WIDTH / width), "exact"
    else:
        scale = QUICK_SIDE if width * height > QUICK_PIXELS else 1
    return f"{round(width * scale)}x{max(1, round(height * scale))}", mode


def used_programs(programs, variants):
    return list(dict.fromkeys([*programs, *(program for _, program, _ in variants if program)]))


def check_programs(reader, used, rays, measured):
    """Refuses programs that cannot do what the sweep asks for."""
    if rays and (unfit := [program for program in used if not program.rays]):
        reader.fail(
            "programs", f'workloads, ray_kinds and ray_cycles need programs with "rays": true, which {unfit[0].file} '
            "has not: they take workloads, and tell where rays begin")
    if measured and (unfit := [program for program in used if not program.specialised or program.convert]):
        reader.fail(
            "programs",
            'error, hits and workloads with "rays" need programs that are "specialised", without "convert", which '
            f"{unfit[0].file} is not")


def mode_of(reader, mode, needs_exact):
    """The mode: the command line's or the sweep's, but "exact" if every cycle is needed or the run is not trax-render's
    own."""
    chosen = mode or reader.strings("mode", "exact", MODES)[0]
    if needs_exact and chosen != "exact" and "mode" in reader.value and not mode:
        reader.fail(
            "mode", 'series, ray_kinds, error, hits, workloads with "rays" and programs that are compiled or '
            'converted need "exact"')
    return "exact" if needs_exact else chosen


def read_sweep(path, *, size=None, mode=None, programs=None, chips=None, only_scenes=None, only_variants=None):
    """The sweep in a file. size, mode, programs and chips replace those of the file; programs are names, and Programs
    that take the place of the sweep's. only_scenes, only_variants: the others are left out, but for the reference. With
    the mode "quick" pictures are smaller, unless size is given."""
    reader = Reader(path, read_json(path, TEXT_LIMIT), KEYS)
    value, name = reader.value, reader.name()
    if missing := [key for key in ("scenes", "chips") if key not in value]:
        reader.fail(
            None, f"it is no sweep without {' and '.join(map(quoted, ([key] for key in missing)))}: what is rendered, "
            "and on which chips")
    chosen_size = reader.text("size", size or "1280x720")
    if not parse_size(chosen_size):
        reader.fail("size", f'expected "WIDTHxHEIGHT", each 1 to 16384, is "{chosen_size}"')
    series = value.get("series", 0)
    if type(series) is not int or not 0 <= series <= 10**9:
        reader.fail("series",
                    f"expected the cycles of an interval, 1 to 1000000000, or 0 for no series, is {canonical(series)}")
    ray_kinds, ray_cycles, error, hits = map(reader.flag, ("ray_kinds", "ray_cycles", "error", "hits"))
    workloads = reader.workloads()
    rays = ray_kinds or ray_cycles or list(workloads) != [PAPER]
    chosen_programs, variants = reader.programs(rays), reader.variants()
    named = list(dict.fromkeys(variant[0] for variant in variants if variant[0]))
    reference = reader.text("reference", "")
    if only_variants is not None:
        variants = [variant for variant in variants if variant[0] in only_variants or variant[0] == reference != ""]
    if programs is not None:
        own = [program for program in programs if isinstance(program, Program)]
        chosen_programs = own + [program for program in chosen_programs if program.name in programs]
        variants = [(label, program, settings) for label, program, settings in variants
                    if not program or program.name in programs]
    used = used_programs(chosen_programs, variants)
    alone = [name for name, workload in workloads.items() if workload["rays"]]
    if alone and (ray_kinds or ray_cycles or error or hits):
        reader.fail("workloads", f'"{alone[0]}" traces rays of one kind again, which makes no picture: '
                    "not with ray_kinds, ray_cycles, error or hits")
    if len(alone) < len(workloads) and any(key == "trax-render --ray-order" for _, _, settings in variants
                                           for key, _ in settings):
        reader.fail("set", '--ray-order needs workloads with "rays"')
    check_programs(reader, used, rays, error or hits or alone)
    needs_exact = bool(series or ray_kinds or error or hits or alone)
    needs_exact = needs_exact or not all(program.can_be_sampled for program in used)
    chosen_mode = mode_of(reader, mode, needs_exact)
    if mode == "quick" and not size and not ray_kinds and not ray_cycles:
        chosen_size, chosen_mode = quick_size(chosen_size, chosen_mode)
    scenes = {name: scene for name, scene in reader.scenes().items() if only_scenes is None or name in only_scenes}
    chips = reader.chips() if chips is None else {chip: "" for chip in chips}
    groups = {program: [variant for variant in variants if not variant[1]] for program in chosen_programs}
    for variant in variants:
        if variant[1]:  # it has a program of its own
            groups.setdefault(variant[1], []).append(variant)
    runs = len(scenes) * len(chips) * len(workloads) * sum(map(len, groups.values()))
    if runs > MOST_RUNS:
        reader.fail(None, f"it asks for {runs} runs; at most {MOST_RUNS} are allowed")
    points = [
        Point(scene, program, chip, settings, size or chosen_size, chosen_mode, series, ray_kinds, workload,
              chips[chip], variant, error, hits, ray_cycles)
        for workload, scene, (program, some) in itertools.product(workloads, scenes, groups.items())
        for chip, (variant, _, settings) in itertools.product(chips, some)
    ]
    known = list(dict.fromkeys([*named, *(program.name for program in used)]))
    if reference and programs is None and reference not in known:
        reader.fail("reference", f'"{reference}" is neither a variant nor a program of this sweep; {quoted(known)} are')
    table = value.get("table")
    try:
        descriptions({"name": name, "table": table})
    except Problem as problem:
        reader.fail(None, str(problem))
    return Sweep(name, reader.text("title", name), reader.text("claim", ""), reader.text("x", "threads"),
                 reader.text("y", "mrps"), reader.text("y_per", ""), str(path), scenes, used, points, workloads, named,
                 reference, table, reader.flag("all", True), mode == "quick")
