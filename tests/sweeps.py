"""Sweeps: two programs print a hash of each routine's results over the same numbered operands, and where hashes differ
the search for the first such operand follows (numerics/sweep.py, isa/oracle/sweep.py; the programs' frame is
numerics/sweep_main.h)."""

import os
import struct
import subprocess
import sys
import tempfile
import time

PIECE = 1 << 20  # operands between two lines of progress


class Program:
    """name: for messages. command: for the host, or of trax-sim for the TP."""

    def __init__(self, name, command, on_tp=False):
        self.name, self.command, self.on_tp = name, command, on_tp

    def run(self, which, first, count, verbose=0):
        numbers = (which, first, count, verbose)
        command = self.command + [str(n) for n in numbers]
        with tempfile.TemporaryDirectory() as folder:
            if self.on_tp:
                path = os.path.join(folder, "parameters")
                with open(path, "wb") as file:
                    file.write(struct.pack("<4I", *numbers))
                command = self.command[:-1] + ["--bind", f"parameters={path}", self.command[-1]]
            done = subprocess.run(command, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, check=False)
        if done.returncode != 0:
            sys.exit(f"sweep.py: {' '.join(command)} ended with status {done.returncode}")
        return done.stdout.decode().splitlines()


def find(program, reference, which, first, count):
    """Prints the first operands of the range, which has some, for which the two differ."""
    while count > 1:
        half = count // 2
        if program.run(which, first, half) == reference.run(which, first, half):
            first, count = first + half, count - half
        else:
            count = half
    for ours, theirs in zip(program.run(which, first, 1, 1), reference.run(which, first, 1, 1)):
        if ours != theirs:
            print(f"  operands {first}: {program.name} {ours}\n  {reference.name} {theirs}")


def compare(what, program, reference, which, first, count):
    """Returns whether nothing differs. what: names the sweep in messages."""
    start = time.monotonic()
    for done in range(0, count, PIECE):
        size = min(PIECE, count - done)
        ours, theirs = program.run(which, first + done, size), reference.run(which, first + done, size)
        if ours != theirs or len(ours) < 2:
            wrong = [a.split()[0] for a, b in zip(ours, theirs) if a != b] if len(ours) == len(theirs) else ["all"]
            print(f"{what}, {program.name}: differs in {', '.join(wrong)}")
            find(program, reference, which, first + done, size)
            return False
        if count > PIECE:
            print(f"{what}, {program.name}: {done + size} operands, {time.monotonic() - start:.0f} s", flush=True)
    print(f"{what}, {program.name}: {len(ours)} routines, {count} operands each, no difference", flush=True)
    return True
