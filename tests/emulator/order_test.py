#!/usr/bin/env python3
"""order_test.py BUILD_BIN SOURCE: trax-sim --check-order, on both engines that can observe.

Programs that order what they share are not reported. The same ones with relaxed orders, or without one of them, are: at
the line that loads, with the line that stored. A program's lines are known by the comments in it.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
OWN = SOURCE / "tests/emulator/order"


def build(scratch, source, *flags):
    program = scratch / "program.elf"
    clang = BIN / ("clang++" if source.suffix == ".cpp" else "clang")
    subprocess.run([clang, "--target=trax", "-O2", "-g", "-Wall", "-Wno-atomic-alignment", *flags, source, "-o",
                    program], check=True)
    return program


def run(program, tms, tps, *options):
    command = [BIN / "trax-sim", "--quiet", "--check-order", "--max-cycles", "20000000", "--set", f"chip.tms={tms}",
               "--set", f"chip.tps_per_tm={tps}", *options, program]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def line_of(source, comment):
    lines = source.read_text().splitlines()
    return next(i + 1 for i, line in enumerate(lines) if f"/* {comment} */" in line)


def expect_nothing(what, result, status=0):
    check(result.returncode == status and not result.stderr, what, f"status {result.returncode}", result.stderr)


def expect_report(what, result, source, missing, loads="loads", stores="loads", object=""):
    error = result.stderr
    places = re.findall(rf"{re.escape(source.name)}:(\d+)", error)
    check(result.returncode == 1, what, f"status {result.returncode}", error)
    check(error.startswith("trax-sim: order: a load may return an old value\n"), what, error)
    check([int(place) for place in places[:2]] == [line_of(source, loads), line_of(source, stores)], what, "lines",
          places, error)
    check(f"({object}" in error and re.search(missing, error), what, error)
    check(
        error.endswith("trax-sim: error: the program relies on more order than the machine promises (--check-order)\n"),
        what, error)


NO_RELEASE = r"missing +a `fence w` of thread 0 after its store\n"
NO_ACQUIRE = (r"missing +a `fence r` of thread \d+ since thread 0's `fence w` in cycle \d+; TM 1 may hold the line "
              r"since cycle \d+\n")


def orders(release="release", acquire="acquire"):
    return f"-DRELEASE=memory_order_{release}", f"-DACQUIRE=memory_order_{acquire}"


def messages(scratch):
    source = OWN / "message.c"
    for engine in ("fast", "reference"):
        options = "--engine", engine
        right = build(scratch, source, *orders())
        for tms, tps in ((2, 1), (1, 2), (3, 4)):
            expect_nothing(f"message on {tms}x{tps}, {engine}", run(right, tms, tps, *options))
        for release, acquire, missing in (("relaxed", "acquire", NO_RELEASE), ("release", "relaxed", NO_ACQUIRE),
                                          ("relaxed", "relaxed", NO_RELEASE)):
            program = build(scratch, source, *orders(release, acquire))
            what = f"message, {release}, {acquire}, {engine}"
            expect_report(what, run(program, 2, 1, *options), source, missing, stores="stores", object="data+0x4")
            if release == "relaxed":  # the store may wait in the writer's buffer
                expect_report(what + ", one TM", run(program, 1, 2, *options), source, missing, stores="stores",
                              object="data+0x4")
            else:  # the TM's threads share its cache
                expect_nothing(what + ", one TM", run(program, 1, 2, *options))
        waits = build(scratch, source, *orders(), "-DPLAIN")
        expect_report(f"plain flag, {engine}", run(waits, 2, 1, *options), source, NO_RELEASE, loads="waits",
                      stores="says so", object="flag")
    first, second = (run(program, 2, 1, "--engine", engine).stderr for engine in ("fast", "reference"))
    check(first == second, "engines differ", first, second)


def others(scratch):
    expect_nothing("neighbours", run(build(scratch, OWN / "neighbours.c"), 4, 1))
    source = OWN / "lock.c"
    expect_nothing("lock", run(build(scratch, source, *orders()), 2, 3))
    for kinds in (("relaxed", "acquire"), ("release", "relaxed"), ("relaxed", "relaxed")):
        expect_report(f"lock, {kinds}", run(build(scratch, source, *orders(*kinds)), 2, 3), source, "missing",
                      object="count")


def litmus(scratch):
    for name in ("lock", "exchange_lock", "double_checked", "reference_counting", "barrier"):
        source = SOURCE / f"tests/litmus/{name}.c"
        expect_nothing(name, run(build(scratch, source, "-DRUNS=40"), 2, 4))
        result = run(build(scratch, source, "-DRUNS=40", "-DRELAXED"), 2, 4)
        place = re.search(rf"in .*{name}\.c:(\d+)", result.stderr)
        check(result.returncode == 1 and place and "value" in source.read_text().splitlines()[int(place[1]) - 1],
              name, "relaxed", result.returncode, result.stderr)


def programs(scratch):
    """Of tests/c, those whose threads share something. Not atomic_operations.c: clang guesses a wide word by a plain
    load before it compares and exchanges it."""
    for name in ("heap_threads.c", "barrier.c", "threads.c", "atomic_announce.c", "atomic_lock.c", "atomic_mixed.c",
                 "atexit.c",
                 "thread_local_values.c", "cxx_threads.cpp", "cxx_mutex.cpp"):
        flags = ["-mstack=global", "-std=c++20"] if name.endswith(".cpp") else []
        expect_nothing(name, run(build(scratch, SOURCE / "tests/c" / name, *flags), 2, 16))


def picture(scratch):
    """The ray tracer on two TMs."""
    subprocess.run([BIN / "trax-render", SOURCE / "tests/render/box.obj", "--size", "40x24", "--config", "2x32",
                    "--quiet", "--prepare",
                    scratch], check=True)
    expect_nothing("ray tracer", subprocess.run([BIN / "trax-sim", "--quiet", "--check-order",
                                                 scratch / "manifest.json"],
                                                capture_output=True, text=True, timeout=600))


def refused(scratch):
    program = build(scratch, OWN / "neighbours.c")
    result = run(program, 1, 1, "--engine", "functional")
    check(result.returncode == 1 and "a run is explained by the engine fast, reference or simt" in result.stderr,
          "functional", result.stderr)


def main():
    for test in (messages, others, litmus, programs, picture, refused):
        with tempfile.TemporaryDirectory() as scratch:
            test(pathlib.Path(scratch))
    return checking.failures != 0


if __name__ == "__main__":
    sys.exit(main())
