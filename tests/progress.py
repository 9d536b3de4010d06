"""A line of progress, with the time left, if standard error is a terminal."""

import sys
import time


class Progress:
    def __init__(self, total):
        self.total, self.started = total, time.monotonic()
        self.shown = sys.stderr.isatty()

    def show(self, done, text):
        if not self.shown:
            return
        elapsed = time.monotonic() - self.started
        left = f"{elapsed / done * (self.total - done):.0f} s left" if done else "..."
        print(f"\r\033[K{done}/{self.total} {text}, {left}", end="", file=sys.stderr, flush=True)

    def clear(self):
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
