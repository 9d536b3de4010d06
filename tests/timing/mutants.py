#!/usr/bin/env python3
"""Do the tests of time notice a wrong engine?

    mutants.py [SCRATCH] [--build build] [--jobs N] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there

Each mutant is one changed line of an engine. The tests are linked with it, one after the other, until one fails.
"""

import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutants_list import MUTANTS  # noqa: E402
from mutation import ROOT, Mutant, compile_as, failure, linked, main, relinked  # noqa: E402

SOURCE = ROOT / "emulator"
# Of the two variants of cycle.c, the one that this host runs.
AVX2 = "traxfast_v3" if "avx2" in pathlib.Path("/proc/cpuinfo").read_text() else "traxfast"
ENGINES = ["--jobs", "1", "--stop", "--engine"]
# The quickest first, since it decides about most mutants. Seconds of a processor, some five times as many as without a
# mutant; the only part that is tested; test and words.
TESTS = [(3, "", "timing-rules-test", "docs/timing-rules.md"), (3, "dram", "timing-dram-test"),
         (3, "fast", "timing-ahead-test")]
TESTS += [(3, engine, f"timing-{name}-test") for engine in ("fast", "reference") for name in ("runs", "faults")]
TESTS += [(10, "", "timing-engines-test", *ENGINES, "fast-translated", "--count", "15"),
          *((15, "fast", f"timing-{name}-test")
            for name in ("bandwidth", "translated", "epochs", "checkpoint", "state")),
          (15, "reference", "timing-bandwidth-test")]
TESTS += [(120, "", "timing-engines-test", *ENGINES, engine, "--count", "200")
          for engine in ("fast-translated", "fast")]
FIRST = {"merge": "timing-epochs-test", "store_buffer": "timing-epochs-test", "written": "timing-epochs-test"}
PARTS = {"fast": "fast", "translate": "fast", "reference": "reference"}  # the others are parts of both engines
BY_COMPARISON = tuple(f"timing-{name}" for name in ("engines", "ahead", "state", "epochs", "checkpoint", "translated"))


def tests_of(mutant):
    """Those of its part; first the one that is known to notice it, or those of its file."""
    part = PARTS.get(mutant.file.split("/")[0], "")
    first = mutant.case or FIRST.get(pathlib.Path(mutant.file).stem)
    return sorted((test for test in TESTS if not test[1] or not part or test[1] == part),
                  key=lambda test: test[2] != first)


def with_templates(folder, build, source, text, tests):
    """The same as relinked for the file of which the build extracts templates."""
    changed, generated = folder / source.name, str(build / "emulator/templates")
    changed.write_text(text)
    recipe = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "emulator/templates.c"], check=True,
                            capture_output=True, text=True).stdout.splitlines()[-1].rsplit(" && ", 1)[0]
    subprocess.run(recipe.replace(str(source), str(changed)).replace(generated, str(folder / "extracted")), check=True,
                   shell=True)
    compile_as(build, "emulator/CMakeFiles/traxemu.dir/templates.c.o", f"{generated}.c", folder / "extracted.c",
               folder / "extracted.c.o", "-O1")
    yield from linked(folder, build, tests, [folder / "extracted.c.o"])


def noticed(folder, build, mutant):
    """The first test that fails."""
    tests = tests_of(mutant)
    extracted = mutant.file == "translate/templates.c"
    if extracted:
        tests = [test for test in tests if test[2] != "timing-translated-test"]  # which has templates of its own
    words = [SOURCE / mutant.file, mutant.changed(SOURCE), [name for _, _, name, *_ in tests]]
    if extracted:
        programs = with_templates(folder, build, *words)
    else:  # a header is changed for its own part of the engine: what else includes it does not use the line
        part = "fast/" if mutant.file == "machine/overlay.h" else re.match("fast/time/|[a-z]+/", mutant.file)[0]
        programs = relinked(folder, build, fr"emulator/CMakeFiles/({AVX2}|traxemu)\.dir/{part}", *words, "-O1")
    for program, (seconds, engine, _, *words) in zip(programs, tests):
        environment = os.environ | ({"TRAX_ENGINE": engine} if engine else {})
        if why := failure(seconds, program, *words, cwd=ROOT, env=environment):
            return [f"{engine} {why}".strip()]
    return []


def print_totals(results):
    """Of each engine: by counts derived by hand, not by comparison with another engine."""
    for kind in sorted({mutant.file.split("/")[0] for mutant, _ in results}):
        found = [said for mutant, said in results if mutant.file.startswith(kind + "/")]
        by_hand = sum(bool(said) and not any(name in said[0] for name in BY_COMPARISON) for said in found)
        print(f"{kind}: {sum(map(bool, found))} of {len(found)} caught, {by_hand} by counts derived by hand")


if __name__ == "__main__":
    LIST = [Mutant(*row[:3], case="".join(row[3:])) for row in MUTANTS]
    sys.exit(main(__doc__, SOURCE, LIST, noticed, totals=print_totals))
