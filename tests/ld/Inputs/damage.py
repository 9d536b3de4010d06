"""Damages a file in many small ways and links each: usage damage.py LINKER FILE DIRECTORY [ARGUMENT...]

The file is cut to every length that is a multiple of a step, and single bytes are inverted, set to 0, 0xff and other
values, at every offset below 64 and then in steps; all by a fixed rule. Whatever the damage, the linker must end by
itself with status 0 or 1 and its own messages only; after status 1 it must have said why and left no file behind.
"""

import os
import subprocess
import sys

linker, path, directory, *arguments = sys.argv[1:]
with open(path, "rb") as file:
    original = file.read()
os.makedirs(directory, exist_ok=True)
for name in os.listdir(directory):
    os.unlink(os.path.join(directory, name))
suffix = os.path.splitext(path)[1]
damaged = os.path.join(directory, "damaged" + suffix)
output = os.path.join(directory, "output")
failures = 0


def variants():
    step = max(1, len(original) // 25)
    for length in range(0, len(original), step):
        yield f"cut to {length} bytes", original[:length]
    step = max(1, len(original) // 75)
    offsets = [*range(64), *range(64, len(original), step)]
    for number, offset in enumerate(offsets):
        old = original[offset]
        values = (old ^ 0xFF, old ^ 0x80) if offset < 64 else (old ^ 0xFF, 0xFF, old ^ 0x01, 0x80, 0x00)
        value = values[number % len(values)]
        if value != old:
            yield f"byte {offset} {old:#x} -> {value:#x}", original[:offset] + bytes([value]) + original[offset + 1:]


def problem(run):
    lines = run.stderr.decode(errors="replace").splitlines()
    foreign = [line for line in lines if not line.startswith(("trax-ld: ", ">>> "))]
    if run.returncode not in (0, 1):
        return f"status {run.returncode}"
    if foreign:
        return f"says {foreign[0]!r}"
    errors = [line for line in lines if line.startswith("trax-ld: error: ")]
    if (run.returncode == 1) != bool(errors):
        return f"status {run.returncode} with {len(errors)} errors"
    left = sorted(set(os.listdir(directory)) - {os.path.basename(damaged)})
    if left != (["output"] if run.returncode == 0 else []):
        return f"leaves {left}"
    return None


counts = {0: 0, 1: 0}
for what, contents in variants():
    with open(damaged, "wb") as file:
        file.write(contents)
    if os.path.exists(output):
        os.unlink(output)
    try:
        run = subprocess.run([linker, damaged, "-o", output, *arguments], capture_output=True, timeout=60, check=False)
        wrong = problem(run)
        counts[min(run.returncode, 1)] = counts.get(min(run.returncode, 1), 0) + 1
    except subprocess.TimeoutExpired:
        wrong = "does not end"
    if wrong:
        failures += 1
        print(f"{what}: {wrong}")
print(f"{counts[0]} linked, {counts[1]} rejected, {failures} failed")
if min(counts[0], counts[1]) < 25:
    sys.exit("too few of one kind: the test proves nothing")
sys.exit(failures != 0)
