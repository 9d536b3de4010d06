"""Every program tells the project's version; a message begins with the name that it is about, even if that is empty; an
option that is none and one that is not said far enough are told apart.

Usage: messages_test.py BIN VERSION
"""

import os
import pty
import re
import shutil
import subprocess
import tempfile

from common import BIN, TEST_BIN, VERSION, accepted, end, fail, path_of, refused, run

USERS = ["clang", "clang++", "trax-clang", "trax-clang++", "trax-compare", "trax-eval", "trax-ld", "trax-mc",
         "trax-objdump", "trax-render",
         "trax-scene", "trax-sim"]
OTHERS = ["trax-llc", "trax-isa-gen", "trax-isa-model", "trax-isa-mutants", "trax-accuracy"]


def versions():
    if not set(os.listdir(BIN)) <= set(USERS):
        fail(f"build/bin has more than the user's programs: {set(os.listdir(BIN)) - set(USERS)}")
    found = {
        name
        for name in os.listdir(TEST_BIN) if name.startswith("trax-") and not name.endswith(("-replay", "-fuzzer"))}
    if not found <= set(OTHERS):
        fail(f"programs that are not asked: {found - set(OTHERS)}")
    for name in USERS + OTHERS:
        if not os.path.exists(path_of(name)):
            continue
        out = accepted(name, "--version").stdout
        if not re.search(rf"(^|[ ]){re.escape(VERSION)}([ ,\n]|$)", out, re.MULTILINE):
            fail(f"{name} --version: {out}")
    if VERSION not in accepted("trax-eval", "report", "--version").stdout:
        fail("trax-eval report --version")


def empty_names():
    """No message begins with a colon, whatever is empty."""
    with open("a.obj", "w") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    commands = [
        ["trax-sim", ""], ["trax-sim", "--config", "", "x"], ["trax-sim", "--bind", "a=", "x"],
        ["trax-sim", "--resume=", "x"],
        ["trax-render", "", "-o", "x.png"], ["trax-render", "a.obj", "-o", ""],
        ["trax-render", "a.obj", "-o", "x.png", "--view", ""],
        ["trax-render", "a.obj", "-o", "x.png", "--config", ""], ["trax-render", "a.obj", "-o", "x.png", "--program="],
        ["trax-render", "a.obj", "-o", "x.png", "--write-view="], ["trax-render", "a.obj", "-o", "x.png", "--keep="],
        ["trax-render", "a.obj", "-o", "x.png", "--set", ""], ["trax-render", "a.obj", "--prepare", ""],
        ["trax-render", "a.obj", "-o", "x.png", "--material", ""], ["trax-render", "a.obj", "-o", "x.png", "--cache="],
        ["trax-scene", "", "-o", "x.trax"], ["trax-scene", "a.obj", "-o", ""],
        ["trax-scene", "a.obj", "-o", "x", "--stats-json", ""],
        ["trax-scene", "--check", ""], ["trax-scene", "a.obj", "-o", "x", "--diffuse", ""], ["trax-compare", "", ""],
        ["trax-compare", "a.obj", ""],
        ["trax-ld", ""], ["trax-ld", "a.obj", "-o", ""], ["trax-ld", "-l", "", "a.obj"], ["trax-ld", "@"],
        ["trax-ld", "-Map=", "a.obj"],
        ["trax-mc", ""], ["trax-llc", ""], ["trax-objdump", ""], ["clang", "--target=trax", ""],
        ["clang", "--target=trax", "-c", "a.c", "-o", ""],
        ["trax-isa-model", ""], ["trax-eval", ""], ["trax-eval", "table1", "", "-o", ""], ["trax-eval", "report", ""],
        ["trax-eval", "report", "x.json", "-o", ""],
        ["trax-eval", "table1", "--size", ""]]
    for program, *words in commands:
        ended = run(program, *words)
        if ended.returncode == 0 or not ended.stderr:
            fail(f"{program} {words}: status {ended.returncode}")
        for line in ended.stderr.splitlines():
            if re.match(r"([\w+-]+: )?((fatal )?error: )?:|.*: : ", line) or "Traceback" in line:
                fail(f"{program} {words}: {line}")
    refused('"": cannot ', "trax-scene", "", "-o", "x.trax")
    refused('"": cannot ', "trax-sim", "")


def options():
    render, scene = ("trax-render", "a.obj", "-o", "x.png"), ("trax-scene", "a.obj", "-o", "x.trax")
    refused("unknown option --siez; did you mean --size?", *render, "--siez", "1x1")
    refused("--s is ambiguous: ", *render, "--s", "x")
    refused("unknown option --quite-another", *render, "--quite-another=3")
    refused("unknown option -z", *render, "-qz")
    refused("--quiet takes no value", *render, "--quiet=1")
    refused("-o needs FILE", "trax-render", "a.obj", "-o")
    refused("--size needs WxH", *render, "--size")
    refused("unknown option --depht; did you mean --depth?", *scene, "--depht", "2")
    refused("--s is ambiguous: --stats, --stats-json, --splits, --smooth", *scene, "--s")
    refused("unknown option -x", *scene, "-x")
    refused("--quiet takes no value", *scene, "--quiet=1")
    refused("--leaf needs N", *scene, "--leaf")
    refused("unknown option --wihtin; did you mean --within?", "trax-compare", "a", "b", "--wihtin", "2")
    refused("unknown option --outputs", "trax-compare", "a", "b", "--outputs")
    refused("--within needs N", "trax-compare", "a", "b", "--within")
    refused("unknown option --reprot; did you mean --report?", "trax-sim", "--reprot", "x", "y")
    refused("unknown option '--gc-section'; did you mean '--gc-sections'?", "trax-ld", "a.obj", "--gc-section")
    refused("unknown option '--nothing-like-it'", "trax-ld", "a.obj", "--nothing-like-it")
    for program, *words in (render, scene, ("trax-compare", "a", "b")):
        for option in ("--zzz", "--siez=1", "--wihtin"):
            ended = run(program, *words, option)
            if "ambiguous" in ended.stderr:
                fail(f"{program} {option} is called ambiguous: {ended.stderr}")


def listings():
    """What programs that pass options on ask for, and completion."""
    given = accepted("trax-sim", "--stats", "s", "--quiet", "--explore-against", "a", "--config", "4x32",
                     "--help-given")
    names = ["options of trax-sim:", "--config", "--stats writes", "--explore-against reads", "--quiet"]
    if given.stdout.splitlines() != names:
        fail(f"--help-given: {given.stdout}")
    words = accepted("trax-sim", "--help-words", "--quiet", "--config", "4x32", "--max-cycles", "5", "a", "an operand")
    if words.stdout.split("\0") != ["--quiet", "--config=4x32", "--max-cycles=5", "--", "a", "an operand", ""]:
        fail(f"--help-words: {words.stdout!r}")
    if "complete -o filenames" not in accepted("trax-sim", "--help-completion").stdout:
        fail("--help-completion")


def on_terminal(program, *words, **environment):
    """What a program prints on a terminal."""
    master, slave = pty.openpty()
    process = subprocess.Popen([f"{BIN}/{program}", *words], stdin=subprocess.DEVNULL, stdout=slave, stderr=slave,
                               env=os.environ | {"TERM": "xterm", "NO_COLOR": ""} | environment)
    os.close(slave)
    text = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:  # the other end is closed
            part = b""
        if not part:
            break
        text += part
    os.close(master)
    process.wait(timeout=60)
    return text.decode()


def colours():
    """The word `error` is red on a terminal that has colours, unless the user wants none; in a file it never is."""
    commands = [["trax-sim", "absent"], ["trax-render", "absent.obj", "-o", "x.png"],
                ["trax-scene", "absent.obj", "-o", "x.trax"], ["trax-compare", "absent", "absent"],
                ["trax-ld", "absent"], ["trax-mc", "absent"], ["trax-objdump", "absent"], ["trax-eval", "absent"],
                ["trax-eval", "report", "absent"],
                ["trax-clang", "absent.c"]]
    for program, *words in commands:
        shown = on_terminal(program, *words)
        if not re.search(r"\033\[[0-9;]*31m *error: ", shown):
            fail(f"{program} {words}: no colour: {shown!r}")
        for environment in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            shown = on_terminal(program, *words, **environment)
            if "\033[" in shown.replace("\033[K", "") or "error: " not in shown:
                fail(f"{program} {words} with {environment}: {shown!r}")
        if "\033" in run(program, *words, env=os.environ | {"TERM": "xterm"}).stderr:
            fail(f"{program} {words}: a colour in a file")


def notes():
    """A note stands on a line of its own beside the progress, in colour, and once."""
    with open("thin.obj", "w") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n")
    words = ["thin.obj", "-o", "x.png", "--size", "8x6"]
    shown = on_terminal("trax-render", *words, "--engine", "native")
    if shown.count("1 of 2 triangles have no area") != 1 or not re.search(
            r"(^|\n|\033\[K)trax-render: \033\[1;36mnote: \033\[0m1 of 2", shown):
        fail(f"the note is not there once and by itself: {shown!r}")
    ended = accepted("trax-render", *words, "--engine", "native")
    if "note: 1 of 2" not in ended.stderr or "\033" in ended.stderr:
        fail(f"the note in a file: {ended.stderr!r}")
    environment = os.environ | {"PATH": "/nowhere", "XDG_CACHE_HOME": os.path.abspath("none")}
    os.makedirs("lone/bin"), os.makedirs("lone/share")
    for name in ("lib", "share/trax"):
        os.symlink(os.path.realpath(f"{BIN}/../{name}"), f"lone/{name}")
    shutil.copy(f"{BIN}/trax-render", "lone/bin/trax-render")  # without a compiler beside it
    ended = subprocess.run(["lone/bin/trax-render", *words], capture_output=True, text=True, env=environment)
    if ended.returncode != 0 or ended.stderr.count("the general program renders") != 1:
        fail(f"the note is not there once: {ended.stderr}")


with tempfile.TemporaryDirectory() as directory:
    os.chdir(directory)
    for part in (versions, empty_names, options, listings, colours, notes):
        part()
    os.chdir("/")
end()
