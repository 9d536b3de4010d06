"""The report's tables."""

from .charts import CAUSES, shares, sweep_runs, sweep_value
from .claims import AGREES, DIFFERS
from .markup import Html, MISSING, cell, el, figure, join, number_cell, percent, published, seconds, table
from .results import SCENES, deviation, mean, number, ratio

_VERDICTS = {AGREES: ("yes", "✓ agrees"), DIFFERS: ("no", "✗ differs"), "unknown": ("open", "? not known")}


def shade(value):
    """The class of a deviation: how far off, and to which side."""
    if value is None:
        return ""
    size = abs(value)
    return "near" if size <= 0.10 else ("high" if value > 0 else "low") + ("2" if size > 0.5 else "1")


SHADES = "Below a figure: its deviation from the paper's. Green: within 10 %; blue: above, deep blue by more than half; orange: below, deep orange by more than half."


def paper_cell(value):
    return number_cell(value, published(value), class_="paper")


def compared(ours, wanted):
    """A cell: the figure, below it how far from the paper's it is."""
    off = deviation(ours, wanted)
    return number_cell(ours, below=None if off is None else percent(off, signed=True), class_=shade(off))


def claims_table(claims, programs):
    head = [("claim", "t"), ("paper", None)] + [(program, "t") for program in programs] + [("how it is judged", None)]
    rows = []
    for claim in claims:
        row = [cell(claim.title, claim.title), cell(claim.paper)]
        for program in programs:
            verdict, found = claim.verdicts[program]
            kind, text = _VERDICTS[verdict]
            row.append(cell(join([el("span", text, class_="verdict " + kind), el("small", found)]), verdict))
        rows.append(row + [cell(claim.rule, class_="rule")])
    return table("claims", "What the paper says, and what was measured", head, rows)


def _figures_of(results, program, chip, name):
    return mean(results.figure(name, program, scene, chip) for scene in SCENES.values())


def table1(results, paper):
    programs = results.programs()
    head = [("chip", "t"), ("threads", "n"), ("area (mm²), paper", "n"), ("area (mm²), fit", "n"), ("peak GFLOPS, paper", "n"), ("peak GFLOPS, here", "n"),
            ("RT GFLOPS, paper", "n")] + [(f"RT GFLOPS, {program}", "n") for program in programs]
    units = {run.config: run.get("values.area_units") for run in results.runs if run.done and not run.set and "area_units" in run.values}
    if units:
        head.insert(4, ("area (mm²), sum of units", "n"))
    rows = []
    for row in paper.table1:
        chip, ours = row["name"], row["name"] in paper.table2
        threads = paper.threads(chip) if ours else None
        one = next((run for run in results.runs if run.config == chip and run.done and not run.set), None) if ours else None
        cells = [cell(chip, threads), number_cell(threads, shown=None if threads else Html("")), paper_cell(row.get("area_mm2")),
                 compared(one.get("area_mm2") if one else None, row.get("area_mm2")) if ours else cell("")]
        if units:
            cells.append(compared(units.get(chip), row.get("area_mm2")) if ours else cell(""))
        cells += [paper_cell(row.get("peak_gflops")), compared(one.get("peak_gflops") if one else None, row.get("peak_gflops")) if ours else cell(""),
                  paper_cell(row.get("rt_gflops"))]
        cells += [compared(_figures_of(results, program, chip, "gflops"), row.get("rt_gflops")) if ours else cell("") for program in programs]
        rows.append(cells)
    return table("table1", "Table 1: area and floating-point operations per second", head, rows,
                 note="RT GFLOPS are the mean of the four scenes, and missing if one of them is. "
                      f"The other accelerators' figures are those that the paper quotes. {SHADES}")


def table2(results, paper, program):
    names = list(SCENES)
    head = [("chip", "t"), ("threads", "n")]
    for name in names:
        head += [(f"{name}, paper", "n"), (f"{SCENES[name] if name == 'fairy' else name}, {program}", "n")]
    head += [("average, paper", "n"), (f"average, {program}", "n")]
    rows = []
    for chip in paper.chips:
        row = [cell(chip, paper.threads(chip)), number_cell(paper.threads(chip))]
        for name in names:
            run = results.cell(program, SCENES[name], chip)
            wanted = paper.table2[chip].get(name + "_mrps")
            row += [paper_cell(wanted), measured(run, "mrps", wanted)]
        average = mean(results.figure("mrps", program, scene, chip) for scene in SCENES.values())
        row += [paper_cell(paper.table2[chip].get("average_mrps")), compared(average, paper.table2[chip].get("average_mrps"))]
        rows.append(row)
    times = [run.host_seconds for chip in paper.chips for scene in SCENES.values() if (run := results.cell(program, scene, chip)) and run.host_seconds]
    own = ", ".join(f"{key} = {value}" for key, value in results.machine(program))
    note = (f"The chips are the paper's, with {own}. " if own else "") + "Million rays per second. The fairy scene is not to be had; the generated forest stands in for it."
    note += " " + SHADES
    if times:
        note += f" The cells took {seconds(sum(times))} of the host together."
    return table(f"table2-{program}", f"Table 2, program “{program}”: million rays per second", head, rows, note=note)


def measured(run, name, wanted):
    """As compared, with what a sampled run is sure of, and a link to the run."""
    if run is None:
        return number_cell(None)
    if not run.done:
        return cell(el("span", "failed" if run.status == "failed" else "–", class_="missing", title=run.error or "not run"))
    interval = run.interval() if name == "mrps" else None
    more = Html(f"[{figure(interval[0])}, {figure(interval[1])}]") if interval else None
    off = deviation(run.get(name), wanted)
    below = join([part for part in (percent(off, signed=True) if off is not None else None, more) if part is not None], " ")
    title = f"{run.name()}: {run.get('cycles') or 0:,.0f} cycles, {seconds(run.host_seconds) if run.host_seconds else '?'} of the host"
    return cell(join([el("a", figure(run.get(name)), href=f"#run-{run.index}", title=title), el("small", below) if below else None]), run.get(name),
                class_=("n " + shade(off)).strip())


def table3(results, paper):
    head = [("chip", "t"), ("threads", "n"), ("bandwidth (GB/s)", "n"), ("dragon, paper", "n")] + [(f"dragon, {p}", "n") for p in results.programs()]
    head += [("average, paper", "n")] + [(f"average, {p}", "n") for p in results.programs()]
    rows = []
    for chip, wanted in paper.table3.items():
        for bandwidth in (8.0, 16.0):
            row = [cell(chip, paper.threads(chip)), number_cell(paper.threads(chip)), number_cell(bandwidth, shown=Html(f"{bandwidth:g}"))]
            of_dragon, of_average = (wanted.get(f"{what}_{bandwidth:g}gbs_mrps") for what in ("dragon", "average"))
            row.append(paper_cell(of_dragon))
            row += [measured(results.cell(p, "dragon", chip, bandwidth), "mrps", of_dragon) for p in results.programs()]
            row.append(paper_cell(of_average))
            row += [compared(mean(results.figure("mrps", p, scene, chip, bandwidth) for scene in SCENES.values()), of_average) for p in results.programs()]
            rows.append(row)
    return table("table3", "Table 3: 8 and 16 GB/s, million rays per second", head, rows, note=SHADES)


# What section 3 says of the machine, and where the configuration has it.
_DESCRIBED = [
    ("clock", "500 MHz", "chip.clock_mhz", 500), ("TPs that share an FPU, one adder and one multiplier", "8", "fpu.tps_per_cluster", 8),
    ("adders of a cluster", "1", "fpu.adders_per_cluster", 1), ("multipliers of a cluster", "1", "fpu.multipliers_per_cluster", 1),
    ("FPDIV/iSQRT units of a TM", "1", "special.units_per_tm", 1), ("latency of FPDIV/iSQRT", "8 cycles", "special.latency_cycles", 8),
    ("the unit accepts an operation every cycle", "9, 13 and 17 FLOP per cycle", "special.pipelined", True),
    ("latency of additions", "1 cycle", "fpu.add_latency_cycles", 1), ("latency of multiplications", "1 cycle", "fpu.mul_latency_cycles", 1),
    ("instruction cache", "4 kB", "icache.bytes", 4096), ("its banks", "16", "icache.banks", 16), ("TPs that share it", "16", "icache.tps_per_cache", 16),
    ("data cache of a TM", "16 kB", "dcache.bytes", 16384), ("TPs for each of its banks", "8", "dcache.tps_per_bank", 8),
    ("off-chip bandwidth", "8 GB/s", "memory.bandwidth_gbps", 8),
]


def described(results, paper):
    """The machine of the text beside the configurations of the runs of its chips, but for what a sweep set."""
    head = [("the text", "t"), ("says", "t"), ("key", "t"), ("the runs have", "n"), ("", "t")]
    runs = [run for run in results.runs if run.done and run.config in paper.table2]
    rows = []
    for what, says, key, wanted in _DESCRIBED:
        values = sorted({value for run in runs if key not in run.set and (value := run.setting(key)) is not None})
        verdict = AGREES if values == [wanted] else DIFFERS if values else "unknown"
        kind, text = _VERDICTS[verdict]
        rows.append([cell(what, what), cell(says, says), cell(el("code", key), key), cell(", ".join(f"{value:g}" for value in values) or MISSING, values[0] if values else None, class_="n"),
                     cell(el("span", text, class_="verdict " + kind), verdict)])
    return table("described", "The machine as section 3 describes it", head, rows,
                 note="32 registers and 512 bytes of local memory are the instruction set's (docs/isa.md) and cannot be configured. What the text leaves open is in docs/timing.md.")


def hardware(results, paper):
    """What each chip's hardware did, a row for each run of a cell."""
    head = [("program", "t"), ("scene", "t"), ("chip", "t"), ("adders", "n"), ("multipliers", "n"), ("FPDIV/iSQRT", "n"), ("issue", "n"), ("data-cache hits", "n"),
            ("bank conflicts, instructions", "n"), ("bandwidth", "n"), ("bytes a ray", "n"), ("binds", "t"), ("power (W)", "n")]
    rows = []
    for program in results.programs():
        for scene in results.scenes():
            for chip in paper.chips:
                run = results.cell(program, scene, chip)
                if not run or not run.done:
                    continue
                used = run.get("memory.utilisation")
                conflicts = ratio(run.get("causes.icache_bank_conflict"), run.get("thread_cycles"))
                row = [cell(program, program), cell(scene, scene), cell(chip, paper.threads(chip))]
                row += [number_cell(value, percent(value)) for value in (run.get("fp_add.utilisation"), run.get("fp_mul.utilisation"),
                        run.get("special.utilisation"), run.get("issue.utilisation"), run.get("dcache.hit_rate"))]
                row += [number_cell(conflicts, percent(conflicts, digits=1)), number_cell(used, percent(used)),
                        number_cell(ratio(run.get("memory.bytes"), run.get("rays"))),
                        cell(MISSING if used is None else _binds(run, used), None if used is None else _binds(run, used)),
                        number_cell(run.get("energy.average_power"))]
                rows.append(row)
    return table("hardware", "Utilisation, bytes a ray, and what binds", head, rows,
                 note="Binds: the bandwidth where 95 % of it is in use; else, of the hardware that threads share, that for which they waited longest, if it cost more than "
                      "a tenth of the thread-cycles.")


def _binds(run, used):
    if used >= 0.95:
        return "bandwidth"
    parts = [(share, label) for (style, label, _), (_, share, _) in zip(CAUSES, shares(run) or []) if style not in (10, 18) and share]
    share, label = max(parts, default=(0, ""))
    return label if share > 0.10 else "nothing"


def sampled(results):
    """Each sampled or quick run beside the exact run of the same job, where there is one."""
    exact = {(run.program, run.scene, run.config, run.size, tuple(sorted(map(str, run.set.items())))): run for run in results.runs if run.done and run.mode == "exact"}
    head = [("mode", "t"), ("program", "t"), ("scene", "t"), ("chip", "t"), ("bandwidth (GB/s)", "n"), ("estimate (MRPS)", "n"), ("interval", None), ("exact", "n"), ("error", "n"), ("inside", "t"),
            ("host, estimate", "n"), ("host, exact", "n")]
    rows, inside, known = [], 0, 0
    for run in results.runs:
        if not run.done or run.mode == "exact":
            continue
        true = exact.get((run.program, run.scene, run.config, run.size, tuple(sorted(map(str, run.set.items())))))
        value, interval = true.get("mrps") if true else None, run.interval()
        holds = None if value is None or interval is None else interval[0] <= value <= interval[1]
        known += holds is not None
        inside += bool(holds)
        error = deviation(run.get("mrps"), value)
        bandwidth = run.setting("memory.bandwidth_gbps")
        rows.append([cell(run.mode, run.mode), cell(run.program, run.program), cell(run.scene, run.scene), cell(run.config, run.get("threads")), number_cell(bandwidth), number_cell(run.get("mrps")),
                     cell(Html(f"{figure(interval[0])} to {figure(interval[1])}") if interval else MISSING, class_="n"), number_cell(value),
                     number_cell(error, percent(error, signed=True, digits=1)), cell(MISSING if holds is None else ("yes" if holds else "no"), None if holds is None else str(holds)),
                     number_cell(run.host_seconds, seconds(run.host_seconds)), number_cell(true.host_seconds if true else None, seconds(true.host_seconds if true else None))])
    if not rows:
        return None
    return table("sampled", "Estimates and their intervals", head, rows, note=f"The interval held the exact figure in {inside} of {known} cases where it is known.")


def sweep_table(results, sweep, identity):
    key = str(sweep.get("x") or "")
    head = [("scene", "t"), ("program", "t"), ("chip", "t"), (key, "n"), ("other settings", "t"), (str(sweep.get("y") or "mrps") + (f" / {sweep['y_per']}" if sweep.get("y_per") else ""), "n"),
            ("cycles", "n"), ("host", "n")]
    rows = []
    for run in sweep_runs(results, sweep):
        x, others = run.setting(key), ", ".join(f"{name} = {value}" for name, value in sorted(run.set.items()) if name != key)
        rows.append([cell(el("a", run.scene, href=f"#run-{run.index}"), run.scene), cell(run.program, run.program), cell(run.config, run.get("threads")),
                     number_cell(x), cell(others, others), number_cell(sweep_value(run, sweep), figure(sweep_value(run, sweep), 4)),
                     number_cell(run.get("cycles")), number_cell(run.host_seconds, seconds(run.host_seconds))])
    return table(identity, str(sweep.get("title") or sweep.get("name") or "sweep") + ": every run", head, rows)


def run_table(results, paper, link, configurations):
    head = [("run", "t"), ("program", "t"), ("scene", "t"), ("chip", "t"), ("size", "n"), ("mode", "t"), ("status", "t"), ("MRPS", "n"), ("against the paper", "n"),
            ("cycles", "n"), ("simulated", "n"), ("host", "n"), ("configuration", None), ("files", None), ("command", None)]
    rows = []
    for run in results.runs:
        off = deviation(run.get("mrps"), paper.mrps(run.scene, run.config) if not run.set else None)
        size = f"{run.size[0]}x{run.size[1]}" if run.size else MISSING
        changed = ", ".join(f"{key} = {value}" for key, value in sorted(run.set.items()))
        place = configurations.get(run.index)
        files = join([link(run.json, "JSON"), link(run.csv, "CSV"), link(run.picture, "picture")], " ")
        simulated = run.get("seconds")
        status = run.status if not run.error else join([run.status, el("small", run.error)])
        rows.append([cell(el("span", run.key[:10] or str(run.index), id=f"run-{run.index}", class_="key-of-run", title=run.key), run.key), cell(run.program, run.program), cell(run.scene, run.scene),
                     cell(run.config, run.get("threads")), cell(size, run.size[0] * run.size[1] if run.size else None, class_="n"), cell(run.mode, run.mode),
                     cell(status, run.status, class_="" if run.done else "bad"), number_cell(run.get("mrps")), number_cell(off, percent(off, signed=True)),
                     number_cell(run.get("cycles"), figure(run.get("cycles"), 12)), number_cell(simulated, Html(f"{1e3 * simulated:.2f} ms") if simulated is not None else None),
                     number_cell(run.host_seconds, seconds(run.host_seconds)),
                     cell(join([changed or None, el("a", f"C{place}", href=f"#configuration-{place}") if place else None], " ")), cell(files),
                     cell(el("code", run.command) if run.command else MISSING, class_="command")])
    return table("runs", "Every run", head, rows)


def flat(value, prefix=""):
    """The keys of a configuration, dotted."""
    for key, inner in value.items():
        if isinstance(inner, dict):
            yield from flat(inner, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", inner


def configurations(results):
    """The distinct configurations, and for each run the number of its own."""
    numbers, of_run, listed = {}, {}, []
    for run in results.runs:
        configuration = run.stats.get("configuration")
        if not isinstance(configuration, dict):
            continue
        items = tuple((key, repr(value) if number(value) is None else f"{value:g}" if isinstance(value, float) else str(value)) for key, value in flat(configuration))
        if items not in numbers:
            numbers[items] = len(numbers) + 1
            listed.append((numbers[items], dict(items), run.config))
        of_run[run.index] = numbers[items]
    if not listed:
        return el("p", "No run says what its configuration was.", class_="missing"), of_run
    first = listed[0][1]
    blocks = []
    for place, items, chip in listed:
        other = [f"{key} = {value}" for key, value in items.items() if first.get(key) != value]
        summary = "every key" if place == 1 else "C1 but for " + ", ".join(other)
        body = el("dl", *(join([el("dt", key), el("dd", value)]) for key, value in items.items()), class_="keys")
        blocks.append(el("details", el("summary", el("b", f"C{place}"), f" ({chip}): {summary}"), body, id=f"configuration-{place}"))
    return join(blocks), of_run

