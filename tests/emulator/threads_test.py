#!/usr/bin/env python3
"""threads_test.py BIN: trax-sim takes as many threads of the host as it may have processors, and as many as it is
told."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

BIN = pathlib.Path(sys.argv[1]).resolve()


def threads_of(command, folder, processors=None):
    """Start the command on these processors and return how many threads it has, at most, in its first second of
    processor time."""
    prefix = ["taskset", "-c", ",".join(map(str, processors))] if processors else []
    with subprocess.Popen([*prefix, *command], cwd=folder, stdout=subprocess.DEVNULL) as process:
        most = ticks = 0
        while ticks < os.sysconf("SC_CLK_TCK") and process.poll() is None:
            status = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
            most, ticks = max(most, int(status[17])), int(status[11]) + int(status[12])
            time.sleep(0.02)
        assert process.poll() is None, "it has ended too soon"
        process.kill()
    return most


def main():
    failures = 0
    allowed = sorted(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([BIN / "../tests/bin/emulator-programs", folder], check=True)
        sim = [str(BIN / "trax-sim"), "--quiet", "--config", "4x32"]
        cases = [("one processor", [*sim, "idle.elf"], allowed[:1], lambda n: n == 1),
                 ("three threads asked for", [*sim, "--host-threads", "3", "idle.elf"], allowed[:1], lambda n: n == 3),
                 ("all processors", [*sim, "idle.elf"], None, lambda n: 1 <= n <= min(4, len(allowed)))]
        for name, command, processors, right in cases:
            threads = threads_of(command, folder, processors)
            if not right(threads):
                failures += 1
                print(f"FAILED: {name}: {threads} threads")
    sys.exit(1 if failures else 0)


main()
