"""The report's figures, made of the runs."""

import math

from .claims import speedup
from .plots import Bars, Lines, Series, log_ticks
from .results import mean, number, ratio
from .sweeps import Axes, Value, by_kind

# Styles of page.css, each with a mark of its own. Scenes and the like begin where programs are rare.
PAPER = (0, "circle")
OF_PROGRAMS = [(1, "square"), (2, "dot"), (3, "triangle"), (4, "diamond"), (5, "circle"), (6, "square")]
STYLES = OF_PROGRAMS[2:] + OF_PROGRAMS[:2]

# Causes of docs/trax-sim.md, together where the same hardware is behind them.
CAUSES = [
    (10, "issued", ["issued"]),
    (11, "instruction fetch", ["icache_bank_conflict", "icache_miss"]),
    (12, "data-cache banks and hits", ["dcache_bank_conflict", "wait_dcache_hit", "wait_local"]),
    (13, "off-chip memory", ["wait_memory", "memory_queue_full"]),
    (14, "adders and multipliers", ["fp_add_conflict", "fp_mul_conflict", "int_mul_conflict"]),
    (15, "FPDIV/iSQRT", ["wait_special", "special_conflict"]),
    (16, "atomic increments", ["wait_atomic"]),
    (17, "other waits", ["wait_other", "branch_bubble"]),
    (18, "ended", ["halted"]),
]


def style_of(index):
    return OF_PROGRAMS[index % len(OF_PROGRAMS)]


def _styles(results, groups, by_scene):
    """(colour, mark) of each group (scene, program, other parts of its label). On the whole page a program has one
    colour and one mark, and a scene one colour. The first that differs of scene, program and other parts has the
    colour, the rest the mark."""
    scenes, programs = [*results.scenes(), ""], [*results.programs(), ""]  # of a run by hand neither may be known
    others = [*dict.fromkeys(group[2] for group in groups)]
    several = len({group[1] for group in groups}) > 1
    marks = [(program, others[0]) for program in programs]
    marks += dict.fromkeys(group[1:] for group in groups if group[2] != others[0])
    for scene, program, rest in groups:
        rounds, place = divmod(others.index(rest), len(STYLES))  # a colour that comes again has another mark
        other = STYLES[place][0], STYLES[(place + rounds) % len(STYLES)][1]
        own = style_of(programs.index(program)) if several else other
        if by_scene:
            mark = style_of(marks.index((program, rest)))[1] if several else other[1]
            yield STYLES[scenes.index(scene) % len(STYLES)][0], mark
        else:
            yield own[0], (other if len(others) > 1 else own)[1]


def shares(run):
    """Returns (style, share of the thread-cycles, tip) by group of CAUSES, or None if the run has no causes."""
    total = run.get("thread_cycles")
    parts = []
    for style, label, causes in CAUSES:
        counts = [run.get("causes." + cause) for cause in causes]
        known = [count for count in counts if count is not None]
        share = ratio(sum(known), total) if known else None
        detail = ", ".join(f"{cause} {100 * count / total:.1f} %" for cause, count in zip(causes, counts)
                           if count and total)
        parts.append((style, share, f"{run.config}: {label} {100 * share:.1f} % ({detail})" if share else ""))
    return parts if any(share is not None for _, share, _ in parts) else None


def _threads_axis(paper):
    counts = sorted({paper.threads(chip) for chip in paper.chips})
    chosen = [count for count in counts if count in (32, 64, 128, 256, 512)] or counts
    return [(count, str(count)) for count in chosen]


def _scaling(results, paper, scene):
    series = []
    column = results.stands_for.get(scene)
    if paper.speedup(column, "8x64"):
        points = [(paper.threads(chip), paper.speedup(column, chip),
                   f"paper, {chip}: {paper.speedup(column, chip):.2f} times, {paper.mrps(column, chip):.2f} MRPS")
                  for chip in paper.chips]
        label = "paper" if results.columns[column] == scene else f"paper, {column}"
        series.append(Series(label, PAPER[0], points, PAPER[1], line=False))
    for index, program in enumerate(results.programs()):
        style, mark = style_of(index)
        points = []
        for chip in paper.chips:
            value, mrps = speedup(results, program, scene, chip), results.figure("mrps", program, scene, chip)
            points.append(
                (paper.threads(chip), value, f"{program}, {chip}: {value:.2f} times, {mrps:.2f} MRPS" if value else ""))
        series.append(Series(program, style, points, mark, line=False))
    top = max((point[0] for one in series for point in one.known()), default=512)
    if any(one.known() for one in series[:-1] or series):
        points = [(32, 1.0, "1x32: 1"), (top, top / 32, f"in proportion: {top / 32:g} times")]
        series.append(Series("in proportion", 7, points, "dot", dashed=True))
    return Lines("scaling-" + scene, f"Speed-up from 1x32: {scene}", "threads", "speed-up (times)", series,
                 x_ticks=_threads_axis(paper))


def _memory(results, paper, program):
    series = []
    for index, scene in enumerate(results.scenes()):
        points = []
        for chip in paper.chips:
            used = results.figure("memory.utilisation", program, scene, chip)
            points.append((paper.threads(chip), None if used is None else 100 * used,
                           f"{scene}, {chip}: {100 * used:.0f} % of 8 GB/s" if used is not None else ""))
        style, mark = STYLES[index % len(STYLES)]
        series.append(Series(scene, style, points, mark, line=False))
    return Lines("memory-" + program, f"Off-chip bandwidth in use: {program}", "threads", "of 8 GB/s (%)", series,
                 x_ticks=_threads_axis(paper))


def _stalls(results, paper, program, scene):
    bars = []
    for chip in paper.chips:
        run = results.cell(program, scene, chip)
        bars.append((chip, (shares(run) if run else None) or []))
    return Bars(f"stalls-{program}-{scene}", f"Where thread-cycles went: {scene}, {program}",
                "share of all thread-cycles", bars, [(style, label) for style, label, _ in CAUSES])


def _error_time(results, paper):
    series = []
    for index, program in enumerate(results.programs()):
        style, mark = style_of(index)
        points = []
        for run in results.runs:
            if run.program != program or run.set or run.workload or not run.host_seconds:
                continue
            value = ratio(run.get("mrps"), results.published(paper, run.scene, run.config))
            if value is None:
                continue
            points.append((run.host_seconds, 100 * (value - 1),
                           f"{run.name()}: {100 * (value - 1):+.0f} % in {run.host_seconds:.1f} s"))
        series.append(Series(program, style, points, mark, line=False))
    ticks = log_ticks(point[0] for one in series for point in one.known())
    return Lines("error-time", "Deviation from Table 2 against the host's time", "time of the host for a cell (s)",
                 "deviation from the paper (%)", series, log_x=True, from_zero=False, x_ticks=ticks)


def _label(scene, program, rest):
    return ", ".join(part for part in (scene, program, *rest) if part)


class SweepFigure:
    """A sweep's x and y: a series for each scene, program and other difference, or for each kind of ray with means of
    the scenes. x may be an axis of tables, "threads" or a statistic."""
    def __init__(self, results, paper, sweep):
        self.results, self.sweep = results, sweep
        runs = results.of_sweep(sweep.get("name"))
        kinds = sweep.get("y") in (None, "mrps") and any(run.kinds() for run in runs)
        self.value = Value({"name": "kind.mrps" if kinds else sweep.get("y") or "mrps", "per": sweep.get("y_per")})
        self.kinds = self.value.name.startswith("kind.")
        self.runs = list(by_kind(runs)) if self.kinds else runs
        self.axes = Axes(results, paper, self.runs, {**sweep, "x": None})
        self.key, self.counted = self.x_axis()
        left = {self.key, "scene", "chip" if self.key == "threads" else "", "variant" if self.counted else ""}
        self.others = [axis for axis in self.axes.varying if axis not in left]
        self.named = [text for text in self.axes.order.get(self.key, []) if isinstance(text, str) and text]
        self.groups = self.means(self.points()) if self.kinds else self.points()

    def x_axis(self):
        """(key, whether it is a statistic). y is no function of a statistic, so variants are marks of one series then.
        If x has one value, the axis is one in which runs differ, the variants first."""
        key, varying = str(self.sweep.get("x") or "threads"), self.axes.varying
        if key != "threads" and key not in self.axes.order and any(
                run.configured(key) is None and run.get(key) is not None for run in self.runs):
            return key, True
        if len({run.setting(key) for run in self.runs if run.done}) < 2:
            key = next((axis for axis in ("variant", *reversed(varying)) if axis in varying), key)
        return key, False

    def x(self, run):
        if self.axes.value(run, self.key) in self.named:
            return self.named.index(self.axes.value(run, self.key))
        return run.get(self.key) if self.counted else run.setting(self.key)

    def group(self, run):
        """(scene, program, other differences) of a series."""
        known = ("chip", "workload", "variant", "kind", "size", "mode")
        parts = [(axis, part) for axis, part in zip(self.others, self.axes.place(run, self.others)) if part != ""]
        label = tuple(str(part) if axis in known else f"{axis}={part}" for axis, part in parts if axis != "program")
        scene = "" if self.kinds or self.key == "scene" else run.scene
        return scene, run.program if "program" in self.others else "", label

    def points(self):
        groups = {}
        for run in self.runs:
            x, y = self.x(run), self.value.of(run)
            if x is not None and y is not None:
                groups.setdefault(self.group(run), []).append((x, y, f"{run.name()}: {y:.4g}"))
        return groups

    @staticmethod
    def means(groups):
        """One point for each x, the mean of the scenes."""
        found = {}
        for group, points in groups.items():
            rates = {x: mean(point[1] for point in points if point[0] == x) for x in {point[0] for point in points}}
            found[group] = [(x, y, f"{_label(*group)}: {y:.4g}, mean of the scenes") for x, y in rates.items()]
        return found

    def series(self):
        several = len({group[0] for group in self.groups}) > 1 or len({group[1:] for group in self.groups}) == 1
        several = several and not self.kinds and self.key != "scene"
        first = self.results.programs()[:1]
        for (group, points), (colour, mark) in zip(self.groups.items(), _styles(self.results, self.groups, several)):
            scene, program, rest = group
            label = _label(scene if several else "", program, rest) or self.value.title
            dashed = first != [] and "program" in self.axes.varying and program not in first
            yield Series(label, colour, sorted(points), mark, not self.named and not self.counted, dashed)

    def lines(self, identity):
        values = sorted({point[0] for points in self.groups.values() for point in points})
        if len(values) < 2:
            return None
        ticks = list(enumerate(self.named)) or ([(one, f"{one:g}") for one in values] if len(values) <= 9 else None)
        doubling = not self.named and len(values) > 2 and values[0] > 0 and values[-1] / values[0] >= 8
        heights = [point[1] for points in self.groups.values() for point in points if point[1] > 0]
        unit = self.value.name + (f" / {self.value.per}" if self.value.per else "")
        return Lines(identity, f"{unit} against {self.key}", self.key, unit, list(self.series()), log_x=doubling,
                     base=2, x_ticks=ticks, log_y=bool(heights) and max(heights) / min(heights) >= 1000)


def sweep_figure(results, paper, sweep, identity):
    """The figure of a sweep; None if its runs differ in nothing."""
    return SweepFigure(results, paper, sweep).lines(identity)


def _joined(columns, rows):
    """Intervals of a time series joined so that each decade of cycles has at most 40: more cannot be told apart, and
    made the page four times as large. A share of the joined interval is the mean by the intervals' cycles; of the
    fetches refused, by the fetches."""
    groups, begin = {}, 0
    for row in rows:
        groups.setdefault(math.floor(40 * math.log10(max(1, row[0]))), []).append((row, row[0] - begin))
        begin = row[0]
    asked = [columns.index(name) for name in ("issued", "icache_bank_conflict") if name in columns]

    def weight(row, column):
        """An interval's weight for each of its cycles."""
        by_fetches = column == "fetch_refused" and len(asked) == 2
        return sum(number(row[other]) or 0 for other in asked) if by_fetches else 1

    for group in groups.values():
        joined = [group[-1][0][0]]
        for place, column in enumerate(columns[1:], 1):
            known = [(row[place], cycles * weight(row, column)) for row, cycles in group
                     if number(row[place]) is not None]
            joined.append(ratio(math.fsum(value * part for value, part in known), math.fsum(part for _, part in known)))
        yield joined


def _over_time(record, identity):
    columns = record.get("columns") if isinstance(record.get("columns"), list) else []
    rows = [
        row for row in record.get("rows") or []
        if isinstance(row, list) and len(row) == len(columns) and number(row[0]) is not None
    ]
    rows = list(_joined(columns, rows))
    series, used = [], set()
    for place, column in enumerate(columns[1:], 1):
        points = [(row[0], None if row[place] is None else 100 * row[place],
                   f"to cycle {row[0]:,}: {column} {100 * row[place]:.1f} %" if row[place] is not None else "")
                  for row in rows]
        style = next((style for style, _, causes in CAUSES if column in causes), 0)
        style = 4 if style in used else style  # the second of a group
        series.append(Series(str(column), style, points))
        used.add(style)
    title = ": ".join(str(part) for part in (record.get("name"), record.get("title")) if part)
    ticks = [(10.0**power, f"{10 ** power:,}") for power in range(1, 10)
             if rows and rows[0][0] / 10 < 10**power < 10 * rows[-1][0]]
    return Lines(identity, title or "series", "cycle", "share of thread-cycles (%)", series, log_x=True, x_ticks=ticks)


def all_figures(results, paper):
    for scene in _paper_scenes(results):
        yield _scaling(results, paper, scene)
    for program in results.programs():
        yield _memory(results, paper, program)
        for scene in _paper_scenes(results):
            if scene in results.papers or any((run.scene, run.program) == (scene, program) for run in results.runs):
                yield _stalls(results, paper, program, scene)
    yield _error_time(results, paper)
    for index, sweep in enumerate(results.sweeps):
        figure = sweep_figure(results, paper, sweep, f"sweep-{index}")
        if figure and not str(sweep.get("name")).startswith("table"):  # those have figures of their own
            yield figure
    for index, record in enumerate(results.series):
        yield _over_time(record, f"series-{index}")


def _paper_scenes(results):
    """The paper's scenes, measured or not, and others that have runs on several chips."""
    chips = {scene: {run.config for run in results.runs if run.scene == scene} for scene in results.scenes()}
    return results.papers + [scene for scene in chips if scene not in results.papers and len(chips[scene]) > 1]
