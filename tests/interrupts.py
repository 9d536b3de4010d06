"""Signals for tools whose threads run programs. Python would make an exception of Ctrl-C: the pool of threads then
first works through its queue, or the exception is lost in one of its locks."""
import atexit
import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def children(process="self"):
    found = []
    for path in pathlib.Path(f"/proc/{process}/task").glob("*/children"):
        with contextlib.suppress(OSError):  # the thread has ended
            found += map(int, path.read_text().split())
    return found


def end_by_signals():
    """From now on a signal ends this process at once by its default action, and its children by SIGTERM. Temporary
    folders that are made after this are removed."""
    scratch = tempfile.tempdir = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, scratch, True)

    def end(number, _):
        subprocess.Popen = None  # no thread starts another program
        deadline = time.monotonic() + 10
        while (running := children()) and time.monotonic() < deadline:  # the threads wait for them
            for child in running:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(child, signal.SIGTERM)
            time.sleep(0.01)
        shutil.rmtree(scratch, True)
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, end)
