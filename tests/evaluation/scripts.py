"""The scripts of this folder share check, the command line, and the run of every test in a scratch folder."""

import argparse
import os
import pathlib
import sys
import tempfile
import time
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402
from inside import Inside  # noqa: E402, F401


def main(doc, listed, **more):
    """Runs the tests of listed(options, scratch), a dictionary of functions, or the one that --only names. A test that
    fails does not stop the others. more: further options with their defaults."""
    parser = argparse.ArgumentParser(description=doc.split("\n\n")[0])
    parser.add_argument("--bin", type=lambda text: pathlib.Path(text).resolve(), required=True)
    parser.add_argument("--only", metavar="TEST")
    for name, default in more.items():
        parser.add_argument(f"--{name}", type=type(default), default=default)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=os.environ.get("TRAX_TEST_FOLDER")) as temporary:
        tests = listed(options, pathlib.Path(temporary).resolve())
        if options.only not in (None, *tests):
            parser.error(f"--only {options.only}: there are {', '.join(tests)}")
        for name, test in tests.items():
            if options.only in (None, name):
                begin, used = time.monotonic(), sum(os.times()[:4])
                try:
                    test()
                except Exception:
                    check(False, traceback.format_exc())
                used = sum(os.times()[:4]) - used
                print(f"{name}: {time.monotonic() - begin:.1f} s, {used:.1f} s of a processor", flush=True)
    return 1 if checking.failures else 0
