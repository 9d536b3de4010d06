"""The tables of the paper, and those that all results have. Each is a Table (table.py), for the page, the command's
output and docs."""

from .charts import CAUSES, shares
from .claims import AGREES, DIFFERS, FITTED, UNKNOWN, speedup
from .results import deviation, mean, ratio, shown
from .sweeps import interval_text
from .sweeps import makers as any_makers
from .table import EMPTY, Cell, Table, duration, figure, percent, seconds, share, words

VERDICTS = {
    AGREES: ("✓ agrees", "verdict yes"), DIFFERS: ("✗ differs", "verdict no"),
    UNKNOWN: ("? not known", "verdict open"), FITTED: ("○ fitted", "verdict open")
}


def _shade(value):
    """The class of a deviation: how far off, and to which side."""
    if value is None:
        return ""
    size = abs(value)
    return "near" if size <= 0.10 else ("high" if value > 0 else "low") + ("2" if size > 0.5 else "1")


def published(value):
    """A published figure with the paper's digits."""
    return Cell(None if value is None else getattr(value, "text", f"{value:g}"), value, style="paper")


def compared(value, wanted, digits=3, more="", **others):
    """A figure, beside it how far from the paper's it is."""
    off = deviation(value, wanted)
    below = " ".join(part for part in (percent(off, signed=True), more) if part)
    return figure(value, digits, below=below, style=_shade(off), **others)


def measured(run, wanted):
    """The rays per second of a run as compared, with what a sampled run is sure of, and a link to the run."""
    if run is None:
        return Cell(None)
    if not run.done:
        return Cell("failed" if run.status == "failed" else None, title=run.error or "not run", style="missing")
    title = f"{run.name()}: {run.get('cycles') or 0:,.0f} cycles, {seconds(run.host_seconds) or '?'} of the host"
    return compared(run.get("mrps"), wanted, 4, interval_text(run), link=f"#run-{run.index}", title=title)


def claims_table(results, claims, programs):
    columns = [("claim", "t"), ("paper", None), *((program, "t") for program in programs), ("how it is judged", None)]
    rows, notes = [], []
    for claim in claims:
        row, more = [words(claim.title), Cell(claim.paper)], []
        for program in programs:
            verdict, found = claim.verdicts[program]
            text, style = VERDICTS[verdict]
            short, _, rest = found.partition("; ")  # the first clause; what explains it stands below the table
            row.append(Cell(text, verdict, short, style))
            more += [f"{program}: {rest}"] if rest else []
        rows.append(row + [Cell(claim.rule, style="rule")])
        notes += [(claim.title, ". ".join(more))] if more else []
    own = [f"{program}: {text.rstrip('. ')}" for program in programs if (text := own_machine(results, program))]
    notes = [("The chips", ". ".join(own)), *notes] if own else notes
    return Table("claims", "What the paper says, and what was measured", columns, rows, notes=notes)


def own_machine(results, program):
    own = ", ".join(f"{key} = {value}" for key, value in results.machine(program))
    return f"The chips are the paper's, with {own}. " if own else ""


def table1(results, paper):
    programs = results.programs()
    columns = [("chip", "t"), ("threads", "n"), ("area (mm²), paper", "n"), ("fit", "n"),
               *((f"sum of units, {program}", "n") for program in programs), ("peak GFLOPS, paper", "n"), ("here", "n"),
               ("RT GFLOPS, paper", "n")]
    columns += [(f"RT GFLOPS, {program}", "n") for program in programs]
    rows = []
    for row in paper.table1:
        chip, wanted = row["name"], row.get("rt_gflops")
        if chip not in paper.table2:
            rows.append([
                words(chip), EMPTY, published(row.get("area_mm2")), *([EMPTY] * (1 + len(programs))),
                published(row.get("peak_gflops")), EMPTY, published(wanted) if wanted else EMPTY,
                *([EMPTY] * len(programs))
            ])
            continue
        one = next((run for run in results.runs if run.config == chip and run.done and not run.set), None)

        def of(name):
            return one.get(name) if one else None

        cells = [
            Cell(chip, paper.threads(chip)),
            figure(paper.threads(chip)),
            published(row.get("area_mm2")),
            compared(of("area_mm2"), row.get("area_mm2")),
            *(compared(results.figure("values.area_units", program, results.papers[0], chip), row.get("area_mm2"))
              for program in programs),
            published(row.get("peak_gflops")),
            compared(of("peak_gflops"), row.get("peak_gflops")),
            published(wanted)
        ]
        cells += [compared(results.mean_of_papers("gflops", program, chip), wanted) for program in programs]
        rows.append(cells)
    return Table(
        "table1", "Table 1: area and floating-point operations per second", columns, rows,
        "RT GFLOPS are the mean of the four scenes, and missing if one of them is. The other accelerators' figures "
        "are those that the paper quotes."
    )


def table1_scenes(results, paper, program):
    """The scenes behind the mean of Table 1, and the utilisation of the units."""
    columns = [("chip", "t"), ("threads", "n"), ("RT GFLOPS, paper", "n"), (program, "n"),
               *((scene, "n") for scene in results.papers),
               *((unit, "n") for unit in ("adders", "multipliers", "FPDIV/iSQRT"))]
    rows = []
    for row in paper.table1:
        chip = row["name"]
        if chip in paper.table2:
            rows.append([
                Cell(chip, paper.threads(chip)),
                figure(paper.threads(chip)),
                published(row.get("rt_gflops")),
                compared(results.mean_of_papers("gflops", program, chip), row.get("rt_gflops")),
                *(figure(results.figure("gflops", program, scene, chip)) for scene in results.papers),
                *(share(results.mean_of_papers(f"{unit}.utilisation", program, chip))
                  for unit in ("fp_add", "fp_mul", "special"))
            ])
    return Table(f"table1-{program}", f"RT GFLOPS by scene, {results.title('programs', program)}", columns, rows,
                 "Units: the share of their cycles in which they are in use, mean of the scenes.")


def table2(results, paper, program):
    columns = [("chip", "t"), ("threads", "n")]
    for column, scene in [*results.columns.items(), ("average", "average")]:
        columns += [(f"{column}, paper", "n"), (f"{scene}, {program}", "n")]
    columns += [("simulated", "n"), ("host", "n")]
    rows = []
    for chip in paper.chips:
        row = [Cell(chip, paper.threads(chip)), figure(paper.threads(chip))]
        runs = [results.cell(program, scene, chip) for scene in results.papers]
        for column, run in zip(results.columns, runs):
            row += [published(paper.mrps(column, chip)), measured(run, paper.mrps(column, chip))]
        wanted = paper.mrps("average", chip)
        row += [published(wanted), compared(mean(run.get("mrps") if run else None for run in runs), wanted)]
        done = [run for run in runs if run and run.done]
        row += [
            duration(sum(run.get("seconds") or 0 for run in done) or None),
            duration(sum(run.host_seconds or 0 for run in done) or None)
        ]
        rows.append(row)
    note = (own_machine(results, program) + "Million rays per second. "
            "The fairy scene is not available; the generated forest replaces it.")
    times = [
        run.host_seconds for chip in paper.chips for scene in results.papers
        if (run := results.cell(program, scene, chip)) and run.host_seconds
    ]
    if times:
        note += f" The cells took {seconds(sum(times))} of the host's time together."
    return Table(f"table2-{program}", f"Table 2, {results.title('programs', program)}: million rays per second",
                 columns, rows, note)


def speedups(results, paper, program):
    """Speed-ups over 1x32, which depend on the machine more than on the program's speed."""
    columns = [("chip", "t"), ("threads", "n")]
    for column, scene in results.columns.items():
        columns += [(f"{column}, paper", "n"), (f"{scene}, {program}", "n")]
    rows = []
    for chip in paper.chips[1:]:
        row = [Cell(chip, paper.threads(chip)), figure(paper.threads(chip))]
        for column, scene in results.columns.items():
            wanted = paper.speedup(column, chip)
            row += [figure(wanted, style="paper"), compared(speedup(results, program, scene, chip), wanted)]
        rows.append(row)
    return Table(f"speedup-{program}", f"Speed-up from 1x32, {results.title('programs', program)}", columns, rows)


def of_the_text(results, paper):
    """Figures of the paper that are in its text: the dragon's on 4x32, and means of the scenes there."""
    rows, published_at = [], paper.published.get
    for program in results.programs():
        dragon = results.columns["dragon"]
        run = results.cell(program, dragon, "4x32")
        for title, value, name in (
            ("dragon on 4x32 against MRTP scaled to 500 MHz, times",
             ratio(results.figure("mrps", program, dragon, "4x32"), published_at("mrtp_mrps_scaled")), "mrtp_speedup"),
            ("dragon on 4x32, frames of 1280x720 per second", run.frames_per_second() if run else None,
             "frames_per_second"),
            ("power of 4x32, W, mean of the scenes (a lower bound: docs/statistics.md, Energy)",
             results.mean_of_papers("energy.average_power", program, "4x32"), "power_4x32_w"),
            ("adds and multiplies per ray, mean of the scenes",
             results.mean_of_papers("values.flops_per_ray", program, "4x32"), "flops_per_ray"),
        ):
            rows.append(
                [words(program),
                 words(title),
                 published(published_at(name)),
                 compared(value, published_at(name))])
    return Table("of-the-text", "Figures of the paper's text", [("program", "t"), ("figure", "t"), ("paper", "n"),
                                                                ("here", "n")], rows)


def table3(results, paper):
    programs = results.programs()
    columns = [("chip", "t"), ("scene", "t")] + [(f"{measure}, {name}", "n")
                                                 for measure in ("8 GB/s", "16 GB/s", "gain")
                                                 for name in ("paper", *programs)]
    rows = []
    for chip, wanted in paper.table3.items():
        for what in ("dragon", "average"):
            row = [Cell(chip, paper.threads(chip)), words(what)]
            scenes = [results.columns["dragon"]] if what == "dragon" else results.papers
            rates = []  # at both bandwidths: the paper's and those of the programs
            for bandwidth in (8.0, 16.0):
                papers = wanted.get(f"{what}_{bandwidth:g}gbs_mrps")
                rates.append([
                    papers, *(mean(results.figure("mrps", program, scene, chip, bandwidth) for scene in scenes)
                              for program in programs)
                ])
                links = [
                    results.cell(program, scenes[0], chip, bandwidth) if what == "dragon" else None
                    for program in programs
                ]
                row += [
                    published(papers), *(measured(run, papers) if run else compared(value, papers, 4)
                                         for run, value in zip(links, rates[-1][1:]))
                ]
            gain, *gains = (ratio(after, before) for before, after in zip(*rates))
            rows.append([*row, figure(gain, style="paper"), *(compared(value, gain) for value in gains)])
    return Table("table3", "Table 3: 8 and 16 GB/s, million rays per second", columns, rows)


# The statements of section 3 about the machine, with their keys of the configuration.
_DESCRIBED = [
    ("clock", "500 MHz", "chip.clock_mhz", 500),
    ("TPs that share an FPU, one adder and one multiplier", "8", "fpu.tps_per_cluster", 8),
    ("adders of a cluster", "1", "fpu.adders_per_cluster", 1),
    ("multipliers of a cluster", "1", "fpu.multipliers_per_cluster", 1),
    ("FPDIV/iSQRT units of a TM", "1", "special.units_per_tm", 1),
    ("latency of FPDIV/iSQRT", "8 cycles", "special.latency_cycles", 8),
    ("the unit accepts an operation every cycle", "9, 13 and 17 FLOP per cycle", "special.pipelined", True),
    ("latency of additions", "1 cycle", "fpu.add_latency_cycles", 1),
    ("latency of multiplications", "1 cycle", "fpu.mul_latency_cycles", 1),
    ("instruction cache", "4 kB", "icache.bytes", 4096),
    ("its banks", "16", "icache.banks", 16),
    ("TPs that share it", "16", "icache.tps_per_cache", 16),
    ("data cache of a TM", "16 kB", "dcache.bytes", 16384),
    ("TPs for each of its banks", "8", "dcache.tps_per_bank", 8),
    ("off-chip bandwidth", "8 GB/s", "memory.bandwidth_gbps", 8),
]


def described(results, paper):
    """The machine of the text beside the configurations of the runs of its chips, but for what a sweep set."""
    runs = [run for run in results.runs if run.done and run.config in paper.table2]
    rows = []
    for what, says, key, wanted in _DESCRIBED:
        values = sorted({value for run in runs if key not in run.set and (value := run.setting(key)) is not None})
        verdict = AGREES if values == [wanted] else DIFFERS if values else UNKNOWN
        text, style = VERDICTS[verdict]
        rows.append([
            words(what),
            words(says),
            words(key, style="code"),
            Cell(", ".join(f"{value:g}" for value in values) or None, values[0] if values else None),
            Cell(text, verdict, style=style)
        ])
    return Table(
        "described", "The machine as section 3 describes it", [("the text", "t"), ("says", "t"), ("key", "t"),
                                                               ("the runs have", "n"), ("", "t")], rows,
        "32 registers and 512 bytes of local memory are the instruction set's (docs/isa.md) and cannot be configured. "
        "What the text leaves open is in docs/timing.md."
    )


def hardware(results, paper):
    """The utilisation of each chip's hardware, a row for each run of a cell."""
    columns = [("program", "t"), ("scene", "t"), ("chip", "t"), ("adders", "n"), ("multipliers", "n"),
               ("FPDIV/iSQRT", "n"), ("issue", "n"), ("data-cache hits", "n"), ("bank conflicts, instructions", "n"),
               ("bandwidth", "n"), ("bytes a ray", "n"), ("binds", "t"), ("power (W)", "n")]
    rows = []
    for program in results.programs():
        for scene in results.scenes():
            for chip in paper.chips:
                run = results.cell(program, scene, chip)
                if run and run.done:
                    rows.append([
                        words(program),
                        words(scene),
                        Cell(chip, paper.threads(chip)),
                        *(share(run.get(name))
                          for name in ("fp_add.utilisation", "fp_mul.utilisation", "special.utilisation",
                                       "issue.utilisation", "dcache.hit_rate")),
                        share(ratio(run.get("causes.icache_bank_conflict"), run.get("thread_cycles")), 1),
                        share(run.get("memory.utilisation")),
                        figure(ratio(run.get("memory.bytes"), run.get("rays"))),
                        _binds(run),
                        figure(run.get("energy.average_power"))
                    ])
    return Table(
        "hardware", "Utilisation, bytes a ray, and what binds", columns, rows,
        "Binds: the bandwidth where 95 % of it is in use; else, of the hardware that threads share, that for which "
        "they waited longest, if it cost more than "
        "a tenth of the thread-cycles.")


def _binds(run):
    used = run.get("memory.utilisation")
    if used is None:
        return Cell(None)
    parts = [(part, label) for (style, label, _), (_, part, _) in zip(CAUSES, shares(run) or [])
             if style not in (10, 18) and part]
    longest, label = max(parts, default=(0, ""))
    return words("bandwidth" if used >= 0.95 else label if longest > 0.10 else "nothing")


def run_table(results, paper, link, configurations):
    columns = [("run", "t"), ("program", "t"), ("scene", "t"), ("chip", "t"), ("size", "n"), ("mode", "t"),
               ("status", "t"), ("MRPS", "n"), ("against the paper", "n"), ("cycles", "n"), ("simulated", "n"),
               ("host", "n"), ("configuration", None), ("files", None), ("command", None)]
    rows = []
    for run in results.runs:
        off = deviation(run.get("mrps"), results.published(paper, run.scene, run.config) if not run.set else None)
        changed = ", ".join(f"{key} = {shown(value)}" for key, value in sorted(run.set.items()))
        place, simulated = configurations.get(run.index), run.get("seconds")
        files = [(text, address) for text, path in (("JSON", run.json), ("CSV", run.csv), ("picture", run.picture))
                 if (address := link(path))]
        rows.append([
            Cell(run.key[:10] or str(run.index), run.key, identity=f"run-{run.index}", title=run.key,
                 style="key-of-run"),
            words(run.program),
            words(run.scene),
            Cell(run.config, run.get("threads")),
            Cell(run.axis("size"), run.size[0] * run.size[1] if run.size else None),
            words(run.mode),
            Cell(run.status, run.status, run.error, "" if run.done else "bad"),
            figure(run.get("mrps")),
            Cell(percent(off, signed=True), off),
            figure(run.get("cycles"), 12),
            Cell(f"{1e3 * simulated:.2f} ms" if simulated is not None else None, simulated),
            duration(run.host_seconds),
            Cell(changed, links=[(f"C{place}", f"#configuration-{place}")] if place else []),
            Cell("", links=files),
            Cell(run.command or None, style="command code")
        ])
    return Table("runs", "Every run", columns, rows)


def makers(results, paper, sweep):
    """Returns functions that make a sweep's tables from its own runs. The sweeps that repeat the paper's tables have
    those."""
    name = sweep.get("name")
    only, made = results.only(name), []
    for make in {"table1": (table1, ), "table2": (of_the_text, ), "table3": (table3, )}.get(name, ()):
        made.append(lambda make=make: make(only, paper).measured())
    for make in {"table1": (table1_scenes, ), "table2": (table2, speedups)}.get(name, ()):
        made += [
            lambda make=make, program=program: make(only, paper, program).measured() for program in only.programs()
        ]
    return made + (any_makers(results, paper, sweep) if sweep.get("table") or not made else [])


def of_sweep(results, paper, sweep):
    return [make() for make in makers(results, paper, sweep)]


def print_tables(results, paper, names, out):
    """The command's output: of each sweep its tables."""
    for sweep in results.sweeps:
        if sweep.get("name") in names:
            made = [table for table in of_sweep(results, paper, sweep) if table.rows]
            for place, table in enumerate(made):
                table.title += f"\n{sweep['claim']}" if sweep.get("claim") and place == 0 else ""
                out.write(table.without_empty().text())
