#!/usr/bin/env python3
"""Stock GDB on programs of our compiler: usage gdb_test.py BINDIR GDB"""

import os
import re
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
from elf_files import ElfFile  # noqa: E402

BIN, GDB = os.path.abspath(sys.argv[1]), sys.argv[2]
HERE = os.path.dirname(os.path.abspath(__file__))
FOUR = ("--set", "chip.tms=2", "--set", "chip.tps_per_tm=2")

# Commands of a session, and what GDB must print for each, in this order: regular expressions.
VARIABLES = [
    ("break frame.c:6", "Breakpoint 1 at .*frame.c, line 6"),
    ("continue", r"Breakpoint 1, scale \(size=3, factor=7\) at .*frame.c:6"),
    ("print local", r"\$1 = 21"),
]
SESSIONS = {
    **{("frame", f"-O0 -gdwarf-{version}", ()): VARIABLES for version in (2, 3, 4, 5)},
    ("calls", "-O0", ()): [
        ("break walk if depth == 1", "Breakpoint 1 at .*calls.c, line 10"),
        ("continue", r"Breakpoint 1, walk \(p=0xf+[0-9a-f]+, depth=1\) at .*calls.c:10"),
        ("backtrace", r"#0  walk \(p=.*, depth=1\)"),
        ("", r"#1 .* walk \(p=.*, depth=2\) at .*:13"),
        ("", r"#2 .* walk \(p=.*, depth=3\) at .*:13"),
        ("", r"#3 .* main \(\) at .*:20"),
        ("up", r"#1 .* depth=2"),
        ("print local", r"\$1 = 4"),
        ("print *p", r"\$2 = {first = 7, second = 1.5}"),
        ("print table", r"\$3 = {1, 2, 3, 4}"),
        ("finish", r"Value returned is \$4 = 18"),
        ("print total", r"\$5 = 18"),
        ("watch total", "Hardware watchpoint 2: total"),
        ("continue", "Old value = 18\nNew value = 36"),
        ("delete", None),
        ("next", "16\t"),
        ("next", r"main \(\) at .*:21"),
        ("next", "22\t"),
        ("print walk(&p, 1)", r"\$6 = 11"),
        ("print total", r"\$7 = 43"),
        ("set variable result = 77", None),
        ("monitor cycle", r"\d+"),
        ("monitor disassemble", "=> 0x"),
        ("continue", r"exited with code 015"),
    ],
    ("calls", "-O2", ()): [
        ("break calls.c:14 if depth == 2", "Breakpoint 1 at"),
        ("continue", r"Breakpoint 1, walk \(p=.*, depth=2\) at .*calls.c:14"),
        ("backtrace", r"#1 .* walk \(p=.*, depth=3\)"),
        ("", r"#2 .* main \(\)"),
        ("print depth", r"\$1 = 2"),
        ("print $r4", r"\$2 = 11"),
        ("print $a0", r"\$3 = 11"),
        ("stepi", "15\t"),
        ("finish", r"Value returned is \$4 = 18"),
        ("continue", r"exited with code 034"),
    ],
    ("threads", "-O1", FOUR): [
        ("info threads", r'\* 1 +Thread 1 "TM 0 TP 0" _start'),
        ("", r'4 +Thread 4 "TM 1 TP 1" _start'),
        ("break work", "Breakpoint 1"),
        ("continue", r'Thread 1 "TM 0 TP 0" hit Breakpoint 1, work \(i=1\)'),
        ("continue", r'Thread 2 "TM 0 TP 1" hit Breakpoint 1, work \(i=1\)'),
        ("continue", r'Thread 3 "TM 1 TP 0" hit Breakpoint 1, work \(i=1\)'),
        ("continue", r'Thread 4 "TM 1 TP 1" hit Breakpoint 1, work \(i=1\)'),
        ("continue", r'hit Breakpoint 1, work \(i=2\)'),
        ("delete", None),
        ("break work thread 3 if i == 3", "Breakpoint 2"),
        ("continue", r'Thread 3 "TM 1 TP 0" hit Breakpoint 2, work \(i=3\)'),
        ("print mine", r"\$1 = 3"),
        ("thread 1", r'Switching to thread 1'),
        ("print $_thread", r"\$2 = 1"),
        ("thread 3", r'Switching to thread 3'),
        ("next", None),
        ("next", None),
        ("print mine", r"\$3 = 6"),
        ("delete", None),
        ("continue", r"exited normally"),
    ],
    ("fault", "-O1", ()): [
        ("continue", "received signal SIGSEGV, Segmentation fault"),
        ("", r"load \(at=0x8\) at .*fault.c:3"),
        ("backtrace", r"#1 .* main \(\) at .*fault.c:6"),
        ("print/x $pc", r"\$1 = 0x"),
        ("continue", "Program terminated with signal SIGSEGV"),
    ],
    ("loop", "-O1", ()): [
        ("break loop.c:4 if turns == 20", "Breakpoint 1"),
        ("continue", "Breakpoint 1, main"),
        ("print turns", r"\$1 = 20"),
        ("set variable go_on = 0", None),
        ("delete", None),
        ("continue", "exited with code 05"),
    ],
}


def session(work, name, level, options, commands):
    elf, script = (os.path.join(work, name + end) for end in (".elf", ".gdb"))
    subprocess.run([f"{BIN}/clang", "--target=trax", "-g", *level.split(), "-o", elf, f"{HERE}/{name}.c"], check=True)
    sim = subprocess.Popen([f"{BIN}/trax-sim", "--gdb", "0", *options, elf],
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    port = re.search(r"localhost:(\d+)", sim.stderr.readline().decode())[1]
    with open(script, "w") as file:
        file.write("".join(f"{command}\n" for command, _ in commands if command))
    run = subprocess.run([GDB, "-nx", "-batch", "-ex", "set pagination off", "-ex", f"target remote 127.0.0.1:{port}",
                          "-x", script, elf], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, timeout=120, env={**os.environ, "LC_ALL": "C"})
    if sim.poll() is None and run.returncode:
        sim.kill()
    sim.communicate(timeout=60)
    return run.stdout.decode()


def fault_of(work, name, options, change):
    """What trax-sim prints at the fault of a program whose bytes were changed."""
    elf = os.path.join(work, "changed.elf")
    subprocess.run([f"{BIN}/clang", "--target=trax", "-g", *options, "-o", elf, f"{HERE}/{name}.c"], check=True)
    with open(elf, "r+b") as file:
        image = bytearray(file.read())
        change(image)
        file.seek(0)
        file.write(image)
    return subprocess.run([f"{BIN}/trax-sim", elf], capture_output=True, text=True, check=False).stderr


def set_versions(image, version):
    """Gives each CIE a version."""
    at = ElfFile(image).section(".debug_frame").offset
    while (length := struct.unpack_from("<I", image, at)[0]) and length < 4096:
        if struct.unpack_from("<I", image, at + 4)[0] == 0xFFFFFFFF:
            image[at + 8] = version
        at += 4 + length


def check_versions(work):
    """Of a CIE of an unknown version no callers are found."""
    failed = 0
    for version in (2, 4, 5):
        fault = fault_of(work, "fault", ["-O1"], lambda image, version=version: set_versions(image, version))
        if ("called by   main" in fault) != (version == 4):
            print(f"CIE version {version}:", fault)
            failed += 1
    return failed


with tempfile.TemporaryDirectory() as work:
    failures = check_versions(work)
    for (name, level, options), commands in SESSIONS.items():
        text = session(work, name, level, options, commands)
        rest = text
        for command, expected in commands:
            if expected is None:
                continue
            found = re.search(expected, rest)
            if not found:
                print(f"{name} {level}: {command or 'then'}: no {expected!r} in\n{rest}\n--- of\n{text}")
                failures += 1
                break
            rest = rest[found.end() :]
sys.exit(failures > 0)
