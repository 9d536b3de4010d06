"""The format of the lit tests. A file whose RUN lines are all `%run_c %s %t OPTIONS` is run by run_c.py in lit's own
process: another interpreter would take longer to start than most programs take to run."""

import contextlib
import io
import os
import re
import shlex

import lit.formats
import lit.Test
import lit.TestRunner
import lit.util
import run_c

OTHERS = re.compile(r"\b(DEFINE|REDEFINE|REQUIRES|UNSUPPORTED|XFAIL|ALLOW_RETRIES):")


def read_options(path):
    """The options of each RUN line; None if something else is to be done."""
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    lines = "\n".join(re.findall(r"RUN:[ \t]*(.*)", text)).replace("\\\n", " ").split("\n")
    if OTHERS.search(text) or not all(re.fullmatch(r"%run_c %s %t(\s[^%|<>&;`$]*)?", line) for line in lines):
        return None
    return [shlex.split(line)[3:] for line in lines]


class Format(lit.formats.ShTest):
    def __init__(self, runner):
        super().__init__(execute_external=False)
        self.runner = runner  # what run_c.py is given before the options of a line

    def execute(self, test, lit_config):
        lines = read_options(test.getSourcePath())
        if lines is None or lit_config.noExecute:
            return super().execute(test, lit_config)
        folder, base = lit.TestRunner.getTempPaths(test)
        lit.util.mkdir_p(folder)
        run_c.PROCESS.update(cwd=os.path.dirname(test.getExecPath()), env=test.config.environment)
        for options in lines:
            errors = io.StringIO()
            try:
                with contextlib.redirect_stderr(errors):
                    status = run_c.main([test.getSourcePath(), f"{base}.tmp", *self.runner, *options])
            except SystemExit as exit_:
                status = exit_.code
            if status:
                return lit.Test.Result(lit.Test.FAIL, f"run_c.py {shlex.join(options)}\n{errors.getvalue()}")
        return lit.Test.Result(lit.Test.PASS, "")
