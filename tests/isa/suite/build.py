#!/usr/bin/env python3
"""Makes the conformance suite: build.py INSTRUCTIONS_INC ABI_H BIN_DIR FOLDER [--model PROGRAM]

From the ISA description as generated to INSTRUCTIONS_INC: assembly, images by our assembler and linker, reference
signatures by the model (BIN_DIR/trax-isa-model), the list of them (suite.json) and the coverage table (coverage.md). An
instruction without a test, or without a case of a condition that applies to it, is an error that names it."""

import argparse
import concurrent.futures
import json
import os
import shutil
import subprocess
import sys
from collections import Counter

import coverage
import features
from description import DescriptionError, read_constants, read_instructions
from faults import fault_programs, unused_programs
from image import Image
from instructions import ROWS, check_rows, programs

MEMORY_MIB = 16
TIMEOUT = 60  # seconds, of one program


class BuildError(Exception):
    pass


def run(*words, statuses=(0,)):
    try:
        done = subprocess.run(words, capture_output=True, timeout=TIMEOUT, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        raise BuildError(f"{' '.join(words)}: not ended after {TIMEOUT} s") from None
    if done.returncode not in statuses:
        raise BuildError(f"{' '.join(words)}: status {done.returncode}\n{done.stderr.decode(errors='replace')[:2000]}")
    return done


class Builder:
    def __init__(self, tools, model, folder):
        self.tools, self.model, self.folder = tools, model, folder
        self.sources = os.path.join(folder, "sources")
        os.makedirs(self.sources, exist_ok=True)

    def tool(self, name):
        return os.path.join(self.tools, name)

    def reference(self, name, program):
        """The model's signature of an image, as lines; with the status at its end."""
        path = os.path.join(self.folder, name)
        done = run(self.model, "--memory-mib", str(MEMORY_MIB), "--tms", str(program.tms), "--tps", str(program.tps),
                   "--signature",
                   path + ".signature", path + ".elf", statuses=range(256))
        if not os.path.exists(path + ".signature"):
            raise BuildError(f"{name}: the model has made no signature\n{done.stderr.decode(errors='replace')[:2000]}")
        with open(path + ".signature") as file:
            return file.read().splitlines(), done

    def make(self, program):
        """Its tests as they stand in suite.json."""
        source, linked = (os.path.join(self.sources, program.name + end) for end in (".s", ".elf"))
        with open(source, "w") as file:
            file.write(program.text())
        run(self.tool("trax-mc"), "-filetype=obj", "-o", source[:-1] + "o", source)
        start = next(iter(program.entries), "_start")
        run(self.tool("trax-ld"), "--stack-check=none", "-e", start, "-o", linked, *program.link, source[:-1] + "o")
        image = Image(linked)
        if not program.entries:
            return [self.single(program, image)]
        tests = []
        for label, conditions in program.entries.items():
            name = f"{program.name}-{label}"
            image.set_entry(image.symbols[label])
            image.save(os.path.join(self.folder, name + ".elf"))
            lines, done = self.reference(name, program)
            faulted = lines[-1].startswith("fault ")
            if faulted == (label in program.statuses):
                raise BuildError(f"{name}: in the model it ends by {lines[-1]}")
            wanted = program.faults.get(label)
            if wanted and lines[-1].split()[1] != wanted:
                raise BuildError(f"{name}: not a fault of the kind {wanted} in the model: {lines[-1]}")
            if lines[0] != "0000600d" or "0000600d" in lines[1:]:
                raise BuildError(
                    f"{name}: in the model, what is before the end has not happened, or what is behind it has")
            if done.returncode != (program.statuses[label]
                                   if label in program.statuses else 134 if wanted == "abort" else 1):
                raise BuildError(f"{name}: in the model it ends with status {done.returncode}")
            tests.append(self.test(name, program, conditions, done.returncode, b""))
        return tests

    def single(self, program, image):
        """The results that the model stores become the table with which the program compares them."""
        image.save(os.path.join(self.folder, program.name + ".elf"))
        if program.checked:
            lines, done = self.reference(program.name, program)
            if len(lines) != program.results + program.unchecked:
                raise BuildError(
                    f"{program.name}: {len(lines)} words, not {program.results + program.unchecked}, in the model: "
                    f"{lines[-1]}"
                )
            image.set_words(image.symbols["expected"], [int(line, 16) for line in lines[:program.results]])
            image.save(os.path.join(self.folder, program.name + ".elf"))
        lines, done = self.reference(program.name, program)
        if done.returncode != 0 or lines[-1].startswith("fault"):
            raise BuildError(
                f"{program.name}: in the model it ends with status {done.returncode}: {lines[-1]}\n"
                f"{done.stderr.decode()[:500]}"
            )
        if done.stdout != program.output:
            raise BuildError(f"{program.name}: the model prints {done.stdout!r}, not {program.output!r}")
        return self.test(program.name, program, program.conditions, 0, program.output)

    def test(self, name, program, conditions, status, output):
        return {"name": name, "of": program.of, "tms": program.tms, "tps": program.tps, "status": status,
                "output": output.decode("latin-1"),
                "cases": sum(conditions.values()), "conditions": dict(conditions), "places": program.places}


def all_programs(instructions, constants):
    check_rows(instructions)
    numbers = {"s": range(constants["TRAX_SR_COUNT"]), "t": range(constants["TRAX_TRAP_COUNT"]),
               "f": range(constants["TRAX_FENCE_R"], constants["TRAX_FENCE_RW"] + 1)}
    limits = {inst.name: numbers[inst.syntax[-1]] for inst in instructions if inst.syntax[-1:] in numbers}
    made = []
    for inst in instructions:
        made += programs(inst, constants) + fault_programs(inst, ROWS[inst.name], instructions, limits, constants)
    return made + unused_programs(instructions) + features.programs(instructions)


def count(instructions, made, constants):
    """({mnemonic: cases by condition}, the same of features), checked for completeness."""
    counts = {}
    for program in made:
        row = counts.setdefault(program.of, Counter())
        row.update(program.conditions)
        for conditions in program.entries.values():
            row.update(conditions)
    of_features = {
        name: counts.pop(name)
        for name in list(counts) if name not in {inst.mnemonic
                                                 for inst in instructions}}
    coverage.check(instructions, counts, constants)
    return counts, of_features


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    for name in ("instructions", "numbers", "tools", "folder"):
        parser.add_argument(name)
    parser.add_argument("--model", help="what makes the signatures")
    parser.add_argument("--check", action="store_true", help="look for missing tests, and make nothing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    constants = read_constants(options.numbers)
    instructions = read_instructions(options.instructions)
    made = all_programs(instructions, constants)
    counts, of_features = count(instructions, made, constants)
    if options.check:
        return
    temporary = options.folder + ".new"
    shutil.rmtree(temporary, ignore_errors=True)
    builder = Builder(options.tools, options.model or os.path.join(options.tools, "../tests/bin/trax-isa-model"),
                      temporary)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        tests = [test for tests in pool.map(builder.make, made) for test in tests]
    shutil.rmtree(builder.sources)
    with open(os.path.join(temporary, "suite.json"), "w") as file:
        json.dump({"memory_mib": MEMORY_MIB, "tests": tests}, file, indent=1)
    with open(os.path.join(temporary, "coverage.md"), "w") as file:
        file.write(coverage.table(instructions, counts, of_features, constants))
    shutil.rmtree(options.folder, ignore_errors=True)
    os.rename(temporary, options.folder)
    print(f"{len(tests)} images, {sum(test['cases'] for test in tests)} cases")


if __name__ == "__main__":
    try:
        main()
    except (DescriptionError, BuildError, ValueError, OSError) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: error: {error}")
