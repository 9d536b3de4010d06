"""A signal that ends the command is an exception in the main thread."""

import contextlib
import os
import signal
import sys

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(BaseException):
    """An interrupt by the signal whose number is its argument."""


class Held:
    depth, number = 0, None  # how many blocks of held() are open, and the signal that came meanwhile


def interrupt(number, frame):
    for other in SIGNALS:  # a second one ends it at once
        if signal.getsignal(other) is interrupt:
            signal.signal(other, signal.SIG_DFL)
    if Held.depth:
        Held.number = number
    else:
        raise Interrupted(number)


@contextlib.contextmanager
def held():
    """An interrupt waits for the end of the block: a process that was started is where the interrupt finds it."""
    Held.depth += 1
    try:
        yield
    finally:
        Held.depth -= 1
        number = Held.number
        if number is not None and not Held.depth:
            Held.number = None
            raise Interrupted(number)


def catch_interrupts():
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:  # nohup
            signal.signal(number, interrupt)


def end_by_signal(number, said):
    """Ends the process by the signal, as every program of the project (docs/architecture.md, "Signals")."""
    print(said, file=sys.stderr)
    sys.stdout.flush()
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)
