#!/usr/bin/env python3
"""An instruction without a test, or without a condition's, stops the build: complete_test.py TRAX_ISA_GEN ISA_FOLDER
INSTRUCTIONS_INC NUMBERS_H LLVM_INCLUDE...

Copies of the description with one more instruction of each format, and with one less. The build has checked the
description as it is."""

import os
import re
import shutil
import subprocess
import sys
import tempfile

import coverage
from build import all_programs, count
from description import DescriptionError, read_constants, read_instructions

GENERATOR, ISA, TABLE, NUMBERS, *INCLUDES = sys.argv[1:]
HERE = os.path.dirname(os.path.realpath(__file__))
MORE = [
    ('def ROTL : InstR<1, 16, "rotl", UnitInt, [{ RD = RA << RB; }], "Rotate.">;', "rotl (ROTL) has no test"),
    ('def CLZ : InstR1<5, 4, "clz", UnitInt, [{ RD = RA; }], "Count.">;', "clz (CLZ) has no test"),
    ('def MULI : InstI<18, "muli", [{ RD = RA * IMM; }], "Multiply.">;', "muli (MULI) has no test"),
    ('def LWX : InstLoad<31, 4, "lwx", [{ RD = LOAD32(RA + IMM); }], "Load.">;', "lwx (LWX) has no test"),
    ('def BALWAYS : InstB<47, "balways", "always", "if", [{ NEXT_PC = PC + IMM; }], "Branch.">;',
     "balways (BALWAYS) has no test"),
    ('def AUIPC : InstU<19, "auipc", uimm16, UnitInt, [{ RD = PC + (IMM << 16); }], "Add.">;',
     "auipc (AUIPC) has no test"),
]
failures = 0


def build(change):
    """Returns the output of build.py --check for a changed description."""
    with tempfile.TemporaryDirectory() as folder:
        for name in os.listdir(ISA):
            if name.endswith(".td"):
                shutil.copy(os.path.join(ISA, name), folder)
        path = os.path.join(folder, "TraxInstructions.td")
        with open(path) as file:
            text = file.read()
        with open(path, "w") as file:
            file.write(change(text))
        table = os.path.join(folder, "instructions.inc")
        includes = [word for include in [folder, *INCLUDES] for word in ("-I", include)]
        subprocess.run([GENERATOR, "-gen=instructions", *includes, os.path.join(folder, "Isa.td"), "-o", table],
                       check=True)
        return subprocess.run([sys.executable, "-B", os.path.join(HERE, "build.py"), "--check", table,
                               NUMBERS, "none", "none"], capture_output=True, text=True)


def expect(what, change, messages):
    global failures
    done = build(change)
    if done.returncode == 0 or any(message not in done.stderr for message in messages):
        failures += 1
        print(f"FAILED: {what}: status {done.returncode}, {done.stderr!r}, not {messages!r}")


expect("one of each format more", lambda text: text + "\n".join(definition for definition, _ in MORE) + "\n",
       [message for _, message in MORE])
expect("without fmin", lambda text: re.sub(r"(?s)def FMIN .*?;\n(?=def)", "", text), ["FMIN has tests"])

# A condition that loses its cases, one after the other.
instructions, constants = read_instructions(TABLE), read_constants(NUMBERS)
counts, _ = count(instructions, all_programs(instructions, constants), constants)
cells = 0
for mnemonic, row in counts.items():
    for condition in list(row):
        fewer = counts | {mnemonic: {name: cases for name, cases in row.items() if name != condition}}
        try:
            coverage.check(instructions, fewer, constants)
            failures += 1
            print(f"FAILED: {mnemonic} without {condition} is complete")
        except DescriptionError as error:
            cells += 1
            if str(error) != f"{mnemonic} has no test of: {condition}":
                failures += 1
                print(f"FAILED: {mnemonic} without {condition}: {error}")
print(f"{cells} cells of the table, {failures} failures")
sys.exit(failures > 0)
