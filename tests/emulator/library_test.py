"""The program of docs/library.md, built as the page says against an installation, does what it says: a run in parts,
looked at on the way, has the cycles and instructions of trax-sim's.

  library_test.py CMAKE BUILD SOURCE"""

import json
import os
import re
import subprocess
import sys
import tempfile

CMAKE, BUILD, SOURCE = sys.argv[1:]

PROGRAM = """
#include <trax.h>
unsigned counter;
int main(void) {
  for (int i = 0; i < 3; i++) {
    trax_atomic_inc(&counter);
    for (volatile int j = 0; j < 100; j++) {}
  }
  return 0;
}
"""


def run(*command, **keywords):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **keywords)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def main():
    with open(os.path.join(SOURCE, "docs", "library.md"), encoding="utf-8") as page:
        text = page.read()
    program = re.search(r"^```c\n(.*?)^```", text, re.M | re.S)[1]
    command = re.search(r"^cc .*", text, re.M)[0]
    if program.count("\n") > 60:
        sys.exit("the example has more than 60 lines")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prefix = os.path.join(folder, "prefix")
        run(CMAKE, "--install", BUILD, "--prefix", prefix)
        for name, content in (("watcher.c", program), ("program.c", PROGRAM)):
            with open(name, "w", encoding="utf-8") as file:
                file.write(content)
        run("sh", "-ec", command, env={**os.environ, "PKG_CONFIG_PATH": "prefix/lib/pkgconfig"})
        run(f"{prefix}/bin/clang", "--target=trax", "-O1", "-o", "program.elf", "program.c")
        lines = run("./watcher", "program.elf").splitlines()

        machine = ("--config", "2x32", "--set", "memory.bandwidth_gbps=16")
        run(f"{prefix}/bin/trax-sim", *machine, "--stats", "whole.json", "program.elf")
        subprocess.run([f"{prefix}/bin/trax-sim", *machine, "--stats", "part.json", "--max-cycles", "1000",
                        "program.elf"], check=False,
                       capture_output=True)
        with open("whole.json", encoding="utf-8") as whole, open("part.json", encoding="utf-8") as part:
            whole, part = json.load(whole), json.load(part)
        expected = [
            rf"cycle 1000: {part['instructions']} instructions; thread 33 is at 0x0000\w{{4}}, its return address is "
            rf"0x0000\w{{4}}",
            rf"{whole['cycles']} cycles, {whole['instructions']} instructions, exit status 0"]
        looks = [tuple(map(int, re.fullmatch(r"cycle (\d+): counter (\d+)", line).groups())) for line in lines[1:-1]]
        counters = [counter for _, counter in looks]
        if not re.fullmatch(expected[0], lines[0]) or not re.fullmatch(expected[1], lines[-1]):
            sys.exit(f"{lines} is not {expected}")
        if [cycle for cycle,
            _ in looks] != [1500 + 500 * i for i in range(len(looks))] or counters != sorted(counters) or \
                not looks or counters[-1] < 40 or any(counter >= 40 for counter in counters[:-1]):
            sys.exit(f"the looks {looks} are not every 500 cycles from 1500 on, up to a counter of 40")


main()
