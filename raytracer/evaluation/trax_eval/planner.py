"""Turns sweeps into keys of jobs: names and options are checked, programs built, scenes imported and inputs
prepared."""

import contextlib
import sys
import tempfile

from .fields import installed
from .inputs import Request, prepare_inputs
from .jobs import key_of, make_job, write_job
from .names import check_report
from .programs import Program, build
from .scenes import import_scenes, order_options, plan_scene
from .sweep import CHIPS, TAKEN, option_of, option_words, without_option
from .util import Problem, hash_value, nearest, read_sealed, shown


def check_names(options, sweeps):
    """Names of --program are those of programs that come with trax, or that a sweep has; other names are those of a
    sweep."""
    known = dict.fromkeys([*installed("programs"), *(program.name for sweep in sweeps for program in sweep.programs)])
    for program in options.programs or ():
        if not isinstance(program, Program) and program not in known:
            raise Problem(f'--program {program}: allowed are {", ".join(known)}, and files NAME.json'
                          f'{nearest(program, known)}')
    for option, given, known in (("scene", options.scene, [scene for sweep in sweeps for scene in sweep.scenes]),
                                 ("variant", options.variant, [name for sweep in sweeps for name in sweep.variants])):
        for name in given or ():
            if name not in known:
                raise Problem(f'--{option} {name}: the sweep has {"; ".join(dict.fromkeys(known)) or "none"}'
                              f'{nearest(name, known)}')


def check_machines(sweeps, tools):
    """A wrong key or value of the configuration, or an option that its program refuses, is the sweep's mistake, and
    ends the command before anything is written."""
    def check(place, tool, words):
        for option, use in tools.given(place, tool, tuple(words)) if words else ():
            if option in TAKEN[tool]:
                raise Problem(f"{place}: trax-eval sets --{option} itself")
            if use == "writes":
                raise Problem(f"{place}: --{option} writes files, and trax-eval itself chooses them")

    def machine(place, chip, settings):
        try:
            tools.configuration(chip, settings)
        except Problem as problem:
            raise Problem(f"{place}: {problem}") from None

    for sweep in sweeps:
        check_report(sweep, tools)
        for program in sweep.programs:
            machine(f"{program.file}: set", CHIPS[0], program.settings)
        for point in sweep.points:
            for key, value in point.settings:
                if option := option_of(key):
                    check(f"{sweep.file}: set.{key}", option[0], option_words(option[1], value))
            machine(sweep.file, point.chip_file, point.machine())
        for program in sweep.programs:
            check(f"{program.file}: scene", "trax-scene", program.scene)
            check(f"{program.file}: render", "trax-render", program.render)
        for workload in sweep.workloads.values():
            check(f"{workload['file']}: scene", "trax-scene", workload["scene"])
            check(f"{workload['file']}: render", "trax-render", workload["render"])


class Planner:
    """Turns points into keys of jobs. Programs are built, scenes imported and inputs prepared once each."""
    def __init__(self, out, tools, folder, quiet, only_look, scratch):
        self.out, self.tools, self.folder, self.scratch = out, tools, folder, scratch
        self.quiet, self.only_look = quiet, only_look
        self.made, self.hashes = {}, {}
        self.not_imported = {}  # path of a scene file: why it could not be made
        self.prepared = {}  # Request: description of the inputs, or Problem

    def once(self, what, function):
        if what not in self.made:
            try:
                self.made[what] = function(), None
            except Problem as problem:
                reason = str(problem)
                if (None, reason) not in self.made.values():  # several inputs may fail by one
                    print(f"trax-eval: {reason}", file=sys.stderr)
                self.made[what] = None, reason
        value, reason = self.made[what]
        if reason:
            raise Problem(reason)
        return value

    def note(self, text):
        if not self.quiet and sys.stderr.isatty():
            print(f"\r\033[Ktrax-eval: {text}\r", end="", file=sys.stderr, flush=True)

    def program(self, program):
        """Options of trax-render."""
        def make():
            self.note(f"{program.name}: compiling")
            return build(self.tools, program, tempfile.mkdtemp(dir=self.scratch))

        return self.once(("program", program), make)

    def scene(self, sweep, point):
        """Returns the scene file that a point needs, and its import, as plan_scene does."""
        scene, workload = sweep.scenes[point.scene], sweep.workloads[point.workload]
        options = tuple(point.options("trax-scene", workload))
        machine = point.chip_file, point.machine()
        order = []
        if point.program.specialised:  # made for a machine, as trax-render has it
            order = order_options(self.tools.value(*machine, "dcache.bytes"))
        key = "scene", point.scene, scene["folder"], tuple(scene["meshes"]), options, tuple(order)
        return self.once(
            key, lambda: plan_scene(self.out, self.tools, self.folder, scene, [*order, *options], self.hashes,
                                    self.only_look))

    def import_all(self, sweeps, jobs):
        """The scenes of all sweeps, several at the same time."""
        wanted = {}
        for sweep in sweeps:
            for point in sweep.points:
                with contextlib.suppress(Problem):  # told when its runs are planned
                    imported = self.scene(sweep, point)
                    if imported.command:
                        wanted[imported.path] = imported
        self.note("scenes")
        self.not_imported = import_scenes(wanted, jobs, self.scratch)

    def scene_file(self, sweep, point):
        """None if it is only looked at and has not been imported."""
        imported = self.scene(sweep, point)
        if imported is None or self.only_look and imported.command:
            return None

        def check():
            if imported.path in self.not_imported:
                raise Problem(f"{point.scene}: {self.not_imported[imported.path]}")

        self.once(("imported", imported.path), check)
        return imported.path

    def statistics(self, sweep, point):
        """Returns what trax-scene --stats-json said of a point's scene, by name; nothing of a scene that an earlier
        version imported."""
        with contextlib.suppress(Problem):
            imported = self.scene(sweep, point)
            return read_sealed(imported.record).get("statistics", {}) if imported else {}
        return {}

    def request(self, sweep, point):
        """Returns the request for a point's inputs; None if its scene is only looked at and has not been imported."""
        scene, program, workload = sweep.scenes[point.scene], point.program, sweep.workloads[point.workload]
        machine = point.chip_file, point.machine()
        rendered = tuple(point.options("trax-render", workload))
        # An exact picture is simulated completely.
        sampling = tuple(word for word in rendered if word.startswith("--sample-") and point.mode == "quick")
        rendered = tuple(word for word in rendered if not word.startswith("--sample-"))
        path = self.scene_file(sweep, point)
        if path is None:
            return None
        chip = None
        if program.specialised:
            chip = tuple(self.tools.value(*machine, key) for key in ("chip.tms", "icache.bytes"))
        again = ()
        if workload["rays"]:
            rest = tuple(without_option(rendered, "ray-order"))
            again = (*(word for word in rendered if word not in rest), "--set",
                     f"dcache.bytes={self.tools.value(*machine, 'dcache.bytes')}")
            rendered = rest
        return Request(path, scene["view"], point.size, program, chip, rendered, sampling,
                       whole=point.mode == "quick" or point.error or point.hits, rays=workload["rays"], again=again)

    def prepare_all(self, sweeps, jobs):
        """The inputs of all sweeps, several at the same time."""
        wanted = {}
        for sweep in sweeps:
            for point in sweep.points:
                try:
                    request = self.request(sweep, point)
                    if request and request not in wanted:
                        wanted[request] = self.program(point.program)
                except Problem:
                    continue  # told when its runs are planned
        with contextlib.closing(prepare_inputs(self.out, self.tools, wanted, jobs, self.only_look)) as results:
            for request, result in results:
                self.prepared[request] = result
                self.note(f"inputs: {len(self.prepared)} of {len(wanted)}")

    def inputs(self, sweep, point):
        request = self.request(sweep, point)
        if request is None:
            return None
        self.program(point.program)

        def check():
            if isinstance(self.prepared[request], Problem):
                raise self.prepared[request]
            return self.prepared[request]

        return self.once(request, check)

    def key(self, sweep, point):
        """(key, None), or (None, why there is none)."""
        try:
            inputs = self.inputs(sweep, point)
            if inputs is None:  # none of its runs has been made
                machine = self.tools.configuration(point.chip_file, point.machine())
                return "-" + hash_value([
                    point.scene, point.program.file, machine, point.size, point.mode, point.series,
                    point.ray_kinds, point.workload,
                    [pair for pair in point.settings if option_of(pair[0])], point.error, point.hits, point.ray_cycles
                ]), None
            job = make_job(self.tools, inputs, point)
        except Problem as problem:
            return None, str(problem)
        return key_of(job) if self.only_look else write_job(self.out, job), None


def label(point):
    changes = "".join(f" {key}={shown(value)}" for key, value in point.settings)
    machine = point.chip + (f" ({point.variant})" if point.variant else changes)
    return " ".join(part for part in (point.scene, machine, point.program.name, point.workload, point.size) if part)
