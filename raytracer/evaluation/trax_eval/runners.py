"""Runs jobs on this host's processors. `trax-eval job` runs one, for other schedulers."""

import concurrent.futures
import contextlib
import os
import signal
import sys
import threading
import time

from .finished import is_done
from .interrupts import held
from .jobs import run_job
from .util import Problem, duration, write_file

POLL_SECONDS = 0.5


class Progress:
    """A line for each finished job, and on a terminal one more that says how long it will take."""
    def __init__(self, total, labels, quiet):
        self.total, self.labels, self.quiet = total, labels, quiet
        self.begin, self.done = time.monotonic(), 0
        self.terminal = sys.stderr.isatty() and not quiet

    def left(self):
        elapsed = time.monotonic() - self.begin
        if not self.done:
            return duration(elapsed)
        return f"{duration(elapsed)}, about {duration(elapsed / self.done * (self.total - self.done))} left"

    def show(self):
        if self.terminal:
            sys.stderr.write(f"\r\033[Ktrax-eval: {self.done} of {self.total} runs, {self.left()}")
            sys.stderr.flush()

    def finished(self, key, error):
        self.done += 1
        if self.quiet:
            return
        if self.terminal:
            sys.stderr.write("\r\033[K")
        print(f"{self.labels[key]}: {'FAILED: ' + reason(error) if error else 'done'} ({self.done} of {self.total})",
              file=sys.stderr, flush=True)
        self.show()

    def end(self):
        if self.terminal:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()


def reason(error):
    """The first words of a program's message or fault, with the fault's message if it is on the next line."""
    lines = [line.strip() for line in error.splitlines()]
    message = next((line.removeprefix("message").strip() for line in lines[1:] if line.startswith("message ")), None)
    return f"{lines[0]}: {message}" if message else lines[0]


def try_job(out, tools, key, threads, on_start=None):
    """Runs the job. Returns the error, or None. The error is also written beside the results."""
    try:
        run_job(out, tools, key, threads, on_start)
        return None
    except (Problem, OSError, ValueError, KeyError) as problem:
        text = str(problem) or type(problem).__name__
        write_file(out / "runs" / f"{key}.error", text + "\n")
        return text


def kill(process):
    """Kills a process. process.kill would also wait for it, and its thread may still do so."""
    if process.returncode is None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process.pid, signal.SIGKILL)


def run_locally(out, tools, keys, options, progress):
    """One job a core: two of one thread get more done than one of two (raytracer/evaluation/README.md)."""
    workers = min(options.jobs, len(keys))
    threads = max(1, options.jobs // workers)
    running, stopped, lock = set(), threading.Event(), threading.Lock()

    def work(key):
        mine = []

        def started(process):
            with lock:
                mine.append(process)
                running.add(process)
            if stopped.is_set():
                kill(process)

        if stopped.is_set():
            return key, None
        error = try_job(out, tools, key, threads, started)
        with lock:
            running.difference_update(mine)
        return key, error

    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        try:  # an interrupt while jobs are handed out ends those that have begun
            with held():  # an exception within the pool's functions could leave one of its locks locked
                waiting = {pool.submit(work, key) for key in keys}
            while waiting:
                with held():
                    finished, waiting = concurrent.futures.wait(waiting, timeout=POLL_SECONDS,
                                                                return_when=concurrent.futures.FIRST_COMPLETED)
                for future in finished:
                    progress.finished(*future.result())
                progress.show()
        except BaseException:
            stopped.set()
            with lock:
                for process in running:
                    kill(process)
            pool.shutdown(cancel_futures=True)
            for key in keys:
                (out / "runs" / f"{key}.error").unlink(missing_ok=True)  # of the runs just killed
            raise


def run_all(out, tools, labels, options):
    """Runs the missing jobs; labels: key -> name for people. Returns how many failed."""
    keys = [key for key in labels if not is_done(out, key)]
    if keys:
        for key in keys:
            (out / "runs" / f"{key}.error").unlink(missing_ok=True)
        (out / "runs").mkdir(parents=True, exist_ok=True)
        progress = Progress(len(keys), labels, options.quiet)
        try:
            run_locally(out, tools, keys, options, progress)
        finally:
            progress.end()
    return sum(not is_done(out, key) for key in keys)
