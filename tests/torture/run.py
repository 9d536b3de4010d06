#!/usr/bin/env python3
"""Compile and run gcc's C torture programs for the TP.

    tests/torture/run.py                                all programs at -O0 and -O2
    tests/torture/run.py --levels -O1,-Os --filter 'execute/2000*'

The programs are those of Debian's package gcc-12-source; they are unpacked into the build folder. A program of execute/
(with ieee/ and builtins/) has to compile, link, run on trax-sim and end with status 0; one of compile/ has to become an
object file, or to be refused where it says so. Each first has the 512 bytes of local memory for its stack; one that
needs more gets -mstack=global.

not_applicable.txt names the programs that cannot pass and why. It is checked: a listed program that passes is an error,
unless its behaviour is undefined, and so is one that the host's clang -m32 passes, which is tried for each. Those that
gcc's own driver excludes are not tried.

Exit status: 0 if at least 98 % of the applicable programs pass at every level and the list holds, else 1.
"""

import argparse
import collections
import concurrent.futures
import dataclasses
import fnmatch
import glob
import os
import re
import shutil
import signal
import subprocess
import sys
import tarfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import interrupts  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ARCHIVE = "/usr/src/gcc-12/gcc-12.*-dfsg.tar.xz"
SUITE = "gcc/testsuite/gcc.c-torture"
REQUIRED = 98.0  # percent of the applicable
SECONDS = 120  # per step
CYCLES = 2_000_000_000
GLOBAL_STACK = ["-mstack=global", "-mstack-size=8388608"]
SIMULATOR = ["--engine", "fast", "--quiet", "--max-cycles", str(CYCLES), "--set", "icache.bytes=1048576", "--set",
             "memory.size_mib=64"]

# gcc 12 takes the C of before 1999 with warnings only; so do these, by clang.
DIALECT = ["-w", "-std=gnu17", "-Wno-implicit-int", "-Wno-implicit-function-declaration", "-Wno-int-conversion",
           "-Wno-return-mismatch",
           "-Wno-incompatible-function-pointer-types"]
# The directives that matter: options without a condition on the target, and that the compiler must refuse the program.
OPTIONS = re.compile(r'\{\s*dg-(?:additional-)?options\s+[{\s]*"([^"]*)"[}\s]*\}')
ERROR = re.compile(r'\bdg-error\s+"[^"]*"[^{}]*\}')
# Options that gcc's drivers (ieee.exp, builtins.exp) add for a folder.
FOLDER_OPTIONS = {"execute/ieee": ["-fno-inline", "-DSIGNAL_SUPPRESS"],
                  "execute/builtins": ["-fno-inline-functions", "-Wl,--allow-multiple-definition"]}


@dataclasses.dataclass
class Program:
    """One program of the suite."""

    name: str  # for example execute/ieee/hugeval.c
    sources: list
    run: bool  # else only compiled


@dataclasses.dataclass
class Result:
    """A program's verdict (passed, failed or not applicable) and its reason; global_stack: it needed one."""

    verdict: str
    reason: str = ""
    global_stack: bool = False


@dataclasses.dataclass
class Listed:
    """A program of not_applicable.txt."""

    name: str
    levels: str  # all, excluded, undefined, optimized or a list
    reason: str
    used: bool = False

    def covers(self, level):
        if self.levels == "optimized":
            return level != "-O0"
        return self.levels in ("all", "excluded", "undefined") or level in self.levels.split(",")


def fail(message):
    print(f"run.py: error: {message}", file=sys.stderr)
    sys.exit(1)


def unpack(build):
    """Return the suite's folder, unpacked from the package if it is not there yet."""
    archives = glob.glob(ARCHIVE)
    if not archives:
        fail(f"there is no {ARCHIVE}: install the Debian package gcc-12-source")
    folder = os.path.join(build, "tests", "torture")
    suite = os.path.join(folder, "gcc.c-torture")
    if not os.path.isdir(suite):
        fresh = suite + ".unpacking"
        shutil.rmtree(fresh, ignore_errors=True)
        os.makedirs(fresh)
        with tarfile.open(archives[0]) as archive:
            for member in archive:
                _, found, path = member.name.partition(f"/{SUITE}/")
                if found and member.isfile():
                    member.name = path
                    archive.extract(member, fresh)
        os.rename(fresh, suite)
    return folder, suite


def programs(suite):
    """All programs of the suite, as gcc's drivers find them."""
    def names(folder):
        return sorted(glob.glob(os.path.join(suite, folder, "*.c")))

    found = [Program(os.path.relpath(path, suite), [path],
                     True) for folder in ("execute", "execute/ieee") for path in names(folder)]
    for path in names("execute/builtins"):
        if not path.endswith("-lib.c"):
            sources = [path, path[:-2] + "-lib.c", os.path.join(suite, "execute/builtins/lib/main.c")]
            found.append(Program(os.path.relpath(path, suite), sources, True))
    return found + [Program(os.path.relpath(path, suite), [path], False) for path in names("compile")]


def read_list(path):
    """Read not_applicable.txt, whose head says how it looks."""
    listed, levels, reason = [], None, None
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.strip() or line.startswith("#"):
                continue
            if line[0].isspace() and levels:
                listed += [Listed(name, levels, reason) for name in line.split()]
                continue
            match = re.fullmatch(r"(all|excluded|undefined|optimized|-O\S+) (.+)\n", line)
            if not match:
                fail(
                    f"{path}:{number}: expected 'all|excluded|undefined|optimized|LEVELS REASON', or names with a "
                    f"blank before them"
                )
            levels, reason = match.groups()
    return listed


def options_of(program, text):
    """The options that the program, its .x file and its folder ask for."""
    options = FOLDER_OPTIONS.get(os.path.dirname(program.name), []) + " ".join(OPTIONS.findall(text)).split()
    driver = program.sources[0][:-2] + ".x"
    if os.path.exists(driver):
        with open(driver, encoding="latin-1") as file:
            for line in file:
                match = re.match(r"(?:set|lappend) additional_flags (.*)", line)
                if match:
                    options += match.group(1).replace('"', "").split()
    return options


def execute(command, folder):
    """Run a command in a process group of its own; return (status, standard error and output); status None if it had to
    be stopped."""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          cwd=folder,
                          start_new_session=True) as process:
        try:
            output, _ = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return None, f"did not end in {SECONDS} s"
    return process.returncode, output.decode(errors="replace")


def compile_(command, options, folder):
    """Compile; options that this compiler has never heard of (gcc's own optimizers') are left out."""
    while True:
        status, output = execute([*command, *options], folder)
        unknown = set(re.findall(r"(?:unknown argument(?:; did you mean '.*?')?:?|unsupported option) '([^']*)'",
                                 output)) & set(options)
        if status in (None, 0) or not unknown:
            return status, output
        options = [option for option in options if option not in unknown]


def first_error(output):
    """Returns the most informative line about a failure."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    for pattern in (r"fatal error: error in backend", r"\*\*\* Bad machine code", r"Assertion .* failed",
                    r"PLEASE submit a bug report",
                    r"\berror: (?!linker command failed)", r"undefined", r"fault:"):
        for line in lines:
            if re.search(pattern, line):
                return re.sub(r"^.*?((?:fatal )?error: |fault: )", r"\1", line)
    return lines[-1] if lines else ""


class Compiler:
    """One of the two compilers that a program is tried with."""

    def __init__(self, command, simulator):
        self.command, self.simulator = command, simulator

    def attempt(self, program, text, level, folder, extra=()):
        """Return "" if the program does what it has to, else why not; and the output of the failing step."""
        binary = os.path.join(folder, "program")
        mode = [] if program.run else ["-c"]
        # -lm stands last, as in gcc's driver.
        command = [*self.command, *DIALECT, level, *extra, *mode, *program.sources, "-o", binary,
                   *(["-lm"] if program.run else [])]
        status, output = compile_(command, options_of(program, text), folder)
        if ERROR.search(text):
            return ("", "") if status == 1 else ("is compiled, and should not be", output)
        if status != 0:
            return f"compilation: {first_error(output)}", output
        if not program.run:
            return "", ""
        status, output = execute([*self.simulator, binary], folder)
        if status == 0:
            return "", ""
        return f"run: status {status}: {first_error(output)}", output


def needs_global_stack(output):
    """Whether a program failed for want of stack: the compiler or the linker refused it, or it overflowed."""
    return re.search(r"does not fit the local memory|error: the stack takes|fault: stack overflow", output)


class Runner:
    """Tries programs at one level."""

    def __init__(self, options, folder, not_applicable, level):
        build = options.build
        self.trax = Compiler([os.path.join(build, "bin", "clang"), "--target=trax", "-mllvm", "-verify-machineinstrs"],
                             [os.path.join(build, "bin", "trax-sim"), *SIMULATOR])
        # Without the 80 bits of the old floating-point unit, which are no machine's binary64.
        self.host = Compiler([options.host_clang, "-m32", "-msse2", "-mfpmath=sse"], [])
        self.folder, self.list, self.level = folder, not_applicable, level

    def listed(self, name):
        for listed in self.list:
            if listed.name == name and listed.covers(self.level):
                listed.used = True
                return listed
        return None

    def attempt(self, program):
        """Return the program's Result."""
        with open(program.sources[0], encoding="latin-1") as file:
            text = file.read()
        listed = self.listed(program.name)
        if listed and listed.levels == "excluded":
            return Result("not applicable", f"gcc's own driver: {listed.reason}")
        folder = os.path.join(self.folder, self.level, program.name)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        problem, output = self.trax.attempt(program, text, self.level, folder)
        global_stack = bool(problem and needs_global_stack(output))
        if global_stack:
            problem, output = self.trax.attempt(program, text, self.level, folder, GLOBAL_STACK)
        if listed and listed.levels == "undefined":
            if not any(self.host.attempt(program, text, level, folder)[0] for level in ("-O2", "-Os", "-O0")):
                return Result("failed",
                              f"in not_applicable.txt, but clang -m32 passes it at all levels: {listed.reason}")
            return Result("not applicable", f"undefined: {listed.reason}")
        if not problem:
            if listed:
                return Result("failed", f"passes, but not_applicable.txt lists it: {listed.reason}")
            shutil.rmtree(folder)
            return Result("passed", global_stack=global_stack)
        with open(os.path.join(folder, "output.txt"), "w", encoding="utf-8") as file:
            file.write(output)
        if not listed:
            return Result("failed", problem)
        if not self.host.attempt(program, text, self.level, folder)[0]:
            return Result("failed", f"{problem}; in not_applicable.txt, but clang -m32 passes it: {listed.reason}")
        return Result("not applicable", listed.reason)


def suite_of(name):
    return os.path.dirname(name)


def report(level, results):
    """Print a level's table; return whether enough passed."""
    rows = collections.defaultdict(collections.Counter)
    for name, result in results.items():
        rows[suite_of(name)][result.verdict] += 1
        rows[suite_of(name)]["global"] += result.global_stack
    total = sum(rows.values(), collections.Counter())
    print(
        f"\n{'level':6}{'programs':20}{'passed':>8}{'failed':>8}{'not applicable':>16}"
        f"{'passed of applicable':>22}{'-mstack=global':>16}"
    )
    for suite, row in [*sorted(rows.items()), ("all", total)]:
        applicable = row["passed"] + row["failed"]
        share = f"{100 * row['passed'] / applicable:.2f} %" if applicable else "-"
        print(
            f"{level:6}{suite:20}{row['passed']:8}{row['failed']:8}{row['not applicable']:16}{share:>22}"
            f"{row['global']:16}"
        )
    reasons = collections.Counter(result.reason for result in results.values() if result.verdict == "not applicable")
    for reason, count in reasons.most_common():
        print(f"  not applicable {count:4}  {reason}")
    for name, result in results.items():
        if result.verdict == "failed":
            print(f"  FAILED {name}: {result.reason}")
    return 100 * total["passed"] >= REQUIRED * (total["passed"] + total["failed"])


def main():
    default_build = os.path.join(os.path.dirname(os.path.dirname(HERE)), "build")
    parser = argparse.ArgumentParser(description="Compile and run gcc's C torture programs for the TP.")
    parser.add_argument("--build", default=default_build, help="build folder (default: build)")
    parser.add_argument("--levels", default="-O0,-O2", help="comma separated (default: -O0,-O2)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--filter", action="append", default=[], metavar="PATTERN",
                        help="only programs such as 'execute/ieee/*'")
    parser.add_argument("--host-clang", default="clang-19", help="the reference for the list (default: clang-19)")
    arguments = sys.argv[1:]
    for place, argument in enumerate(arguments[:-1]):
        if argument == "--levels":  # -O0 is its value, not an option
            arguments[place:place + 2] = [f"--levels={arguments[place + 1]}"]
            break
    options = parser.parse_args(arguments)
    interrupts.end_by_signals()
    options.build = os.path.abspath(options.build)

    for name in ("clang", "trax-sim"):
        if not os.path.exists(os.path.join(options.build, "bin", name)):
            fail(f"{options.build}/bin/{name} is missing: build first")
    folder, suite = unpack(options.build)
    probe = os.path.join(folder, "probe")
    status, output = execute([options.host_clang, "-m32", "-x", "c", "/dev/null", "-shared", "-o", probe], folder)
    if status != 0:
        fail(
            f"{options.host_clang} -m32 does not link, install the Debian packages clang-19 and gcc-multilib: "
            f"{first_error(output)}"
        )
    chosen = [program for program in programs(suite)
              if not options.filter or any(fnmatch.fnmatchcase(program.name, pattern) for pattern in options.filter)]
    if not chosen:
        fail("no program has such a name")

    not_applicable = read_list(os.path.join(HERE, "not_applicable.txt"))
    good = True
    for level in options.levels.split(","):
        runner = Runner(options, folder, not_applicable, level)
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            results = dict(zip([program.name for program in chosen], pool.map(runner.attempt, chosen)))
        good &= report(level, results)
    levels = options.levels.split(",")
    for listed in not_applicable:
        if not options.filter and not listed.used and any(listed.covers(level) for level in levels):
            print(f"  not_applicable.txt: there is no program {listed.name} to compile")
            good = False
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
