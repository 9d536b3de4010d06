"""Parts of files_test.py that are not random: limits of the host, what another process puts to a name before it is
written, and input by the library."""

import json
import os
import resource
import subprocess

NAME = "q/a"


class Case:
    """Lines as in sequences.py."""

    def __init__(self, *lines, begin=()):
        self.begin, self.lines = list(begin), list(lines)

    def scripts(self):
        return "\n".join(["Q q", *self.begin, ""]), "\n".join(["Q q", *self.lines, ""])


def run_same(tools, label, case, *options, limit=None, kind=resource.RLIMIT_FSIZE):
    """Runs it on both sides, the machine's with a limit."""
    begin, script = case.scripts()
    folder = tools.fresh("host-files", begin)
    path = tools.write(tools.root / "script", script)
    expected = tools.run([tools.host], folder, path)[1], tools.list(folder)
    folder = tools.fresh("guest-files", begin)
    tools.write(path, script)
    status, output, message = tools.run(tools.simulate(*options), folder, path, limit, kind)
    tools.check(label, (output, tools.list(folder)) == expected and status == 0, (status, output[-300:], message))


def limits(tools, _):
    """Descriptors are not kept for closed files or for folders; room is taken by what was written."""
    deferred = ("--checkpoint", tools.root / "none")
    for names in (["n"], [f"f{i}/" for i in range(100)]):
        begin = [f"M {name[:-1]}" for name in names if "/" in name]
        files = [f"{name}{i}" for name in names for i in range(300 // len(names))]
        case = Case(*[line for name in files for line in (f"o 1 {name} wc", "w 1 5 3", "c 1")], begin=begin)
        for how in (("--engine", "functional"), deferred):
            run_same(tools, f"{len(names)} folders {how[0]}", case, *how, limit=100, kind=resource.RLIMIT_NOFILE)
    ends = [
        line
        for i in range(14)
        for line in (f"o {i} n{i} bc", f"t {i} 4294967296", f"s {i} -1 2", f"w {i} 1 {i}", f"s {i} -5 2", f"r {i} 9")
    ]
    for how in (("--engine", "functional"), deferred):
        run_same(tools, f"holes {how[0]}", Case(*ends), *how, limit=1 << 32, kind=resource.RLIMIT_AS)


def contents(path):
    return path.read_bytes() if path.is_file() else None


def moved(tools, _):
    """What cannot be written under its new name stays under its old one: at the end, and at a checkpoint."""
    begin = "Q q\nF q/a 20000 1 644 0\nF q/b 10 2 644 0\n".replace("q/", "")
    for label, lines in (
        ("renamed", ["R a c"]),
        ("exchanged", ["R a c", "R b a", "R c b"]),
        ("replaced", ["R a c", "o 1 a wct", "w 1 9 1", "c 1"]),
    ):
        folder = tools.fresh("guest-files", begin)
        path = tools.write(tools.root / "script", "\n".join(["Q q", *lines, ""]))
        before = contents(folder / NAME)
        status, _, message = tools.run(tools.simulate("--checkpoint", tools.root / "none"), folder, path, 10000)
        tools.check(
            f"{label} without room",
            status == 1
            and "cannot be written" in message
            and contents(folder / NAME) == before
            and (folder / "q" / "b").exists()
            and len(os.listdir(folder / "q")) == 2,
            (status, message, os.listdir(folder / "q")),
        )
    for label, lines in (("open", ["o 1 a b", "R a c"]), ("written", ["o 1 a b", "w 1 5 5", "R a c"])):
        folder = tools.fresh("guest-files", begin)
        path = tools.write(tools.root / "script", "\n".join(["Q q", *lines, *1000 * ["f 1"], ""]))
        status, _, message = tools.run(
            tools.simulate("--checkpoint", tools.root / "state", "--max-cycles", "400000"), folder, path
        )
        tools.check(
            f"{label} at the checkpoint",
            status == 124 and contents(folder / NAME) == before,
            (status, os.listdir(folder / "q")),
        )
        status, _, message = tools.run(tools.simulate("--resume", tools.root / "state"), folder, path)
        tools.check(
            f"{label} after it",
            status == 0 and contents(folder / NAME) is None and len(contents(folder / "q" / "c") or "") == 20000,
            message,
        )


def resumed(tools, _):
    """What a checkpoint has is complete, whether the host's files are those before or after the changes that belong to
    it."""
    begin = "Q q\nF a 20000 1 644 0\nF b 10 2 644 0\n"
    new = [line for name in "nk" for line in (f"o 1 {name} wct", "w 1 9 1", "c 1")]
    for committed in (True, False):
        folder = tools.fresh("guest-files", begin)
        whole = contents(folder / NAME)
        path = tools.write(
            tools.root / "script",
            "\n".join(["Q q", "R a c", "u b", *new, *1000 * ["f 1"], "R n m", "u k", "R c d", ""]),
        )
        tools.run(tools.simulate("--checkpoint", tools.root / "state", "--max-cycles", "600000"), folder, path)
        tools.check(
            "committed at the checkpoint", sorted(os.listdir(folder / "q")) == ["c", "k", "n"], os.listdir(folder / "q")
        )
        if not committed:
            tools.fresh("guest-files", begin)
            tools.write(path, "\n".join(["Q q", "R a c", "u b", *new, *1000 * ["f 1"], "R n m", "u k", "R c d", ""]))
        status, _, message = tools.run(tools.simulate("--resume", tools.root / "state"), folder, path)
        tools.check(
            f"resumed, {committed}",
            status == 0 and sorted(os.listdir(folder / "q")) == ["d", "m"] and contents(folder / "q" / "d") == whole,
            (status, message, os.listdir(folder / "q")),
        )


def ended(tools, _):
    """A run that is killed while it changes files after its program's end is resumed from there."""
    begin = "Q q\nF a 20000 1 644 0\nF b 10 2 644 0\n"
    lines = ["Q q", "R a c", "u b", "o 1 n wct", "w 1 9 1", "c 1", "o 2 m wct", "w 2 7 3"]
    changes = [
        lambda folder: (folder / "n").write_bytes(b"half"),
        lambda folder: (folder / "a").rename(folder / "c"),
        lambda folder: (folder / "b").unlink(),
    ]
    stats, state = tools.root / "stats", tools.root / "state"
    for config in ("1x32", "4x32"):
        folder = tools.fresh("guest-files", begin)
        path = tools.write(tools.root / "script", "\n".join([*lines, ""]))
        how = ("--config", config, "--stats", stats)
        status, _, message = tools.run(tools.simulate(*how, "--checkpoint", state), folder, path)
        tools.check(f"ended, {config}", status == 0 and state.exists(), (status, message))
        expected, figures = tools.list(folder), statistics(stats)
        for made in (*range(4), "all"):
            if made != "all":
                folder = tools.fresh("guest-files", begin)
                for change in changes[:made]:
                    change(folder / "q")
            tools.write(path, "\n".join([*lines, ""]))
            done = tools.run(tools.simulate(*how, "--resume", state), folder, path)
            tools.check(
                f"ended, {config}, {made} changes made",
                done == (0, "", "") and tools.list(folder) == expected and statistics(stats) == figures,
                (done, tools.list(folder)),
            )


def statistics(path):
    figures = json.loads(path.read_text())
    return {name: value for name, value in figures.items() if "host" not in name}


def put_link(path):
    path.symlink_to("../../outside/a")


def put_device(path):
    os.mknod(path, 0o600 | 0o020000, os.makedev(1, 3))


OBSTACLES = {"link": (put_link, 1), "pipe": (os.mkfifo, 1), "device": (put_device, 1), "folder": (os.mkdir, 21)}


def obstacles(tools, _):
    """What another process has put to the name meanwhile is neither followed nor opened nor replaced."""
    for what, (put, number) in OBSTACLES.items():
        for way in ("closed", "left open", "checkpoint", "renamed"):
            folder = tools.fresh("guest-files", "Q in\nM q\nF q/a 5 1 644 0\nF q/b 5 1 644 0\n") / "in"
            (folder.parent / "outside").mkdir()
            (folder.parent / "outside" / "a").write_text("SECRET")
            lines = {"renamed": ["o 1 t wct", "w 1 9 1", "R t a"]}.get(way, ["o 1 a wct", "w 1 9 1"])
            options = ("--checkpoint", tools.root / "none") if way == "checkpoint" else ("--engine", "functional")
            with subprocess.Popen(
                tools.simulate(*options),
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
            ) as process:
                process.stdin.write("\n".join(["Q q", *lines, "Z", ""]).encode())
                output = b""
                while (b"R 0\n" if way == "renamed" else b"w 9\n") not in output:
                    output += process.stdout.read(100)
                (folder / NAME).unlink()
                try:
                    put(folder / NAME)
                except PermissionError:
                    process.kill()
                    continue
                before = os.lstat(folder / NAME)
                rest, message = process.communicate(b"" if way == "left open" else b"c 1\n", timeout=60)
            after = os.lstat(folder / NAME)
            failed = process.returncode == 1 and b"a: the program's file cannot be written" in message
            failed = failed if way in ("left open", "checkpoint") else f"c -1 {number}".encode() in output + rest
            tools.check(
                f"{what}, {way}",
                failed
                and (before.st_ino, before.st_mode) == (after.st_ino, after.st_mode)
                and (folder.parent / "outside" / "a").read_text() == "SECRET"
                and sorted(os.listdir(folder.parent / "outside")) == ["a"]
                and not list(folder.rglob(".trax*")),
                (process.returncode, output + rest, message),
            )


def exchanged(tools, _):
    """Two files exchange names, and another process gives one of the names to a folder. The other file's contents stay:
    under their former name, or if that has been replaced, in a temporary file that the message names."""
    kept = []
    for taken, other in ("ab", "ba"):
        folder = tools.fresh("guest-files", "Q q\nF a 20000 1 644 0\nF b 10 2 644 0\n") / "q"
        whole = contents(folder / other)
        with subprocess.Popen(
            tools.simulate("--checkpoint", tools.root / "none"),
            cwd=folder.parent,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            bufsize=0,
        ) as process:
            process.stdin.write(b"Q q\nR a c\nR b a\nR c b\nZ\n")
            output = b""
            while output.count(b"R 0\n") < 3:
                output += process.stdout.read(100)
            (folder / taken).unlink()
            (folder / taken).mkdir()
            message = process.communicate(timeout=60)[1].decode()
        left = [path.name for path in folder.iterdir() if contents(path) == whole]
        kept += left
        tools.check(
            f"exchanged, {taken} is taken",
            process.returncode == 1
            and "cannot be written" in message
            and len(left) == 1
            and (left[0] == other or f"(complete in {left[0]})" in message),
            (process.returncode, message, os.listdir(folder)),
        )
    tools.check("exchanged: a temporary file", sum(name.startswith(".trax-") for name in kept) == 1, kept)


def library(tools, options):
    if not options.library:
        return
    case = Case("o 1 n wc", "w 1 5 3", "c 1", "S n")
    for way in ("memory", "cookie", "read"):
        begin, script = case.scripts()
        folder = tools.fresh("guest-files", begin)
        path = tools.write(tools.root / "script", "not read\n" * (way == "read") + script)
        done = tools.run([os.path.abspath(options.library), tools.guest, path, way], folder, path)
        tools.check(f"input by the library: {way}", done == (0, "Q q\no 3\nw 5\nc 0\nS file 5 600\n", ""), done)


def outputs(tools, _):
    """An output of the simulator is no file that the program has read or written."""
    begin = "Q q\nF a 20 1 644 0\n"
    for label, lines, left in (("read", ["o 1 a r", "r 1 5", "c 1"], 20), ("written", ["o 1 a wct", "w 1 9 1",
                                                                                       "c 1"], 9)):
        for option in ("--stats", "--trace"):
            folder = tools.fresh("guest-files", begin)
            path = tools.write(tools.root / "script", "\n".join(["Q q", *lines, ""]))
            status, _, message = tools.run(tools.simulate(option, folder / NAME), folder, path)
            tools.check(
                f"{label} by the program, {option}",
                status == 1 and "is an input and the output" in message and len(contents(folder / NAME)) == left
                and os.listdir(folder / "q") == ["a"],
                (status, message, os.listdir(folder / "q")),
            )
    folder = tools.fresh("guest-files", begin)
    status, _, message = tools.run(tools.simulate("--stats", folder / "q" / "b"), folder,
                                   tools.write(tools.root / "script", "Q q\n"))
    tools.check("beside the program's files", status == 0 and (folder / "q" / "b").exists(), message)


PARTS = {
    "limits": limits, "moved": moved, "resumed": resumed, "ended": ended, "obstacles": obstacles,
    "exchanged": exchanged, "library": library, "outputs": outputs
}
