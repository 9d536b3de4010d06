#!/usr/bin/env python3
"""Breaks the package for Python, one line at a time, and says whether its tests or the notebook's notice.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there
"""

import os
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from mutation import ROOT, Mutant, failure, main  # noqa: E402

SOURCE = ROOT / "emulator/python/trax"
PYTHON = pathlib.Path("/usr/bin/python3")
SECONDS = 60

# File of emulator/python/trax, text, what it becomes.
MUTANTS = [
    ("machine.py", "elif not isinstance(value, list):", "else:"),
    ("machine.py", 'name != "configuration"', 'name == "configuration"'),
    ("machine.py", '.set_index("tm")', ""),
    ("machine.py", 'for tp in tm["tps"]]', 'for tp in tm["tps"][1:]]'),
    ("machine.py", "for word in (program, *arguments)]", "for word in arguments]"),
    ("machine.py", "if chip is None and self._manifest:", "if False:"),
    ("machine.py", "config.update(settings or {})", "pass"),
    ("machine.py", "if not 0 <= size < 1 << 32:", "if False:"),
    ("machine.py", "ffi.NULL if zeros else view, size", "ffi.NULL if zeros else view, size and size - 1"),
    ("machine.py", "lambda pointer, machine=self._handle: None", "lambda pointer: None"),
    ("machine.py", "        array.flags.writeable = False\n", ""),
    ("machine.py", "        if self._ran:\n", "        if False:\n"),
    ("machine.py", "            self.interrupt()\n", "            pass\n"),
    ("machine.py", '"max_cycles": max_cycles, ', ""),
    ("machine.py", "options.engine = keep[-1]", "pass"),
    ("machine.py", "options.input = ffi.cast(\"FILE *\", input)", "pass"),
    ("machine.py", ' and not name.endswith("_count")', ""),
    ("machine.py", "elif kind and kind.isidentifier()", "elif kind"),
    ("machine.py", "check(lib.trax_explain_end(report, error), error)", "pass"),
    ("machine.py", "raise raised[0]", "pass"),
    ("machine.py", "self._stop[0] = 1", "pass"),
    ("machine.py", 'raise Fault(message or report.splitlines()[0], report, run)', "return run"),
    ("machine.py", '(Stuck if name == "TRAX_STUCK" else Interrupted)', "Stuck"),
    ("machine.py", "shape = height[0], width[0], ", "shape = width[0], height[0], "),
    ("machine.py", "3 if is_float[0] else 4", "4"),
    ("config.py", "str(value).lower() if isinstance(value, (bool, numpy.bool_)) else str(value)", "str(value)"),
    ("config.py", "other.handle = ffi.gc(lib.trax_config_copy(self.handle), lib.trax_config_destroy)",
     "other.handle = self.handle"),
    ("config.py", "found[name] = values[name]", "found[name] = None"),
    ("config.py", "                section = begin[1]\n", "                section = section or begin[1]\n"),
    ("config.py", "        self.update(settings or {})\n", ""),
    ("sweep.py", "itertools.product(*axes.values())", "zip(*axes.values())"),
    ("sweep.py", "            setup(machine)\n", "            pass\n"),
    ("sweep.py", "                machine.interrupt()\n", "                pass\n"),
    ("sweep.py", "return point | machine.run(threads=1, **run).figures()",
     "return machine.run(threads=1, **run).figures() | point"),
    ("sweep.py", "            running.discard(machine)\n", "            pass\n"),
    ("sweep.py", "        if ended.is_set():", "        if False:"),
    ("sweep.py", "isinstance(values, (str, Config)) or ", ""),
    ("sweep.py", "point | row for point, row", "row | point for point, row"),
    ("sweep.py", 'zip(("width", "height"), run["size"])', 'zip(("height", "width"), run["size"])'),
    ("picture.py", "self.pixels.shape[1], self.pixels.shape[0]", "self.pixels.shape[0], self.pixels.shape[1]"),
    ("picture.py", "zlib.crc32(kind + data)", "zlib.crc32(data)"),
    ("picture.py", "rows[:, 1:] = self.bytes()", "rows[:, 1:] = self.bytes()[::-1]"),
    ("picture.py", "linear <= 0.0031308", "linear <= 0.31308"),
    ("picture.py", "(curve * 255 + 0.5)", "(curve * 255)"),
    ("tools.py", "    if done.returncode:\n", "    if False:\n"),
    ("tools.py", '"{}x{}".format(*size)', '"{1}x{0}".format(*size)'),
    ("tools.py", "*options, \"--quiet\"", "\"--quiet\""),
    ("_library.py", "    if status != lib.TRAX_OK:\n", "    if False:\n"),
    ("_library.py", "        libc.fclose(self.file)\n", ""),
]
MUTANTS = [Mutant(*row) for row in MUTANTS]


def noticed(folder, build, mutant):
    package = folder / "trax/python/trax"
    shutil.copytree(build / "lib/trax/python/trax", package, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "trax/libtraxemu.so").symlink_to(build / "lib/trax/libtraxemu.so")
    (package / mutant.file).write_text(mutant.changed(SOURCE))
    environment = os.environ | {"PYTHONPATH": str(package.parent), "PYTHONDONTWRITEBYTECODE": "1",
                                "TRAX_BUILD": str(build), "TRAX_BIN": str(build / "bin")}
    if why := failure(SECONDS, PYTHON, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", HERE,
                      "--deselect", HERE / "tables_test.py::test_wheel", env=environment):
        return [why]
    why = failure(SECONDS, PYTHON, HERE / "notebook.py", ROOT / "docs/python.ipynb", env=environment)
    return [f"notebook: {why}"] if why else []


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, MUTANTS, noticed))
