"""rows.py LINKER TEST YAML SCRATCH: links the object that each row of TEST makes of YAML, and compares.

    LINKS: NAME=VALUE... -> BYTES   .text behind its first word, without a last word that is still a5a5a5a5
    FAILS: NAME=VALUE... -> TEXT    the error behind "trax-ld: error: FILE:"; nothing is written"""

import os
import re
import subprocess
import sys

linker, test, source, scratch = sys.argv[1:]
made, linked = scratch + ".o", scratch + ".out"
counts = {"LINKS": 0, "FAILS": 0}
failures = 0


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


def result(kind, definitions):
    """What comes of the object, as a row has it."""
    subprocess.run(["yaml2obj", *(f"-D{definition}" for definition in definitions), source, "-o", made], check=True)
    if os.path.exists(linked):
        os.unlink(linked)
    done = run(linker, made, "-o", linked)
    if kind == "FAILS":
        written = " and writes a file" if os.path.exists(linked) else ""
        said = re.fullmatch(rf"trax-ld: error: {re.escape(made)}: ?(.*)", done.stderr.split("\n")[0])
        return (said[1] if said and done.returncode == 1 else f"status {done.returncode}: {done.stderr}") + written
    if done.returncode:
        return done.stderr
    section = run("llvm-readelf", "-x", ".text", linked).stdout
    return re.search(r"0x00001000 00000000 (\w+ \w+)", section)[1].removesuffix(" a5a5a5a5")


with open(test, encoding="utf-8") as file:
    rows = re.findall(r"^(LINKS|FAILS): (.*?) -> (.*)$", file.read(), re.MULTILINE)
for kind, definitions, expected in rows:
    counts[kind] += 1
    found = result(kind, definitions.split())
    if found != expected:
        failures += 1
        print(f"{definitions}:\n  expected {expected}\n  got      {found}")
print(f"{counts['LINKS']} linked, {counts['FAILS']} refused, {failures} differ")
sys.exit(failures != 0 or not rows)
