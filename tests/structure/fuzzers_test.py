#!/usr/bin/env python3
"""fuzzers_test.py SOURCE: the fuzzers compile every file again that reads their input. A file that comes from the
library instead has no instrumentation: the fuzzer works, but does not learn which input reaches it."""
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
# Folders, how their fuzzers name them, and files that read nothing of the input.
FOLDERS = {
    "emulator/program": ("../program", {"arguments.c"}),  # words of the command line
    "emulator/gdb": ("../gdb", {"listen.c"}),  # the socket
    "raytracer/scene": ("${SCENE}", {"bvh.c"}),  # calls what throws
}
WHOLE = "get_target_property(SCENE_SOURCES traxscene SOURCES)"


def sources(text):
    """The files of traxscene, as its CMakeLists.txt lists them."""
    return set(re.findall(r"\w+\.c\b", re.search(r"add_library\(traxscene\b[^)]*\)", text)[0]))


failures = 0
for folder, (name, others) in FOLDERS.items():
    fuzz = (SOURCE / folder).parent / "fuzz/CMakeLists.txt"
    listed = set(re.findall(re.escape(name) + r"/(\w+\.c)\b", fuzz.read_text()))
    files = {path.name for path in (SOURCE / folder).glob("*.c")}
    if folder == "raytracer/scene":
        files = sources((SOURCE / folder / "CMakeLists.txt").read_text())
        listed |= files if WHOLE in fuzz.read_text() else set()
    for missing in sorted(files - listed - others):
        print(f"FAILED: {folder}/{missing}: no fuzzer compiles it again")
        failures += 1
sys.exit(failures > 0)
