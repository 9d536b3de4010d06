"""What concerns more than one instruction: programs of the folder features, and those that hazards.py, litmus.py and
own_accesses.py generate.

A file features/NAME.s begins with lines `# KEY: VALUE`:
  threads: TMS TPS       of the machine
  results: WORDS         of the signature, which thread 0 compares when it jumps to `check`
  link: WORDS            for the linker
  case: NAME COUNT       a condition, and how many cases of it there are
  entry: LABEL CONDITION KIND, or LABEL CONDITION status NUMBER
                         an image that starts there; it ends by a fault of that kind, or with that status. It stores
                         0x600d to the
                         first word, and nothing stores that elsewhere."""

import os

import hazards
import litmus
import own_accesses
from program import Program

FOLDER = os.path.join(os.path.dirname(os.path.realpath(__file__)), "features")


def read(name, common):
    path = os.path.join(FOLDER, name + ".s")
    program = Program(name, name.replace("-", " "))
    program.checked = False
    program.results = 6
    with open(path) as file:
        lines = file.read().splitlines()
    for number, line in enumerate(lines, 1):
        key, colon, value = line.lstrip("# ").partition(": ")
        if not line.startswith("# ") or not colon or " " in key:  # prose
            continue
        words = value.split()
        if key == "threads":
            program.tms, program.tps = map(int, words)
        elif key == "results":
            program.results, program.checked = int(value), True
        elif key == "link":
            program.link = words
        elif key == "case":
            program.case(" ".join(words[:-1]), int(words[-1]))
        elif key == "entry":
            label, condition, kind = words[:3]
            program.entries[label] = {condition.replace("_", " "): 1}
            if kind == "status":
                program.statuses[label] = int(words[3], 0)
            else:
                program.faults[label] = kind
        else:
            raise ValueError(f"{path}:{number}: unknown key {key}")
    program.lines = common + lines
    program.places = []
    if program.checked:
        program.lines += ["  .text", "check:"]
        program.end()
    return program


def programs(instructions):
    with open(os.path.join(FOLDER, "common.inc")) as file:
        common = file.read().splitlines()
    names = sorted(name[:-2] for name in os.listdir(FOLDER) if name.endswith(".s"))
    return [read(name, common)
            for name in names] + hazards.programs(instructions) + own_accesses.programs() + litmus.programs(common)
