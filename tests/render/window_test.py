#!/usr/bin/env python3
"""trax-render --show and --progress-png: window_test.py BIN CLIENT

The window is on a display of its own, by Xvfb; without Xvfb the test is skipped (status 77)."""

import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

BIN, CLIENT = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
MESH = pathlib.Path(__file__).resolve().parent / "box.obj"
SKIPPED = 77
failures = 0


def check(passed, *what):
    global failures
    if not passed:
        failures += 1
        print("FAILED:", *what, flush=True)


def pixels(path):
    """Width, height and rows of RGB of a PNG as trax-render writes it, or of a PPM."""
    data = path.read_bytes()
    if data.startswith(b"P6"):
        _, size, _, rest = data.split(b"\n", 3)
        width, height = map(int, size.split())
        return width, height, [rest[3 * width * y:3 * width * (y + 1)] for y in range(height)]
    at, packed, width, height = 8, b"", 0, 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", content[:8])
        packed += content if kind == b"IDAT" else b""
        at += 12 + length
    raw, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        method, row = raw[y * (3 * width + 1)], bytearray(raw[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)])
        for x in range(3 * width):
            left, up, corner = row[x - 3] if x >= 3 else 0, above[x], above[x - 3] if x >= 3 else 0
            nearest = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            row[x] = (row[x] + (0, left, up, (left + up) // 2, nearest)[method]) & 255
        rows.append(bytes(row))
        above = row
    return width, height, rows


def magnified(picture, times):
    width, height, rows = picture
    large = [b"".join(row[3 * x:3 * x + 3] * times for x in range(width)) for row in rows]
    return width * times, height * times, [row for row in large for _ in range(times)]


def client(*words):
    run = subprocess.run([CLIENT, *words], capture_output=True, text=True, timeout=120)
    check(run.returncode == 0, "the client failed:", *words)
    return run.stdout.strip()


def wait_for(what, condition):
    """No time is measured here: it is as long as this host needs, within two minutes."""
    for _ in range(1200):
        if condition():
            return
        time.sleep(0.1)
    check(False, "this never came:", what)


def shown(*words):
    return subprocess.Popen([BIN / "trax-render", MESH, *words, "--size", "64x48", "--show"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(process, status):
    out, err = process.communicate(timeout=120)
    check(process.returncode == status, "status", process.returncode, "instead of", status, err)
    return out


def test_emulated(folder):
    process = shown("-o", "picture.png", "--cost-picture", "cost.png", "--progress-png", "progress.png")
    wait_for("the picture, when the run has ended", lambda: b"picture.png" in os.read(process.stdout.fileno(), 4096))
    client("grab", "window.ppm")
    picture = pixels(folder / "picture.png")
    check(picture[0] == 64, "the picture has another size", picture[:2])
    check(pixels(folder / "window.ppm") == magnified(picture, 8), "the window has another picture than the file")
    check(pixels(folder / "progress.png") == picture, "the last frame is another picture")
    check("picture (c: cost" in client("title"), "the title of the picture:", client("title"))
    client("key", "c")
    wait_for("the cost", lambda: "cost (c: picture" in client("title"))
    client("grab", "window.ppm")
    check(pixels(folder / "window.ppm") == magnified(pixels(folder / "cost.png"), 8), "the window has other costs than the file")
    client("key", "c")
    wait_for("the picture again", lambda: "picture (c: cost" in client("title"))
    client("grab", "window.ppm")
    check(pixels(folder / "window.ppm") == magnified(picture, 8), "the key does not lead back")
    client("key", "q")
    ended(process, 0)


def test_twin(folder):
    process = shown("--engine", "native")  # a window alone is enough
    wait_for("the title", lambda: client("title").startswith("trax-render: picture"))
    process.send_signal(signal.SIGSTOP)
    process.send_signal(signal.SIGCONT)
    client("key", "c")
    wait_for("that there are no costs", lambda: "no costs are known" in client("title"))
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=120)
    check(process.returncode in (0, -signal.SIGINT), "an interrupt ends it:", process.returncode)


def test_lost_display(folder, display):
    """Who has lost the window still gets the picture."""
    process = shown("-o", "lost.png", "--engine", "native")
    wait_for("the picture", lambda: b"lost.png" in os.read(process.stdout.fileno(), 4096))
    display.kill()
    display.wait()
    ended(process, 0)
    check((folder / "lost.png").exists(), "the picture is lost with the display")


def test_without_display(folder):
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    run = subprocess.run([BIN / "trax-render", MESH, "--show", "-o", "never.png"], capture_output=True, text=True, env=environment)
    check(run.returncode == 1 and "--show: there is no display" in run.stderr and "--progress-png" in run.stderr and not (folder / "never.png").exists(), run)
    for engine in ("fast", "native", "embree"):
        words = [MESH, "--size", "40x30", "--engine", engine]
        subprocess.run([BIN / "trax-render", *words, "--progress-png", "frames.png", "-o", "whole.png", "-q"], check=True, env=environment)
        check((folder / "frames.png").read_bytes() == (folder / "whole.png").read_bytes(), engine, "the last frame is another picture")
        (folder / "frames.png").unlink()
    subprocess.run([BIN / "trax-render", *words, "--progress-png", "frames.png", "-q"], check=True, env=environment)
    check((folder / "frames.png").exists(), "no frames without -o")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.chdir(folder)
        test_without_display(folder)
        if not shutil.which("Xvfb"):
            print("SKIPPED: the window, since Xvfb is missing (package xvfb)")
            return SKIPPED if not failures else 1
        for depth in (30, 24):
            reader, writer = os.pipe()
            display = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", f"1280x1024x{depth}",
                                        "-nolisten", "tcp"],
                                       pass_fds=[writer], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            os.close(writer)
            os.environ["DISPLAY"] = ":" + os.read(reader, 100).decode().strip()
            try:
                test_emulated(folder)
                if depth == 24:
                    test_twin(folder)
                    test_lost_display(folder, display)
            finally:
                if display.poll() is None:
                    display.terminate()
                    display.wait()
        os.chdir("/")
    print("all as expected" if not failures else f"{failures} failures")
    return failures != 0


sys.exit(main())
