#!/usr/bin/env python3
"""Every option that trax-sim --help lists, with good and with bad values: usage options_test.py TRAX_SIM
EMULATOR_PROGRAMS

An option that is listed and not here fails the test, and so does one that is here and not listed. What an option does
in detail is tested where it belongs (cli_test.sh, explain, gdb, ...); here it must do something, and refuse what it
cannot do: with status 1, one line, nothing on standard output, and no file."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import fail  # noqa: E402
from png_files import read_png  # noqa: E402

SIM, PROGRAMS = (os.path.abspath(path) for path in sys.argv[1:])


def run(*words):
    done = subprocess.run([SIM, *words], capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode()


class Case:
    """Words that make sense with the option, on which program; what must hold then; values that are refused."""

    def __init__(self, words, check=None, program="mix.elf", status=0, bad=(), twice=None):
        self.words, self.check, self.program = words, check, program
        self.status, self.bad, self.twice = status, bad, twice


def file_holds(name, text):
    def check(out, err):
        if not os.path.exists(name):
            return f"no file {name}"
        with open(name) as file:
            return None if re.search(text, file.read()) else f"no {text!r} in {name}"

    return check


def exists(name):
    return lambda out, err: None if os.path.exists(name) and os.path.getsize(name) else f"no {name}"


def prints(text):
    return lambda out, err: None if re.search(text, out) else f"{text!r} is not printed"


def says(text):
    return lambda out, err: None if re.search(text, err) else f"{text!r} is not said"


def statistic(name, value, path="stats.json"):
    def check(out, err):
        with open(path) as file:
            found = json.load(file)[name]
        return None if found == value else f"{name} is {found}, not {value}"

    return check


NUMBERS = ("x", "-1", "1.5", "1x", " 1", "99999999999999999999", "0x")
FILES = ("none/x", "closed")  # neither can be written
WINDOW = ["--trace", "trace.txt"]
CASES = {
    "config": Case(["4x32", "--stats", "stats.json"], statistic("threads", 128), bad=("4x31", "none.cfg", "hello.elf"),
                   twice="1x32"), "set": Case(["chip.tps_per_tm=3", "--stats", "stats.json"], statistic("threads", 3),
                                              bad=("chip.tms", "=4", "chip.tms=", "chip.tms=x", "chip.tms=0",
                                                   "chip.tms=65", "chip.tsm=1", "tms=1")),
    "bind": Case(["input=in.bin", "--alloc", "output=16", "--dump", "output=out.txt"],
                 file_holds("out.txt", "^0123456789abcdef$"), "copy.elf",
                 bad=("input", "=in.bin", "input=", "input=none", "nothing=in.bin", "input=closed")),
    "scene": Case(["in.bin"], says("no symbol scene"), status=1, bad=("none", "closed")),
    "alloc": Case(["input=0", "--alloc", "output=4", "--dump", "output=out.txt"], file_holds("out.txt", "\0\0\0\0"),
                  "copy.elf", bad=tuple("input=" + number for number in NUMBERS) + ("input", "=4", "input=4294967296")),
    "dump": Case(["output=out.txt", "--bind", "input=in.bin", "--alloc", "output=16"],
                 file_holds("out.txt", "^0123456789abcdef$"), "copy.elf",
                 bad=("output", "=x", "output=", "output=none/x", "output=closed", "nothing=x", "output=x.png",
                      "output=x.png:2", "output=x.png:2x", "output=x.png:0x4", "output=x.png:2x2x2",
                      "output=x.PNG:-2x2", "output=x.png:3x2", "output=none/x.png:2x2", "output=.png:99999x1")),
    "signature": Case(["out.txt"],
                      file_holds("out.txt", r"^fedcba98\n0000002a\nfault null pc 00001018 address 00000004\n$"),
                      "signature.elf", 1, FILES,
                      "b"), "stats": Case(["stats.json"], statistic("status", "finished"), bad=FILES,
                                          twice="b"), "report": Case(["report.txt"],
                                                                     file_holds("report.txt", "Thread-cycles by cause"),
                                                                     bad=FILES, twice="b"),
    "explore": Case(["out.txt"], file_holds("out.txt", "<!doctype html>"), bad=FILES, twice="b"),
    "explore-against": Case(["hello.json", "--explore", "out.html"], file_holds("out.html", "id=\"against\""),
                            bad=("none", "closed"), twice="b"),
    "source-folder": Case(
        [".", "--explore", "out.txt"], file_holds("out.txt", "<!doctype html>"),
        bad=("none", "hello.elf", "")), "profile": Case(["out.txt"], file_holds("out.txt", "outer|mix|_start|[0-9]"),
                                                        bad=FILES, twice="b"),
    "profile-folded": Case(["out.txt"], file_holds("out.txt", r" \d+\n"), bad=FILES, twice="b"), "profile-sample": Case(
        ["out.txt"], file_holds("out.txt", r"^outer:\d+:\d+\n"), "abort.elf", 134, bad=FILES,
        twice="b"),
    "heat": Case(["out.txt"], file_holds("out.txt", ","), bad=FILES, twice="b"),
    "waits": Case(["out.txt"], file_holds("out.txt", ","), bad=FILES, twice="b"),
    "heat-lines": Case(["out.txt"], file_holds("out.txt", ","), bad=FILES, twice="b"),
    "items": Case(["out.txt"], file_holds("out.txt", ","), "items.elf", bad=FILES, twice="b"),
    "item-buffer": Case(["output", "--items", "out.txt", "--bind", "input=in.bin", "--alloc", "output=16"],
                        file_holds("out.txt", ","), "copy.elf", bad=("nothing", ),
                        twice="b"),
    "ray-cycles": Case(["out.txt"], file_holds("out.txt", r"part,weight,kind,rays,.*\n(all,1,.*\n){9}$"), "items.elf",
                       bad=FILES, twice="b"),
    "ray-kinds": Case(["out.txt"], file_holds("out.txt", r"kind,rays,.*\n(.*\n){8}none,0,(.*\n){2}all,"), "items.elf",
                      bad=FILES, twice="b"),
    "series": Case(["out.txt"], file_holds("out.txt", ","), bad=FILES, twice="b"), "series-interval": Case(
        ["100", "--series", "out.txt"], file_holds("out.txt", "(.*\n){4}"),
        bad=NUMBERS + ("0", )), "memory-trace": Case(
            ["out.csv"],
            file_holds("out.csv", r"^cycle,address,bytes,kind,tm,channel\n\d+,\d+,64,instruction_line,0,0\n"),
            bad=FILES, twice="b"), "trace": Case(["trace.txt"], file_holds("trace.txt", "addi"), bad=FILES,
                                                 twice="b"), "perfetto": Case(["out.txt", "--window", "0:1000"],
                                                                              file_holds("out.txt", "traceEvents"),
                                                                              bad=FILES, twice="b"),
    "window": Case(["100:200"] + WINDOW, file_holds("trace.txt", "[0-9]"),
                   bad=("100", "200:100", "x:y", "1:", "-1:5",
                        "1:2:3")), "window-tms": Case(["0"] + WINDOW, file_holds("trace.txt", "addi"),
                                                      bad=("x", "0-", "3-1", "99", ",",
                                                           "-1")), "window-tps": Case(["0"] + WINDOW,
                                                                                      file_holds("trace.txt", "addi"),
                                                                                      bad=("x", "0-", "3-1", "99", ",",
                                                                                           "-1")),
    "dir": Case([".", "--dir", ".::name"], None,
                bad=("none", "hello.elf", "::x",
                     ".::")), "main-on": Case(["all"], None, bad=("1", "-1", "x", "")), "max-cycles": Case(
                         ["1000"], says("not ended after 1000 cycles"),
                         "spin.elf", 124, NUMBERS + ("0", )), "watchdog": Case(["1000"], says("no thread has ended"),
                                                                               "idle.elf", 124, NUMBERS + ("0", )),
    "progress-total": Case(["1000"], None, bad=NUMBERS + ("0", )), "engine": Case(
        ["functional", "--stats", "stats.json"], statistic("cycles", 0),
        bad=("slow", "Fast", "fastest", "sampled")), "host-threads": Case(
            ["2", "--config", "2x32", "--stats", "stats.json"], statistic("threads", 64),
            bad=NUMBERS + ("0", "65")), "checkpoint": Case(["c.bin", "--max-cycles", "100"], exists("c.bin"),
                                                           "spin.elf", 124, FILES,
                                                           "b"), "checkpoint-at": Case(["100", "--checkpoint", "c.bin"],
                                                                                       exists("c.bin"),
                                                                                       bad=NUMBERS + ("0", )),
    "checkpoint-every": Case(["100", "--checkpoint", "c.bin"], exists("c.bin"), bad=NUMBERS + ("0", )), "resume": Case(
        ["hello.elf"], says("not a checkpoint"), status=1, bad=("none", "closed", "in.bin"),
        twice="b"), "post-mortem": Case(["out.txt"], file_holds("out.txt", "^1 thread, 1 ended\n$"), bad=FILES,
                                        twice="b"), "gdb": Case(["65536"], says("not a whole number from 0 to 65535"),
                                                                status=1, bad=NUMBERS),  # runs are tests/emulator/gdb's
    "check-memory": Case([], None),  # more in memory_test.py
    "check-races": Case([], None),  # more in races_test.py
    "quiet": Case([], None), "print-config": Case([], prints("latency_cycles")), "help-config": Case(
        [], prints("chip.tms")), "help-stats": Case([], prints("thread_cycles")), "version": Case(
            [], prints(r"^trax-sim \d")), "help": Case([], prints("^usage: trax-sim")), }


def listed():
    """The options that --help lists, with the name of their argument or None."""
    return dict(re.findall(r"^  --([a-z-]+)(?: ([A-Z]\S*))?  +\S", run("--help")[1], re.M))


def files():
    return {name: os.stat(name).st_mtime_ns for name in os.listdir(".")}


def refused(name, words, program):
    before = files()
    status, out, err = run(*words, program)
    shown = " ".join(words + [program])
    if status != 1:
        fail(f"status {status}, not 1, of: {shown}", out[:300], err)
    if not re.fullmatch(r"trax-sim: error: [^\n]+\n", err):
        fail(f"not one line of error is said by: {shown}", err)
    if out:
        fail(f"something is printed by: {shown}", out[:300])
    if files() != before:
        fail(f"files are left by: {shown}: {set(files().items()) ^ set(before.items())}")


def with_value(case, name, value):
    """The case's words with another value for the option; what an option needs beside it stays."""
    return [f"--{name}={value}", *case.words[1:]]


def same_file():
    """Two outputs in one file; what is no file takes several."""
    outputs = [[f"--{name}", "both", *case.words[1:]] for name,
               case in CASES.items() if case.bad is FILES and name != "stats"]
    outputs.append(["--dump", "input=both", "--bind", "input=in.bin"])
    for words in outputs:
        refused(words[0], words + ["--stats", "both"], "copy.elf")
        err = run(*words, "--stats", "both", "copy.elf")[2]
        if "--stats" not in err or f"{words[0]} " not in err or "both: is written twice" not in err:
            fail(f"it is not said that {words[0]} and --stats write the same file", err)
    refused("dump", ["--dump", "input=both", "--dump", "output=both"], "copy.elf")
    if run("--stats", "/dev/null", "--report", "/dev/null", "hello.elf")[0] != 0:
        fail("/dev/null does not take two outputs")


def picture():
    """A PNG has the buffer's bytes but each fourth one, row by row."""
    status, _, err = run("--bind", "input=in.bin", "--alloc", "output=16", "--dump", "output=out.png:1x4", "copy.elf")
    if status != 0:
        return fail("--dump writes no PNG", err)
    with open("in.bin", "rb") as given, open("out.png", "rb") as file:
        data, png = given.read(16), file.read()
    width, height, rows = read_png(png)
    if (width, height) != (1, 4) or rows != [data[4 * y:4 * y + 3] for y in range(4)]:
        fail("the PNG's pixels are wrong", width, height, rows)


def try_option(name, argument, case):
    words = [f"--{name}", *case.words]
    status, out, err = run(*words, case.program)
    if status != case.status:
        fail(f"status {status}, not {case.status}, of: {' '.join(words)} {case.program}", err)
    elif case.check and (wrong := case.check(out, err)):
        fail(f"{wrong}: {' '.join(words)} {case.program}", err)
    for left in ("out.txt", "out.html", "trace.txt", "stats.json", "report.txt", "c.bin"):
        if os.path.exists(left):
            os.remove(left)
    if not argument:
        refused(name, [f"--{name}=1"], case.program)
        return
    refused(name, [f"--{name}="] + case.words[1:], case.program)
    last = subprocess.run([SIM, case.program, f"--{name}"], capture_output=True)
    if last.returncode != 1 or f"--{name} needs {argument}".encode() not in last.stderr:
        fail(f"--{name} without a value", last.stderr)
    for value in case.bad:
        refused(name, with_value(case, name, value), case.program)
    if case.twice:
        refused(name, words + [f"--{name}", case.twice], case.program)


with tempfile.TemporaryDirectory() as directory:
    os.chdir(directory)
    subprocess.run([PROGRAMS, "."], check=True)
    os.mkdir("closed")
    with open("in.bin", "w") as file:
        file.write("0123456789abcdef")
    run("--stats", "hello.json", "hello.elf")
    options = listed()
    if len(options) < 30:
        fail(f"--help is not understood: {options}")
    for name in options.keys() - CASES.keys():
        fail(f"--{name} has no test: add it to CASES of {os.path.basename(__file__)}")
    for name in CASES.keys() - options.keys():
        fail(f"--{name} is tested, but not listed by --help")
    for name in options.keys() & CASES.keys():
        try_option(name, options[name] or None, CASES[name])
    same_file()
    picture()
    os.chdir("/")
print(f"{len(CASES)} options, {checking.failures} failures")
sys.exit(checking.failures > 0)
