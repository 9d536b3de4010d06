#!/usr/bin/env python3
"""The same run again, on other numbers of host threads and by other builds of trax-sim: the same bytes in every output
file.

    same_bytes.py --bin build/bin
    same_bytes.py --bin build/bin --sim build-clang/bin/trax-sim --sim build-debug/bin/trax-sim

What says how fast the host was is left out. Exit status 0 if nothing differs.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time

import extremes

# Machines and programs of extremes.c.
RUNS = [("everything", ["chip.tms=4", "chip.tps_per_tm=8"]),
        ("everything", ["chip.tms=3", "chip.tps_per_tm=5", "memory.latency_cycles=300"]),
        ("stores", ["chip.tms=8", "chip.tps_per_tm=3"]), ("one atomic", ["chip.tms=5", "chip.tps_per_tm=4"]),
        ("fault later", ["chip.tms=4", "chip.tps_per_tm=2"])]
COUNTED = ["--stats", "--report"]
SERIES = [*COUNTED, "--series"]
EXPLAINED = [*SERIES, "--profile", "--profile-folded", "--heat", "--heat-lines", "--items", "--trace", "--perfetto"]
HOST = re.compile(rb"host|instructions/s|per second of", re.IGNORECASE)


def run(simulator, path, keys, files, host_threads, folder):
    """Run once; return exit status, outputs and the bytes of the files without the host's lines."""
    command = [simulator, os.path.relpath(path, folder), "--quiet", "--host-threads", str(host_threads), "--set",
               "memory.size_mib=4"]
    for key in keys:
        command += ["--set", key]
    if "--series" in files:
        command += ["--series-interval", "100"]
    if "--trace" in files:
        command += ["--window", "150:600"]
    for option in files:
        command += [option, option[2:]]
    if "fault" not in path:
        command += ["--alloc", "result=4096", "--dump", "result=result"]
    for name in [option[2:] for option in files] + ["result"]:
        if os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=600, check=False)
    found = {"exit status": str(done.returncode).encode(), "standard output": done.stdout,
             "standard error": done.stderr}
    for name in [option[2:] for option in files] + ["result"]:
        if os.path.exists(os.path.join(folder, name)):
            with open(os.path.join(folder, name), "rb") as file:
                found[name] = b"\n".join(line for line in file.read().split(b"\n")
                                         if not (name in ("stats", "report") and HOST.search(line)))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bin", default=os.path.join(extremes.HERE, "..", "..", "build", "bin"),
                        help="the folder of trax-sim and clang")
    parser.add_argument("--sim", action="append", default=[], help="trax-sim of another build; may be repeated")
    options = parser.parse_args()
    own = os.path.join(os.path.abspath(options.bin), "trax-sim")
    simulators = [own, *(os.path.abspath(path) for path in options.sim)]
    begin, runs, failures, compared = time.monotonic(), 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        programs = dict(extremes.build(os.path.abspath(options.bin), os.path.join(folder, "programs")))
        for name, keys in RUNS:
            for files in (COUNTED, SERIES, EXPLAINED):
                first = run(own, programs[name], keys, files, 1, folder)
                missing = [option for option in files if option[2:] not in first]
                if missing:
                    failures += 1
                    print(
                        f"{name}, {' '.join(keys)}: no file of {', '.join(missing)}: "
                        f"{first['standard error'].decode()[:300]}"
                    )
                for simulator in simulators:
                    for host_threads in (1, 2, 3, 8):
                        again = run(simulator, programs[name], keys, files, host_threads, folder)
                        runs += 1
                        compared += sum(len(content) for content in again.values())
                        for file in sorted(first.keys() | again.keys()):
                            if first.get(file) != again.get(file):
                                failures += 1
                                print(
                                    f"{name}, {' '.join(keys)}, {host_threads} host threads, {simulator}: {file} "
                                    f"differs"
                                )
    print(
        f"{runs} runs of {len(simulators)} builds on 1, 2, 3 and 8 host threads, {compared:,} bytes of output: "
        f"{failures} differences; "
        f"{time.monotonic() - begin:.0f} s")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
