"""frames.py PROGRAM DISASSEMBLY: every function's record in .stack_sizes covers what its instructions take: what the
prologue subtracts from sp, or, where sp stays, the deepest store below it."""

import re
import subprocess
import sys

program, disassembly = sys.argv[1:]
text = subprocess.run(["llvm-readelf", "--stack-sizes", program], check=True, capture_output=True, text=True).stdout
records = {name: int(size) for size, name in re.findall(r"^\s*(\d+)\s+(\S+)$", text, re.MULTILINE)}

taken, alignment, current = {}, {}, None
for line in open(disassembly):
    if label := re.match(r"[0-9a-f]+ <(.+)>:$", line):
        current = label[1]
    elif adjust := re.search(r"\baddi\s+r2, r2, -(\d+)", line):
        taken[current] = taken.get(current, 0) + int(adjust[1])
    elif align := re.search(r"\bandi\s+r2, r2, -(\d+)", line):
        alignment[current] = int(align[1]) - 4
    elif below := re.search(r"\bsw\s+r\d+, -(\d+)\(r2\)", line):
        taken[current] = max(taken.get(current, 0), int(below[1]))

assert {"main", "large", "aligned", "select"} <= set(records) and "variable" not in records, records
assert alignment == {"aligned": 60}, alignment
for name, size in records.items():
    expected = taken.get(name, 0) + alignment.get(name, 0)
    assert size == expected, f"{name}: {size} recorded, {expected} taken"
