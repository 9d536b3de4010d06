#!/usr/bin/env python3
"""Do the tests of warps notice a wrong engine? Each mutant is a rule of docs/simt.md changed in one line of
emulator/simt. The changed file is compiled and linked into the tests, before the library.

    mutants.py --build build [--only EXPRESSION]

Ends with status 1 if a mutant survives, or if a line to be changed is not there any more."""

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
EMULATOR = os.path.join(HERE, "..", "..", "emulator")
SECONDS = 15
TESTS = [("simt-rules-test", []),
         ("timing-engines-test", ["--engine", "simt", "--seed", "7001", "--count", "12", "--stop"])]

# File below emulator/simt/, what stands there once, what the mutant has instead.
MUTANTS = [
    ("choice.c", "if (tm->place[i] < tm->place[first])", "if (tm->place[i] > tm->place[first])"),
    ("choice.c", "if (tm->place[i] < tm->place[first])", "if (tm->place[i] >> 32 < tm->place[first] >> 32)"),
    ("choice.c", "if ((uint32_t)tm->place[lane] != pc)", "if ((uint32_t)tm->place[lane] != pc || warp->group)"),
    ("choice.c", "if (warp->issued - warp->waits_from >= tm", "if (warp->issued - warp->waits_from > tm"),
    ("choice.c", "  warp->waits_from = tm->last_issued[longest];\n", ""),
    ("choice.c", "    tm->last_issued[lane] = warp->issued;\n", ""),
    ("choice.c", "    trax_simt_place(tm, lane, calls);\n", "    trax_simt_place(tm, lane, 0 * calls);\n"),
    ("choice.c", "cost = waits ? part : 1;", "cost = 1;"),
    ("choice.c", "warp->turns_left = part_of_patience(tm);", "warp->turns_left = 1;"),
    ("choice.c", "if (!(warp->running & trax_simt_bit(warp->turns_lane)))", "if (0)"),
    ("fetch.c", " || warp->uncharged != warp->group)", ")"),
    ("fetch.c", "return lane / tm->ref->config->icache.tps_per_cache;", "return lane * 0;"),
    ("fetch.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_BANK);", ";"),
    ("fetch.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_MEMORY_QUEUE);", ";"),
    ("operands.c", "warp->active = warp->has_operands ? warp->left : 0;",
     "warp->active = warp->left & warp->uncharged;"),
    ("operands.c", "passes = check(tm, warp, i, needs, t) && passes;", "passes = check(tm, warp, i, needs, t);"),
    ("operands.c", "if (warp->is_checked && !*waits_for)", "if (warp->is_checked)"),
    ("operands.c", "has_more ? 0 : needed_registers(first);", "needed_registers(first);"),
    ("operands.c", "(lane->inst.rb + n) % TRAX_NUM_REGISTERS", "lane->inst.rb"),
    ("run.c", " || !trax_always_free(unit, ref->config);", ";"),
    ("sleep.c", "      next = tm->ref->tp[lane].scoreboard[waits_for].usable;",
     "      next = tm->ref->tp[lane].scoreboard[waits_for].usable + 1;"),
    ("sleep.c", "warp->slept_from = t + 1;", "warp->slept_from = t;"),
    ("sleep.c", "if (has_arrived || t >= warp->wakes) {", "if (t >= warp->wakes) {"),
    ("sleep.c", "return waits_for ? tm->ref->tp[lane].scoreboard[waits_for].cause : TRAX_CAUSE_LOCKSTEP;",
     "return waits_for ? tm->ref->tp[lane].scoreboard[waits_for].cause : TRAX_CAUSE_DIVERGENCE;"),
    ("resources.c", "i < kind->per_group && asks & ~won;", "i < 1 && asks & ~won;"),
    ("resources.c", "  set &= tm->warp[winner / tm->ref->config->simt.width].group;\n", ""),
    ("resources.c", "while (is_load(first) && set) {", "while (set) {"),
    ("resources.c", "if (lane->address / 4 == first->address / 4)", "if (lane->address / 64 == first->address / 64)"),
    ("resources.c", "if (lane->address / 4 == first->address / 4)", "if (0)"),
    ("resources.c", "{asks & ~before, asks & before};", "{asks, 0};"),
    ("accounting.c", "*pointer = (winner - first + 1) % n;", "*pointer = (winner - first) % n;"),
    ("accounting.c", "const uint64_t bubble = ends <= since ? since : ends < t ? ends : t;",
     "const uint64_t bubble = since + 0 * ends;"),
    ("accounting.c", "tp->ended ? TRAX_CAUSE_HALTED : TRAX_CAUSE_DIVERGENCE", "TRAX_CAUSE_DIVERGENCE"),
    ("accounting.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_LOCKSTEP);",
     "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_DIVERGENCE);"),
    ("accounting.c", "stats->broadcast_loads += (tm->broadcast & bit) != 0;", "stats->broadcast_loads += 0;"),
]


def last_command(build, target):
    done = subprocess.run(["ninja", "-C", build, "-t", "commands", target], check=True, capture_output=True, text=True)
    return next(line for line in reversed(done.stdout.splitlines()) if target in line)


def build_mutant(build, name, text, folder):
    """The tests with another text of the file. None: it cannot be compiled."""
    source, changed = os.path.join(folder, name), os.path.join(folder, name + ".o")
    with open(source, "w", encoding="utf-8") as file:
        file.write(text)
    target = f"emulator/CMakeFiles/traxemu.dir/simt/{name}.o"
    words = shlex.split(last_command(build, target))
    words = [source if word.endswith(f"emulator/simt/{name}") else changed if word == target else word
             for word in words]
    if subprocess.run([*words, "-w"], cwd=build, capture_output=True, check=False).returncode:
        return None
    programs = []
    for test, arguments in TESTS:
        target, program = f"tests/bin/{test}", os.path.join(folder, test)
        outputs = f"-o {shlex.quote(program)} {shlex.quote(changed)}"
        command = last_command(build, target).replace(f"-o {target}", outputs)
        subprocess.run(command, shell=True, cwd=build, check=True, capture_output=True)
        programs.append([program, *arguments])
    return programs


def first_failure(programs):
    """The name of the first test that fails; None if none does."""
    for command in programs:
        try:
            if subprocess.run(command, capture_output=True, timeout=SECONDS, check=False).returncode:
                return os.path.basename(command[0])
        except subprocess.TimeoutExpired:
            return os.path.basename(command[0])
    return None


def try_mutant(build, name, old, new):
    with open(os.path.join(EMULATOR, "simt", name), encoding="utf-8") as file:
        text = file.read()
    if text.count(old) != 1:
        return "stale" if old not in text else "ambiguous"
    with tempfile.TemporaryDirectory() as folder:
        programs = build_mutant(build, name, text.replace(old, new), folder)
        return "does not compile" if programs is None else first_failure(programs) or "SURVIVES"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", required=True, type=os.path.abspath, help="the build directory")
    parser.add_argument("--only", default="", help="mutants in whose file or lines it is found")
    options = parser.parse_args()
    caught = total = 0
    for name, old, new in MUTANTS:
        if not re.search(options.only, name + old + new):
            continue
        outcome = try_mutant(options.build, name, old, new)
        total += 1
        caught += outcome.endswith("-test")
        print(f"{outcome:20} {name}: {old.strip()}  ->  {new.strip()}", flush=True)
    print(f"{caught} of {total} noticed")
    return caught != total or not total


if __name__ == "__main__":
    sys.exit(main())
