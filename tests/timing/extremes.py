#!/usr/bin/env python3
"""Machines at the ends of what a configuration allows, in both engines: they end, the accounts balance, nothing
differs.

    extremes.py --bin build/bin [--short]

--short leaves out what takes longest: random cases on three machines of four, the programs in assembly on two of
three, those in C on the machine of 4,096 threads, and on each other machine two of the three in C that do one thing.
Prints a row for each machine: the cycles of each program, and what the random cases of timing-engines-test said. Exit
status 0 if all runs of the reference and the fast engine are equal in every statistic, every byte of memory and every
message.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time

import engines

HERE = os.path.dirname(os.path.abspath(__file__))

LATENCIES = ["tp.int_latency_cycles", "tp.local_latency_cycles", "tp.branch_bubble_cycles", "fpu.add_latency_cycles",
             "fpu.mul_latency_cycles",
             "fpu.compare_latency_cycles", "fpu.convert_latency_cycles", "int_mul.latency_cycles",
             "special.latency_cycles",
             "dcache.hit_latency_cycles"]
ONE_LINE = ["icache.bytes=64", "icache.line_bytes=64", "icache.ways=1", "dcache.bytes=64", "dcache.line_bytes=64",
            "dcache.ways=1"]
DRAM = ["memory.model=dram"]
DRAM_TIMES = ("trcd", "trp", "tcl", "tcwl", "tras", "trrd", "tfaw", "twtr", "twr", "trtp", "tturn")
# Name, TMs and TPs of each, keys.
MACHINES = [
    ("defaults", (2, 16), []),
    ("1 x 1", (1, 1), []),
    ("1 x 64", (1, 64), []),
    ("64 x 1", (64, 1), []),
    ("64 x 64", (64, 64), []),
    ("0.001 GB/s", (1, 2), ["memory.bandwidth_gbps=0.001"]),
    ("0.01 GB/s", (2, 16), ["memory.bandwidth_gbps=0.01"]),
    ("1000 GB/s", (2, 16), ["memory.bandwidth_gbps=1000"]),
    ("1,000,000 GB/s", (2, 16), ["memory.bandwidth_gbps=1000000"]),
    ("latency 0", (2, 16), ["memory.latency_cycles=0"]),
    ("latency 0, 1000 GB/s", (2, 16), ["memory.latency_cycles=0", "memory.bandwidth_gbps=1000"]),
    ("latency 10,000", (2, 16), ["memory.latency_cycles=10000"]),
    ("latency 100,000", (1, 4), ["memory.latency_cycles=100000"]),
    ("caches of one line", (2, 16), ONE_LINE),
    ("one line, 1 x 1", (1, 1), ONE_LINE),
    ("lines of 4 bytes", (2, 16), ["icache.bytes=64", "icache.line_bytes=4", "dcache.bytes=64", "dcache.line_bytes=4"]),
    ("lines of 4096 bytes", (2, 16),
     ["icache.bytes=4096", "icache.line_bytes=4096", "dcache.bytes=4096", "dcache.line_bytes=4096"]),
    ("64 ways of one set", (2, 16), ["icache.bytes=4096", "icache.ways=64", "dcache.bytes=4096", "dcache.ways=64"]),
    ("one bank", (2, 16), ["icache.banks=1", "icache.tps_per_cache=64", "dcache.tps_per_bank=64"]),
    ("a cache each", (2, 16), ["icache.tps_per_cache=1", "icache.banks=64", "dcache.tps_per_bank=1"]),
    ("one unit of each", (1, 64), ["fpu.tps_per_cluster=64", "int_mul.tps_per_unit=64", "fpu.compare_units=false"]),
    ("units of their own", (2, 16), ["fpu.tps_per_cluster=1", "int_mul.tps_per_unit=1", "special.units_per_tm=64"]),
    ("latencies 1000", (2, 8), [f"{key}=1000" for key in LATENCIES]),
    ("latencies 1000, pipelined", (2, 8), [f"{key}=1000" for key in LATENCIES] + ["special.pipelined=true"]),
    ("1 miss register", (2, 16), ["dcache.mshrs=1"]),
    ("queue of 1", (2, 16), ["memory.queue_depth=1"]),
    ("queue of 1, latency 10,000", (1, 4), ["memory.queue_depth=1", "memory.latency_cycles=10000"]),
    ("queue of 4096", (2, 16), ["memory.queue_depth=4096", "dcache.mshrs=1024"]),
    ("transfers of 4096 bytes", (2, 16), ["memory.min_transfer_bytes=4096", "memory.atomic_bytes=4096"]),
    ("second level of one line", (4, 8),
     ["l2.bytes=64", "l2.ways=1", "l2.banks=1", "l2.mshrs=1", "l2.latency_cycles=1"]),
    ("second level of 256 MB", (4, 8),
     ["l2.bytes=268435456", "l2.ways=64", "l2.banks=64", "l2.mshrs=4096", "l2.latency_cycles=1000"]),
    ("16 channels", (4, 8), ["memory.channels=16", "memory.interleave_bytes=64"]),
    ("16 channels, 0.01 GB/s", (2, 4), ["memory.channels=16", "memory.bandwidth_gbps=0.01", "l2.bytes=4096"]),
    ("16 channels, 1000 GB/s", (4, 8), ["memory.channels=16", "memory.bandwidth_gbps=1000", "memory.latency_cycles=0"]),
    ("increments of 100,000", (2, 2), ["memory.atomic_latency_cycles=100000"]),
    ("DRAM, one of everything", (2, 8),
     [*DRAM, "dram.banks=1", "dram.reads=1", "dram.writes=1", "dram.batch_from=1", "dram.batch_to=0", "dram.cap=0"]),
    ("DRAM, 16 channels", (4, 8), [*DRAM, "memory.channels=16", "dram.ranks=4", "dram.banks=32", "dram.reads=256",
                                   "dram.writes=256", "dram.batch_from=256"]),
    ("DRAM, 100,000 MT/s", (2, 8), [*DRAM, "dram.mtps=100000", "memory.latency_cycles=0"]),
    ("DRAM, 100 MT/s", (1, 2), [*DRAM, "dram.mtps=100", "l2.bytes=4096"]),
    ("DRAM, 1000 ticks each", (1, 2),
     [*DRAM, *(f"dram.{key}=1000" for key in DRAM_TIMES), "dram.trfc=10000", "dram.trefi=10001"]),
    ("fills of 64, increments of 1000", (2, 8), ["dcache.fill_cycles=64", "memory.atomic_interval_cycles=1000"]),
    ("64 units of a group", (2, 16),
     ["fpu.adders_per_cluster=64", "fpu.multipliers_per_cluster=64", "int_mul.units_per_group=64"]),
    ("1 MHz", (2, 16), ["chip.clock_mhz=1"]),
    ("100 GHz", (1, 8), ["chip.clock_mhz=100000"]),
]

# Name, and macros of extremes.c or the text.
C_PROGRAMS = [("everything", ["EVERYTHING", "ROUNDS=4"]), ("one address", ["ONE_ADDRESS", "ROUNDS=10"]),
              ("one atomic", ["ONE_ATOMIC", "ROUNDS=3"]),
              ("stores", ["STREAM", "ROUNDS=6"])]
FAULTING = ("fault", "fault later", "illegal", "runs off")
ASSEMBLY = [("empty", "halt"), ("fault", "lw r4, 8(r0)"),
            ("fault later", "rdsr r4, cycle\n  slli r4, r4, 2\n  sw r4, -2048(r0)\n  halt"),
            ("illegal", ".long 0"), ("runs off", "nop")]


def build(binaries, folder, rounds=None):
    """Compile the programs, with so many rounds of the C programs; return their names and paths."""
    paths = []
    os.makedirs(folder, exist_ok=True)
    for name, macros in C_PROGRAMS:
        macros = [macros[0], f"ROUNDS={rounds}"] if rounds else macros
        path = os.path.join(folder, name.replace(" ", "_") + ".elf")
        subprocess.run([os.path.join(binaries, "clang"), "--target=trax", "-O2", *(f"-D{macro}" for macro in macros),
                        os.path.join(HERE, "extremes.c"),
                        "-o", path], check=True)
        paths.append((name, path))
    for name, text in ASSEMBLY:
        path = os.path.join(folder, name.replace(" ", "_"))
        with open(path + ".s", "w", encoding="utf-8") as file:
            file.write(f"  .globl _start\n_start:\n  {text}\n")
        subprocess.run([os.path.join(binaries, "clang"), "--target=trax", "-nostdlib", path + ".s", "-o",
                        path + ".elf"], check=True)
        paths.append((name, path + ".elf"))
    return paths


def random_cases(options, chip, keys):
    """Random programs on the machine: "equal", or what timing-engines-test printed."""
    sets = [f"--set={key}" for key in [f"chip.tms={chip[0]}", f"chip.tps_per_tm={chip[1]}", *keys]]
    if chip[0] * chip[1] > 128:
        return "-"  # more threads than their programs have memory for
    done = subprocess.run([os.path.join(options.bin, "../tests/bin/timing-engines-test"), "--seed", str(options.seed),
                           "--count", str(options.random), *sets],
                          capture_output=True, text=True, timeout=1200, check=False)
    return "equal" if done.returncode == 0 else done.stdout + done.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bin", default=os.path.join(HERE, "..", "..", "build", "bin"),
                        help="the folder of trax-sim and clang")
    parser.add_argument("--short", action="store_true",
                        help="one round of each program, and what takes longest is left out")
    parser.add_argument("--random", type=int, default=10, help="random cases on each machine (default: 10)")
    parser.add_argument("--seed", type=int, default=1, help="of the first (default: 1)")
    options = parser.parse_args()
    options.bin = os.path.abspath(options.bin)
    begin, failures, runs = time.monotonic(), [], 0
    with tempfile.TemporaryDirectory() as folder:
        short = build(options.bin, os.path.join(folder, "short"), rounds=1)
        programs = short if options.short else build(options.bin, os.path.join(folder, "programs"))
        print(f"{'machine':<27}" + "".join(f"{name:>13}" for name, _ in programs) + f"{'random':>8}")
        for number, (machine, chip, keys) in enumerate(MACHINES):
            cells, left_out = [], {name for name, _ in C_PROGRAMS[1:]} - {C_PROGRAMS[1 + number % 3][0]}
            for name, path in short if chip[0] * chip[1] > 1000 else programs:
                large, in_assembly = chip[0] * chip[1] > 1000, name in dict(ASSEMBLY)
                if options.short and (large and not in_assembly or in_assembly and number % 3 != 1 or
                                      name in left_out):
                    cells.append("-")
                    continue
                command = [os.path.join(options.bin, "trax-sim"), path, "--quiet"]
                for key in [f"chip.tms={chip[0]}", f"chip.tps_per_tm={chip[1]}", "memory.size_mib=4", *keys]:
                    command += ["--set", key]
                if name in dict(C_PROGRAMS):
                    command += ["--alloc", f"result={16 * chip[0] * chip[1]}", "--dump", "result=result"]
                reference, fast = (engines.run(command, engine, folder, ["result"]) for engine in ("reference", "fast"))
                runs += 1
                wrong = engines.difference(reference, fast) or engines.violation(reference)
                expected = 1 if name in FAULTING else 0
                if not wrong and reference.status != expected:
                    wrong = f"exit status {reference.status}: {reference.errors.decode()[:200]}"
                cells.append("DIFFERS" if wrong else f"{reference.statistics['cycles']:,}")
                if wrong:
                    failures.append(f"{machine}, {name}: {wrong}")
            randomly = random_cases(options, chip, keys) if not options.short or number % 4 == 3 else "-"
            if randomly not in ("equal", "-"):
                failures.append(f"{machine}, random cases: {randomly}")
                randomly = "DIFFERS"
            print(f"{machine:<27}" + "".join(f"{cell:>13}" for cell in cells) + f"{randomly:>8}", flush=True)
    for failure in failures:
        print(failure)
    print(f"{len(MACHINES)} machines, {runs} pairs of runs, {len(failures)} failures; {time.monotonic() - begin:.0f} s")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
