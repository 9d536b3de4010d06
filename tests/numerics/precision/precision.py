#!/usr/bin/env python3
"""What a less precise FPDIV/iSQRT unit costs in accuracy and saves in time, for each special.precision_bits from 1 to
24.

    precision.py --output DIR [--scenes DIR]     the whole report: DIR/precision.csv, precision.md and precision.png;
                                                 some minutes
    precision.py --page docs/results/precision.md --output DIR     puts the tables and the plot of such a report into
    the page
    precision.py --check                         a short run that must end, and end with what holds at every precision

For each precision b: the errors of frsqrt and fdiv themselves (precision-units), of the library's sqrtf and of
normalised vectors (loops.c on the emulator), and of pictures of the ray tracer against those of b = 24, with its
cycles; once at the latency of a unit that produces four bits a cycle, once at that of a unit that multiplies:

    digits   four bits a cycle
    newton   a table and Newton's iteration

units.c defines both, and both give the paper's 8 cycles for 24 bits. The bunny of
Debian's glmark2-data is rendered, and conference if --scenes is given.
"""

import argparse
import array
import csv
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
import png_files  # noqa: E402

BUNNY = "/usr/share/glmark2/models/bunny.obj"
BEGIN, END = "<!-- precision.py: begin -->\n", "<!-- precision.py: end -->\n"
COUNT = 4096  # results of a loop of loops.c
WRONG = 8  # of 255: a pixel whose colour is off by more is called wrong
TIME_LIMIT = 600  # seconds for one run on the emulator


def fail(text):
    sys.exit(f"precision.py: {text}")


MODELS = ("digits", "newton")
LATENCIES = {}  # {(model, bits): cycles}, from precision-units


def run(command):
    try:
        done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL,
                              timeout=TIME_LIMIT, check=False)
    except subprocess.TimeoutExpired:
        fail(f"{' '.join(map(str, command))} did not end in {TIME_LIMIT} s")
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))} ended with status {done.returncode}")
    return done.stdout.decode()


def unit_errors(bin_directory, stride):
    """{(operation, bits): {column: number}}; LATENCIES is filled too."""
    rows = list(csv.DictReader(run([bin_directory / "../tests/bin/precision-units", stride]).splitlines()))
    LATENCIES.update({(model, int(r["bits"])): int(r[model]) for r in rows for model in MODELS})
    return {(r["operation"], int(r["bits"])): {k: float(v) for k,
                                               v in r.items() if k not in ("operation", *MODELS)} for r in rows}


def special(bits, model):
    return ["--set", f"special.precision_bits={bits}", "--set", f"special.latency_cycles={LATENCIES[model, bits]}"]


def draw_state(state):
    return (state * 1664525 + 1013904223) & 0xFFFFFFFF


def to_float(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def loop_operands():
    """The first operand of each set that loops.c draws, as it computes it in binary32."""
    state, out = 1, []
    for _ in range(COUNT):
        state = draw_state(state)
        out.append(to_float(1 + to_float(3 * ((state >> 8) * 2.0**-24))))
        state = draw_state(draw_state(state))
    return out


def loops(bin_directory, program, bits, model, scratch):
    dump = scratch / "results"
    text = run([bin_directory / "trax-sim", *special(bits, model), "--alloc", f"results={3 * COUNT * 4}", "--dump",
                f"results={dump}", program])
    sqrt_cycles, normalise_cycles, divide_cycles, others = text.split()
    values = array.array("f", dump.read_bytes())
    error = max(abs(s - math.sqrt(x)) / 2.0 ** (math.frexp(math.sqrt(x))[1] - 24) for s,
                x in zip(values, loop_operands()))
    length = max(abs(math.sqrt(v) - 1) for v in values[COUNT : 2 * COUNT])
    return {"sqrtf_cycles": int(sqrt_cycles) / COUNT, "normalise_cycles": int(normalise_cycles) / COUNT,
            "divide_cycles": int(divide_cycles) / COUNT, "sqrtf_max_ulp": error, "length_error": length,
            "others": others}


def render(bin_directory, meshes, bits, model, size, chip, scratch):
    """Statistics of a rendering, and the picture's file."""
    picture, stats = scratch / f"{bits}.png", scratch / "stats.json"
    run([bin_directory / "trax-render", *meshes, "--config", chip, *special(bits, model), "--size", size, "--quiet",
         "--stats", stats,
         "-o", picture])
    return json.loads(stats.read_text()), picture


def read_png(path):
    """The pixels of a picture, as tuples of three."""
    width, _, rows = png_files.read_png(pathlib.Path(path).read_bytes())
    return [tuple(row[i:i + 3]) for row in rows for i in range(0, len(row), len(row) // width)]


BACKGROUND = (0x98, 0xA8, 0xB8)  # trax-render's


def compare(exact, other):
    """What is wrong with the other picture."""
    square = sum((a - b) ** 2 for p, q in zip(exact, other) for a, b in zip(p, q))
    holes = sum(q == BACKGROUND != p for p, q in zip(exact, other))
    grown = sum(p == BACKGROUND != q for p, q in zip(exact, other))
    both = [(sum(p), sum(q), max(abs(a - b) for a, b in zip(p, q))) for p,
            q in zip(exact, other) if BACKGROUND not in (p, q)]
    dark = sum(q < p and most > WRONG for p, q, most in both)
    bright = sum(q > p and most > WRONG for p, q, most in both)
    return {"rmse": math.sqrt(square / (3 * len(exact))), "holes": holes, "grown": grown, "dark": dark,
            "bright": bright,
            "wrong_percent": 100 * (holes + grown + dark + bright) / len(exact)}


SCENES = ("bunny", "conference")


def scenes(options):
    """{name: arguments of trax-render}"""
    found = {}
    if pathlib.Path(BUNNY).exists():
        found["bunny"] = [BUNNY, "--view", "bunny"]
    if options.scenes:
        path = options.scenes / "conference.ply.xz"
        if not path.exists():
            fail(f"{path} is not there")
        found["conference"] = [path, "--view", "conference"]
    if not found:
        fail(f"neither {BUNNY} (Debian's glmark2-data) nor --scenes")
    return found


def pack_scenes(found, bin_directory, scratch):
    """The same with the scene files made once."""
    packed = {}
    for name, (mesh, *view) in found.items():
        run([bin_directory / "trax-scene", mesh, "-o", scratch / f"{name}.trax"])
        packed[name] = [scratch / f"{name}.trax", *view]
    return packed


def measure(options, scratch):
    units = unit_errors(options.bin, 1)
    program = scratch / "loops.elf"
    run([options.bin / "clang", "--target=trax", "-std=gnu17", "-O2", HERE / "loops.c", "-o", program])
    packed = pack_scenes(scenes(options), options.bin, scratch)
    start, done, steps = time.monotonic(), 0, 24 * (1 + 2 * len(packed))
    rows, exact, others = [], {}, None
    for bits in range(24, 0, -1):
        row = {"bits": bits, "digits_latency": LATENCIES["digits", bits], "newton_latency": LATENCIES["newton", bits]}
        for operation in ("frsqrt", "fdiv"):
            for column, value in units[operation, bits].items():
                if column != "bits":
                    row[f"{operation}_{column}"] = value
        figures = loops(options.bin, program, bits, "digits", scratch)
        others = others or figures["others"]
        if figures.pop("others") != others:
            fail(f"at {bits} bits functions give other results that should not depend on the precision")
        row |= figures
        done += 1
        for name, arguments in packed.items():
            for model in MODELS:
                stats, picture = render(options.bin, arguments, bits, model, options.size, options.config, scratch)
                row[f"{name}_{model}_cycles"] = stats["cycles"]
                if model == "digits":
                    pixels = read_png(picture)
                    exact.setdefault(name, pixels)
                    row |= {f"{name}_{k}": v for k, v in compare(exact[name], pixels).items()}
                    row[f"{name}_unit_use"] = stats["special"]["utilisation"]
                    row[f"{name}_unit_stalls"] = (stats["causes"]["special_conflict"] +
                                                  stats["causes"]["wait_special"]) / stats["thread_cycles"]
                done += 1
                if sys.stderr.isatty():
                    left = (time.monotonic() - start) * (steps / done - 1)
                    print(f"\r{bits:2} bits, {name:12} {100 * done / steps:3.0f} %, {left:4.0f} s left ", end="",
                          file=sys.stderr)
        rows.append(row)
    if sys.stderr.isatty():
        print("\r" + " " * 60 + "\r", end="", file=sys.stderr)
    return rows


def tables(rows, options):
    """The report's tables, as Markdown."""
    lines = [
        "| b | frsqrt: greatest, mean ulp | relative | fdiv: greatest, mean ulp | relative | `sqrtf`, ulp | \\|v\\| - "
        "1 |",
        "| --- | --- | --- | --- | --- | --- | --- |"]
    for r in rows:
        lines.append(
            f"| {r['bits']} | {r['frsqrt_max_ulp']:.7g}, {r['frsqrt_mean_ulp']:.4g} | "
            f"2^{math.log2(r['frsqrt_max_relative']):.1f} | "
            f"{r['fdiv_max_ulp']:.7g}, {r['fdiv_mean_ulp']:.4g} | 2^{math.log2(r['fdiv_max_relative']):.1f} | "
            f"{r['sqrtf_max_ulp']:.3g} | {r['length_error']:.2g} |")
    for name in SCENES:
        if f"{name}_rmse" not in rows[0]:
            continue
        lines += [
            "", f"{name}, {options.size}, {options.config}; cycles against those of b = 24:", "",
            "| b | latency: digits, newton | cycles: digits, newton | RMSE of 255 | wrong pixels | holes | grown | "
            "dark | bright | unit in use | its stalls |",
            "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
        for r in rows:
            change = [
                f"{r[f'{name}_{m}_cycles'] / rows[0][f'{name}_{m}_cycles'] - 1:+.1%}"
                if r["bits"] < 24 else f"{r[f'{name}_{m}_cycles']:,}" for m in MODELS]
            lines.append(
                f"| {r['bits']} | {r['digits_latency']}, {r['newton_latency']} | {', '.join(change)} | "
                f"{r[f'{name}_rmse']:.2f} | "
                f"{r[f'{name}_wrong_percent']:.2f} % | {r[f'{name}_holes']} | {r[f'{name}_grown']} | "
                f"{r[f'{name}_dark']} | "
                f"{r[f'{name}_bright']} | {r[f'{name}_unit_use']:.0%} | {r[f'{name}_unit_stalls']:.1%} |")
    return "\n".join(lines) + "\n"


def plot(rows, output):
    """The plot by gnuplot: errors to the left, run time to the right, over b."""
    names = [n for n in SCENES if f"{n}_rmse" in rows[0]]
    data = "\n".join(" ".join(
        str(v) for v in [r["bits"], r["frsqrt_max_ulp"], r["fdiv_max_ulp"]] + [
            x for n in names
            for x in (max(r[f"{n}_rmse"], 1e-3), 100 * r[f"{n}_digits_cycles"] / rows[0][f"{n}_digits_cycles"],
                      100 * r[f"{n}_newton_cycles"] / rows[0][f"{n}_newton_cycles"])]) for r in rows)
    curves = ["$d using 1:2 with linespoints noenhanced title 'frsqrt, ulp'",
              "$d using 1:3 with linespoints title 'fdiv, ulp'"]
    for i, n in enumerate(names):
        curves += [f"$d using 1:{4 + 3 * i} with linespoints title '{n}: RMSE of 255'",
                   f"$d using 1:{5 + 3 * i} axes x1y2 with lines dashtype 2 title '{n}: cycles, digits'",
                   f"$d using 1:{6 + 3 * i} axes x1y2 with lines dashtype 3 title '{n}: cycles, newton'"]
    script = f"""set terminal pngcairo size 900,520 enhanced
set output '{output}.new'
set logscale y
set format y '10^{{%L}}'
set xlabel 'bits of the special unit'
set ylabel 'greatest error'
set y2label 'cycles, % of those at 24 bits'
set xrange [1:24]
set xtics 1,1,24
set ytics nomirror
set y2tics
set key outside below
$d << EOD
{data}
EOD
plot {', '.join(curves)}
"""
    subprocess.run(["gnuplot"], input=script.encode(), check=True)
    pathlib.Path(f"{output}.new").rename(output)


def write(path, text):
    new = path.with_name(path.name + ".new")
    new.write_text(text)
    new.rename(path)


def report(options):
    if not shutil.which("gnuplot"):
        fail("gnuplot is missing: install Debian's gnuplot-nox")
    options.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        rows = measure(options, pathlib.Path(folder))
    lines = [",".join(rows[0])] + [
        ",".join(f"{v:.9g}" if isinstance(v, float) else str(v) for v in r.values()) for r in rows]
    write(options.output / "precision.csv", "\n".join(lines) + "\n")
    write(options.output / "precision.md", tables(rows, options))
    plot(rows, options.output / "precision.png")


def into_page(options):
    """The tables between the page's marks, and the plot beside it."""
    text = options.page.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        fail(f"{options.page}: the marks of the tables are missing")
    tables_text = (options.output / "precision.md").read_text(encoding="utf-8")
    write(options.page, text.split(BEGIN)[0] + BEGIN + tables_text + END + text.split(END)[1])
    shutil.copyfile(options.output / "precision.png", options.page.parent / "precision.png")


def check(options):
    """At every precision: the units round to b bits, sqrtf is as good as them, and the ray tracer ends."""
    units = unit_errors(options.bin, 101)
    for (operation, bits), error in units.items():
        # Half of the last place of b bits, after half of that of 24.
        bound = 0.5 if bits == 24 else 2 ** (23 - bits) + 0.5
        if not bound * 0.9 < error["max_ulp"] <= bound:
            fail(f"{operation} at {bits} bits is {error['max_ulp']} units off, not {bound}")
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        program = scratch / "loops.elf"
        run([options.bin / "clang", "--target=trax", "-std=gnu17", "-O2", HERE / "loops.c", "-o", program])
        others = None
        for bits in (24, 23, 16, 12, 8, 4, 3, 2, 1):
            figures = loops(options.bin, program, bits, "digits", scratch)
            others = others or figures["others"]
            if figures["others"] != others:
                fail(f"at {bits} bits functions give other results that should not depend on the precision")
            bound = 0.5 if bits == 24 else 2 ** (24 - bits) + 1  # a root is up to twice the reciprocal's last place
            if figures["sqrtf_max_ulp"] > bound:
                fail(f"sqrtf at {bits} bits is {figures['sqrtf_max_ulp']} units off, more than {bound}")
            if figures["length_error"] > 2.0**-bits + 2.0**-22:
                fail(f"normalised vectors at {bits} bits are {figures['length_error']} too long or short")
        box = HERE.parents[1] / "render"
        for bits in (24, 12, 6, 3, 2, 1):
            stats, picture = render(options.bin, [box / "box.obj", "--view", box / "box.view"], bits, "digits", "48x27",
                                    "1x32", scratch)
            if stats["items"] != 48 * 27:
                fail(f"the ray tracer at {bits} bits rendered {stats['items']} pixels")
            print(
                f"{bits:2} bits: {stats['cycles']} cycles, "
                f"{compare(read_png(scratch / '24.png'), read_png(picture))['wrong_percent']:.2f} % of the pixels wrong"
            )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("--scenes", type=pathlib.Path, help="the directory of conference.ply.xz")
    parser.add_argument("--page", type=pathlib.Path, help="put the report in --output into this page")
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--config", default="4x32")
    parser.add_argument("--bin", type=pathlib.Path, default=HERE.parents[2] / "build/bin")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.check == bool(options.output):
        parser.error("give either --output or --check")
    if options.check:
        check(options)
    elif options.page:
        into_page(options)
    else:
        report(options)


main()
