#!/usr/bin/env python3
"""memory_test.py BUILD_BIN SOURCE: trax-sim --check-memory.

A generated program has several hundred functions, each with one error of memory or none: what is found must be exactly
the errors, each with its function in the call chain. With TRAX_MEMORY_ALL=1 the programs of tests/c, too.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
import memory_cases  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
END = re.compile(r"trax-sim: error: the program has (\d+) errors? of memory \(--check-memory\)\n$")


def build(scratch, source, *flags):
    program = scratch / "program.elf"
    clang = BIN / ("clang++" if source.suffix == ".cpp" else "clang")
    subprocess.run([clang, "--target=trax", "-g", "-w", *flags, source, "-o", program], check=True)
    return program


def write(scratch, text):
    source = scratch / "cases.c"
    source.write_text(text)
    return source


def run(program, *options, arguments=()):
    command = [BIN / "trax-sim", "--quiet", "--check-memory", "--max-cycles", "50000000", *options, program, *arguments]
    return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=600)


def findings(error):
    """Returns the findings by the case whose function is in the chain of the access, or of a leak's allocation."""
    found = {}
    for text in re.split(r"^trax-sim: memory: ", error, flags=re.M)[1:]:
        kind, rest = text.split("\n", 1)
        chain = re.split(r"^  thread ", rest, flags=re.M)[0]
        case = re.search(r"\bcase_\d+\b", chain)
        found.setdefault(case[0] if case else chain, set()).add(kind)
    return found


def table(scratch):
    text, expected = memory_cases.batch()
    wrong = sum(finding is not None for finding, _ in expected.values())
    check(wrong >= 300 and len(expected) - wrong >= 150, "cases", wrong, len(expected))
    for what, flags in (("local stack", ["-O2"]), ("global stack", ["-O1", "-mstack=global"])):
        result = run(build(scratch, write(scratch, text), *flags))
        found = findings(result.stderr)
        check(result.returncode == 1 and END.search(result.stderr) and "fault:" not in result.stderr, what,
              result.returncode, result.stderr[:500], result.stderr[-500:])
        for name, (finding, body) in expected.items():
            check(found.pop(name, set()) == ({finding} if finding else set()), what, name, finding, body)
        check(not found, what, "further findings", found)


def ends(scratch):
    """Errors after which the program cannot go on."""
    text, expected = memory_cases.single()
    program = build(scratch, write(scratch, text), "-O1")
    for number, finding in enumerate(expected):
        result = run(program, arguments=[str(number)])
        check(result.returncode == 1 and findings(result.stderr) == {f"case_{number}": {finding}}, number, finding,
              result.stderr)


def buffers(scratch):
    """A bound buffer: loads of the rest of its last word are found; what lies behind is a fault of the machine."""
    source = write(scratch, """#include <trax.h>
struct trax_buffer data;
int main(void) { volatile int i = INDEX; return ((volatile TYPE *)data.data)[i] != 0; }
""")
    for type, index, kind in (("char", 5, None), ("char", 6, "outside"), ("int", 1, "outside"), ("char", 8, "fault"),
                              ("int", -1, "fault")):
        program = build(scratch, source, "-O1", f"-DTYPE={type}", f"-DINDEX={index}")
        result = run(program, "--alloc", "data=6")
        error = result.stderr
        check(result.returncode == (kind is not None), type, index, result.returncode, error)
        outside = memory_cases.OUTSIDE in error and "data, of 6 bytes" in error
        check(outside == (kind == "outside"), type, index, error)
        check(("fault: " in error and "the buffer data (6 bytes" in error) == (kind == "fault"), type, index, error)


def report(scratch):
    """One report, word for word but for numbers."""
    source = write(scratch, """#include <stdlib.h>
static int *make(unsigned n) { return malloc(n * sizeof(int)); }
int main(void) {
  int *p = make(5), sum = 0;
  for (volatile int i = 5; i < 7; i++)
    p[i] = 1;
  free(p);
  return sum;
}
""")
    program = build(scratch, source, "-O0")
    error = run(program).stderr
    lines = [re.sub(r"0x[0-9a-f]+", "X", re.sub(r"cycle \d+", "cycle N", re.sub(r"\S*/", "", line)))
             for line in error.replace(f"{scratch}/", "").splitlines()]
    check(lines == [
        "trax-sim: memory: an access outside of its object",
        "  access      store of 4 bytes to X; 2 times",
        "  in          main+X at cases.c:6:10",
        "  called by   _start+X at crt0.S:35",
        "  thread      0 (TM 0, TP 0), cycle N",
        "  object      0 bytes behind the end of a block of 20 bytes at X",
        "  allocated   make+X at cases.c:2:39",
        "  called by   main+X at cases.c:4:12",
        "  called by   _start+X at crt0.S:35",
        "trax-sim: error: the program has 1 error of memory (--check-memory)"], error)
    for engine in ("reference", "simt"):
        other = run(program, "--engine", engine).stderr
        check(re.sub(r"cycle \d+", "", error) == re.sub(r"cycle \d+", "", other), engine, other)


def read(scratch):
    """Only the bytes that a read has got are defined."""
    program = build(scratch, write(scratch, """#include <unistd.h>
int main(void) { char a[64]; return read(0, a, 64) > 0 && a[40] == 'x' ? 3 : 0; }
"""), "-O1")
    for text, status in (("short", 1), (64 * "x", 3)):
        result = subprocess.run([BIN / "trax-sim", "--quiet", "--check-memory", program], input=text,
                                capture_output=True, text=True, timeout=100)
        check(result.returncode == status and ("never written" in result.stderr) == (status == 1), text, result.stderr)
    program = build(scratch, write(scratch, """#include <fcntl.h>
int main(void) { return openat(open("here", O_RDONLY | O_DIRECTORY), "cases.c", O_RDONLY) < 0; }
"""), "-O1", "-mstack=global")
    result = run(program, "--dir", f"{scratch}::here")
    check(result.returncode == 0 and not result.stderr, "a folder's path", result.stderr)


def jumps(scratch):
    """After longjmp the callers are those of setjmp: an error in a loop is one site."""
    program = build(scratch, write(scratch, """#include <setjmp.h>
#include <stdlib.h>
static jmp_buf place;
static char *block;
static volatile int n;
__attribute__((noinline)) static void back(int k) { volatile int a[4]; a[0] = k; if (k) longjmp(place, 1); }
__attribute__((noinline)) static void use(int i) { ((volatile char *)block)[i] = 1; }
int main(void) { block = malloc(8); setjmp(place); if (n < 5) { n++; use(8); back(n); } free(block); }
"""), "-O1")
    error = run(program).stderr
    check("; 5 times\n" in error and error.endswith("has 1 error of memory (--check-memory)\n"), error)


def returned(scratch):
    """At the end a pointer in the frame of a function that has returned keeps no block."""
    source = write(scratch, """#include <stdlib.h>
__attribute__((noinline)) static void lose(void) { void *volatile pointers[20]; pointers[0] = malloc(20); }
int main(void) { lose(); }
""")
    for flags in (["-O1"], ["-O1", "-mstack=global"]):
        error = run(build(scratch, source, *flags)).stderr
        check(memory_cases.LEAK in error and error.endswith("has 1 error of memory (--check-memory)\n"), flags, error)


def stripped(scratch):
    """Without symbols, objects lie between those of the loader's, which are no padding."""
    program = build(scratch, write(scratch, """#include <stdio.h>
#include <stdlib.h>
int main(int argc, char **argv) { void *volatile p = malloc(5000); free(p); printf("%d %p\\n", argc, argv[0]); }
"""), "-O1", "-s")
    result = run(program)
    check(result.returncode == 0 and not result.stderr, result.stderr)


def large(scratch):
    """Time and memory are in proportion to what is written to a block, not to its size."""
    program = build(scratch, write(scratch, """#include <stdlib.h>
static char *volatile block;
int main(void) {
  for (int i = 0; i < 6; i++) {
    char *it = block = malloc(200000000);
    for (int at = 5; at < 100000000; at += 9999991) it[at] = 7;
    block = realloc(it, 300000000);
    it = block;
    if (it[5 + 9999991] != 7 || it[4095 * 4096 + i] == 3) return i + 1;
    free(block);
  }
}
"""), "-O1")
    status, error, memory = checking.run_measured([BIN / "trax-sim", "--quiet", "--check-memory", program])
    found = set(findings(error).popitem()[1]) if "trax-sim: memory:" in error else set()
    check(status == 1 and found == {memory_cases.BRANCH} and "; 6 times" in error and memory < 300e6, status, error,
          memory)


# Programs of tests/c whose errors are what they test, or that leave blocks.
WRONG = {"abort_double_free.c", "buffers.c", "fault_memory_ends.c", "local_memory.c", "parallel.c"}
SOME = ["bitfields.c", "string_edges.c", "varargs.c", "vla.c", "setjmp_longjmp.c", "struct_large.c", "unions.c",
        "thread_local_values.c", "attributes.c", "large_alignment.c", "cxx_language.cpp"]


def programs(scratch):
    """Correct programs give nothing."""
    every = os.environ.get("TRAX_MEMORY_ALL")
    folder = SOURCE / "tests/c"
    for source in sorted([*folder.glob("*.c"), *folder.glob("*.cpp")]) if every else map(folder.joinpath, SOME):
        head = source.read_text()[:1500]
        flags = ["-mstack=global", "-std=c++20"] if source.suffix == ".cpp" else []
        flags += re.findall(r"-mstack=global|-mstack-size=\d+|-fopenmp", head)
        given = re.search(r"RUN: %trax_sim ((?:--set \S+ |--config \S+ |--main-on 0 )+)", head)
        try:
            program = build(scratch, source, "-O0" if source.name == "attributes.c" else "-O2", *flags)
        except subprocess.CalledProcessError:
            check(every, source.name, "does not compile")
            continue
        result = run(program, *(given[1].split() if given else []))
        if source.name not in WRONG:
            check("trax-sim: memory:" not in result.stderr, source.name, result.stderr)


def main():
    for test in (table, ends, buffers, report, read, jumps, returned, stripped, large, programs):
        with tempfile.TemporaryDirectory() as scratch:
            test(pathlib.Path(scratch))
    return checking.failures != 0


if __name__ == "__main__":
    sys.exit(main())
