"""The top of the tree has the folders and files that belong there, and nothing that a program has left behind.

  top_test.py SOURCE

Only what git tracks counts. Without git or its folder the test is skipped."""

import subprocess
import sys

FOLDERS = "cmake docs emulator isa llvm-target raytracer runtime tests .ci .githooks .github".split()
FILES = ("CHANGELOG.md CITATION.cff CMakeLists.txt CMakePresets.json CONTRIBUTING.md Containerfile LICENSE README.md "
         "VERSION demo.sh setup.sh test.sh .clang-format .dockerignore .flake8 .gitignore").split()

try:
    listed = subprocess.run(["git", "-C", sys.argv[1], "ls-files", "-z"], capture_output=True, text=True)
except FileNotFoundError:
    sys.exit(77)
if listed.returncode != 0:
    sys.exit(77)
paths = listed.stdout.rstrip("\0").split("\0")
top = {path.split("/")[0] for path in paths}
unknown = top - set(FOLDERS) - set(FILES)
missing = set(FOLDERS + FILES) - top
for name in sorted(unknown):
    print(f"{name!r} does not belong to the top of the tree (tests/structure/top_test.py has a list)", file=sys.stderr)
for name in sorted(missing):
    print(f"{name!r} is not at the top of the tree", file=sys.stderr)
sys.exit(bool(unknown or missing))
