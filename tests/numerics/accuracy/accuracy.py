#!/usr/bin/env python3
"""The accuracy of the binary32 functions and their cost, for docs/results/functions.md.

    accuracy.py --measure        measures the functions that measured.csv lacks or that have changed, then does --update
                                 (trax-accuracy, half an hour on two cores from nothing)
    accuracy.py --update         writes the table of docs/results/functions.md from measured.csv, with cycles and bytes
                                 measured now (seconds)
    accuracy.py --check-page     exit status 1 if the table's errors are not those of measured.csv
    accuracy.py --check-sample   exit status 1 if a sample, the results or an error of a function contradict
                                 measured.csv

Cycles are those of cost.c on one TP with the latencies of the paper, and with caches that hold all. Bytes are those of
code and constants that a program gets by calling the function, compiled with -O2.
"""

import argparse
import concurrent.futures
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
import interrupts  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
MEASURED = HERE / "measured.csv"
PAGE = ROOT / "docs/results/functions.md"
BEGIN, END = "<!-- accuracy.py: begin -->\n", "<!-- accuracy.py: end -->\n"


SAMPLE = 1 << 20  # operands of each function


def run(command, text=""):
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, input=text.encode(), check=False)
    if done.returncode != 0:
        sys.exit(f"accuracy.py: {' '.join(map(str, command))} ended with status {done.returncode}")
    return done.stdout.decode()


def compile_tp(bin_directory, source, program):
    run([bin_directory / "clang", "--target=trax", "-std=gnu17", "-O2", source, "-o", program])


def cycles(bin_directory, scratch):
    """{function: (least, mean, greatest)}"""
    program = scratch / "cost.elf"
    compile_tp(bin_directory, HERE / "cost.c", program)
    text = run([bin_directory / "trax-sim", "--set", "icache.bytes=1048576", "--set", "dcache.bytes=1048576", program])
    return {line.split()[0]: line.split()[1:] for line in text.splitlines()}


def bytes_of(bin_directory, scratch, name):
    """The code and constants of a program that refers to the function; of one without it if the name is empty."""
    source, program = scratch / f"size_{name}.c", scratch / f"size_{name}.elf"
    if name == "trax_rsqrt":
        body = "float root(float x) { return trax_rsqrt(x); }\nvoid *volatile p = (void *)root;\n"
    else:
        body = f"void *volatile p = {f'(void *){name}' if name else '0'};\n"
    source.write_text("#include <math.h>\n#include <trax.h>\n" + body + "int main(void) { return p != 0; }\n")
    compile_tp(bin_directory, source, program)
    sections = re.findall(r"^(\.\S+)\s+(\d+)\s+(\d+)", run(["llvm-size-19", "-A", program]), re.MULTILINE)
    return sum(int(size) for section, size, _ in sections if section.startswith((".text", ".rodata")))


def sizes(bin_directory, scratch, names):
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        empty, *rest = pool.map(lambda name: bytes_of(bin_directory, scratch, name), ["", *names])
    return {name: size - empty for name, size in zip(names, rest)}


def measured_rows():
    with open(MEASURED, encoding="ascii") as file:
        return list(csv.DictReader(file))


def share(part, whole):
    if part == 0:
        return "0"
    percent = 100 * part / whole
    return f"{percent:.2g} %" if percent < 10 else f"{percent:.0f} %"


def measured_columns(row):
    """Returns a line of the table up to cycles and bytes."""
    count = int(row["operands"])
    at = ", ".join(f"{int(word, 16):08X}" for word in row["at"].split())
    tried = "all" if count == 2**32 else f"2^{count.bit_length() - 1}"
    return (
        f"| `{row['function']}` | {tried} | {float(row['max_ulp']):.4f} | {at} | "
        f"{share(int(row['not_rounded_correctly']), count)} | "
        f"{row['beyond_1_ulp']} | {row['wrong_special_values']} | {row['wrong_order']} |")


def update(options):
    rows = measured_rows()
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        cost = cycles(options.bin, scratch)
        size = sizes(options.bin, scratch, [row["function"] for row in rows])
    lines = [
        "| function | operands | greatest error, ulp | at | not rounded correctly | beyond 1 ulp | wrong special "
        "values | wrong order | "
        "cycles: least, mean, greatest | bytes |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for row in rows:
        least, mean, greatest = cost[row["function"]]
        same = least == greatest
        lines.append(
            f"{measured_columns(row)} {least if same else f'{least}, {float(mean):.0f}, {greatest}'} | "
            f"{size[row['function']]:,} |"
        )
    page = PAGE.read_text(encoding="utf-8")
    if BEGIN not in page or END not in page:
        sys.exit(f"accuracy.py: {PAGE}: the marks of the table are missing")
    before, rest = page.split(BEGIN)
    new = PAGE.with_name(PAGE.name + ".new")
    new.write_text(before + BEGIN + "\n".join(lines) + "\n" + END + rest.split(END)[1], encoding="utf-8")
    new.rename(PAGE)


def accuracy(options, *arguments, text=""):
    return run([options.bin / "../tests/bin/trax-accuracy", *arguments], text)


def measure(options):
    """Measures the functions whose rows are missing or do not hold. Writes each row when it is there."""
    rows = {row["function"]: row for row in measured_rows()} if MEASURED.exists() else {}
    current = [line.split(",") for line in accuracy(options, "--results").splitlines()]
    for name, count, results in current:
        if name not in rows or (rows[name]["operands"], rows[name]["results"]) != (count, results):
            row, = csv.DictReader(accuracy(options, "--whole", name).splitlines())
            rows[name] = row
            new = MEASURED.with_name(MEASURED.name + ".new")
            with open(new, "w", encoding="ascii") as file:
                writer = csv.DictWriter(file, row, lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows[name] for name, _, _ in current if name in rows)
            new.rename(MEASURED)


def check_sample(options):
    rows = measured_rows()
    samples = {row["function"]: row
               for row in csv.DictReader(accuracy(options, "--sample", SAMPLE).splitlines())}
    places = [row for row in rows if row["at"]]
    errors = accuracy(options, "--errors", text="".join(f"{row['function']} {row['at']}\n" for row in places))
    there = dict(zip((row["function"] for row in places), errors.split()))
    wrong = [f"{name}: has no row" for name in samples if name not in {row["function"] for row in rows}]
    for row in rows:
        name = row["function"]
        sample = samples[name]
        greater = float(sample["max_ulp"]) > float(row["max_ulp"])
        wrong += [f"{name}: {what}" for what, is_wrong in (
            (f"an error of {sample['max_ulp']} at {sample['at']}", greater),
            ("more wrong special values", int(sample["wrong_special_values"]) > int(row["wrong_special_values"])),
            ("more neighbours in wrong order", int(sample["wrong_order"]) > int(row["wrong_order"])),
            ("another error at the recorded operand", there.get(name, row["max_ulp"]) != row["max_ulp"]),
            ("other results: run accuracy.py --measure", sample["results"] != row["results"])) if is_wrong]
    print("\n".join(wrong) or f"{len(rows)} functions agree with measured.csv")
    sys.exit(bool(wrong))


def check_page():
    page = PAGE.read_text(encoding="utf-8")
    table = page[page.index(BEGIN) : page.index(END)]
    missing = [row["function"] for row in measured_rows() if measured_columns(row) not in table]
    if missing or table.count("\n| `") != len(measured_rows()):
        sys.exit(
            f"accuracy.py: docs/results/functions.md differs from measured.csv for "
            f"{' '.join(missing) or 'some functions'}: run accuracy.py --update"
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    what = parser.add_mutually_exclusive_group(required=True)
    for name, text in (("--measure", "measure what is missing, then --update"),
                       ("--update", "write the table of docs/results/functions.md"),
                       ("--check-page", "compare the table with measured.csv"),
                       ("--check-sample", "compare the functions with measured.csv")):
        what.add_argument(name, action="store_true", help=text)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    options = parser.parse_args()
    interrupts.end_by_signals()
    if options.check_sample:
        check_sample(options)
    if options.check_page:
        check_page()
        return
    if options.measure:
        measure(options)
    update(options)


main()
