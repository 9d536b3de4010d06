"""The style of Python: flake8 with .flake8 at the top finds nothing in any file that git tracks.

  python_test.py SOURCE

A file that was clean is not read again: flake8 needs ten seconds for all of them. The cache of the tests has the hashes
of files, with flake8's version and settings in each."""

import hashlib
import os
import pathlib
import subprocess
import sys

KNOWN = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "trax-flake8")


def output_of(*command):
    return subprocess.run(command, capture_output=True, check=True).stdout


def main():
    os.chdir(sys.argv[1])
    try:
        names = output_of("git", "ls-files", "-z", "*.py", "raytracer/evaluation/trax-eval").decode().split("\0")[:-1]
    except (FileNotFoundError, subprocess.CalledProcessError):  # not a repository
        return subprocess.run(["flake8", ".", "raytracer/evaluation/trax-eval"], check=False).returncode
    rules = output_of("flake8", "--version") + pathlib.Path(".flake8").read_bytes()
    hashes = {name: hashlib.sha256(rules + name.encode() + b"\0" + pathlib.Path(name).read_bytes()).hexdigest()
              for name in names if os.path.exists(name)}
    clean = set(KNOWN.read_text().split()) if KNOWN.exists() else set()
    changed = [name for name, digest in hashes.items() if digest not in clean]
    print(f"{len(hashes)} files, {len(changed)} of them read")
    if changed and subprocess.run(["flake8", *changed], check=False).returncode:
        return 1
    KNOWN.parent.mkdir(parents=True, exist_ok=True)
    KNOWN.write_text("\n".join(hashes.values()) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
