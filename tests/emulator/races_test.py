#!/usr/bin/env python3
"""races_test.py BUILD_BIN SOURCE: trax-sim --check-races.

A generated program has pairs of accesses by two threads, unordered and ordered, to the same bytes and to neighbours:
the words in the report must be exactly the racy ones. Programs whose threads order what they share give nothing; the
same ones with relaxed orders are reported.
"""

import itertools
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
RACE = "trax-sim: race: nothing orders two accesses to the same word\n"


def build(scratch, source, *flags):
    program = scratch / "program.elf"
    clang = BIN / ("clang++" if source.suffix == ".cpp" else "clang")
    subprocess.run([clang, "--target=trax", "-O2", "-g", "-w", *flags, source, "-o", program], check=True)
    return program


def run(program, tms, tps, *options):
    command = [BIN / "trax-sim", "--quiet", "--check-races", "--max-cycles", "20000000", "--set", f"chip.tms={tms}",
               "--set", f"chip.tps_per_tm={tps}", *options, program]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def pairs(scratch):
    """Thread 0 makes the first access of each pair, the other thread the second one, at any time or after a message."""
    objects, first, second, racy = "", {}, {}, set()
    kinds = {"load": "sink = {};", "store": "{} = 1;"}
    for order in ("none", "message", "lock", "increment", "no_release", "no_acquire"):
        first[order], second[order] = [], []
        for number, (type, one, other, apart) in enumerate(itertools.product(
                ("char", "short", "int"), kinds, kinds, (False, True))):
            name = f"{order}_{number}"
            if type == "int" and apart:
                continue
            objects += f"volatile {type} {name}[4] __attribute__((aligned(16)));\n"
            first[order].append(kinds[one].format(f"{name}[0]"))
            second[order].append(kinds[other].format(f"{name}[{int(apart)}]"))
            if order.startswith("no") and "store" in (one, other) and not apart:
                racy.add(name)
    body = {order: (" ".join(first[order]), " ".join(second[order])) for order in first}
    text = f"""#include <stdatomic.h>
#include <trax.h>
static _Thread_local volatile int sink;
static _Atomic unsigned flags[4], next, serving;
{objects}
static void say(unsigned i, memory_order order) {{ atomic_store_explicit(&flags[i], 1, order); }}
static void hear(unsigned i, memory_order order) {{ while (!atomic_load_explicit(&flags[i], order)); }}
static void enter(unsigned ticket) {{
  atomic_fetch_add_explicit(&next, 1, memory_order_relaxed);
  while (atomic_load_explicit(&serving, memory_order_acquire) != ticket);
}}
static void leave(void) {{ atomic_store_explicit(&serving, serving + 1, memory_order_release); }}
int main(void) {{
  if (trax_thread() == 0) {{
    {body["none"][0]}
    {body["message"][0]} say(0, memory_order_release);
    enter(0); {body["lock"][0]} leave();
    {body["increment"][0]} atomic_fetch_add_explicit(&flags[1], 1, memory_order_release);
    {body["no_release"][0]} say(2, memory_order_relaxed);
    {body["no_acquire"][0]} say(3, memory_order_release);
  }} else {{
    {body["none"][1]}
    hear(0, memory_order_acquire); {body["message"][1]}
    enter(1); {body["lock"][1]} leave();
    while (atomic_fetch_add_explicit(&flags[1], 1, memory_order_acquire) == 0); {body["increment"][1]}
    hear(2, memory_order_acquire); {body["no_release"][1]}
    hear(3, memory_order_relaxed); {body["no_acquire"][1]}
  }}
}}
"""
    # A later fence orders what is before it in both threads, so the last two groups stand behind all others.
    source = scratch / "pairs.c"
    source.write_text(text)
    program = build(scratch, source)
    reports = {}
    for engine in ("fast", "reference"):
        for tms, tps in ((2, 1), (1, 2)):
            result = run(program, tms, tps, "--engine", engine)
            reports[engine, tms] = result.stderr
            found = set(re.findall(r"^  word +0x[0-9a-f]+ \(([a-z_0-9]+)[+)]", result.stderr, re.M))
            check(result.returncode == 1 and result.stderr.count(RACE) >= len(racy), engine, tms, result.stderr[-300:])
            check(found == racy, engine, tms, "too many", sorted(found - racy), "missing", sorted(racy - found))
    check(reports["fast", 2] == reports["reference", 2] and reports["fast", 1] == reports["reference", 1], "engines")


def message(scratch):
    """A report has both lines and both threads."""
    source = SOURCE / "tests/emulator/order/message.c"
    lines = source.read_text().splitlines()
    program = build(scratch, source, "-DRELEASE=memory_order_relaxed", "-DACQUIRE=memory_order_acquire")
    error = run(program, 2, 1).stderr
    loads, stores = (next(i + 1 for i, line in enumerate(lines) if f"/* {what} */" in line)
                     for what in ("loads", "stores"))
    expected = (rf"{RACE}  word +0x[0-9a-f]+ \(data\+0x4\), cycle \d+\n"
                rf"  first +store by thread 0 \(TM 0, TP 0\)\n  in +tell\+0x[0-9a-f]+ at \S*message.c:{stores}:\d+\n"
                rf"  second +load by thread 1 \(TM 1, TP 0\)\n  in +listen\+0x[0-9a-f]+ at \S*message.c:{loads}:\d+\n"
                r"trax-sim: error: the program has 1 race \(--check-races\)\n")
    check(re.fullmatch(expected, error), error)


def programs(scratch):
    for name in ("lock", "double_checked", "reference_counting", "barrier"):
        source = SOURCE / f"tests/litmus/{name}.c"
        right = run(build(scratch, source, "-DRUNS=20"), 2, 4)
        check(right.returncode == 0 and not right.stderr, name, right.stderr)
        relaxed = run(build(scratch, source, "-DRUNS=20", "-DRELAXED"), 2, 4)
        check(relaxed.returncode == 1 and RACE in relaxed.stderr, name, "relaxed", relaxed.stderr)
    for name in ("threads.c", "heap_threads.c", "atomic_mixed.c", "parallel.c", "cxx_mutex.cpp"):
        flags = ["-mstack=global", "-std=c++20"] if name.endswith(".cpp") else []
        options = ["--main-on", "0"] if name == "parallel.c" else []
        result = run(build(scratch, SOURCE / "tests/c" / name, *flags), 2, 8, *options)
        check(result.returncode == 0 and not result.stderr, name, result.returncode, result.stderr)


def main():
    for test in (pairs, message, programs):
        with tempfile.TemporaryDirectory() as scratch:
            test(pathlib.Path(scratch))
    return checking.failures != 0


if __name__ == "__main__":
    sys.exit(main())
