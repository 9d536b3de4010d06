#!/usr/bin/env python3
"""buffers_test.py BIN: what a program does beside its buffers is a fault that names the buffer, its size, the distance
and the place, by every engine; and inputs that are pipes."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
BIN = pathlib.Path(sys.argv[1]).resolve()
ENGINES = ["fast", "fast-any", "reference", "functional"]
GUARD = 65536
FINE, EFAULT = 3, 4
NAMES = {"i": "input", "o": "output"}


def run(*words, **more):
    command = [BIN / "trax-sim", "--quiet", *map(str, words)]
    done = subprocess.run(command, capture_output=True, timeout=60, check=False, **more)
    return done.returncode, done.stderr.decode()


def where(size, offset, bytes_of):
    """What the report says of an access at this offset of a buffer; None if the access is allowed."""
    if 0 <= offset and offset + bytes_of <= size:
        return None
    if offset == size:
        return "directly behind"
    if 0 <= offset < size:
        return "across the end of"
    distance = -offset if offset < 0 else offset - size
    return f"{distance} byte{'s' if distance > 1 else ''} {'before' if offset < 0 else 'behind'}"


def accesses(engine):
    """Loads, stores and increments around both buffers: outside, each is a fault."""
    sizes = {"i": 57, "o": 128}
    options = ["--engine", engine, "--main-on", "0", "--config", "1x32"]
    options += ["--alloc", f"input={sizes['i']}", "--alloc", f"output={sizes['o']}", "buffers"]
    for buffer, size in sizes.items():
        words = (size + 3) // 4 * 4
        for what, bytes_of, store in (("s", 1, True), ("l", 1, False), ("S", 4, True), ("L", 4, False), ("a", 4, True)):
            offsets = [4 - GUARD // 2, -4, 0, size // 4 * 4 - 4, size // 4 * 4, words, words + GUARD // 2]
            for offset in offsets + ([size - 1, size] if bytes_of == 1 else []):
                status, errors = run(*options, what, buffer, offset)
                said = where(size if store else words, offset, bytes_of)
                name = f"{engine}: {what} {NAMES[buffer]} {offset}"
                if said is None:
                    equal(status, FINE, f"{name}: status")
                    continue
                distance = where(size, offset, bytes_of)
                equal(status, 1, f"{name}: status")
                check(f"{distance} the buffer {NAMES[buffer]} ({size} bytes from 0x" in errors, f"{name}: {errors}")
                check(re.search(r"  in +(load|store|main).*?buffers\.c:\d+", errors, re.S), f"{name}: place: {errors}")


def other_accesses(engine):
    pathlib.Path("full").write_bytes(b"x" * 57600)
    options = ["--engine", engine, "--main-on", "0", "--config", "4x32", "--bind", "input=full",
               "--alloc", "output=64", "buffers"]
    for what, offset, expected in (("w", 57592, FINE), ("w", 57596, EFAULT), ("r", 57592, FINE), ("r", 57596, EFAULT),
                                   ("w", -4, EFAULT), ("t", 57600 - 256, FINE), ("t", 57600 - 252, 1), ("t", -252, 1),
                                   ("p", 57500, 1)):
        status, errors = run(*options, what, "i", offset, input=b"12345678")
        equal(status, expected, f"{engine}: {what} {offset}: {errors}")
    for size in (0, 100):
        options = ["--engine", engine, "--main-on", "0", "--alloc", "input=64", "--alloc", f"output={size}", "buffers"]
        status, errors = run(*options, "S", "o", 57596)
        equal(status, 1, f"{engine}: {size} bytes: status")
        check(f"{57596 - size} bytes behind the buffer output ({size} bytes from" in errors, engine, size, errors)


def unbound(engine):
    """An access through a buffer to which nothing is bound says so, with and without debug information."""
    for program in ("buffers", "plain"):
        for what in "sl":
            status, errors = run("--engine", engine, "--alloc", "input=64", program, what, "o", 0)
            equal(status, 1, f"{engine}: unbound: status")
            check("nothing is bound to output: --alloc output=BYTES or --bind output=FILE" in errors, engine, errors)
            check("input:" not in errors, f"{engine}: bound: {errors}")
            check(program == "plain" or "other" not in errors, f"{engine}: no buffer: {errors}")
    options = ["--engine", engine, "--alloc", "input=64", "--alloc", "output=64", "buffers"]
    status, errors = run(*options, "s", "o", -(1 << 24))
    check(status == 1 and "is bound to" not in errors and "the buffer" not in errors, engine, "far outside", errors)


def pipes():
    """The bytes of a pipe are bound; a signal ends the wait for its writer."""
    os.mkfifo("pipe")
    command = [BIN / "trax-sim", "--quiet", "--bind", "input=pipe", "buffers", "l", "i", "7"]
    with subprocess.Popen(command, stderr=subprocess.PIPE) as waiting:
        pathlib.Path("pipe").write_bytes(b"12345678")
        waiting.communicate(timeout=60)
        equal(waiting.returncode, FINE + ord("8"), "a pipe: status")
    with subprocess.Popen(command, stderr=subprocess.PIPE) as waiting:
        writer = os.open("pipe", os.O_WRONLY)  # waits for the reader
        os.write(writer, b"1234")
        time.sleep(0.3)
        waiting.send_signal(signal.SIGINT)
        try:
            waiting.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            waiting.kill()
        os.close(writer)
        equal(waiting.returncode, -signal.SIGINT, "an interrupted pipe: status")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, options in (("buffers", ["-g"]), ("plain", [])):
            command = [BIN / "clang", "--target=trax", "-O2", *options, HERE / "buffers.c", "-o", name]
            subprocess.run(command, check=True)
        for engine in ENGINES:
            accesses(engine)
            other_accesses(engine)
            unbound(engine)
        pipes()
        os.chdir("/")
    sys.exit(1 if checking.failures else 0)


main()
