"""The runners of jobs: this process, GNU parallel, or Slurm. Each starts `trax-eval job`, or does the same."""

import concurrent.futures
import contextlib
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time

from .finished import error_of, is_done
from .interrupts import held
from .jobs import run_job
from .tools import dying
from .util import Problem, duration, remark, write_file

ARRAY_LIMIT = 1000  # tasks of one Slurm array; slurm.conf's MaxArraySize is 1001 unless it says otherwise
POLL_SECONDS = 0.5
SQUEUE_SECONDS = 30  # between two questions to Slurm's controller, which many users share
SQUEUE_PATIENCE = 600  # it may be overloaded, or restarted, for so long
GRACE_SECONDS = 90  # until a file of another host is seen here: NFS keeps what it knows of a folder for 60


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
    """The error, or None. It is kept beside the results, for whoever started the job."""
    try:
        run_job(out, tools, key, threads, on_start)
        return None
    except (Problem, OSError, ValueError, KeyError) as problem:
        text = str(problem) or type(problem).__name__
        write_file(out / "runs" / f"{key}.error", text + "\n")
        return text


# --- this host


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


# --- others: they start `trax-eval job`, and the folder of results says what is finished


def job_command(tools, out, threads):
    return [tools.path("trax-eval"), "job", str(out), "--threads", str(threads)]


def watch(out, keys, progress, alive, complaint, grace=0):
    """Reports results as they appear until all are there, or nobody has worked on them for `grace` seconds: so long it
    may take to see the last ones. complaint() is what the engine said then."""
    open_keys, ended = list(keys), None
    while open_keys:
        ended = ended or (None if alive() else time.monotonic())
        for key in [key for key in open_keys if is_done(out, key) or error_of(out, key)]:
            open_keys.remove(key)
            progress.finished(key, None if is_done(out, key) else error_of(out, key))
        if ended and time.monotonic() >= ended + grace:
            break
        progress.show()
        time.sleep(POLL_SECONDS)
    for key in open_keys:
        text = f"it was not run: {complaint()}"
        write_file(out / "runs" / f"{key}.error", text + "\n")
        progress.finished(key, text)


def last_line(path):
    lines = pathlib.Path(path).read_text(errors="replace").splitlines()
    return lines[-1] if lines else "no message"


def run_parallel(out, tools, keys, options, progress):
    if not shutil.which("parallel"):
        raise Problem("GNU parallel is not installed (Debian's package is called parallel)")
    names = out / "scratch" / f"keys.{os.getpid()}"
    write_file(names, "".join(key + "\n" for key in keys))
    errors = open(out / "parallel.errors", "wb")
    command = ["parallel", "--arg-file", str(names), "--joblog", str(out / "parallel.log")]
    command += ["--sshlogin", options.hosts, "--jobs", "100%"] if options.hosts else ["--jobs", str(options.jobs)]
    process = None
    try:
        command = dying([*command, *map(shlex.quote, job_command(tools, out, 1)),
                         "{}"])  # it ends after the runs in progress
        with held():
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
        watch(out, keys, progress, lambda: process.poll() is None, lambda: f"GNU parallel: {last_line(errors.name)}")
    finally:
        if process and process.poll() is None:
            process.terminate()
            process.terminate()  # the second one ends its jobs too
            process.wait()
        errors.close()
        names.unlink(missing_ok=True)


def slurm(*words):
    try:
        run = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=SQUEUE_PATIENCE)
    except FileNotFoundError:
        raise Problem(
            f"Slurm is not installed: there is no {words[0]} (Debian's packages are slurm-client, slurmctld and slurmd)"
        ) from None
    except subprocess.TimeoutExpired:
        raise Problem(f"{words[0]}: no answer in {SQUEUE_PATIENCE} seconds") from None
    if run.returncode != 0:
        raise Problem(f"{words[0]}: {run.stderr.strip()}")
    return run.stdout.strip()


class Queue:
    """The state of arrays according to Slurm's controller, which is asked now and then. If it does not answer for a
    while, the tasks go on."""
    def __init__(self, arrays):
        self.arrays, self.asked, self.answered, self.known = arrays, None, time.monotonic(), True

    def is_alive(self):
        if self.asked is None or time.monotonic() >= self.asked + SQUEUE_SECONDS:
            try:
                self.known = bool(slurm("squeue", "--noheader", "--jobs", ",".join(self.arrays), "--format=%i"))
                self.answered = time.monotonic()
            except Problem as problem:
                if "Invalid job id" in str(problem):  # finished for so long that it is forgotten
                    self.known = False
                elif time.monotonic() >= self.answered + SQUEUE_PATIENCE:
                    tasks = ", ".join(self.arrays)
                    text = f"{problem}; the tasks {tasks} may run on: the same command takes what they have made"
                    self.arrays.clear()  # nor would scancel be heard
                    raise Problem(text) from None
            self.asked = time.monotonic()
        return self.known


def run_slurm(out, tools, keys, options, progress):
    """One array of one-processor tasks, or several if there are many."""
    arrays = []
    logs = out / "slurm"
    logs.mkdir(parents=True, exist_ok=True)
    try:
        for first in range(0, len(keys), ARRAY_LIMIT):
            some = keys[first:first + ARRAY_LIMIT]
            names = logs / f"keys.{os.getpid()}.{first}"
            write_file(names, "".join(key + "\n" for key in some))
            command = shlex.join([*job_command(tools, out, 1), "--list", str(names)])
            with held():
                arrays.append(
                    slurm("sbatch", "--parsable", f"--array=0-{len(some) - 1}", "--ntasks=1", "--cpus-per-task=1",
                          "--job-name=trax-eval", f"--output={str(logs).replace('%', '%%')}/%A_%a.log",
                          *shlex.split(options.slurm_options), "--wrap", command).split(";")[0])
        watch(out, keys, progress,
              Queue(arrays).is_alive, lambda: f"Slurm: the tasks' output is in {logs}", GRACE_SECONDS)
        arrays.clear()
    finally:
        if arrays:
            try:
                slurm("scancel", *arrays)
            except Problem as problem:
                remark(f"{problem}; the tasks {', '.join(arrays)} may run on")


RUNNERS = {"local": run_locally, "parallel": run_parallel, "slurm": run_slurm}


def run_all(out, tools, labels, options):
    """Runs what is missing of the jobs; labels: key -> name for people. Returns how many failed."""
    keys = [key for key in labels if not is_done(out, key)]
    if keys:
        for key in keys:
            (out / "runs" / f"{key}.error").unlink(missing_ok=True)
        (out / "runs").mkdir(parents=True, exist_ok=True)
        progress = Progress(len(keys), labels, options.quiet)
        try:
            RUNNERS[options.runner](pathlib.Path(out), tools, keys, options, progress)
        finally:
            progress.end()
    return sum(not is_done(out, key) for key in keys)
