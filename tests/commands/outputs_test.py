"""One rule for the outputs of all programs (trax/output.h): devices, pipes and links stay what they are, no input is
destroyed, a file is whole or as it was on a full disk and after a failure, and closed standard streams change nothing
but what is printed.

Usage: outputs_test.py BIN VERSION
"""

import itertools
import json
import os
import resource
import shutil
import stat
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "report"))
import example  # noqa: E402  (invented results)
from common import TEST_BIN, accepted, end, fail, path_of, refused  # noqa: E402

CLANG = ["clang", "--target=trax"]
INPUT = "is an input and the output"


def write(path, text):
    with open(path, "w") as file:
        file.write(text)


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def prepare():
    subprocess.run([f"{TEST_BIN}/emulator-programs", "."], check=True)
    write("inc.h", "int of_header;\n")
    write("h.c", '#include "inc.h"\nint main(void) { for (int i = 0; i < of_header; i++) of_header += i; return 0; }\n')
    write("long.c", '#include "h.c"\n' + "".join(f"int f{i}(int x) {{ return x * {i}; }}\n" for i in range(99)))
    write("bad.c", "int x = \n")
    write("bad.s", "no_such_instruction\n")
    write("a.s", '.include "part.s"\n.incbin "bytes"\nnop\n.skip 9000\n')
    write("part.s", "nop\n")
    write("bytes", "0123")
    write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    write("response", "-c h.c\n")
    write("profile", "main:10:1\n 1: 1\n")
    accepted(*CLANG, "-c", "h.c", "-o", "h.o")
    accepted(*CLANG, "-c", "h.c", "-o", "z.o")
    subprocess.run(["ar", "rc", "libz.a", "z.o"], check=True)
    accepted("trax-scene", "-q", "a.obj", "-o", "a.trax")
    accepted(*CLANG, "-O1", "h.c", "-o", "h.elf")
    accepted("trax-render", "a.obj", "-q", "--size", "8x6", "--engine", "native", "-o", "p.png")
    write("results.json", json.dumps(example.partial()))


def outputs():
    """Each: a program with its arguments, the option of an output, and the ending that it needs."""
    for name in ("report", "stats", "explore", "profile", "heat", "trace", "post-mortem", "checkpoint"):
        yield ["trax-sim", *(["--checkpoint-at", "5"] if name == "checkpoint" else []),
               "hello.elf"], lambda path, name=name: [f"--{name}={path}"], ""
    yield ["trax-scene", "-q", "a.obj"], lambda path: ["-o", path], ".trax"
    yield ["trax-scene", "-q", "a.obj", "-o", "new.trax"], lambda path: ["--stats-json", path], ""
    yield ["trax-render", "-q", "a.obj", "--size", "8x6", "--engine", "native"], lambda path: ["-o", path], ".png"
    yield ["trax-render", "-q", "a.obj", "--size", "8x6", "--engine", "native", "-o",
           "new.png"], lambda path: ["--write-view", path], ""
    yield ["trax-ld", "h.o", "-e", "main"], lambda path: ["-o", path], ""
    yield ["trax-ld", "h.o", "-e", "main", "-o", "new"], lambda path: ["-Map", path], ""
    yield ["trax-mc", "-filetype=obj", "a.s"], lambda path: ["-o", path], ""
    yield ["trax-mc", "a.s"], lambda path: ["-o", path], ""
    for kind in (["-c", "long.c"], ["-S", "long.c"], ["-E", "long.c"], ["-c", "a.s"], ["-emit-llvm", "-c", "long.c"],
                 ["h.c"]):
        yield [*CLANG, *kind], lambda path: ["-o", path], ""
    for option in (["-MD", "-MF"], ["-MJ"], ["--serialize-diagnostics"]):
        yield [*CLANG, "-c", "h.c", "-o", "new.o"], lambda path, option=option: [*option, path], ""
    for name in ("foptimization-record-file", "ftime-trace", "fproc-stat-report"):
        yield [*CLANG, "-O2", "-c", "h.c", "-o", "new.o"], lambda path, name=name: [f"-{name}={path}"], ""
    yield [*CLANG, "h.c", "-o", "new"], lambda path: [f"-Wl,-Map={path}"], ""
    yield ["trax-eval", "report", "results.json"], lambda path: ["-o", path], ""


def few_descriptors():
    """With few descriptors an output is there, or its lack is an error."""
    for few in range(8, 66):
        for path in ("few.d", "few.o"):
            if os.path.exists(path):
                os.remove(path)
        ended = subprocess.run([path_of("clang"), *CLANG[1:], "-c", "h.c", "-o", "few.o", "-MD", "-MF", "few.d"],
                               capture_output=True, timeout=60, stdin=subprocess.DEVNULL,
                               preexec_fn=lambda few=few: resource.setrlimit(resource.RLIMIT_NOFILE, (few, few)))
        if ended.returncode == 0 and not (os.path.exists("few.d") and os.path.exists("few.o")):
            fail(f"with {few} descriptors an output is not there: {os.listdir('.')}")


def kind_of(path):
    status = os.lstat(path)
    return stat.S_IFMT(status.st_mode), status.st_ino, status.st_rdev


def special(number, words, option, ending):
    """What is no regular file is what it was, and the output has gone through it. The compiler's outputs, which all go
    one way, take two kinds each by turns."""
    shown = f"{' '.join(words)} {' '.join(option('X'))}"
    for path in ("link", "dangling", "fifo", "device", "far"):
        if os.path.lexists(path + ending):
            os.remove(path + ending)
    write("target", "old")
    os.symlink("target", f"link{ending}")
    os.symlink("absent", f"dangling{ending}")
    os.mkfifo(f"fifo{ending}")
    places = [f"link{ending}", f"dangling{ending}", f"fifo{ending}"]
    try:
        os.mknod(f"device{ending}", 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        os.symlink(f"device{ending}", f"far{ending}")
        places += [f"device{ending}", f"far{ending}"]
    except PermissionError:
        pass  # only root makes devices
    if words[0] == "clang" and not os.environ.get("TRAX_WHOLE"):
        places = [places[number % len(places)], places[(number + 2) % len(places)]]
    for path in places:
        before, got = kind_of(path), []
        reader = threading.Thread(target=lambda: got.append(contents(path)), daemon=True)
        if path.startswith("fifo"):
            reader.start()
        accepted(*words, *option(path))
        if not os.path.lexists(path) or kind_of(path) != before:
            fail(f"{shown}: {path} is not what it was")
        if path.startswith("fifo"):
            reader.join(20)
            if not got or not got[0]:
                fail(f"{shown}: nothing came through the pipe")
    if any(path.startswith("link") and contents("target") == b"old" or
           path.startswith("dangling") and not os.path.exists("absent") for path in places):
        fail(f"{shown}: nothing was written through a link")
    write("absent", "")
    os.remove("absent")
    long = "n" * (255 - len(ending)) + ending
    accepted(*words, *option(long))
    if not os.path.exists(long) or os.path.getsize(long) == 0:
        fail(f"{shown}: a name of 255 bytes has no contents")
    write(long, "")
    os.remove(long)


def full(words, option, ending):
    """A disk that is full after some bytes: status 1, the file as it was, nothing beside it, and no words of a
    crash."""
    os.makedirs("disk", exist_ok=True)
    shutil.rmtree("disk")
    os.makedirs("disk")
    write(f"disk/old{ending}", "old")
    ended = subprocess.run([path_of(words[0]), *words[1:], *option(f"disk/old{ending}")], capture_output=True,
                           text=True, timeout=60, stdin=subprocess.DEVNULL,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (16, 16)))
    if ended.returncode != 1 or "PLEASE" in ended.stderr or "Traceback" in ended.stderr:
        fail(f"{words} {option('X')} on a full disk: {ended.returncode}: {ended.stderr[:500]}")
    os.makedirs("disk", exist_ok=True)
    if os.listdir("disk") != [f"old{ending}"] or contents(f"disk/old{ending}") != b"old":
        fail(f"{words} {option('X')} on a full disk: left {os.listdir('disk')}")


def failures():
    """A run that fails leaves the earlier output."""
    write("old.out", "old")
    for words in ([*CLANG, "-c", "bad.c", "-o"], [*CLANG, "bad.c", "-o"], [*CLANG, "-c", "bad.s", "-o"],
                  [*CLANG, "h.c", "-Wl,--bad", "-o"],
                  [*CLANG, "h.o", "-lno-such", "-o"], ["trax-mc", "bad.s", "-o"],
                  ["trax-ld", "h.o", "-e", "nothing", "-lno-such", "-o"],
                  ["trax-scene", "-q", "bad.c", "-o"], ["trax-eval", "report", "bad.c", "-o"]):
        refused("error: ", *words, "old.out")
    os.symlink("old.out", "to-old")
    refused("error: ", *CLANG, "-c", "bad.c", "-o", "to-old")
    os.remove("to-old")


def inputs():
    refused(INPUT, *CLANG, "h.o", "-L.", "-lz", "-o", "libz.a")
    refused(INPUT, *CLANG, "h.o", "-L.", "-l:libz.a", "-o", "libz.a")
    kept = {name: contents(name) for name in ("h.c", "inc.h", "response", "profile", "a.s", "part.s", "bytes")}
    compile_h = [*CLANG, "-c", "h.c", "-O2", "-o", "new.o"]
    for words in ([*CLANG, "-c", "h.c", "-o", "inc.h"], [*CLANG, "h.c", "-o",
                                                         "inc.h"], [*CLANG, "-E", "h.c", "-o",
                                                                    "inc.h"], [*CLANG, "@response", "-o", "response"],
                  [*compile_h, "-fprofile-sample-use=profile", "-MD", "-MF",
                   "profile"], [*CLANG, "-c", "h.c", "-fprofile-sample-use=profile", "-o",
                                "profile"], *([*compile_h, *option, path] for path in ("h.c", "inc.h")
                                              for option in (["-MD", "-MF"], ["-MJ"], ["--serialize-diagnostics"])),
                  *([*compile_h, f"-{option}={path}"] for path in ("h.c", "inc.h")
                    for option in ("foptimization-record-file", "ftime-trace", "fproc-stat-report")),
                  *([*CLANG, "h.c", "-o", "new", f"-Wl,-Map={path}"]
                    for path in ("h.c", "inc.h")), *([*CLANG, "h.c", f"-Wl,-o,{path}"]
                                                     for path in ("h.c", "inc.h")), *([*CLANG, "-c", "a.s", "-o", path]
                                                                                      for path in ("part.s", "bytes")),
                  *(["trax-mc", "a.s", "-o", path]
                    for path in ("part.s", "bytes")), [*CLANG, "-c", "h.c", "-o", "./inc.h"]):
        ended = subprocess.run([path_of(words[0]), *words[1:]], capture_output=True, text=True,
                               stdin=subprocess.DEVNULL, timeout=60)
        if ended.returncode != 1 or INPUT not in ended.stderr:
            fail(f"{words}: {ended.returncode}: {ended.stderr}")
        for name, before in kept.items():
            if not os.path.exists(name) or contents(name) != before:
                fail(f"{words} destroyed {name}")
                with open(name, "wb") as file:
                    file.write(before)
    words = ["trax-render", "-q", "a.obj", "--size", "8x6", "-o", "new.png", "--source", "source", "--stats"]
    os.makedirs("source/trax", exist_ok=True)
    for name in ("main.c", "ray.h", "trax/deep.h"):
        write(f"source/{name}", "int x;\n")
        refused(INPUT, *words, f"source/{name}")


def closed():
    """One of the standard streams closed, or all of them: the same status and files."""
    commands = [(["trax-sim", "hello.elf", "--stats", "out"], "out"),
                (["trax-scene", "a.obj", "-o", "out.trax"], "out.trax"),
                (["trax-render", "a.obj", "--size", "8x6", "--engine", "native", "-o", "out.png"], "out.png"),
                (["trax-compare", "p.png", "p.png"], None),
                (["trax-ld", "-t", "h.o", "-e", "main", "-o", "out"], "out"),
                (["trax-mc", "-filetype=obj", "a.s", "-o", "out"], "out"), (["trax-objdump", "-d", "h.o"], None),
                ([*CLANG, "-v", "-c", "h.c", "-o", "out"], "out"),
                (["clang++", "--target=trax", "-v", "-x", "c++", "h.c", "-o", "out"], "out"),
                (["trax-eval", "report", "results.json", "-o", "out"], "out")]
    for words, output in commands:
        texts = set()
        for count in (0, 1, 3):
            for streams in itertools.combinations(("<&-", ">&-", "2>&-"), count):
                if output and os.path.exists(output):
                    os.remove(output)
                ended = subprocess.run(["sh", "-c", f'"$@" {" ".join(streams)}', "sh", path_of(words[0]), *words[1:]],
                                       capture_output=True, timeout=60)
                if ended.returncode != 0:
                    fail(f"{words} {streams}: status {ended.returncode}: {ended.stderr[:300]}")
                elif output:
                    texts.add(contents(output) if "--stats" not in words else bool(contents(output)))
        if output and len(texts) != 1:
            fail(f"{words}: {len(texts)} different outputs")


with tempfile.TemporaryDirectory() as directory:
    os.chdir(directory)
    os.environ["XDG_CACHE_HOME"] = f"{directory}/cache"
    prepare()
    for number, each in enumerate(outputs()):
        special(number, *each)
        full(*each)
    for part in (failures, inputs, closed, few_descriptors):
        part()
    os.chdir("/")
end()
