#!/usr/bin/env python3
"""Compare the TP's floating-point instructions, and the library's sqrtf, with the oracle, in each engine of trax-sim.

    tests/isa/oracle/sweep.py                                        pairs enough for test.sh
    tests/isa/oracle/sweep.py --engine functional --count 10000000   as many as asked, of one engine

The operands are the numbered pairs of pairs.h; only hashes of results are compared, and where one differs, the search
for the first such pair follows. Exit status: 0 if nothing differs, else 1.
"""

import argparse
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../.."))
import sweeps  # noqa: E402

# Pairs of each engine by default; the slower ones get fewer. A million has all pairs of corner values.
ENGINES = {"reference": 10000, "fast": 50000, "functional": 1000000}
REDUCED = [23, 12, 1]  # precisions of the special unit besides the whole 24, with an eighth of the pairs


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int,
                        help=f"pairs (default: {', '.join(f'{n} {e}' for e, n in ENGINES.items())})")
    parser.add_argument("--first", type=int, default=0, help="the number of the first (default: 0)")
    parser.add_argument("--engine", choices=list(ENGINES), help="one engine only")
    parser.add_argument("--bits", type=int, help="one precision of the special unit only")
    parser.add_argument("--engine-bits", type=int,
                        help="another precision for the engine: to see that differences are found")
    parser.add_argument("--bin", default=os.path.join(HERE, "../../../build/bin"), help="the folder of the programs")
    parser.add_argument("--machine", default="1x32", help="trax-sim's --config")
    options = parser.parse_args()
    if options.count is not None and options.count < 1 or options.first < 0 or options.first + (options.count or
                                                                                                0) > 1 << 32:
        parser.error("pairs are numbered from 0 to 4294967295")
    program, same = os.path.join(options.bin, "../tests/bin/isa-oracle-sweep"), True
    oracle = sweeps.Program("the oracle", [program])
    for name in [options.engine] if options.engine else ENGINES:
        count = options.count or ENGINES[name]
        for bits in [options.bits] if options.bits else [24] + REDUCED:
            command = [os.path.join(options.bin, "trax-sim"), "--quiet", "--engine", name, "--config", options.machine,
                       "--set", f"special.precision_bits={options.engine_bits or bits}", f"{program}.elf"]
            engine = sweeps.Program(name, command, True)
            same &= sweeps.compare(f"{bits} bits", engine, oracle, bits, options.first,
                                   count if bits == 24 else max(1, count // 8))
    return not same


if __name__ == "__main__":
    sys.exit(main())
