#!/usr/bin/env python3
"""Signals end every program while it waits or works, and inputs that never end are refused (docs/architecture.md,
"Signals").

    tests/tools/signals_test.py build/bin"""

import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402
from interrupts import children  # noqa: E402

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def waits(program, scratch, pipe):
    """Command lines that wait for what a pipe's writer does not write."""
    mesh = scratch / "triangle.obj"
    picture = ["-o", "p.png"]
    return {"trax-render": ([mesh, "--view", pipe, *picture], [mesh, "--config", pipe, *picture], [pipe, *picture]),
            "trax-scene": ([pipe, "-o", "s.trax"], ["--check", pipe]),
            "trax-sim": ([pipe], ["--config", pipe, "none"]),
            "trax-compare": ([pipe, pipe],), "trax-eval": ([pipe], ["report", pipe])}[program]


def living(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def reads(pipe, writers):
    """Whether somebody reads the pipe; from then on it has a writer."""
    try:
        writers.append(os.open(pipe, os.O_WRONLY | os.O_NONBLOCK))
    except OSError:  # nobody yet
        pass
    return bool(writers)


def interrupted(command, scratch, folder, number, pipe):
    """The command must end by the signal, soon, with its children, and leave nothing. The signal is sent when the
    command reads the pipe or, without a pipe, when it has a child."""
    folder.mkdir()
    writers = []
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                               env=os.environ | {"TMPDIR": str(folder)})
    deadline = time.monotonic() + 60
    while not (reads(pipe, writers) if pipe else children(process.pid)) and time.monotonic() < deadline:
        time.sleep(0.02)
    time.sleep(0.1)
    started = children(process.pid)
    process.send_signal(number)
    try:
        errors = process.communicate(timeout=60)[1]
    except subprocess.TimeoutExpired:
        process.kill()
        errors = "error: it, or a child that has its standard error, goes on"
    for writer in writers:
        os.close(writer)
    what = " ".join(str(word) for word in command).replace(str(scratch), "")
    check(process.returncode == -number, f"{what}: {process.returncode} instead of {-number}: {errors[-300:]}")
    check("error" not in errors and "Traceback" not in errors, f"{what}: {errors[-300:]}")
    deadline = time.monotonic() + 60
    while (any(map(living, started)) or list(folder.iterdir())) and time.monotonic() < deadline:
        time.sleep(0.05)
    check(not any(map(living, started)), f"{what}: children live on")
    check(not list(folder.iterdir()), f"{what}: left {list(folder.iterdir())}")


def test_signals(programs, scratch):
    source = scratch / "large.c"
    functions = (f"int f{i}(int a,int b){{int s=0;for(int i=0;i<a;i++){{s+=i*b^{i};if(s&1)s*=3;}}return s;}}\n"
                 for i in range(2000))
    source.write_text("".join(functions) + "int main(void){return 0;}\n")
    other = scratch / "other.c"
    other.write_text("int other;\n")
    place = 0
    with ThreadPoolExecutor(4) as pool:  # which mostly wait
        ends = []
        for number in SIGNALS:
            for program in ("trax-render", "trax-scene", "trax-sim", "trax-compare", "trax-eval"):
                for which in range(len(waits(program, scratch, ""))):
                    place += 1
                    pipe = scratch / f"pipe-{place}.{'json' if program == 'trax-eval' else 'obj'}"
                    os.mkfifo(pipe)
                    command = [str(programs / program), *map(str, waits(program, scratch, pipe)[which])]
                    folder = scratch / f"at-{place}"
                    ends.append(pool.submit(interrupted, command, scratch, folder, number, pipe))
            clang = [str(programs / "clang"), "--target=trax", "-O2", "-o", "large.elf"]
            pipe = scratch / f"pipe-{number}.c"
            os.mkfifo(pipe)
            # One source is compiled by the driver's process, several by a process each.
            for sources, waited in (([pipe], pipe), ([source, other], None)):
                place += 1
                command = [*clang, *map(str, sources)]
                ends.append(pool.submit(interrupted, command, scratch, scratch / f"at-{place}", number, waited))
        for end in ends:
            end.result()


def test_orphans(programs):
    """A compiler or linker ends if its driver has ended before it could look. One that another process has started does
    not end."""
    ended = subprocess.Popen(["true"])
    os.waitid(os.P_PID, ended.pid, os.WEXITED | os.WNOWAIT)  # it stays a zombie

    def status(command, parent):
        return subprocess.run(["sh", "-c", f'TRAX_PARENT={parent} "$@"; exit $?', "sh", *command],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode

    def check_all(cases):
        for command in ([programs / "trax-ld", "--version"], [programs / "clang", "-cc1", "-version"]):
            for parent, wanted, what in cases:
                found = status(command, parent)
                check(found == wanted, f"{command[0].name}, whose driver is {what}: {found}")

    check_all([(ended.pid, 128 + signal.SIGTERM, "a zombie"), (os.getpid(), 0, "its grandparent"),
               ("$$", 0, "its parent"), ("x", 0, "no process")])
    ended.wait()
    check_all([(ended.pid, 128 + signal.SIGTERM, "gone")])


def test_limits(programs, scratch):
    """/dev/zero is refused in place of each small input, without much memory."""
    mesh = str(scratch / "triangle.obj")
    for words, limit in ((["trax-sim", "/dev/zero"], 64),
                         (["trax-sim", "--config", "/dev/zero", "none"], 64),
                         (["trax-render", mesh, "--view", "/dev/zero", "-o", "p.png"], 512),
                         (["trax-render", mesh, "--config", "/dev/zero", "-o", "p.png"], 512),
                         (["trax-scene", "/dev/zero", "--unpack-limit", "8M", "-o", "s.trax"], 256),
                         (["trax-scene", "--check", "/dev/zero", "--unpack-limit", "8M"], 256)):
        process = subprocess.Popen([str(programs / words[0]), *words[1:]], cwd=scratch, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (60, 60)))
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        refused = process.returncode == 1 and "error: /dev/zero: " in errors
        check(refused, f"{words}: {process.returncode}: {errors[-300:]}")
        check(usage.ru_maxrss < limit << 10, f"{words}: {usage.ru_maxrss} kB")


TOOL = """
import concurrent.futures, subprocess, interrupts
interrupts.end_by_signals()
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    for done in [pool.submit(subprocess.run, ["sleep", "600"]) for _ in range(9)]:
        done.result()
"""


def test_tools(scratch):
    """A tool whose threads run programs, as tests/fuzz/csmith.py."""
    tests = str(pathlib.Path(__file__).resolve().parents[1])
    for number in SIGNALS:
        command = ["env", f"PYTHONPATH={tests}", sys.executable, "-B", "-c", TOOL]
        interrupted(command, scratch, scratch / f"tool-{number}", number, None)


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as temporary:
        scratch = pathlib.Path(temporary).resolve()
        (scratch / "triangle.obj").write_text(TRIANGLE)
        test_limits(programs, scratch)
        test_orphans(programs)
        test_signals(programs, scratch)
        test_tools(scratch)
    return 1 if checking.failures else 0


if __name__ == "__main__":
    sys.exit(main())
