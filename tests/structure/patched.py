"""Patches that are kept as tests: extensions that change as few files as docs/extending.md says.

  patched.py SOURCE SCRATCH ISA-GENERATOR [COMPILER-LAUNCHER]

Makes a copy of the sources in SCRATCH, applies all patches to it, and builds what their tests need, with the generator
of the ISA's tables that the build has made: no patch changes it. Each patch also applies without the others. Some of
the fast engine's structures receive another field, for state_test.py."""

import glob
import json
import os
import random
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PARTS = ["CMakeLists.txt", "LICENSE", "README.md", "VERSION", "cmake", "docs", "emulator", "isa", "llvm-target",
         "raytracer", "runtime", "tests"]
TARGETS = ["timing-engines-test", "timing-rollback-test", "timing-units-page", "emulator-programs", "trax-sim"]

ADDED = "added-fields.txt"  # in SCRATCH: the names of the structures
FIELDS = 10
NESTED = ["trax_request_list", "trax_instant"]  # only within others, as bytes of theirs


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode:
        printed = done.stdout[-4000:] + done.stderr[-4000:]
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{printed}")
    return done.stdout


def add_fields(scratch):
    """Adds a field at a random place to each of some structures whose saved fields stand in a list. TRAX_RANDOM_SEED
    changes the choice."""
    generator = random.Random(int(os.environ.get("TRAX_RANDOM_SEED", "1")))
    lists = []
    for path in sorted(glob.glob(os.path.join(scratch, "emulator", "fast", "**", "*.h"), recursive=True)):
        with open(path, encoding="utf-8") as file:
            names = re.findall(r"^#define (TRAX_\w+)_STATE\(X, S\)", file.read(), re.M)
        lists += [(path, name.lower()) for name in names if name.lower() not in NESTED]
    chosen = generator.sample(lists, FIELDS)
    for path, name in chosen:
        with open(path, encoding="utf-8") as file:
            lines = file.read().split("\n")
        begin = lines.index(next(line for line in lines if line.startswith(f"#define {name.upper()}_STATE(X, S)")))
        rows = 0
        while lines[begin + rows].endswith("\\"):
            rows += 1
        if rows:
            lines.insert(begin + generator.randint(1, rows), "  X(S, uint8_t, added, [8]) \\")
        else:
            lines[begin] += " X(S, uint8_t, added, [8])"
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines))
    with open(os.path.join(scratch, ADDED), "w", encoding="utf-8") as file:
        file.write(" ".join(name for _, name in chosen) + "\n")


def build(source, scratch, generator, launcher):
    shutil.rmtree(scratch, ignore_errors=True)
    os.makedirs(scratch)
    for name in PARTS:
        place, target = os.path.join(source, name), os.path.join(scratch, name)
        if os.path.isdir(place):
            shutil.copytree(place, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(place, target)
    in_no_repository = os.environ | {"GIT_CEILING_DIRECTORIES": os.path.dirname(scratch)}
    patches = sorted(glob.glob(os.path.join(HERE, "*.patch")))
    for patch in patches:
        run("git", "apply", "--check", patch, cwd=scratch, env=in_no_repository)
    for patch in patches:
        run("git", "apply", patch, cwd=scratch, env=in_no_repository)
    add_fields(scratch)
    launchers = [f"-DCMAKE_{language}_COMPILER_LAUNCHER={launcher}" for language in ("C", "CXX")]
    run("cmake", "-S", scratch, "-B", f"{scratch}/build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
        "-DCMAKE_C_FLAGS=-O0", "-DCMAKE_CXX_FLAGS=-O0", "-DTRAX_FAST_AVX2=OFF", "-DTRAX_TRANSLATE=OFF",
        f"-DTRAX_ISA_GEN={generator}", *launchers)
    run("ninja", "-C", f"{scratch}/build", "-j2", *TARGETS)
    run(f"{scratch}/build/tests/bin/emulator-programs", scratch)


def settings(keys):
    return [word for key in keys for word in ("--set", key)]


class Patched:
    """What a test says of its patch, in the tree that patched.py made."""

    def __init__(self, patch, most_files):
        self.scratch = os.path.abspath(sys.argv[1])
        self.failures = 0
        with open(os.path.join(HERE, patch), encoding="utf-8") as file:
            self.files = re.findall(r"^\+\+\+ b/(\S+)", file.read(), re.M)
        self.check(0 < len(self.files) <= most_files, f"{len(self.files)} files are changed: {' '.join(self.files)}")

    def check(self, good, text):
        if not good:
            self.failures += 1
            print(text)

    def run(self, program, *arguments):
        folder = "bin" if program == "trax-sim" else "tests/bin"
        return run(os.path.join(self.scratch, "build", folder, program), *arguments, cwd=self.scratch)

    def engines_agree(self, keys, count):
        print(self.run("timing-engines-test", "--count", count, "--jobs", 2, *settings(keys)).strip())

    def statistics(self, program, keys, *options):
        self.run("trax-sim", f"{program}.elf", "--quiet", *settings(keys), *options, "--stats", "stats.json")
        with open(os.path.join(self.scratch, "stats.json"), encoding="utf-8") as file:
            return json.load(file)

    def check_pages(self):
        self.run("timing-units-page", os.path.join("docs", "timing.md"))
        with open(os.path.join(self.scratch, "docs", "trax-sim.md"), encoding="utf-8") as page:
            text = page.read()
        for option in ("--help-config", "--help-stats"):
            self.check(self.run("trax-sim", option) in text, f"docs/trax-sim.md lacks the output of trax-sim {option}")

    def end(self):
        self.check_pages()
        print(f"{len(self.files)} files, {self.failures} failures")
        return 1 if self.failures else 0


if __name__ == "__main__":
    build(*map(os.path.abspath, sys.argv[1:4]), "".join(sys.argv[4:5]))
