#!/usr/bin/env python3
"""A signal that arrives while trax-render starts its compiler ends both: interrupt_test.py BIN PRELOADED

Before its exec the child has the program's handlers unless it is made otherwise; a signal of that time must end it all
the same. A compiler that ends of itself at that moment makes no error of the signal."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile

BIN, PRELOADED, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(
    sys.argv[2]).resolve(), pathlib.Path(__file__).resolve().parent
SECONDS = 120  # a child that lost the signal waits for ever


def ends(folder, name, **environment):
    """Whether trax-render ends by the signal that its child sends, starts no other compiler, and leaves nothing."""
    folder = folder / name
    folder.mkdir()
    command = [BIN / "trax-render", SOURCE / "box.obj", "--view", SOURCE / "box.view", "--size", "16x9", "--config",
               "1x32", "--cache", "cache",
               "--source", BIN.parent / "lib/trax/raytracer", "-o", "x.png"]
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True, cwd=folder,
        env=os.environ | {
            "LD_PRELOAD": str(PRELOADED),
            "ASAN_OPTIONS": f"{os.environ.get('ASAN_OPTIONS', '')}:verify_asan_link_order=0", **environment})
    try:
        errors = process.communicate(timeout=SECONDS)[1]
    except subprocess.TimeoutExpired:
        errors = "it goes on"
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    left = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.name != "cache")
    quiet = "error" not in errors and "note" not in errors
    passed = process.returncode == -signal.SIGTERM and left == ["first"] and quiet
    if not passed:
        print(f"FAILED: {name}: {process.returncode} instead of {-signal.SIGTERM}, there are {left}: {errors[-300:]}")
    return passed


def main():
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        passed = [ends(folder, "before-exec", INTERRUPT_WAIT="1"), ends(folder, "ended")]
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
