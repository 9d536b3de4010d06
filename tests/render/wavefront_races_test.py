#!/usr/bin/env python3
"""wavefront_races_test.py BIN EXAMPLES: the programs of raytracer/examples whose threads exchange rays through memory
have no race (trax-sim --check-races), in several waves, and with a thread that comes late out of a barrier. Without the
barrier between the waves of step 10 the late thread is noticed."""
import functools
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402

BIN, EXAMPLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
call = functools.partial(checking.call, BIN)
WAVE = ("#define WAVE (1u << 16)", "#define WAVE (1u << 9)")
LATE = ("int main(void) {", """static __attribute__((noinline)) void be_late(void) {
  if (trax_thread() == 5)
    for (unsigned i = 0; i < 3000; i++)
      __asm__ volatile("");
}

int main(void) {""")
LATE_ROUND = ("while ((count = queued", "while (be_late(), (count = queued")
NO_BARRIER = ("if (first > 0)\n      barrier(&state.stage);", "")

# Name, source, changes of its text, options of the compiler, whether it has races.
PROGRAMS = [
    ("9", "9-wavefront.c", [WAVE], [], False), ("10", "10-treelets.c", [WAVE], ["-DTREELET_BYTES=2048"], False),
    ("10-late", "10-treelets.c", [WAVE, LATE, LATE_ROUND], ["-DTREELET_BYTES=2048"], False),
    ("10-open", "10-treelets.c", [WAVE, LATE, LATE_ROUND, NO_BARRIER], ["-DTREELET_BYTES=2048"], True),
    ("paths", "wavefront-paths.c", [], ["-DWAVE=100u", "-DTRAX_TREE_DEPTH=TRAX_SCENE_DEFAULT_DEPTH"], False)]


def make(name, source, changes, options):
    text = (EXAMPLES / source).read_text()
    for old, new in changes:
        check(old in text, source, "has no", old)
        text = text.replace(old, new)
    pathlib.Path(f"{name}.c").write_text(text)
    done = subprocess.run([BIN / "clang", "--target=trax", "-std=c17", "-O3", "-g", "-DQUEUES=2", *options, "-I",
                           EXAMPLES, "-I", EXAMPLES.parent / "include", "-I", EXAMPLES.parent, f"{name}.c", "-o",
                           f"{name}.elf"], capture_output=True, text=True, check=False)
    equal(done.returncode, 0, name, done.stderr)


def races():
    call("trax-scene", "generate:fir", "--nodes", "quantised", "-q", "-o", "fir.trax")
    for name, source, changes, options, races in PROGRAMS:
        make(name, source, changes, options)
        paths = ["--paths", "3", "--size", "16x12"] if name == "paths" else ["--size", "36x20"]
        call("trax-render", "fir.trax", *paths, "--config", "2x32", "--program", f"{name}.elf", "-q", "--prepare",
             name)
        done = call("trax-sim", f"{name}/manifest.json", "--check-races", "--max-cycles", 20000000,
                    status=1 if races else 0)
        equal("nothing orders two accesses to the same word" in done.stderr, races, name, done.stderr)


sys.exit(checking.run(races))
