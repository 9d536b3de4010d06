#!/usr/bin/env python3
"""Files of programs against the host: random sequences of operations (sequences.py), performed by one program
(operations.c) that is compiled for the machine and for the host. Results, error numbers and the folders that are left
must be equal. A sequence follows from its seed. Parts: sequences; rights, by a user who may not write everything;
checkpoints, a run in pieces; kills, a run with checkpoints that is killed and resumed; killed and limited, where each
file is as a whole one of its versions; disturbed, while another process changes the folder; the others are fixed cases.

  files_test.py BIN SOURCE [--library PROGRAM] [--count N] [--seed N] [--only PART] [--sim PROGRAM] [--reduce]"""

import argparse
import contextlib
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time

import cases
import harm
import sequences


class Tools:
    """The programs, and a folder for the work."""

    def __init__(self, options, root):
        self.root = pathlib.Path(root)
        # A copy: the user of `rights` may not be able to reach the build.
        self.sim = pathlib.Path(shutil.copy(options.sim or options.bin / "trax-sim", self.root)).resolve()
        self.guest, self.host = self.root / "guest", self.root / "host"
        source = options.source / "operations.c"
        warnings = ["-Wall", "-Wextra", "-Werror"]
        subprocess.run(
            [options.bin / "clang", "--target=trax", "-mstack=global", "-O2", *warnings, source, "-o", self.guest],
            check=True,
        )
        subprocess.run(["cc", "-O1", *warnings, source, "-o", self.host], check=True)
        self.failures = []
        self.huge = self.takes_huge_offsets()
        self.user = None  # who runs the programs; None: this user

    def takes_huge_offsets(self):
        with open(self.root / "huge", "w+b") as file, contextlib.suppress(OSError):
            return os.lseek(file.fileno(), 2**62, os.SEEK_SET) == 2**62
        return False

    def check(self, name, good, what=""):
        if not good:
            self.failures.append(name)
            print(f"FAILED: {name}: {what}", flush=True)

    def start(self, command, folder, script, limit=None, kind=resource.RLIMIT_FSIZE):
        """Starts it with the script as standard input."""

        def prepare():
            if limit:
                resource.setrlimit(kind, (limit, limit))
            if self.user:
                os.setgroups([])
                os.setgid(self.user)
                os.setuid(self.user)

        with open(script, "rb") as stdin:
            return subprocess.Popen(
                command, cwd=folder, stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=prepare
            )

    def run(self, command, folder, script, limit=None, kind=resource.RLIMIT_FSIZE):
        with self.start(command, folder, script, limit, kind) as process:
            output, message = process.communicate(timeout=120)
        return process.returncode, output.decode(), message.decode()

    def simulate(self, *options):
        return [self.sim, "--quiet", "--dir", ".::.", "--main-on", "0", *options, self.guest]

    def fresh(self, name, script):
        """A folder with what the sequences find."""
        folder = self.root / name
        remove(folder)
        folder.mkdir()
        for line in script.splitlines():
            if line.startswith("Q "):
                (folder / line[2:]).mkdir()
        if self.user:
            for path in (self.root, folder, *folder.iterdir()):
                os.chown(path, self.user, self.user)
        self.write(folder.parent / "script", script)
        done = self.run([self.host], folder, folder.parent / "script")
        self.check("prepare", done[0] == 0 and not done[2], done)
        return folder

    def write(self, path, text):
        path.write_text(text)
        return path

    def list(self, folder):
        return subprocess.run([self.host, "LIST"], cwd=folder, capture_output=True, check=True).stdout.decode()


def remove(folder):
    for place, folders, _ in os.walk(folder):
        for name in folders:
            if not os.path.islink(os.path.join(place, name)):
                os.chmod(os.path.join(place, name), 0o700)
    shutil.rmtree(folder, ignore_errors=True)


def scripts(batch):
    """What is found, and what is done."""
    begin = "".join("\n".join([f"Q q{i}", *sequence.begin]) + "\n" for i, sequence in enumerate(batch))
    return begin, "".join("\n".join([f"Q q{i}", *sequence.lines]) + "\n" for i, sequence in enumerate(batch))


def parts(output, listing):
    """By sequence."""
    by_name = {}
    for text in output.split("Q ")[1:]:
        name, _, rest = text.partition("\n")
        by_name[name] = rest
    for line in listing.splitlines():
        name = line.split("/")[1].split(" ")[0]
        by_name[name] = by_name.get(name, "") + line.replace(f"./{name}", ".", 1) + "\n"
    return by_name


def compare(tools, batch, perform, label):
    """Performs the batch on both sides; the sequences that differ. perform(folder, script): the machine's output."""
    begin, script = scripts(batch)
    folder = tools.fresh("host-files", begin)
    status, output, message = tools.run([tools.host], folder, tools.write(tools.root / "script", script))
    expected = parts(output, tools.list(folder))
    tools.check(label + ": host", status == 0, message)
    folder = tools.fresh("guest-files", begin)
    output, message = perform(folder, tools.write(tools.root / "script", script))
    if output is None:  # killed: what it printed is not known
        expected = parts("", tools.list(tools.root / "host-files"))
    found = parts(output or "", tools.list(folder))
    different = [
        (sequence, expected.get(f"q{i}", ""), found.get(f"q{i}", ""))
        for i, sequence in enumerate(batch)
        if expected.get(f"q{i}") != found.get(f"q{i}")
    ]
    tools.check(label, not message or different, message)
    return different


def show(label, seed, different):
    sequence, expected, found = different
    print(f"{label}, seed {seed}:", *sequence.begin, *sequence.lines, sep="\n  ")
    ours, theirs = found.splitlines(), expected.splitlines()
    first = next((i for i, (a, b) in enumerate(zip(theirs, ours)) if a != b), min(len(ours), len(theirs)))
    print(f"  line {first} of the results: host {theirs[first:first + 2]}, machine {ours[first:first + 2]}")


def reduced(tools, different, perform):
    """Leaves out operations as long as the results differ."""
    sequence = different[0]
    for lines in ("lines", "begin"):
        at = len(getattr(sequence, lines)) - 1
        while at >= 0:
            kept = getattr(sequence, lines)
            setattr(sequence, lines, kept[:at] + kept[at + 1 :])
            again = compare(tools, [sequence], perform, "reduced")
            if again:
                different = again[0]
            else:
                setattr(sequence, lines, kept)
            at -= 1
    return different


def run_sequences(tools, options, kind, perform, label, batch_size=500, share=1):
    count, whole = 0, max(1, options.count // share)
    while count < whole:
        seeds = range(options.seed + count, options.seed + min(count + batch_size, whole))
        batch = [sequences.Sequence(seed, kind, tools.huge, options.small) for seed in seeds]
        different = compare(tools, batch, perform, label)
        count += len(batch)
        for one in different[:3]:
            seed = seeds[batch.index(one[0])]
            show(label, seed, reduced(tools, one, perform) if options.reduce else one)
        if different:
            tools.failures.append(label)
            print(f"FAILED: {label}: {len(different)} of {len(batch)} sequences differ", flush=True)
            break
    print(f"{label}: {count} sequences", flush=True)


def plain(tools, options):
    """Without checkpoints: everything."""

    def perform(folder, script):
        status, output, message = tools.run(tools.simulate("--engine", "functional"), folder, script)
        return output, message if status or message else ""

    run_sequences(tools, options, "all", perform, "sequences")


def rights(tools, options):
    """By a user who may not write everything."""
    if os.getuid() != 0:
        print("rights: skipped, because only root can be another user")
        return

    def perform(folder, script):
        status, output, message = tools.run(tools.simulate("--engine", "functional"), folder, script)
        return output, message if status or message else ""

    tools.user = 65534
    os.chmod(tools.root, 0o755)
    run_sequences(tools, options, "rights", perform, "rights")
    tools.user = None
    os.chown(tools.root, 0, 0)


def ended(message):
    """The messages of a run that reached --max-cycles say so; any other one is of interest."""
    return "\n".join(line for line in message.splitlines() if "the program has not ended" not in line)


def pieces(tools, options):
    """A run in many pieces, each from the checkpoint of the one before."""
    chance = random.Random(options.seed)

    def perform(folder, script):
        whole, cycle, status, messages, resume = "", 0, 124, "", []
        while status == 124:
            cycle += int(10 ** chance.uniform(4, 6.4))
            state = tools.root / f"state{cycle}"
            status, output, message = tools.run(
                tools.simulate("--checkpoint", state, "--max-cycles", str(cycle), *resume), folder, script
            )
            whole, messages, resume = whole + output, messages + ended(message), ["--resume", state]
        for path in tools.root.glob("state*"):
            path.unlink()
        return whole, messages or status or ""

    run_sequences(tools, options, "pending", perform, "checkpoints", 25, 10)


def kills(tools, options):
    """Killed at any time, also while it changes files after a checkpoint or after the program's end, and resumed."""
    chance = random.Random(options.seed)

    def perform(folder, script):
        before, resume, message, state = tools.list(folder), [], "", None
        for i in range(chance.randrange(1, 6)):
            fresh = tools.root / f"state{i}"
            with tools.start(
                tools.simulate("--checkpoint", fresh, "--checkpoint-every", "100000", *resume), folder, script
            ) as process:
                time.sleep(chance.uniform(0.02, 0.5))
                process.kill()
                process.communicate()
            state = fresh if fresh.exists() else state
            resume = ["--resume", state] if state else []
            if not state:
                tools.check("nothing before the first checkpoint", tools.list(folder) == before)
        last = resume or ["--checkpoint", tools.root / "state9"]
        status, _, message = tools.run(tools.simulate(*last), folder, script)
        message = message or status or ""
        remove_temporaries(folder)
        for path in tools.root.glob("state*"):
            path.unlink()
        return None, message

    run_sequences(tools, options, "pending", perform, "kills", 25, 10)


def remove_temporaries(folder):
    """Of a killed process."""
    for path in folder.rglob(".trax-*"):
        path.unlink()


PARTS = {**cases.PARTS, "sequences": plain, "rights": rights, "checkpoints": pieces, "kills": kills, **harm.PARTS}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__.split("\n\n", maxsplit=1)[0], formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("--library", metavar="PROGRAM", help="library_input.c, compiled")
    parser.add_argument(
        "--count", type=int, default=1000, metavar="N", help="sequences; a tenth of them with checkpoints"
    )
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the first sequence")
    parser.add_argument("--only", choices=PARTS, help="one part")
    parser.add_argument("--sim", metavar="PROGRAM", help="another trax-sim than that in BIN")
    parser.add_argument("--small", action="store_true", help="no large files and offsets")
    parser.add_argument("--reduce", action="store_true", help="print the shortest sequences that differ")
    options = parser.parse_args()
    begun = time.monotonic()
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory) as root:
        tools = Tools(options, root)
        for name, part in PARTS.items():
            if options.only in (None, name):
                part(tools, options)
        remove(root)
        os.makedirs(root, exist_ok=True)
    print(f"{len(tools.failures)} failed, {time.monotonic() - begun:.0f} s")
    sys.exit(1 if tools.failures else 0)


main()
