"""The tables as text: our figures beside the paper's, with their deviation and what they took."""

import json
import math
import re

from .sweep import CHIPS

COLUMNS = (("conference", "conference"), ("crytek-sponza", "crytek"), ("dragon", "dragon"), ("forest", "forest (paper: fairy)"))


def text(value, digits=3):
    """A number with so many significant digits; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "-"
    if value == 0:
        return "0"
    return f"{value:,.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"


def deviation(ours, papers):
    return f"{ours / papers - 1:+.1%}" if ours is not None and papers else "-"


def mean(values):
    """Of a complete list only: an average of what happens to be there would be compared with another average."""
    return sum(values) / len(values) if values and None not in values else None


def print_rows(header, rows, out):
    widths = [max(len(row[column]) for row in [header, *rows]) for column in range(len(header))]
    for index, row in enumerate([header, *rows]):
        out.write("| " + " | ".join(cell.ljust(width) if column == 0 else cell.rjust(width) for column, (cell, width) in enumerate(zip(row, widths))) + " |\n")
        if index == 0:
            out.write("|" + "|".join("-" * (width + 2) for width in widths) + "|\n")
    out.write("\n")


class Index:
    """Finished runs by what they are of."""

    def __init__(self, results):
        self.runs = [run for run in results["runs"] if run["status"] == "done"]

    def find(self, experiment, program, scene, chip, settings=None):
        for run in self.runs:
            if experiment in run["experiments"] and (run["program"], run["scene"], run["config"]) == (program, scene, chip) and run["set"] == (settings or {}):
                return run
        return None

    def programs(self, experiment):
        return [program for program in ("ours", "era") if any(experiment in run["experiments"] and run["program"] == program for run in self.runs)]


def stat(run, name):
    """A statistic, with dots in its name; None if there is no run, or if it failed."""
    if name.startswith("values."):
        value = (run or {}).get("values", {}).get(name.removeprefix("values."))
        return value if isinstance(value, (int, float)) else None
    value = (run or {}).get("stats")
    for part in name.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return value if isinstance(value, (int, float)) else None


def interval(run):
    low, high = stat(run, "values.mrps_low"), stat(run, "values.mrps_high")
    return f" [{text(low)}, {text(high)}]" if low else ""


def print_table2(index, paper, out):
    for program in index.programs("table2"):
        out.write(f"Table 2, million rays per second, program {program}: ours, the paper's, deviation\n\n")
        header, rows = ["chip"], []
        for _, title in (*COLUMNS, (None, "average")):
            header += [title, "paper", "dev."]
        header += ["simulated ms", "host s"]
        for chip in CHIPS:
            runs = [index.find("table2", program, scene, chip) for scene, _ in COLUMNS]
            if not any(runs):
                continue
            row = [chip]
            for (scene, _), run in zip(COLUMNS, runs):
                ours, papers = stat(run, "mrps"), paper.mrps(scene, chip)
                row += [text(ours) + interval(run), text(papers), deviation(ours, papers)]
            average, papers = mean([stat(run, "mrps") for run in runs]), paper.mrps("average", chip)
            row += [text(average), text(papers), deviation(average, papers)]
            row += [text(1e3 * sum(stat(run, "seconds") for run in runs if run)), text(sum(run["host_seconds"] or 0 for run in runs if run))]
            rows.append(row)
        print_rows(header, rows, out)


def print_sweep(index, sweep, results, out):
    """Any sweep: a row for each value, a column for each scene. Machines have the names that the sweep gives them."""
    runs = [run | point for run in results["runs"] for point in run["points"] if point["experiment"] == sweep["name"]]
    scenes = list(dict.fromkeys(run["scene"] for run in runs))
    rows = {}

    def cell(run):
        value, unit = stat(run, sweep["y"]), stat(run, sweep["y_per"]) if sweep["y_per"] else 1
        return text(value / unit if value is not None and unit else None) + (interval(run) if sweep["y"] == "mrps" else "")

    def place(run):
        """What stands on the sweep's axis; for people, and for the order of rows."""
        value = stat(run, f"configuration.{sweep['x']}") if sweep["x"] != "threads" else None
        return run["set"].get(sweep["x"], run["machine"].get(sweep["x"])) if value is None else value

    for run in sorted(runs, key=lambda run: (run["program"] != "ours", CHIPS.index(run["config"]) if run["config"] in CHIPS else 0, place(run) or 0)):
        others = ", ".join(f"{key} {json.dumps(value)}" for key, value in run["set"].items() if key != sweep["x"])
        rows.setdefault((run["program"], run["config"], json.dumps(place(run)), others), {})[run["scene"]] = run
    out.write(f"{sweep['title']}: {sweep['y']}{' / ' + sweep['y_per'] if sweep['y_per'] else ''}\n{sweep['claim']}\n\n")
    columns = [0, 1, *([2] if sweep["x"] != "threads" else []), *([3] if any(key[3] for key in rows) else [])]
    names = ["program", "chip", sweep["x"], "beside"]
    print_rows([*(names[column] for column in columns), *scenes, "host s"],
               [[*(key[column] or "-" for column in columns), *(cell(some.get(scene)) for scene in scenes),
                 text(sum(run.get("host_seconds") or 0 for run in some.values()))] for key, some in rows.items()], out)


def print_table1(index, paper, out):
    for program in index.programs("table1"):
        out.write(f"Table 1, chips at 65 nm, program {program}; area: the fit of the paper's, and the sum of our units; utilisation: of adders, multipliers and FPDIV/iSQRT\n\n")
        rows = []
        for row in paper.table1:
            chip, papers = row["name"], {name: float(value) if value else None for name, value in row.items() if name.endswith(("mm2", "gflops"))}
            runs = [index.find("table1", program, scene, chip) for scene, _ in COLUMNS]
            gflops = mean([stat(run, "gflops") for run in runs])
            units = [mean([stat(run, f"{unit}.utilisation") for run in runs]) for unit in ("fp_add", "fp_mul", "special")]
            if not any(runs) and chip in CHIPS:
                continue
            rows.append([chip, text(papers["area_mm2"]), text(stat(runs[0], "area_mm2")), text(stat(runs[0], "values.area_units")),
                         deviation(stat(runs[0], "values.area_units"), papers["area_mm2"]), text(papers["peak_gflops"]), text(stat(runs[0], "peak_gflops")),
                         text(papers["rt_gflops"]), text(gflops), deviation(gflops, papers["rt_gflops"]), " ".join("-" if unit is None else f"{unit:.0%}" for unit in units)])
        print_rows(["chip", "paper mm2", "fit", "units", "dev.", "paper peak", "ours", "paper RT GFLOPS", "ours", "dev.", "utilisation"], rows, out)


def print_table3(index, paper, out):
    for program in index.programs("table3"):
        out.write(f"Table 3, million rays per second at 8 and 16 GB/s, program {program}: ours, the paper's, deviation\n\n")
        rows = []
        for chip, papers in paper.table3.items():
            row = [chip]
            gains = []
            for name, scenes in (("dragon", ["dragon"]), ("average", [scene for scene, _ in COLUMNS])):
                pair = []
                for bandwidth in (8, 16):
                    settings = {} if bandwidth == 8 else {"memory.bandwidth_gbps": 16}
                    ours = mean([stat(index.find("table3", program, scene, chip, settings), "mrps") for scene in scenes])
                    published = float(papers[f"{name}_{bandwidth}gbs_mrps"])
                    row += [text(ours), text(published), deviation(ours, published)]
                    pair.append(ours)
                gains.append(text(pair[1] / pair[0]) if None not in pair else "-")
            rows.append([*row, *gains])
        print_rows(["chip", *(word for name in ("dragon 8", "dragon 16", "average 8", "average 16") for word in (name, "paper", "dev.")), "gain dragon", "average"], rows, out)


def print_scaling(index, paper, out):
    """Speed-up from 1x32, which tells of the machine whatever the program's speed is."""
    for program in index.programs("table2"):
        rows = []
        for chip in CHIPS[1:]:
            row = [chip]
            for scene, _ in COLUMNS:
                ours, base = (stat(index.find("table2", program, scene, name), "mrps") for name in (chip, "1x32"))
                speed_up = ours / base if ours and base else None
                papers = paper.mrps(scene, chip) / paper.mrps(scene, "1x32")
                row += [text(speed_up), text(papers), deviation(speed_up, papers)]
            if any(cell != "-" for cell in row[1::3]):
                rows.append(row)
        if rows:
            out.write(f"Speed-up from 1x32, program {program}: ours, the paper's, deviation\n\n")
            print_rows(["chip", *(word for _, title in COLUMNS for word in (title, "paper", "dev."))], rows, out)


def print_claims(index, paper, out):
    """Figures of the paper that are in its text."""
    published, rows = paper.published, []
    for program in index.programs("table2"):
        dragon = index.find("table2", program, "dragon", "4x32")
        runs = [index.find("table2", program, scene, "4x32") for scene, _ in COLUMNS]
        power = mean([stat(run, "energy.average_power") for run in runs])
        flops = mean([stat(run, "values.flops_per_ray") for run in runs])
        speed = stat(dragon, "mrps")
        for title, ours, papers in (
            ("dragon on 4x32 against MRTP scaled to 500 MHz, times", speed / published["mrtp_mrps_scaled"] if speed else None, published["mrtp_speedup"]),
            ("dragon on 4x32, frames of 1280x720 per second", stat(dragon, "values.frames_per_second"), published["frames_per_second"]),
            ("power of 4x32, W, average of the scenes (a lower bound: docs/emulator.md, Energy)", power, published["power_4x32_w"]),
            ("adds and multiplies per ray, average of the scenes", flops, published["flops_per_ray"]),
        ):
            rows.append([program, title, text(ours), text(papers), deviation(ours, papers)])
    if rows:
        print_rows(["program", "4x32", "ours", "paper", "dev."], rows, out)


def print_table2_and_text(index, paper, out):
    print_table2(index, paper, out)
    print_scaling(index, paper, out)
    print_claims(index, paper, out)


def print_scenes(index, paper, out):
    rows = []
    for run in index.runs:
        if "scenes" in run["experiments"]:
            ours, papers = stat(run, "mrps"), paper.mrps(run["scene"], run["config"])
            rows.append([run["scene"], f"{stat(run, 'cycles'):,}", f"{stat(run, 'rays'):,}", text(ours), text(papers), deviation(ours, papers),
                         *(text(stat(run, name)) for name in ("values.flops_per_ray", "values.bytes_per_ray", "memory.bandwidth_gbps")), text(run["host_seconds"])])
    print_rows(["scene", "cycles", "rays", "MRPS", "paper's", "deviation", "FLOPs/ray", "bytes/ray", "GB/s", "host s"], rows, out)


def print_lockstep(index, paper, out):
    """Of the issue slots of warps in lockstep, what their threads would use; and the most that any order of execution could."""
    out.write("Warps in lockstep: slots used (at most, whatever the order of execution); independent threads use all of theirs\n\n")
    widths = (2, 4, 8, 16, 32, 64)
    rows = [[run["program"], run["scene"], *(f"{stat(run, f'values.simd_utilisation.{width}'):.0%} ({stat(run, f'values.simd_bound.{width}'):.0%})" for width in widths)]
            for run in index.runs if "lockstep" in run["experiments"]]
    print_rows(["program", "scene", *(f"{width} wide" for width in widths)], rows, out)


RAY_COLUMNS = (("mrps", "MRPS", 3), ("bytes_per_ray", "bytes/ray", 3), ("energy_per_ray", "nJ/ray", 3))
RAY_SHARES = (("utilisation", "issued"), ("fetch", "fetch"), ("memory", "memory"), ("dcache", "d-cache"), ("units", "units"), ("rest", "other"))


def print_rays(index, sweep, out):
    """Rays by kind: a row for each workload, kind and machine, the mean of its scenes."""
    groups = {}
    for run in index.runs:
        if sweep["name"] in run["experiments"]:
            for kind in [name.split(".")[1] for name in run["values"] if re.fullmatch(r"rays\.\w+\.count", name)]:
                if run["values"][f"rays.{kind}.count"]:
                    groups.setdefault((run["workload"], kind, run["config"], *(f"{key} {json.dumps(value)}" for key, value in run["set"].items())), []).append(run)
    widths = [width for width in (4, 8, 16, 32) if any(f"rays.{key[1]}.lanes.{width}" in run["values"] for key, runs in groups.items() for run in runs)]
    out.write(f"{sweep['title']}: means of the scenes; shares are of the kind's thread-cycles; lanes: of a SIMD machine, for the same rays\n{sweep['claim']}\n\n")

    def of(runs, kind, name):
        return mean([stat(run, f"values.rays.{kind}.{name}") for run in runs])

    rows = []
    for (workload, kind, *machine), runs in groups.items():
        rows.append([workload or "paper", kind, " ".join(machine), *(text(of(runs, kind, name), digits) for name, _, digits in RAY_COLUMNS),
                     *(f"{share:.0%}" if (share := of(runs, kind, name)) is not None else "-" for name in [name for name, _ in RAY_SHARES] + [f"lanes.{width}" for width in widths])])
    print_rows(["workload", "kind", "chip", *(title for _, title, _ in RAY_COLUMNS), *(title for _, title in RAY_SHARES), *(f"{width} lanes" for width in widths)], rows, out)


PRINTERS = {"lockstep": print_lockstep, "table1": print_table1, "table2": print_table2_and_text, "table3": print_table3, "scenes": print_scenes}


def print_tables(results, names, paper, out):
    index = Index(results)
    for sweep in results["sweeps"]:
        if sweep["name"] in names:
            if any(sweep["name"] in run["experiments"] and any(name.startswith("rays.") for name in run["values"]) for run in index.runs):
                print_rays(index, sweep, out)
            elif sweep["name"] in PRINTERS:
                PRINTERS[sweep["name"]](index, paper, out)
            else:
                print_sweep(index, sweep, results, out)
