"""The programs beside trax-eval."""

import functools
import json
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import time

from .interrupts import held
from .util import Problem, hash_file, shown

POLL_SECONDS = 0.05


def dying(command, number="TERM"):
    """The command, whose process gets a signal when this process dies, whatever ends it: also if that was before the
    kernel had been asked for it."""
    return [
        "/usr/bin/setpriv", "--pdeathsig", number, "/bin/sh", "-c", '[ "$PPID" = "$0" ] && exec "$@"',
        str(os.getpid()), *command
    ]


def communicate(process):
    """Waits for a process and returns its output. It waits in short steps, because Python notices a signal that comes
    just before a wait only at the wait's end."""
    while True:
        try:
            return process.communicate(timeout=POLL_SECONDS)
        except subprocess.TimeoutExpired:
            pass


def run_tool(command, **where):
    """The finished process, with what it said. An interrupt ends it in an orderly way first: it removes what it has not
    finished. where: cwd, env."""
    process = None
    try:
        with held():
            process = subprocess.Popen(dying(command), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True, errors="replace", **where)
        out, errors = communicate(process)
    except BaseException:
        if process:
            process.terminate()
            process.wait()
        raise
    return subprocess.CompletedProcess(command, process.returncode, out, errors)


def run_tools(commands, jobs):
    """Runs several commands at the same time, as run_tool: yields (place in the list, finished process) as they end.
    Their output is their standard error."""
    running, waiting = {}, list(enumerate(commands))
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                place, command = waiting.pop(0)
                said = tempfile.TemporaryFile()
                with held():
                    running[place] = subprocess.Popen(dying(command), stdin=subprocess.DEVNULL,
                                                      stdout=subprocess.DEVNULL, stderr=said), said
            ended = [place for place, (process, _) in running.items() if process.poll() is not None]
            if not ended:
                time.sleep(POLL_SECONDS)
            for place in ended:
                process, said = running.pop(place)
                said.seek(0)
                errors = said.read().decode(errors="replace")
                said.close()
                yield place, subprocess.CompletedProcess(commands[place], process.returncode, "", errors)
    except BaseException:
        for process, _ in running.values():
            process.terminate()
        for process, _ in running.values():
            process.wait()
        raise


class Tools:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def path(self, name):
        path = self.folder / name
        if not path.is_file():
            raise Problem(f"{path} is missing")
        return str(path)

    @functools.lru_cache(maxsize=None)
    def hash(self, name):
        return hash_file(self.path(name))

    def version(self):
        return subprocess.run([self.path("trax-sim"), "--version"], capture_output=True, text=True,
                              check=True).stdout.split()[-1]

    @functools.lru_cache(maxsize=None)
    def given(self, place, name, words):
        """The options of a program of ours that the words (a tuple) give: (name, "reads", "writes" or ""). Nothing if
        the program is not there. Which of them exclude each other is not asked."""
        if not (self.folder / name).is_file():
            return []
        run = run_tool([self.path(name), *words, "--help-given"])
        if run.returncode != 0:
            said = run.stderr.strip().removeprefix(f"{name}: error: ")
            raise Problem(f"{place}: {said or f'{name} ended with status {run.returncode}'}")
        title, *lines = run.stdout.splitlines() or [""]
        if title != f"options of {name}:":
            raise Problem(f"{place}: {shlex.join(words)} ends {name} before it does anything")
        return [line.removeprefix("--").partition(" ")[::2] for line in lines]

    def words(self, name, arguments):
        """(options as --NAME=VALUE, operands) of a command line for a program of ours."""
        run = run_tool([self.path(name), "--help-words", *arguments])
        if run.returncode != 0:
            raise Problem(run.stderr.strip().removeprefix(f"{name}: error: ") or f"{name} failed")
        words = run.stdout.split("\0")[:-1]
        if "--" not in words:
            raise Problem(f"{shlex.join(arguments)} ends {name} before it does anything")
        end = words.index("--")
        return words[:end], words[end + 1:]

    @functools.lru_cache(maxsize=None)
    def described(self, option):
        """The names that trax-sim --help-config or --help-stats describes, one a line: patterns where a part of them is
        in angle brackets."""
        run = run_tool([self.path("trax-sim"), option])
        words = re.findall(r"^([a-z]\w*(?:\.[\w<>]+)*) ", run.stdout, re.MULTILINE)
        return tuple(re.sub(r"<\w+>", "*", word) for word in words)

    @functools.lru_cache(maxsize=None)
    def configuration(self, chip, settings):
        """The whole configuration of a chip with changes (a tuple of (key, value)), as a file for trax-sim --config."""
        command = [self.path("trax-sim"), "--config", chip]
        for key, value in settings:
            command += ["--set", f"{key}={shown(value)}"]
        run = run_tool([*command, "--print-config"])
        if run.returncode != 0:
            raise Problem(run.stderr.strip().removeprefix("trax-sim: error: ") or "trax-sim failed")
        return run.stdout

    def value(self, chip, settings, key):
        """The value of a key of that machine, such as "dcache.bytes"."""
        section, name = key.split(".")
        return json.loads(
            re.search(rf"^{section}: {{.*?^ *{name} = (.*?);", self.configuration(chip, settings),
                      re.MULTILINE | re.DOTALL).group(1))

    def shape(self, chip, settings):
        """(TMs, TPs of each) of that chip."""
        return self.value(chip, settings, "chip.tms"), self.value(chip, settings, "chip.tps_per_tm")
