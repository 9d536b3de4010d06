"""The cache of compiled programs heals itself, and what stands in its way costs a note, never a picture.

Usage: cache_test.py BIN
"""

import glob
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import checking  # noqa: E402
from checking import fail  # noqa: E402

BIN, SOURCE = os.path.abspath(sys.argv[1]), os.path.dirname(os.path.abspath(__file__))
TINY = """#include <trax.h>
struct trax_buffer scene, image;
int main(void) {
  if (trax_thread() == 0)
    for (unsigned i = 0; i < image.size / 4; i++)
      ((unsigned *)image.data)[i] = 0xFF000000u + i + (scene.size == 0);
}
"""


def command(cache, *words):
    return [f"{BIN}/trax-render", f"{SOURCE}/box.obj", "--view", f"{SOURCE}/box.view", "--size", "16x9", "--config",
            "1x32", "--cache", cache, *words]


def render(cache, *words, **how):
    return subprocess.run(command(cache, "-o", "x.png", *words), capture_output=True, text=True, timeout=120, **how)


def pixels():
    with open("x.png", "rb") as file:
        return file.read()


def clean(cache, programs):
    """The cache has so many entries, and all are whole."""
    names = sorted(os.listdir(cache))
    keys = {name[:32] for name in names}
    if len(keys) != programs or names != sorted(f"{key}.{ending}" for key in keys for ending in ("elf", "h")):
        fail(f"{programs} programs should be in the cache, not {names}")


def expect(ended, what, note=None):
    if ended.returncode != 0 or pixels() != picture:
        fail(
            f"{what}: status {ended.returncode}, {'the' if pixels() == picture else 'another'} picture: {ended.stderr}")
    lines = ended.stderr.splitlines()
    if note is None and lines or note is not None and (len(lines) != 1 or not lines[0].startswith("trax-render: note: ")
                                                       or note not in lines[0]):
        fail(f"{what}: not one note with '{note}': {ended.stderr}")


def damages(entry, whole, other):
    """Yields what a power loss or a stranger may leave: (name, how it is made)."""
    def put(data):
        def make():
            with open(entry, "wb") as file:
                file.write(data)
        return make

    for size in (0, 100, len(whole) - 32, len(whole) - 1):
        yield f"cut to {size} bytes", put(whole[:size])
    for place in (4, len(whole) // 2, len(whole) - 20):
        yield f"bit flipped at {place}", put(whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1:])
    yield "zeros", put(bytes(len(whole)))
    yield "zeros at its end", put(whole[:1024] + bytes(len(whole) - 1024))
    yield "longer", put(whole + b"\0")
    yield "text", put(b"not a program\n" * 100)
    yield "another program", put(open(f"{BIN}/../lib/trax/trax-raytracer.elf", "rb").read())
    yield "another entry", put(other)
    yield "a folder", lambda: os.mkdir(entry)
    yield "a pipe", lambda: os.mkfifo(entry)
    yield "a device", lambda: os.symlink("/dev/zero", entry)
    yield "a link to itself", lambda: os.symlink(os.path.basename(entry), entry)

    def folder():
        os.mkdir(entry)
        open(f"{entry}/file", "w").close()
    yield "a folder with a file", folder


def remove(entry):
    if os.path.isdir(entry) and not os.path.islink(entry):
        shutil.rmtree(entry)
    elif os.path.lexists(entry):
        os.remove(entry)


def healing():
    """The cache heals itself: with a program that compiles in no time."""
    global picture
    shutil.copytree(f"{BIN}/../lib/trax/raytracer", "tiny")
    with open("tiny/main.c", "w") as file:
        file.write(TINY)
    cache, tiny = "healed", ["--source", "tiny"]
    if render(cache, *tiny).returncode != 0:
        fail("the first picture")
    picture = pixels()
    clean(cache, 1)
    entry, = glob.glob(f"{cache}/*.elf")
    with open(entry, "rb") as file:
        whole = file.read()
    if render("other", *tiny, "--background", "000000").returncode != 0:
        fail("another picture")
    with open(glob.glob("other/*.elf")[0], "rb") as file:
        other = file.read()
    for name, make in damages(entry, whole, other):
        remove(entry)
        make()
        expect(render(cache, *tiny), name, "was damaged, and is made anew")
        with open(entry, "rb") as file:
            if file.read() != whole:
                fail(f"{name}: the program made anew is another one")
        for left in glob.glob(f"{cache}/*.elf.*"):
            if name != "a folder with a file" or glob.glob(f"{left}/*.was/file") == []:
                fail(f"{name}: left {left}")
            shutil.rmtree(left)
        clean(cache, 1)
    with open(entry, "wb") as file:
        file.write(whole[:100])
    ended = render(cache, *tiny, "--quiet")
    if ended.returncode or ended.stderr or ended.stdout:
        fail(f"--quiet tells of a damaged program: {ended}")
    header = entry[:-3] + "h"
    remove(entry)
    os.remove(header)
    os.mkdir(header)
    expect(render(cache, *tiny), "a folder for the constants")
    clean(cache, 1)


def together():
    """Processes that find the same damage, or make the same program, do not disturb each other, even if one of them
    fails."""
    global picture
    if render("cache").returncode != 0:
        fail("the picture of the whole program")
    picture = pixels()
    entry, = glob.glob("cache/*.elf")
    with open(entry, "wb") as file:
        file.write(b"damaged")
    processes = [subprocess.Popen(command("cache", "-o", f"x{number}.png", "-q"), stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
                 for number in range(4)]
    for number, process in enumerate(processes):
        said, _ = process.communicate(timeout=120)
        with open(f"x{number}.png", "rb") as file:
            if process.returncode or said or file.read() != picture:
                fail(f"four at once: status {process.returncode}: {said}")
    clean("cache", 1)
    # One that is stopped while the other compiles takes nothing away from it.
    for turn in range(4):
        shutil.rmtree("cache")
        first = subprocess.Popen(command("cache", "-o", "x0.png", "-q"), stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        second = subprocess.Popen(command("cache", "-o", "x.png"), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  text=True)
        children = f"/proc/{first.pid}/task/{first.pid}/children"  # the compiler
        while first.poll() is None and not open(children).read():
            time.sleep(0.005)
        time.sleep(0.03 * turn)
        first.send_signal(signal.SIGTERM)
        if first.wait(timeout=60) != -signal.SIGTERM and turn == 0:
            fail(f"not stopped while it compiles: status {first.returncode}")
        said = second.communicate(timeout=120)[1]
        if second.returncode or said or pixels() != picture:
            fail(f"beside one that was stopped: status {second.returncode}: {said}")
        clean("cache", 1)


def no_room():
    """Files may have only so many bytes, as on a full disk: the general program renders, and nothing is left behind."""
    entry, = glob.glob("cache/*.elf")
    for limit in (12000, 30000, os.path.getsize(entry) - 20):
        shutil.rmtree("full", ignore_errors=True)
        ended = render("full", "--stats", "/dev/null",
                       preexec_fn=lambda: (resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))))
        expect(ended, f"files of {limit} bytes", "the general program renders")
        if os.path.exists("full") and os.listdir("full"):
            fail(f"files of {limit} bytes: left {os.listdir('full')}")
    if os.geteuid() != 0:
        return
    os.makedirs("small", exist_ok=True)
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "none", "small"], stderr=subprocess.DEVNULL).returncode:
        return
    try:
        expect(render("small"), "a full disk", "the general program renders")
        if os.listdir("small"):
            fail(f"a full disk: left {os.listdir('small')}")
        subprocess.run(["mount", "-o", "remount,ro", "small"], check=True)
        ended = render("small")
        if ended.returncode != 1 or "--cache small cannot be written: Read-only file system" not in ended.stderr:
            fail(f"a cache that was asked for and cannot be written: {ended}")
        os.environ["XDG_CACHE_HOME"] = os.path.abspath("small")
        ended = subprocess.run([word for word in command("", "-o", "x.png") if word not in ("--cache", "")],
                               capture_output=True, text=True)
        expect(ended, "a cache that cannot be written", "the general program renders")
    finally:
        subprocess.run(["umount", "small"], check=True)


def full():
    """The program that was used least recently goes when there are more than 256."""
    os.makedirs("many")
    for number in range(256):
        path = f"many/{number:032x}.elf"
        open(path, "w").close()
        os.utime(path, (1e9 - number, 1e9 - number))
    if render("many", "--source", "tiny").returncode:
        fail("a picture with a full cache")
    kept = sorted(name for name in os.listdir("many") if name.endswith(".elf"))
    if len(kept) != 256 or f"{255:032x}.elf" in kept or f"{254:032x}.elf" not in kept:
        fail(f"{len(kept)} programs are in the full cache, from {kept[0]}")


sys.exit(checking.run(healing, full, together, no_room))
