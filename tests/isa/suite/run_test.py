#!/usr/bin/env python3
"""tests/isa/run notices the faults of an implementation: run_test.py RUN TRAX_SIM BUILD

Implementations that damage trax-sim's output; programs that expect something else; the installed suite."""

import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

from image import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
import interrupts  # noqa: E402

RUN, SIM, BUILD = (os.path.abspath(path) for path in sys.argv[1:])
SUITE = os.path.join(BUILD, "isa-suite")
failures = 0

# What each does as an emulator: `sim` runs trax-sim, "$signature" is its file.
BROKEN = {
    "right": 'sim',
    "word": 'sim; sed -i "3s/^......../0bad0bad/" "$signature"',
    "last": 'sim; sed -i \'$d\' "$signature"',
    "longer": 'sim; echo 00000000 >>"$signature"',
    "fault": 'sim; echo "fault illegal pc 00001000 address 00000000" >>"$signature"',
    "fault_pc": 'sim; sed -i "s/pc [0-9a-f]*/pc 00000004/" "$signature"',
    "nothing": 'exit 3',
    "silent": 'sim >/dev/null',
    "status": 'sim; exit 7',
    "hangs": 'sleep 600',
    "late": 'case $image in */xor.elf) echo >"$signature" ;; *) sim ;; esac',
    "empty": 'sim; : >"$signature"',
}
TEMPLATE = "{emulator} {signature} {image} {tms} {tps}"


def run(*words):
    done = subprocess.run([sys.executable, RUN, *words], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


def fail(message, *shown):
    global failures
    failures += 1
    print("FAILED:", message, *shown, sep="\n    ")


def expect(what, status, pattern, *words):
    found, out, err = run("--suite", SUITE, *words)
    if found != status or not re.search(pattern, err if status == 2 else out):
        fail(f"{what}: status {found}, not {status}, or not {pattern!r}", out, err)


def own_comparison(word, status):
    """The status of a program that expects another word there."""
    image = Image(os.path.join(SUITE, "sub.elf"))
    if word is not None:
        image.set_words(image.symbols["expected"] + 4 * word, [0x0BAD0BAD])
    image.save("changed.elf")
    found = subprocess.run([SIM, "--engine", "functional", "changed.elf"]).returncode
    if found != status:
        fail(f"with another word {word} expected the program ends with status {found}, not {status}")


def broken(name, status, pattern, only, *words):
    expect(name, status, pattern, "--emulator", f"./{name}", "--command", TEMPLATE, "--only", only, *words)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, body in BROKEN.items():
        with open(name, "w") as file:
            file.write('#!/bin/sh\nsignature=$1 image=$2 tms=$3 tps=$4\n'
                       f'sim() {{ {shlex.quote(SIM)} --set ray.units_per_group=1 --set chip.tms=$tms --set '
                       'chip.tps_per_tm=$tps --set memory.size_mib=16 --signature "$signature" "$image"; }\n'
                       f'{body}\n')
        os.chmod(name, 0o755)
    broken("right", 0, r"^sub +\d+ images +[\d,]+ cases  ok\n.*\d+ of \d+ images pass", "^sub")
    broken("word", 1, r"sub +\d+ images.*7 FAILED\n    sub: word 2 \(values\) is 0bad0bad, not [0-9a-f]{8}", "^sub$")
    broken("last", 1, r"sub: word \d+ \(bystanders\) is not there, not [0-9a-f]{8}", "^sub$")
    broken("longer", 1, r"sub: word \d+ is 00000000, not there", "^sub$")
    broken("fault", 1, r"sub: the end is fault illegal pc 00001000 address 00000000, not there", "^sub$")
    broken(
        "fault_pc", 1,
        r"lw-faults-null_first: the end is fault null pc 00000004 .*, not fault null pc [0-9a-f]{8} address 00000000",
        "^lw-faults-null")
    broken("nothing", 1, "sub: no signature, status 3", "^sub$")
    broken("silent", 1, "trap: it prints b'', not b'", "^trap$")
    broken("silent", 0, "pass", "^trap$", "--ignore-output")
    broken("status", 1, "sub: exit status 7, not 0", "^sub$")
    broken("status", 0, "pass", "^sub$", "--ignore-status")
    broken("hangs", 1, "sub: not ended after 0.2 s", "^sub$", "--timeout", "0.2")
    broken("empty", 1, "sub: word 0 .* is not there", "^sub$")
    broken("empty", 1, "stopped at the first mismatch", "^lw", "--first")
    broken("late", 1, r"\Axor\n", "^(and|or|xor)$", "--first", "--names")
    broken("word", 1, r"\Asub\nsub-illegal-bit6\n", "^sub$", "--names")
    broken("right", 0, r"\A\Z", "^sub$", "--names")
    expect("trax-sim by the default command", 0, "pass", "--emulator", SIM, "--only", "^rdsr$", "--machine",
           "--engine functional")
    expect("a list", 0, r"(?m)^xor: xor: .*values \d+", "--list")
    expect("the table", 0, r"(?m)^\| `xor` \| \d+ \|", "--coverage")
    expect("no emulator", 2, "--emulator is needed", "--only", "^sub$")
    right = ("--emulator", "./right", "--command", TEMPLATE)
    expect("no name", 2, "no name matches nonsense", *right, "--only", "nonsense")
    expect("some left out", 0, r"^sub +2 images .*ok\n", *right, "--only", "^sub$", "--without", "bit[0-9]+$")
    expect("all left out", 2, "--without: every name matches sub", *right, "--only", "^sub$", "--without", "sub")
    expect("no pattern", 2, "--only: \\(: ", *right, "--only", "(")
    expect("no folder", 2, "none/suite.json: no suite", *right, "--suite", "none")
    expect("no emulator", 2, "./none: cannot be run", "--emulator", "./none", "--command", TEMPLATE, "--only", "^sub$")
    expect("a bad template", 2, r"\{nothing\}: only", "--emulator", "./right", "--command", "{emulator} {nothing}",
           "--only", "^sub$")
    expect("no jobs", 2, "--jobs and --timeout", *right, "--jobs", "0")
    expect("several jobs", 0, "pass", *right, "--only", "^and", "--jobs", "4")
    for word, status in ((None, 0), (0, 1), (1, 2), (253, 254), (254, 255), (255, 255), (1500, 255)):
        own_comparison(word, status)
    subprocess.run(["cmake", "--install", BUILD, "--component", "isa-suite", "--prefix", "installed"],
                   stdout=subprocess.DEVNULL, check=True)
    done = subprocess.run(["installed/isa-suite/run", "--emulator", SIM, "--only", "^or$"], capture_output=True,
                          text=True)
    if done.returncode or "pass" not in done.stdout:
        fail("the installed suite", done.stdout, done.stderr)
    closed = subprocess.run(f"{shlex.join([RUN, '--suite', SUITE, '--coverage'])} | head -1", shell=True,
                            capture_output=True, text=True)
    if closed.stderr or not closed.stdout.startswith("#"):
        fail("nobody reads", closed.stderr)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) * 3:
        interrupted = subprocess.Popen([RUN, "--suite", SUITE, "--emulator", "./hangs", "--command", TEMPLATE,
                                        "--timeout", "600"], stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
        until = time.monotonic() + 60
        # An interpreter that starts does not catch signals yet. At a child's fork the runner does not know of it yet.
        while not interrupts.children(interrupted.pid) and time.monotonic() < until:
            time.sleep(0.001)
        interrupted.send_signal(number)
        _, err = interrupted.communicate(timeout=60)
        if interrupted.returncode != -number or err:
            fail(f"interrupted: status {interrupted.returncode}", err.decode())
    os.chdir("/")
print(f"{failures} failures")
sys.exit(failures > 0)
