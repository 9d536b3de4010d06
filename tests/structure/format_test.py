"""The layout of C and C++: clang-format 19 with .clang-format at the top would change no file that git tracks.

  format_test.py SOURCE

Tests of lit and their inputs are left out: comments name their lines."""

import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
FILES_AT_ONCE = 100


def main():
    os.chdir(sys.argv[1])
    formatter = shutil.which("clang-format-19")
    listed = subprocess.run(["git", "ls-files", "-z", "*.c", "*.h", "*.cpp"], capture_output=True, check=False)
    if not formatter or listed.returncode:
        print("no clang-format-19, or not a repository")
        return SKIPPED
    names = [name for name in listed.stdout.decode().split("\0")[:-1]
             if os.path.exists(name) and "/Inputs/" not in name and b"RUN:" not in pathlib.Path(name).read_bytes()]
    print(f"{len(names)} files")
    return max(subprocess.run([formatter, "--dry-run", "--Werror", *names[first:first + FILES_AT_ONCE]],
                              check=False).returncode
               for first in range(0, len(names), FILES_AT_ONCE))


if __name__ == "__main__":
    sys.exit(main())
