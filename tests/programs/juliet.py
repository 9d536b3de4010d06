#!/usr/bin/env python3
"""The C cases of the Juliet test suite under trax-sim --check-memory: each bad variant must be found, each good one
must be silent.

  juliet.py SUITE --build build [--work DIR] [--only CWE121,...] [--flows 1] [--jobs 2]

SUITE is the folder of the suite, with testcases/ and testcasesupport/: Juliet 1.3 for C/C++, which is public at NIST.
Run on request. Of each functional variant the first flow is taken, and FLOWS - 1 more, in turn. Left out are variants
that need Windows, sockets, input or chance. A case counts as found if a finding of its class is reported, or the fault
that its class means. Exit status: 0 if there is no false alarm and nothing is missed without a reason (MISSED)."""

import argparse
import collections
import concurrent.futures
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import interrupts  # noqa: E402

LEFT_OUT = re.compile(r"w32|wchar|socket|environment|file_|fgets|fscanf|console|rand|Environment", re.IGNORECASE)
BOUNDS = ("outside of its object", "belongs to no object", "below the stack's frame", "fault:")
UNWRITTEN = ("was never written", )
FREED = ("freed block", "freed twice")
INVALID = ("not the beginning of a block", )
LEAK = "a block is lost"
NULL = ("fault: access to the null page", )
# The words of a report, by class.
CLASSES = {
    "121": BOUNDS, "122": BOUNDS, "124": BOUNDS, "126": BOUNDS + UNWRITTEN, "127": BOUNDS + UNWRITTEN,
    "401": (LEAK, ), "415": FREED, "416": FREED, "457": UNWRITTEN, "476": NULL, "562": BOUNDS + UNWRITTEN,
    "590": INVALID, "665": UNWRITTEN + BOUNDS, "680": BOUNDS, "690": NULL, "758": UNWRITTEN, "761": INVALID,
    "843": BOUNDS + UNWRITTEN}
# Cases whose error needs an allocation that fails: blocks of at least so many bytes are taken before main.
EXHAUSTED = {r"CWE690 .*": 1, r"CWE401 malloc_realloc": 65536}
EXHAUST = """#include <stdlib.h>
static void **taken;
__attribute__((constructor)) static void take_the_heap(void) {
  for (size_t bytes = 1u << 30; bytes >= LEAST; bytes >>= 1)
    for (void **block; (block = malloc(bytes)) != NULL;)
      if (bytes >= sizeof *block) {
        *block = taken;
        taken = block;
      }
}
"""
# Missed cases, with reasons.
MISSED = {
    r"CWE12[47] char_declare_":
        "a constant distance before an array: the compiler makes one address of both, that of a neighbour",
    r"CWE121 char_type_overrun_": "beyond a member, within its object",
    r"CWE193_char_alloca_": "one byte behind 10 of alloca, which gives multiples of 4",
    r"CWE562 ": "the memory of a function that has returned is in the frame of the function that reads it",
    r"CWE476 null_check_after_deref": "no null pointer is used when the program runs",
}
FLAGS = ["--target=trax", "-mstack=global", "-mstack-size=256k", "-g", "-O0", "-w"]


class Case:
    def __init__(self, cwe, variant, flow, files):
        self.cwe, self.variant, self.flow, self.files = cwe, variant, flow, files
        self.name = f"CWE{cwe} {variant} {flow}"


def find(suite, only, flows):
    """The cases that are run, in the order of their names."""
    variants = collections.defaultdict(lambda: collections.defaultdict(list))
    for path in sorted((suite / "testcases").rglob("CWE*.c")):
        match = re.fullmatch(r"CWE(\d+)_.*?__(.*)_(\d\d)[a-z]?", path.stem)
        if match and match[1] in CLASSES and not LEFT_OUT.search(path.stem) and (not only or f"CWE{match[1]}" in only):
            variants[match[1], match[2]][match[3]].append(path)
    cases = []
    for turn, ((cwe, variant), by_flow) in enumerate(sorted(variants.items())):
        further = [flow for flow in sorted(by_flow) if flow not in ("01", "12")]  # 12 goes by chance
        chosen = ["01"] * ("01" in by_flow)
        chosen += [further[(turn + i * 7) % len(further)] for i in range(flows - len(chosen)) if further]
        cases += [Case(cwe, variant, flow, by_flow[flow]) for flow in sorted(set(chosen))]
    return cases


def run(options, support, case, kind):
    """Returns (status, the check's output) of a variant; the status is None if it does not compile."""
    program = options.work / f"{case.name} {kind}".replace(" ", "-")
    least = next((least for pattern, least in EXHAUSTED.items() if re.match(pattern, case.name)), None)
    sources = [*case.files, *support, *([options.work / "exhaust.c", f"-DLEAST={least}"] if least else [])]
    built = subprocess.run(
        [options.build / "bin" / "clang", *FLAGS, "-DINCLUDEMAIN", "-DOMITGOOD" if kind == "bad" else "-DOMITBAD",
         "-I", options.suite / "testcasesupport", *sources, "-o", program], capture_output=True, check=False)
    if built.returncode:
        return None, built.stderr.decode(errors="replace")
    ran = subprocess.run(
        [options.build / "bin" / "trax-sim", "--engine", "fast", "--check-memory", "--max-cycles", "5000000",
         *(["--set", "memory.size_mib=16"] if least else []), program],
        capture_output=True, check=False, stdin=subprocess.DEVNULL, timeout=600)
    program.unlink()
    return ran.returncode, ran.stderr.decode(errors="replace")


def judge(options, support, case):
    """(found, false alarm, leaks, messages). Good variants of other classes do not free all memory: these leaks are
    counted."""
    status, bad = run(options, support, case, "bad")
    good_status, good = run(options, support, case, "good")
    if status is None or good_status is None:
        return None, None, 0, bad if status is None else good
    found = any(text in bad for text in CLASSES[case.cwe])
    reports = re.findall(r"^trax-sim: .*", good, re.M)
    leaks = sum(LEAK in line for line in reports) if case.cwe != "401" else 0
    alarms = [line for line in reports if not (leaks and (LEAK in line or "(--check-memory)" in line))]
    return found, "\n".join(alarms) if alarms or good_status and not leaks else "", leaks, bad


def summary(text):
    return " | ".join(line for line in text.splitlines() if line.startswith("trax-sim:"))[:200] or "nothing"


def main():
    parser = argparse.ArgumentParser(description="Run Juliet's C cases under trax-sim --check-memory.")
    parser.add_argument("suite", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--flows", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    if not (options.suite / "testcasesupport" / "std_testcase.h").exists():
        sys.exit(f"juliet.py: error: {options.suite}: is not the folder of the Juliet suite")
    interrupts.end_by_signals()
    scratch = options.work or pathlib.Path(tempfile.mkdtemp())
    options.suite, options.build, options.work = options.suite.resolve(), options.build.resolve(), scratch.resolve()
    options.work.mkdir(parents=True, exist_ok=True)
    (options.work / "exhaust.c").write_text(EXHAUST)
    support = [options.work / "io.o"]
    subprocess.run([options.build / "bin" / "clang", *FLAGS, "-I", options.suite / "testcasesupport", "-c",
                    options.suite / "testcasesupport" / "io.c", "-o", support[0]], check=True)
    cases = find(options.suite, options.only.split(",") if options.only else [], options.flows)
    table = collections.defaultdict(lambda: [0] * 6)
    notes, unexplained = collections.Counter(), 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = pool.map(lambda case: judge(options, support, case), cases)
        for case, (found, alarm, leaks, text) in zip(cases, results):
            row = table[case.cwe]
            row[0] += 1
            row[1] += found is True
            row[2] += found is False
            row[3] += bool(alarm)
            row[4] += bool(leaks)
            row[5] += found is None
            reason = next((why for pattern, why in MISSED.items() if re.search(pattern, case.name)), None)
            if found is False and reason:
                notes[reason] += 1
            unexplained += bool(alarm) or (not found and not reason)
            if alarm:
                print(f"FALSE ALARM {case.name}: {summary(alarm)}", flush=True)
            if found is None:
                print(f"NOT BUILT {case.name}: {text[:300]}", flush=True)
            elif not found and (not reason or options.verbose):
                print(f"MISSED {case.name}: {reason or summary(text)}", flush=True)
    print("| class | cases | found | missed | false alarms | leaks in good ones |")
    print("| --- | --- | --- | --- | --- | --- |")
    for cwe, row in sorted(table.items(), key=lambda item: int(item[0])):
        print(f"| CWE{cwe} | {row[0] - row[5]} | {row[1]} | {row[2]} | {row[3]} | {row[4]} |")
    total = [sum(row[i] for row in table.values()) for i in range(6)]
    print(f"| all | {total[0] - total[5]} | {total[1]} | {total[2]} | {total[3]} | {total[4]} |")
    for reason, count in notes.most_common():
        print(f"missed, {count}: {reason}")
    sys.exit(1 if unexplained else 0)


if __name__ == "__main__":
    main()
