"""What the tests of this folder share: a command is run, and nothing that was there before is another afterwards."""

import hashlib
import os
import subprocess
import sys

BIN = sys.argv[1]
TEST_BIN = os.path.join(BIN, "..", "tests", "bin")
VERSION = sys.argv[2]
failures = 0


def fail(text):
    global failures
    failures += 1
    print(f"FAILED: {text}", flush=True)


def path_of(program):
    path = os.path.join(BIN, program)
    return path if os.path.exists(path) else os.path.join(TEST_BIN, program)


def run(program, *words, **how):
    if callable(program):  # a command of trax-eval, in this process
        return program(*words)
    how = {"stdin": subprocess.DEVNULL, "timeout": 120} | how
    return subprocess.run([path_of(program), *words], capture_output=True, text=True, **how)


hashes = {}  # of contents, by what changes with them


def hash_of(path):
    status = os.stat(path)
    key = status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns
    if key not in hashes:
        with open(path, "rb") as file:
            hashes[key] = hashlib.sha256(file.read()).hexdigest()
    return status.st_ino, hashes[key]


def contents():
    """Every file below this folder, with what a command could change of it."""
    found = {}
    for folder, _, names in os.walk("."):
        for name in names:
            path = os.path.join(folder, name)
            if os.path.islink(path):
                found[path] = os.readlink(path)
            elif os.path.isfile(path):
                found[path] = hash_of(path)
    return found


def refused(message, program, *words, **how):
    """Status 1, the message, or one of several, and every file as it was."""
    message = (message,) if isinstance(message, str) else message
    before, shown = contents(), f"{program} {' '.join(words)}"
    ended = run(program, *words, **how)
    if ended.returncode != 1:
        fail(f"{shown}: status {ended.returncode}: {ended.stdout} {ended.stderr}")
    elif not any(text in ended.stderr for text in message):
        fail(f"{shown}: not '{message}', but: {ended.stderr}")
    if ended.stdout:
        fail(f"{shown}: printed {ended.stdout}")
    if contents() != before:
        changed = {path for path, _ in set(contents().items()) ^ set(before.items())}
        fail(f"{shown}: changed {sorted(changed)}")


def accepted(program, *words, **how):
    ended = run(program, *words, **how)
    if ended.returncode != 0:
        fail(f"{program} {' '.join(words)}: status {ended.returncode}: {ended.stderr}")
    return ended


def end():
    print("all as expected" if not failures else f"{failures} failures")
    sys.exit(failures > 0)
