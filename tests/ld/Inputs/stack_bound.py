"""stack_bound.py BIN STEM SOURCE...: each program, at two levels, runs on the stack that the linker says it takes at
most: that of the path with indirect calls of any function with a taken address, or of the only path."""

import re
import subprocess
import sys

binaries, stem, *sources = sys.argv[1:]
GRANULE = 64  # of -mstack-size


def link(source, level, *options):
    command = [f"{binaries}/clang", "--target=trax", level, "-w", "-mstack=global", source, "-o", stem, *options]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def execute():
    run = subprocess.run([f"{binaries}/trax-sim", "--quiet", "--engine", "fast", stem], capture_output=True,
                         timeout=120, check=False)
    return run.returncode, run.stdout


tight = 0
for source in sources:
    for level in ("-O0", "-O2"):
        report = link(source, level, "-Wl,--print-stack")
        expected = execute()
        assert expected[0] == 0 and expected[1], f"{source} {level} does not run"
        assert not re.search("recursion|variable size|unknown size",
                             report), f"{source} {level} has no bound:\n{report}"
        bound = re.search(r"address is taken, (\d+) bytes", report) or re.search(r"at most (\d+) bytes", report)
        size = -(-int(bound[1]) // GRANULE) * GRANULE
        link(source, level, f"-mstack-size={size}", "-Wl,--stack-check=none")
        assert execute() == expected, f"{source} {level}: {size} bytes of stack are too few"
        link(source, level, f"-mstack-size={size - GRANULE}", "-Wl,--stack-check=none")
        tight += execute() != expected
sys.exit(0 if tight else "no program needs what the linker says")
