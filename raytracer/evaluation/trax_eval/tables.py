"""The tables as text: our figures beside the paper's, with their deviation and what they took."""

import math

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
    value = (run or {}).get("values" if name.startswith("values.") else "stats")
    for part in name.removeprefix("values.").split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return value


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
    """Any sweep: a row for each value, a column for each scene."""
    runs = [run for run in results["runs"] if sweep["name"] in run["experiments"]]
    scenes = list(dict.fromkeys(run["scene"] for run in runs))
    rows = {}
    for run in runs:
        settings = ", ".join(f"{key} {value}" for key, value in run["set"].items())
        rows.setdefault((run["program"], run["config"], settings), {})[run["scene"]] = run
    out.write(f"{sweep['title']}: {sweep['y']}\n{sweep['claim']}\n\n")
    print_rows(["program", "chip", "set", *scenes, "host s"],
               [[program, chip, settings or "-", *(text(stat(some.get(scene), sweep["y"])) + interval(some.get(scene)) for scene in scenes),
                 text(sum(run.get("host_seconds") or 0 for run in some.values()))] for (program, chip, settings), some in rows.items()], out)


PRINTERS = {"table2": print_table2}


def print_tables(results, names, paper, out):
    index = Index(results)
    for sweep in results["sweeps"]:
        if sweep["name"] in names:
            if sweep["name"] in PRINTERS:
                PRINTERS[sweep["name"]](index, paper, out)
            else:
                print_sweep(index, sweep, results, out)
