"""A shared unit is a row: the patch beside this file adds one for float comparisons, with configuration, statistics, area, energy,
both engines and pages, and changes a few files.

  unit_test.py SOURCE SCRATCH [COMPILER-LAUNCHER]

A copy of the sources in SCRATCH receives the patch, and what is needed of the emulator is built. The engines must agree with the
unit on random machines; what the unit did on a small program must be what that program has for it; both pages must be those of
the patched sources."""

import json
import os
import re
import shutil
import subprocess
import sys

SOURCE, SCRATCH = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
LAUNCHER = sys.argv[3] if len(sys.argv) > 3 else ""
PATCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "unit.patch")
MOST_FILES = 5
TARGETS = ["timing-engines-test", "timing-units-page", "emulator-programs", "trax-sim"]
TPS, GROUP, LATENCY, AREA, NJ = 32, 16, 4, 0.000722, 0.000536
SET = ["compare.units_per_group=1", f"compare.tps_per_group={GROUP}", f"compare.latency_cycles={LATENCY}", "compare.pipelined=false"]

failures = []


def check(good, text):
    if not good:
        failures.append(text)
        print(text)


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def settings(keys):
    return [word for key in keys for word in ("--set", key)]


def build(tree):
    for name in ["CMakeLists.txt", "cmake", "docs", "emulator", "isa", "llvm-target", "raytracer", "runtime", "tests", "LICENSE", "README.md"]:
        place = os.path.join(SOURCE, name)
        target = os.path.join(tree, name)
        if os.path.isdir(place):
            shutil.copytree(place, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(place, target)
    run("git", "apply", PATCH, cwd=tree, env=os.environ | {"GIT_CEILING_DIRECTORIES": os.path.dirname(tree)})  # in no repository
    launchers = [f"-DCMAKE_{language}_COMPILER_LAUNCHER={LAUNCHER}" for language in ("C", "CXX")]
    run("cmake", "-S", tree, "-B", f"{tree}/build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_C_FLAGS=-O1", "-DCMAKE_CXX_FLAGS=-O1",
        *launchers)
    run("ninja", "-C", f"{tree}/build", "-j2", *TARGETS)


def stats_of(binaries, program, folder, keys, engine):
    path = os.path.join(folder, "stats.json")
    run(os.path.join(binaries, "trax-sim"), program, "--quiet", "--engine", engine, *settings([f"chip.tps_per_tm={TPS}", *keys]), "--stats", path)
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def check_statistics(binaries, folder):
    """Of a program with a loop of fadd, fsub, fmin and others."""
    run(os.path.join(binaries, "emulator-programs"), folder)
    program = os.path.join(folder, "mix.elf")
    before = stats_of(binaries, program, folder, [], "fast")
    stats = stats_of(binaries, program, folder, SET, "fast")
    same = stats_of(binaries, program, folder, SET, "reference")
    compares = stats["instructions_by_operation"]["fmin"]
    check(compares > 0 and stats["compare"]["operations"] == compares, f"{stats['compare']} of {compares} comparisons")
    check(before["compare"] == {"utilisation": 0, "operations": 0}, f"without the unit: {before['compare']}")
    check(before["fp_add"]["operations"] == stats["fp_add"]["operations"] + compares, f"adders: {before['fp_add']}, {stats['fp_add']}")
    check(stats["causes"]["compare_conflict"] > 0 == before["causes"]["compare_conflict"], f"conflicts: {stats['causes']}")
    share = compares * LATENCY / stats["cycles"] / (TPS // GROUP)
    check(abs(stats["compare"]["utilisation"] - share) < 1e-9, f"utilisation {stats['compare']['utilisation']}, by hand {share}")
    area = 0.64 + 0.63 * TPS / 16 + TPS // GROUP * AREA
    check(abs(stats["area_mm2"] - area) < 1e-9, f"area {stats['area_mm2']}, by hand {area}")
    check(abs(stats["energy"]["fp_compare"] - compares * NJ * 1e-9) < 1e-18, f"energy {stats['energy']}")
    for group in ("causes", "compare", "cycles"):
        check(stats[group] == same[group], f"{group}: {stats[group]}, with the reference {same[group]}")


def main():
    with open(PATCH, encoding="utf-8") as file:
        files = re.findall(r"^\+\+\+ b/(\S+)", file.read(), re.M)
    check(0 < len(files) <= MOST_FILES, f"the patch changes {len(files)} files: {' '.join(files)}")
    shutil.rmtree(SCRATCH, ignore_errors=True)
    os.makedirs(SCRATCH)
    try:
        build(SCRATCH)
        binaries = os.path.join(SCRATCH, "build", "bin")
        for keys in (SET, []):  # one machine's unit, and any
            print(run(os.path.join(binaries, "timing-engines-test"), "--count", 30, "--jobs", 2, *settings(keys)).strip())
        check_statistics(binaries, SCRATCH)
        run(os.path.join(binaries, "timing-units-page"), os.path.join(SCRATCH, "docs", "timing.md"))
        with open(os.path.join(SCRATCH, "docs", "emulator.md"), encoding="utf-8") as page:
            text = page.read()
        for option in ("--help-config", "--help-stats"):
            check(run(os.path.join(binaries, "trax-sim"), option) in text, f"docs/emulator.md has not got what trax-sim {option} prints")
    finally:
        shutil.rmtree(SCRATCH, ignore_errors=True)
    print(f"{len(files)} files, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
