"""The measurements of trax-eval (results.json), as the report needs them. A figure that a file does not have, or that
is no finite number, is None, and arithmetic on None gives None."""

import copy
import math
import pathlib

from trax_eval.util import Problem, read_json, shown

HERE = pathlib.Path(__file__).resolve().parent
FORMAT = "trax-eval-results"
KINDS = ("primary", "shadow", "occlusion", "diffuse", "glossy", "mirror", "glass", "other")  # of rays, in this order
COLUMNS = ("conference", "crytek", "dragon", "fairy")  # of the paper's Table 2


def number(value):
    """value as a finite number, whole ones as they are, or None."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        return value if math.isfinite(float(value)) else None
    except OverflowError:
        return None


def ratio(a, b):
    return None if a is None or b is None or b == 0 else number(a / b)


def deviation(ours, published):
    """Relative: 0.1 is ten per cent above the published figure."""
    quotient = ratio(ours, published)
    return None if quotient is None else quotient - 1


def mean(values):
    """The mean of all values, or None if one is missing: an average over fewer scenes would be another figure."""
    values = list(values)
    if not values or None in values:
        return None
    # A count stays a whole number. sum() rounds otherwise from Python 3.12 on.
    return values[0] if len(values) == 1 else math.fsum(values) / len(values)


class Run:
    """One job. get("memory.bytes") looks in its statistics, get("values.x") in what an experiment computed. asked: by
    the index of a run the names of what it was asked for, which docs.py keeps."""
    def __init__(self, record, index, asked):
        self.index, self.record, self.asked = index, record, asked

        def text(key, default=""):
            value = record.get(key, default)
            if value is not None and not isinstance(value, str):
                raise Problem(f"runs[{index}].{key} is {type(value).__name__}, not a string")
            return value or default

        def table(key):
            value = record.get(key)
            if value is not None and not isinstance(value, dict):
                raise Problem(f"runs[{index}].{key} is {type(value).__name__}, not an object")
            return value or {}

        self.key, self.scene, self.view = text("key"), text("scene"), text("view")
        self.program, self.config, self.mode = text("program"), text("config"), text("mode", "exact")
        self.workload = text("workload")  # empty: the paper's
        self.variant = text("variant")
        self.status, self.error, self.command = text("status", "missing"), text("error"), text("command")
        self.json, self.csv, self.picture = text("json"), text("csv"), text("picture")
        self.set, self.machine = table("set"), table("machine")
        self.stats, self.values = table("stats"), table("values")
        self.host_seconds = number(record.get("host_seconds"))
        size = record.get("size")
        good = isinstance(size, list) and len(size) == 2 and all(type(n) is int and n > 0 for n in size)
        self.size = tuple(size) if good else None
        experiments = record.get("experiments") or []
        if not isinstance(experiments, list):
            raise Problem(f"runs[{index}].experiments is not a list")
        self.experiments = [name for name in experiments if isinstance(name, str)]
        self.points = record.get("points") or [{
            "experiment": name, "config": self.config, "set": self.set, "variant": self.variant
        } for name in self.experiments]
        if not isinstance(self.points, list):
            raise Problem(f"runs[{index}].points is not a list")
        for place, point in enumerate(self.points):
            if not isinstance(point, dict) or not isinstance(point.get("config"), str) or not isinstance(
                    point.get("set"), dict):
                raise Problem(f"runs[{index}].points[{place}] has no config and set")

    @property
    def done(self):
        return self.status == "done"

    def get(self, name):
        if not self.done:
            return None
        self.asked.setdefault(self.index, set()).add(name)
        if name.startswith("values."):
            return number(self.values.get(name[len("values."):]))
        if name == "host.processor_seconds":
            return self.processor_seconds()
        value = self.stats
        for part in name.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        return number(value)

    def processor_seconds(self):
        """The host's processor time of the run, whatever else the host did."""
        self.asked.setdefault(self.index, set()).add("host.processor_seconds")
        host = self.record.get("host")
        return number(host.get("processor_seconds")) if isinstance(host, dict) else None

    def setting(self, name):
        """The configuration's value of a key, true and false as 1 and 0, or the number of threads."""
        if name == "threads":
            return self.get("threads")
        value = self.set.get(name, self.configured(name))
        return float(value) if isinstance(value, bool) else number(value)

    def kinds(self):
        """The kinds of rays that the run has."""
        found = [name.split(".")[1] for name in self.values
                 if name.startswith("rays.") and name.endswith(".count")] if self.done else []
        found.sort(key=lambda kind: (KINDS.index(kind) if kind in KINDS else len(KINDS), kind))
        return [kind for kind in found if self.get(f"values.rays.{kind}.count")]

    def axis(self, name):
        """The run's value on an axis of a sweep's tables."""
        if name in ("program", "scene", "chip", "variant", "workload", "mode", "size"):
            value = getattr(self, "config" if name == "chip" else name)
            return value and "{}x{}".format(*value) if name == "size" else value
        if name in self.set or name == "threads":
            return self.set.get(name, self.get(name))
        return self.configured(name)

    def configured(self, name):
        """The configuration's value of a key, unchanged."""
        self.asked.setdefault(self.index, set()).add("configuration." + name)
        value = self.stats.get("configuration")
        for part in name.split(".", 1):
            value = value.get(part) if isinstance(value, dict) else None
        return value

    def within(self, experiment):
        """The run by each name that a sweep has for its machine."""
        for point in self.points:
            if point.get("experiment") == experiment:
                named = copy.copy(self)
                named.config, named.set, named.variant = point["config"], point["set"], str(point.get("variant") or "")
                yield named

    def interval(self):
        """MRPS between which an estimate lies, or None. Of a sampled run cycles_low is the fast end."""
        given = self.get("values.mrps_low"), self.get("values.mrps_high")
        if None not in given:
            return given
        rays, clock = self.get("rays"), self.get("configuration.chip.clock_mhz")
        low, high = self.get("sampled.cycles_low"), self.get("sampled.cycles_high")
        if None in (rays, clock, low, high) or low <= 0 or high <= 0:
            return None
        return rays * clock / high, rays * clock / low

    def is_estimate(self):
        """Returns whether the run's interval has two ends. A quick run that simulates everything is exact."""
        interval = self.interval()
        return interval is not None and interval[0] != interval[1]

    def frames_per_second(self):
        """Frames per second at 1280x720: the simulated time a pixel, times the pixels of such a picture."""
        seconds = self.get("seconds")
        if not seconds or not self.size:
            return None
        return self.size[0] * self.size[1] / seconds / (1280 * 720)

    def name(self):
        changed = "".join(f", {key} = {shown(value)}" for key, value in sorted(self.set.items()))
        return ", ".join(part for part in (self.scene, self.config + changed, self.program, self.workload, self.variant,
                                           self.mode) if part)


def check_sweep(sweep, index):
    for key in ("x", "y", "y_per", "reference"):
        if not isinstance(sweep.get(key), (str, type(None))):
            raise Problem(f"sweeps[{index}].{key} is {type(sweep[key]).__name__}, not a string")
    variants = sweep.get("variants") or []
    if not isinstance(variants, list) or not all(isinstance(name, str) for name in variants):
        raise Problem(f"sweeps[{index}].variants is not a list of strings")


class Results:
    def __init__(self, document, runs=None):
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise Problem(f"is not a file of results: \"format\" is not \"{FORMAT}\"")
        if document.get("version") != 2:
            raise Problem(f"\"version\" is {document.get('version')!r}, not 2: another trax-eval wrote it; its command "
                          "writes it anew")
        for key in ("runs", "sweeps", "series", "programs", "scenes", "workloads"):
            if not isinstance(document.get(key), (list, type(None))):
                raise Problem(f"\"{key}\" is not a list")
            for index, entry in enumerate(document.get(key) or []):
                if not isinstance(entry, dict):
                    raise Problem(f"{key}[{index}] is not an object")
                if not isinstance(entry.get("name"), (str, type(None))):
                    raise Problem(f"{key}[{index}].name is {type(entry['name']).__name__}, not a string")
        for index, sweep in enumerate(document.get("sweeps") or []):
            check_sweep(sweep, index)
        self.document, self.asked = document, {}
        self.runs = [Run(record, index, self.asked)
                     for index, record in enumerate(document.get("runs") or [])] if runs is None else runs
        self.sweeps = document.get("sweeps") or []
        self.series = document.get("series") or []
        self.by_key = {run.key: run for run in self.runs}
        # The column of the paper's Table 2 that a scene is compared with; of each column the first such scene, or a
        # name that no run has.
        self.stands_for = {
            entry.get("name"): entry["paper"] for entry in document.get("scenes") or [] if entry.get("paper") in COLUMNS
        }
        self.columns = {
            column: next((scene for scene, paper in self.stands_for.items() if paper == column), column)
            for column in COLUMNS
        }
        self.papers = list(self.columns.values())
        # The plain cells: the chip as the paper has it, or with another bandwidth. A finished run goes before any
        # other, a larger picture before a smaller one, and an exact run before a sampled one.
        self._cells = {}
        for run in self.runs:
            others = {key: value for key, value in run.set.items() if key != "memory.bandwidth_gbps"}
            if others or run.workload:
                continue
            bandwidth = number(run.set.get("memory.bandwidth_gbps", 8.0))
            place = (run.program, run.scene, run.config, bandwidth)
            rank = (run.done, run.size or (0, 0), run.mode == "exact")
            best = self._cells.get(place)
            if best is None or rank > best[0]:
                self._cells[place] = (rank, run)

    def text(self, key):
        value = self.document.get(key)
        return value if isinstance(value, str) else ""

    def cell(self, program, scene, chip, bandwidth=8.0):
        """The run of a program and scene on one of the paper's chips, or None."""
        found = self._cells.get((program, scene, chip, bandwidth))
        return found[1] if found else None

    def of_sweep(self, name):
        """The runs that a sweep asks for, with its names of their machines."""
        return [named for run in self.runs for named in run.within(name)]

    def figure(self, name, program, scene, chip, bandwidth=8.0):
        run = self.cell(program, scene, chip, bandwidth)
        return run.get(name) if run else None

    def only(self, sweep):
        """Returns results of the runs that a sweep asks for."""
        return Results(self.document, [run for run in self.runs if sweep in run.experiments])

    def named(self, kind):
        """Returns the entries of "programs", "scenes" or "workloads" that have runs, by name, in the order of the
        file."""
        known = {entry["name"]: entry for entry in self.document.get(kind) or [] if isinstance(entry.get("name"), str)}
        present = dict.fromkeys(getattr(run, kind[:-1]) for run in self.runs)
        return {
            name: known.get(name, {}) for name in
            [*(name for name in known if name in present), *(name for name in present if name and name not in known)]
        }

    def title(self, kind, name):
        title = self.named(kind).get(name, {}).get("title")
        return title if isinstance(title, str) and title else name

    def mean_of_papers(self, name, program, chip, bandwidth=8.0):
        return mean(self.figure(name, program, scene, chip, bandwidth) for scene in self.papers)

    def programs(self):
        return list(self.named("programs"))

    def scenes(self):
        return list(self.named("scenes"))

    def published(self, paper, scene, chip):
        """The paper's rate for the scene that this one stands for, or None."""
        return paper.mrps(self.stands_for.get(scene), chip)

    def machine(self, program):
        """Returns the settings (key, value) that all machines of a program have, apart from their chip and from
        settings of single runs."""
        seen = {}  # by key, the values of the runs that do not set it
        runs = [run for run in self.runs if run.program == program and run.done]
        for run in runs:
            for key in {key for other in runs for key in other.machine} - set(run.set):
                value = run.machine.get(key)
                seen.setdefault(key, set()).add(None if value is None else shown(value))
        return sorted((key, *values) for key, values in seen.items() if len(values) == 1 and None not in values)


def read_results(path):
    value = read_json(path, strict=False)
    try:
        return Results(value)
    except Problem as problem:
        raise Problem(f"{path}: {problem}") from None
