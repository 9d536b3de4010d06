#!/usr/bin/env python3
"""Arguments, standard input and files of programs: as the host has them, in every engine alike, below the allowed
folders only, and whole or not at all.

  calls_test.py BIN SOURCE"""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SIM, ENGINES = BIN / "trax-sim", ("fast", "reference", "functional")


class Place:
    """A folder with the program, for the machine and for the host, and a folder `data` that the program may use."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.data = self.root / "data"
        subprocess.run([BIN / "clang", "--target=trax", "-mstack=global", "-O2", "-g", SOURCE / "files.c", "-o",
                        self.root / "files"], check=True)
        subprocess.run(["cc", "-O1", "-w", SOURCE / "files.c", "-o", self.root / "host"], check=True)
        self.fresh()

    def fresh(self):
        shutil.rmtree(self.data, ignore_errors=True)
        self.data.mkdir()
        (self.data / "old.txt").write_text("one\ntwo\n")

    def files(self):
        return {
            str(path.relative_to(self.data)): path.read_bytes()
            for path in sorted(self.data.rglob("*")) if path.is_file()}

    def run(self, *words, options=(), stdin=b"", folder=("--dir", "data"), prefix=()):
        return subprocess.run([*prefix, SIM, "--quiet", *folder, *options, "files", *words], cwd=self.root, input=stdin,
                              capture_output=True,
                              check=False, timeout=300)

    def host(self, *words, stdin=b""):
        return subprocess.run([self.root / "host", *words], cwd=self.root, input=stdin, capture_output=True,
                              check=False, timeout=60)


# Done by the host and by every engine from the same beginning.
SAME = {
    "read": (["read", "data/old.txt", "read", "./data//old.txt", "read", "data/none"], b""),
    "write": (["write", "data/new.txt", "append", "data/old.txt", "read", "data/new.txt", "append", "data/new.txt",
               "exclusive", "data/new.txt",
               "exclusive", "data/other.txt", "write", "data/none/x"], b""),
    "update": (["update", "data/update.txt", "descriptors", "data/raw.bin"], b""),
    "names": (["rename", "data/old.txt", "data/moved.txt", "remove", "data/none", "folder", "data/sub", "folder",
               "data/sub", "write", "data/sub/x",
               "rename", "data/sub/x", "data/moved.txt", "remove", "data/sub", "remove", "data/moved.txt", "read",
               "data/moved.txt"], b""),
    "input": (["input"], b"".join(b"line %d\n" % i * (i % 3) for i in range(200)) + bytes(range(256)) + b"no end"),
    "copy": (["copy", "data/copy.txt", "read", "data/copy.txt"], b"alpha\nbeta\ngamma"),
    "output elsewhere": (["reopen", "data/output.txt", "read", "data/output.txt"], b""),
    "left open": (["open", "data/left.txt", "write", "data/new.txt"], b""),
}


def same(place):
    for name, (words, stdin) in SAME.items():
        place.fresh()
        host = place.host(*words, stdin=stdin)
        files = place.files()
        cycles = {}
        for engine in ENGINES:
            for chip in ((), ("--set", "chip.tms=2", "--set", "chip.tps_per_tm=4")):
                place.fresh()
                done = place.run(*words, stdin=stdin, options=("--engine", engine, "--stats", "stats.json", *chip))
                label = f"{name}, {engine} {' '.join(chip)}"
                check(
                    done.stdout == host.stdout and done.returncode == host.returncode, label,
                    f"{done.stdout.decode(errors='replace')}\nnot\n{host.stdout.decode(errors='replace')}\n"
                    f"{done.stderr.decode(errors='replace')}"
                )
                check(place.files() == files, label + ": files", f"{place.files()} instead of {files}")
                statistics = json.loads((place.root / "stats.json").read_text())
                if engine != "functional":
                    cycles.setdefault(chip, []).append((statistics["cycles"], statistics["dcache"]))
        for chip, figures in cycles.items():
            check(figures[0] == figures[1], f"{name}: cycles {chip}", figures)


def printed(place):
    """The output of all threads goes to standard output, also in epochs on several threads of the host."""
    subprocess.run([BIN / "clang", "--target=trax", "-mstack=global", "-O2", "-x", "c", "-", "-o", place.root / "many"],
                   input=b"""#include <stdatomic.h>
#include <stdio.h>
#include <trax.h>
static atomic_int ready;
int main(void) {
  if (trax_thread() == 0) ready = freopen("data/output.txt", "w", stdout) ? 1 : 2;
  while (!ready) ;
  for (int i = 0; i < 400; i++) putchar('a' + (int)(trax_thread() + i) % 26);
  return ready - 1;
}
""", check=True)
    texts = set()
    for options in (["--engine", "reference"], ["--host-threads", "1"], ["--host-threads", "3"]):
        place.fresh()
        done = subprocess.run([SIM, "--quiet", "--config", "4x32", *options, "--dir", "data", "many"], cwd=place.root,
                              capture_output=True, check=False, timeout=100)
        check((done.returncode, done.stdout) == (0, b""), "printed", options, done)
        texts.add((place.data / "output.txt").read_bytes())
    check(len(texts) == 1 and len(texts.pop()) == 128 * 400, "printed", "differs")


def arguments(place):
    done = place.run("arguments", "two words", "--report", "-", "")
    check((done.returncode, done.stdout) == (6, b"[files][arguments][two words][--report][-][] 1\n"), "arguments", done)
    subprocess.run([BIN / "clang", "--target=trax", "-O2", "-x", "c", "-", "-o", place.root / "none"],
                   input=b"int main(void) { return 0; }", check=True)
    done = subprocess.run([SIM, "none", "word"], cwd=place.root, capture_output=True, text=True, check=False)
    check(done.returncode == 1 and "main has no parameters" in done.stderr, "no parameters", done)
    done = subprocess.run([SIM, "none", "--report", "-"], cwd=place.root, capture_output=True, text=True, check=False)
    check(done.returncode == 0 and "cycles" in done.stdout, "options behind", done)
    subprocess.run([BIN / "clang", "--target=trax", "-mstack=global", "-O2", "-s", SOURCE / "files.c", "-o",
                    place.root / "stripped"], check=True)
    done = subprocess.run([SIM, "stripped", "arguments"], cwd=place.root, capture_output=True, text=True, check=False)
    check(done.returncode == 2 and done.stdout == "[stripped][arguments] 1\n", "stripped", done)


def folders(place):
    """Allowed folders are reachable, and no path leads out of them."""
    place.fresh()
    (place.root / "secret.txt").write_text("secret\n")
    os.symlink("../secret.txt", place.data / "out")
    os.symlink("/etc/passwd", place.data / "absolute")
    os.symlink("..", place.data / "up")
    os.symlink("old.txt", place.data / "inside")
    os.symlink("loop", place.data / "loop")
    os.mkfifo(place.data / "pipe")
    words = []
    for path in ("data/../secret.txt", "data/out", "data/absolute", "data/up/secret.txt", "data/inside", "data/loop",
                 "secret.txt", "/etc/passwd",
                 "../x", "data/old.txt/x", "data/pipe", "", "data/" + "n" * 300, "data"):
        words += ["read", path]
    done = place.run(*words).stdout.decode()
    answers = re.findall(r"^read .*: (.*)$", done, re.M)
    check(answers == ["Operation not permitted", "Operation not permitted", "Operation not permitted",
                      "Operation not permitted", "good",
                      "Too many levels of symbolic links", "No such file or directory", "No such file or directory",
                      "No such file or directory", "Not a directory", "Operation not permitted",
                      "No such file or directory",
                      "File name too long", "good", "Is a directory"], "folders", done)  # a folder opens
    done = place.run("write", "data/out", "write", "data/up/new", "remove", "data/../secret.txt", "rename",
                     "data/old.txt", "data/up/y").stdout.decode()
    check(done.count("Operation not permitted") == 4 and (place.root / "secret.txt").read_text() == "secret\n" and
          not (place.root / "new").exists() and not (place.root / "y").exists(), "no way out", done)
    done = place.run("read", "data/old.txt", folder=()).stdout.decode()
    check(done == "read data/old.txt: No such file or directory\n", "no folder", done)
    done = place.run("read", "/guest/name/old.txt", "read", "old.txt", "read", "/guest/names",
                     folder=("--dir", "data::/guest/name")).stdout.decode()
    check(re.findall(": (.*)", done) == ["good"] + 2 * ["No such file or directory"], "name", done)
    done = place.run("read", "old.txt", "read", "./old.txt", folder=("--dir", "data::.")).stdout.decode()
    check(re.findall(": (.*)", done) == 2 * ["good"], "here", done)
    for folder, message in (("missing", "missing: No such file or directory"), ("files", "files: Not a directory"),
                            ("data::", "is not of the form")):
        done = place.run("input", folder=("--dir", folder))
        check(done.returncode == 1 and message in done.stderr.decode() and not done.stdout, f"--dir {folder}", done)


def read_only(place):
    """As another user: root may write everywhere."""
    place.fresh()
    (place.data / "fixed.txt").write_text("fixed\n")
    os.chmod(place.data / "fixed.txt", 0o444)
    os.chmod(place.data, 0o555)
    prefix = ["setpriv", "--bounding-set=-dac_override,-dac_read_search"] if os.getuid() == 0 else []
    done = place.run("write", "data/new.txt", "append", "data/fixed.txt", "read", "data/fixed.txt", "remove",
                     "data/old.txt", prefix=prefix)
    check(re.findall(": (.*)", done.stdout.decode()) == ["Permission denied", "Permission denied", "good",
                                                         "Permission denied"], "read-only", done)
    os.chmod(place.data, 0o755)


def whole(place):
    """A fault, a limit or Ctrl-C leaves what was closed, and nothing of what was not."""
    for name, words, options, status in (("fault", ["fault"], (), 1),
                                         ("limit", ["spin"], ("--max-cycles", "200000"), 124)):
        place.fresh()
        done = place.run("write", "data/closed.txt", "open", "data/left.txt", "open", "data/old.txt", *words,
                         options=options)
        check(done.returncode == status and place.files() == {"closed.txt": b"first\n", "old.txt": b"one\ntwo\n"}, name,
              (done, place.files()))
    place.fresh()
    with subprocess.Popen([SIM, "--quiet", "--dir", "data", "files", "write", "data/closed.txt", "open", "data/old.txt",
                           "input"], cwd=place.root,
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        output = b""
        while b"old.txt: good" not in output:  # it waits for input now, or soon
            output += process.stdout.read1(100)
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=60)
    check(process.returncode == -signal.SIGINT and b"interrupted" in message and
          place.files() == {"closed.txt": b"first\n", "old.txt": b"one\ntwo\n"}, "Ctrl-C",
          (process.returncode, message, place.files()))


def checkpoints(place):
    """A run that goes on from a checkpoint reads, prints and leaves the same, wherever the checkpoint was."""
    words = ["append", "data/old.txt", "copy", "data/copy.txt", "read", "data/copy.txt", "append", "data/old.txt",
             "read", "data/old.txt",
             "rename", "data/copy.txt", "data/moved.txt"]
    stdin = b"".join(b"line %d\n" % i for i in range(12))
    for begin, chip in ((1, ()), (2, ("--set", "chip.tms=2", "--set", "chip.tps_per_tm=4"))):
        place.fresh()
        whole_run = place.run(*words, stdin=stdin, options=("--stats", "stats.json", *chip))
        files, statistics = place.files(), json.loads((place.root / "stats.json").read_text())
        for part in range(begin, 10, 2):
            place.fresh()
            limit = ("--max-cycles", str(statistics["cycles"] * part // 10), "--checkpoint", "state")
            first = place.run(*words, stdin=stdin, options=(*limit, *chip))
            second = place.run(*words, stdin=stdin, options=("--resume", "state", "--stats", "stats.json", *chip))
            again = json.loads((place.root / "stats.json").read_text())
            label = f"checkpoint at {part} of 10 {chip}"
            check(
                first.returncode == 124 and second.returncode == 0 and
                first.stdout + second.stdout == whole_run.stdout and place.files() == files and
                again["cycles"] == statistics["cycles"], label,
                (first, second, place.files(), again["cycles"], statistics["cycles"]))
    place.fresh()
    place.run(*words, stdin=stdin, options=(*limit, *chip))
    done = place.run(*words, stdin=b"other\n" * 20, options=("--resume", "state", *chip))
    check(done.returncode == 1 and b"standard input is not that" in done.stderr, "other input", done)
    done = place.run(*words, stdin=b"", options=("--resume", "state", *chip))
    check(done.returncode == 1 and b"standard input is shorter" in done.stderr, "no input", done)


def main_on(place):
    source = (b'#include <stdio.h>\n#include <stdlib.h>\nvoid f(void) { puts("end"); }\nint main(void) { puts("main"); '
              b'atexit(f); return 3; }\n')
    subprocess.run([BIN / "clang", "--target=trax", "-O2", "-x", "c", "-", "-o", place.root / "plain"], input=source,
                   check=True)
    for engine in ENGINES:
        for options, lines in ((["--main-on", "0"], 1), (["--main-on", "all"], 8), ([], 8)):
            done = subprocess.run([SIM, "--quiet", "--engine", engine, "--set", "chip.tms=2", "--set",
                                   "chip.tps_per_tm=4", *options, "plain"], cwd=place.root,
                                  capture_output=True, check=False)
            check(done.stdout == b"main\n" * lines + b"end\n" * lines and done.returncode == 3,
                  f"main on {options} {engine}", done)
    done = subprocess.run([SIM, "--main-on", "1", "plain"], cwd=place.root, capture_output=True, check=False)
    check(done.returncode == 1 and b"is neither 0 nor all" in done.stderr, "main on 1", done)


def picture(place):
    """A path tracer by the book: the host's picture. Its binary64 is software here, so it is a small one."""
    place.fresh()
    source = SOURCE / "pathtracer.c"
    subprocess.run([BIN / "clang", "--target=trax", "-mstack=global", "-O2", source, "-o", place.root / "trax"],
                   check=True)
    subprocess.run(["cc", "-O1", "-ffp-contract=off", source, "-o", place.root / "native", "-lm"], check=True)
    for engine, samples, width in (("functional", "4", "8"), ("fast", "2", "4")):
        subprocess.run([place.root / "native", samples, width, "data/host.ppm"], cwd=place.root, capture_output=True,
                       check=True)
        done = subprocess.run([SIM, "--quiet", "--engine", engine, "--dir", "data", "trax", samples, width,
                               "data/trax.ppm"], cwd=place.root,
                              capture_output=True, check=False, timeout=300)
        check(done.returncode == 0 and done.stderr.endswith(b"100.00%") and
              (place.data / "trax.ppm").read_bytes() == (place.data / "host.ppm").read_bytes(), f"picture, {engine}",
              done)


def errors(place):
    """Standard error is the host's; standard output is not held back behind it."""
    done = place.run("nothing", "x")
    check(done.stdout == b"" and b"nothing: unknown" in done.stderr, "standard error", done)


def main():
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as root:
        place = Place(root)
        for part in (arguments, same, printed, folders, read_only, whole, checkpoints, main_on, picture, errors):
            part(place)
    print(f"{checking.failures} failed, {time.monotonic() - begun:.0f} s")
    sys.exit(1 if checking.failures else 0)


main()
