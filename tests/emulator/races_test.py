#!/usr/bin/env python3
"""races_test.py BUILD_BIN SOURCE: trax-sim --check-races.

A generated program has pairs of accesses by two threads, unordered and ordered, to the same bytes and to neighbours:
the words in the report must be exactly the racy ones. Programs whose threads order what they share give nothing, as the
ray tracer; the same ones with relaxed orders are reported.
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
OWN = SOURCE / "tests/emulator/races"
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


def orders(release="release", acquire="acquire"):
    return f"-DRELEASE=memory_order_{release}", f"-DACQUIRE=memory_order_{acquire}"


def pairs(scratch):
    """Thread 0 makes the first access of each pair, the other thread the second one, at any time or after a message."""
    objects, first, second, racy = "", {}, {}, set()
    kinds = {"load": "sink = {};", "store": "{} = 1;"}
    for order in ("none", "message", "lock", "byte", "increment", "no_release", "no_acquire"):
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
static volatile _Atomic unsigned char bytes[4] __attribute__((aligned(4)));
{objects}
static void say(unsigned i, memory_order order) {{ atomic_store_explicit(&flags[i], 1, order); }}
static void hear(unsigned i, memory_order order) {{ while (!atomic_load_explicit(&flags[i], order)); }}
static void hear_byte(void) {{
  for (volatile int i = 0; i < 1000; i++); /* thread 0 has stored bytes[0] by then */
  atomic_store_explicit(&bytes[1], 1, memory_order_relaxed);
  while (!atomic_load_explicit(&bytes[0], memory_order_acquire));
}}
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
    {body["byte"][0]} atomic_store_explicit(&bytes[0], 1, memory_order_release);
    {body["increment"][0]} atomic_fetch_add_explicit(&flags[1], 1, memory_order_release);
    {body["no_release"][0]} say(2, memory_order_relaxed);
    {body["no_acquire"][0]} say(3, memory_order_release);
  }} else {{
    {body["none"][1]}
    hear(0, memory_order_acquire); {body["message"][1]}
    enter(1); {body["lock"][1]} leave();
    hear_byte(); {body["byte"][1]}
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
    source = OWN / "message.c"
    lines = source.read_text().splitlines()
    error = run(build(scratch, source, *orders("relaxed", "acquire")), 2, 1).stderr
    loads, stores = (next(i + 1 for i, line in enumerate(lines) if f"/* {what} */" in line)
                     for what in ("loads", "stores"))
    expected = (rf"{RACE}  word +0x[0-9a-f]+ \(data\+0x4\), cycle \d+\n"
                rf"  first +store by thread 0 \(TM 0, TP 0\)\n  in +tell\+0x[0-9a-f]+ at \S*message.c:{stores}:\d+\n"
                rf"  second +load by thread 1 \(TM 1, TP 0\)\n  in +listen\+0x[0-9a-f]+ at \S*message.c:{loads}:\d+\n"
                r"trax-sim: error: the program has 1 race \(--check-races\)\n")
    check(re.fullmatch(expected, error), error)
    check(not run(build(scratch, source, *orders()), 2, 1).stderr, "in order")
    for what, flags, place in (("no acquire", orders("release", "relaxed"), "data+0x4"),
                               ("plain flag", (*orders(), "-DPLAIN"), "flag")):
        error = run(build(scratch, source, *flags), 2, 1).stderr
        check(RACE in error and f"({place})" in error, what, error)


def locks(scratch):
    source = OWN / "lock.c"
    check(not run(build(scratch, source, *orders()), 2, 3).stderr, "lock")
    for kinds in (("relaxed", "acquire"), ("release", "relaxed"), ("relaxed", "relaxed")):
        error = run(build(scratch, source, *orders(*kinds)), 2, 3).stderr
        check(RACE in error and "(count)" in error, "lock", kinds, error)
    neighbours = run(build(scratch, OWN / "neighbours.c"), 4, 1)
    check(neighbours.returncode == 0 and not neighbours.stderr, "neighbours", neighbours.stderr)


def counted(scratch):
    """The compiler keeps loops of loads past the cache (llvm-target/TraxNontemporal.cpp)."""
    right = run(build(scratch, OWN / "counted.c"), 4, 1)
    check(right.returncode == 0 and not right.stderr, "counted", right.stderr)
    check("(parts" in run(build(scratch, OWN / "counted.c", "-DPLAIN"), 4, 1).stderr, "counted, through the cache")


def mixed(scratch):
    """Words that atomic and plain accesses share: only a plain load after a store is a race."""
    cases = {"increment_load": ("trax_atomic_inc(&X);", "sink = *(volatile unsigned *)&X;"),
             "store_load": ("trax_store_nt(&X, 1);", "sink = *(volatile unsigned *)&X;"),
             "load_increment": ("sink = *(volatile unsigned *)&X;", "trax_atomic_inc(&X);"),
             "store_store": ("*(volatile unsigned *)&X = 1;", "trax_store_nt(&X, 1);"),
             "atomic_load": ("trax_atomic_inc(&X);", "sink = trax_load_nt(&X);")}
    source = scratch / "mixed.c"
    source.write_text("#include <trax.h>\nstatic _Thread_local volatile unsigned sink;\n" + "".join(
        f"unsigned {name} __attribute__((aligned(16)));\n" for name in cases) + f"""int main(void) {{
  if (trax_thread() == 0) {{ {" ".join(one.replace("X", name) for name, (one, _) in cases.items())} }}
  else {{
    for (volatile int i = 0; i < 500; i++);
    {" ".join(other.replace("X", name) for name, (_, other) in cases.items())}
  }}
}}
""")
    result = run(build(scratch, source), 2, 1)
    found = set(re.findall(r"^  word +0x[0-9a-f]+ \((\w+)\)", result.stderr, re.M))
    check(found == {"increment_load", "store_load"}, "mixed", found, result.stderr)


def programs(scratch):
    for name in ("lock", "exchange_lock", "double_checked", "reference_counting", "barrier"):
        source = SOURCE / f"tests/litmus/{name}.c"
        right = run(build(scratch, source, "-DRUNS=20"), 2, 4)
        check(right.returncode == 0 and not right.stderr, name, right.stderr)
        relaxed = run(build(scratch, source, "-DRUNS=20", "-DRELAXED"), 2, 4)
        check(relaxed.returncode == 1 and RACE in relaxed.stderr, name, "relaxed", relaxed.stderr)
    for name in ("threads.c", "atomic_mixed.c", "atomic_announce.c", "thread_local_values.c",
                 "parallel.c", "cxx_mutex.cpp"):
        flags = ["-mstack=global", "-std=c++20"] if name.endswith(".cpp") else []
        options = ["--main-on", "0"] if name == "parallel.c" else []
        result = run(build(scratch, SOURCE / "tests/c" / name, *flags), 2, 8, *options)
        check(result.returncode == 0 and not result.stderr, name, result.returncode, result.stderr)


def releases(scratch):
    """Words that a thread stores after fences take no memory for each thread of the chip."""
    source = scratch / "releases.c"
    source.write_text("""#include <trax.h>
static volatile unsigned words[100000];
int main(void) {
  if (trax_thread() == 0)
    for (unsigned i = 0; i < 100000; i++) { __atomic_thread_fence(__ATOMIC_RELEASE); words[i] = i; }
}
""")
    status, error, memory = checking.run_measured([BIN / "trax-sim", "--quiet", "--check-races", "--config", "8x64",
                                                   build(scratch, source)])
    check(status == 0 and not error and memory < 150e6, "releases", status, error, memory)


def picture(scratch):
    subprocess.run([BIN / "trax-render", SOURCE / "tests/render/box.obj", "--size", "40x24", "--config", "2x32",
                    "--quiet", "--prepare", scratch], check=True)
    result = subprocess.run([BIN / "trax-sim", "--quiet", "--check-races", scratch / "manifest.json"],
                            capture_output=True, text=True, timeout=600)
    check(result.returncode == 0 and not result.stderr, "ray tracer", result.stderr)


def refused(scratch):
    result = run(build(scratch, OWN / "neighbours.c"), 1, 1, "--engine", "functional")
    check(result.returncode == 1 and "a run is explained by the engine fast, reference or simt" in result.stderr,
          "functional", result.stderr)


def main():
    for test in (pairs, message, locks, counted, mixed, programs, releases, picture, refused):
        with tempfile.TemporaryDirectory() as scratch:
            test(pathlib.Path(scratch))
    return checking.failures != 0


if __name__ == "__main__":
    sys.exit(main())
