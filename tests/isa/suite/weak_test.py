#!/usr/bin/env python3
"""The suite on memory as weak as the manual allows, and with each rule broken: weak_test.py RUN ISA_WEAK_MODEL SUITE"""

import os
import re
import subprocess
import sys

RUN, MODEL, SUITE = sys.argv[1:]
SOURCE = os.path.join(os.path.dirname(os.path.realpath(__file__)), "weak_memory.c")
COMMAND = "{emulator} --limit 4000000 --memory-mib {memory_mib} --tms {tms} --tps {tps} --signature {signature} {image}"
ABOUT_MEMORY = ("^(memory order|own accesses|atomic increment|results in order|reset state|local memory|image|.*of "
                "threads|l[bhw].*|s[bhw].*|ainc|fence|rdsr)$")
SEEDS = range(6)
ORDER = "^(memory order|own accesses|atomic increment)$"


def run(broken, seed, *words):
    environment = os.environ | {"TRAX_BREAK": broken, "TRAX_SEED": str(seed)}
    return subprocess.run([RUN, "--emulator", MODEL, "--command", COMMAND, "--suite", SUITE, *words], env=environment,
                          capture_output=True, text=True)


with open(SOURCE) as file:
    rules = re.findall(r'^  X\(\w+, "([a-z-]+)"\)', file.read(), re.M)
failures = 0
for seed in SEEDS if os.environ.get("TRAX_WHOLE") else SEEDS[:1]:
    done = run("none", seed, "--only", ABOUT_MEMORY)
    print(f"seed {seed}:", done.stdout.splitlines()[-1] if done.stdout else done.stderr)
    if done.returncode:
        failures += 1
        print("FAILED: the suite asks for more than the manual promises", done.stdout, done.stderr, sep="\n")
caught = 0
for rule in rules[1:]:
    for seed in SEEDS:  # a rule is noticed if it is under one of the random orders
        done = run(rule, seed, "--only", ORDER, "--first", "--names")
        if done.returncode == 1 and done.stdout:
            caught += 1
            break
    print(f"{rule:18} {' '.join(done.stdout.split()) or 'NOT NOTICED ' + done.stderr}")
print(f"{caught} of {len(rules) - 1} broken rules noticed")
sys.exit(failures > 0 or caught < len(rules) - 1 or caught < 1)
