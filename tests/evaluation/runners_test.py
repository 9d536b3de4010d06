#!/usr/bin/env python3
"""What trax-eval makes of Slurm's answers, and what it says of a failed run: by its own functions, with commands of
Slurm that do what a test says.

    tests/evaluation/runners_test.py --bin build/bin"""

import argparse
import importlib
import os
import pathlib
import sys
import threading
import unittest.mock

from scripts import Inside, check, main

STUB = """#!/bin/sh
echo "$0" "$@" >>"$LOG"
case $0 in
*/sbatch) echo 42 ;;
*/squeue) . "$LOG.squeue" ;;
esac
"""


class Slurm:
    """Commands of Slurm. answers: what squeue does, in sh; its n-th call has n in $n."""
    def __init__(self, scratch, answers):
        self.out, self.log = scratch / "o%A%%u", scratch / "log"
        (self.out / "runs").mkdir(parents=True)
        (scratch / "bin").mkdir()
        for name in ("sbatch", "squeue", "scancel"):
            (scratch / "bin" / name).write_text(STUB)
            (scratch / "bin" / name).chmod(0o755)
        self.log.write_text("")
        pathlib.Path(f"{self.log}.squeue").write_text(f"n=$(grep -c squeue \"$LOG\")\n{answers}\n")
        self.runners = importlib.import_module("trax_eval.runners")
        self.problem = importlib.import_module("trax_eval.util").Problem

    def run(self, keys=("a", ), patience=600, grace=0.5, interval=0.1):
        """What was reported of each key."""
        reported, options = {}, argparse.Namespace(slurm_options="")
        progress = self.runners.Progress(len(keys), {}, True)
        progress.finished = lambda key, error: reported.update({key: error})
        tools = unittest.mock.Mock()
        tools.path = lambda name: f"/nowhere/{name}"
        settings = {
            "POLL_SECONDS": 0.02, "SQUEUE_SECONDS": interval, "SQUEUE_PATIENCE": patience, "GRACE_SECONDS": grace
        }
        environment = {"PATH": f"{self.log.parent}/bin:{os.environ['PATH']}", "LOG": str(self.log)}
        constants = unittest.mock.patch.multiple(self.runners, create=True, **settings)
        with constants, unittest.mock.patch.dict(os.environ, environment):
            self.runners.run_slurm(self.out, tools, list(keys), options, progress)
        return reported

    def later(self, seconds, key="a"):
        threading.Timer(seconds, lambda: (self.out / "runs" / f"{key}.json").write_text("{}")).start()

    def calls(self, name):
        return [line for line in self.log.read_text().splitlines() if line.split()[0].endswith(name)]


def test_failing_squeue(scratch):
    """A controller that does not answer for a while ends nothing."""
    slurm = Slurm(
        scratch, '[ "$n" -gt 3 ] && { echo 42_0; exit; }\n'
        'echo "slurm_load_jobs error: Socket timed out on send/recv operation" >&2; exit 1')
    slurm.later(1)
    check(slurm.run() == {"a": None}, "the run was not reported")
    check(len(slurm.calls("squeue")) > 4 and not slurm.calls("scancel"), f"calls: {slurm.log.read_text()}")


def test_dead_squeue(scratch):
    """One that never answers again ends the command, and not the tasks."""
    slurm = Slurm(scratch, 'echo "slurm_load_jobs error: Unable to contact slurm controller" >&2; exit 1')
    try:
        check(False, f"it ended: {slurm.run(patience=0.5)}")
    except slurm.problem as problem:
        check("Unable to contact" in str(problem) and "42" in str(problem), f"it says {problem}")
    check(not slurm.calls("scancel") and not list((slurm.out / "runs").glob("*.error")), "the tasks were given up")


def test_asked_seldom(scratch):
    """The controller is that of many users."""
    slurm = Slurm(scratch, "echo 42_0")
    slurm.later(1)
    slurm.run(interval=30)
    check(len(slurm.calls("squeue")) == 1, f"squeue was asked {len(slurm.calls('squeue'))} times in a second")
    least = {"SQUEUE_SECONDS": 30, "SQUEUE_PATIENCE": 300, "GRACE_SECONDS": 60}
    check(all(getattr(slurm.runners, name) >= seconds for name, seconds in least.items()), "the intervals")


def test_late_result(scratch):
    """A task's result may be seen after Slurm has forgotten the task."""
    slurm = Slurm(scratch, '[ "$n" -le 1 ] && echo 42_0; true')
    slurm.later(0.6)
    reported = slurm.run(keys=("a", "b"), grace=1.5)
    missing = f"it was not run: Slurm: the tasks' output is in {slurm.out}/slurm"
    check(reported == {"a": None, "b": missing}, f"what was reported: {reported}")


def test_percent(scratch):
    """sbatch replaces symbols in --output."""
    slurm = Slurm(scratch, "true")
    slurm.later(0)
    slurm.run()
    given = slurm.calls("sbatch")[0].split()
    check(f"--output={scratch}/o%%A%%%%u/slurm/%A_%a.log" in given, f"sbatch was given {given}")


def test_interrupted(scratch):
    """The tasks end, too; if that cannot be, it is told, and the signal is still what ends the command."""
    interrupts = importlib.import_module("trax_eval.interrupts")
    for status in (0, 1):
        slurm = Slurm(scratch / str(status), "echo 42_0")
        (scratch / str(status) / "bin/scancel").write_text(STUB + f"exit {status}\n")
        with unittest.mock.patch.object(slurm.runners.Progress, "show", side_effect=interrupts.Interrupted(2)):
            try:
                slurm.run()
                check(False, "it was not interrupted")
            except interrupts.Interrupted:
                pass
        check(len(slurm.calls("scancel")) == 1, f"calls: {slurm.log.read_text()}")


def test_reason(scratch):
    """What is printed of a failed run names the reason."""
    runners = importlib.import_module("trax_eval.runners")
    progress = runners.Progress(1, {"a": "run a"}, False)
    with unittest.mock.patch.object(sys, "stderr") as errors:
        progress.finished(
            "a", "trax-sim: fault: abort\n  message     this program renders boxes only\n  at          0x000014c0")
    said = "".join(call.args[0] for call in errors.write.call_args_list)
    wanted = "run a: FAILED: trax-sim: fault: abort: this program renders boxes only (1 of 1)"
    check(wanted in said, f"it says {said!r}")


def tests(options, scratch):
    Inside(options.bin)
    listed = (test_failing_squeue, test_dead_squeue, test_asked_seldom, test_late_result, test_percent,
              test_interrupted, test_reason)
    return {test.__name__: lambda test=test: test(scratch / test.__name__) for test in listed}


if __name__ == "__main__":
    sys.exit(main(__doc__, tests))
