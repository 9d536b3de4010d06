"""trax-eval's own functions, called in this process: a start of the program takes longer than most of what is
refused."""

import contextlib
import importlib
import io
import os
import subprocess
import sys


class Inside:
    """Called with the command's words and a folder; returns what subprocess.run would, or raises what would be a
    traceback."""
    def __init__(self, folder):
        self.folder, self.data = folder, folder.parent / "lib/trax/evaluation"
        sys.dont_write_bytecode = True
        sys.path[:0] = [str(self.data)]
        self.main = importlib.import_module("command.main").main

    def __call__(self, *words, cwd=None):
        errors, out, before = io.StringIO(), io.StringIO(), os.getcwd()
        os.chdir(cwd or before)
        try:
            with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(out):
                status = self.main([str(word) for word in words], self.folder, self.data)
        except SystemExit as ended:
            status = ended.code
        finally:
            os.chdir(before)
        return subprocess.CompletedProcess(words, status or 0, out.getvalue(), errors.getvalue())
