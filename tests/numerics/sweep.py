#!/usr/bin/env python3
"""Compare arithmetic on the TP, and its sources compiled for the host, with the host's hardware, operand by operand.

    sweep.py --count 10000000 --group doubles      one group; --first splits the work between processes
    sweep.py                                       20,000 operands for all routines of the groups doubles and integers,
                                                   and 500 for those of functions

Each routine gets the same operands everywhere (sweep.h), and only hashes of the results are compared; where one
differs, the search for the first such operands follows, and they are printed. The groups doubles and integers are
compared with the hardware, functions (sin, pow, complex numbers, ...) with the runtime's sources compiled for the host.
Exit status: 0 if nothing differs, else 1.
"""

import argparse
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import sweeps  # noqa: E402

GROUPS = {"doubles": 0, "integers": 1, "functions": 2}


def main():
    build = os.path.join(HERE, "..", "..", "build")
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int, help="operands for each routine (default: 20000, of functions 500)")
    parser.add_argument("--first", type=int, default=0, help="the number of the first (default: 0)")
    parser.add_argument("--group", choices=list(GROUPS), help="one group only")
    parser.add_argument("--host-only", action="store_true", help="not on the TP")
    parser.add_argument("--bin", default=os.path.join(build, "bin"),
                        help="the folder of trax-sim, beside tests/bin of the compiled sweeps")
    parser.add_argument("--machine", default="1x32", help="trax-sim's --config")
    options = parser.parse_args()

    def program(name):
        return os.path.join(options.bin, name if name == "trax-sim" else f"../tests/bin/{name}")

    hardware = sweeps.Program("hardware", [program("sweep-hardware")])
    sources = sweeps.Program("runtime on the host", [program("sweep-runtime")])
    command = [program("trax-sim"), "--engine", "functional", "--quiet", "--config", options.machine]
    tp = sweeps.Program("TP", [*command, program("sweep.elf")], True)
    same = True
    for group in [options.group] if options.group else list(GROUPS):
        count = options.count or (500 if group == "functions" else 20000)
        # Compiled for the host, functions are the reference itself.
        for candidate in ([] if group == "functions" else [sources]) + ([] if options.host_only else [tp]):
            same &= sweeps.compare(group, candidate, hardware, GROUPS[group], options.first, count)
    return not same


if __name__ == "__main__":
    sys.exit(main())
