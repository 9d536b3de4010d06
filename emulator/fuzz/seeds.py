#!/usr/bin/env python3
"""Writes the seeds of the fuzzers: usage seeds.py BUILD DIRECTORY

BUILD is a finished build. DIRECTORY gets a folder for each fuzzer, with a file for each case, in the form of
fuzz_case.h.
"""

import glob
import hashlib
import os
import subprocess
import sys
import tempfile

if len(sys.argv) != 3:
    sys.exit(__doc__)
build, directory = sys.argv[1:]
bindir = os.path.join(build, "bin")

PROGRAM = """
static int table[4] = {1, 2}; static _Thread_local int counter;
static inline __attribute__((always_inline)) int load(const int *p) { return *p; }
__attribute__((noinline)) static int walk(int *at, int depth) {
  counter++;
  return depth ? walk(at, depth - 1) + table[depth & 3] : load(at);
}
void _start(void) { walk((int *)8, 5); }
"""


def add(fuzzer, options, *files):
    """files: pairs of name and bytes."""
    case = options.encode() + b"\n" + b"".join(f"{name} {len(data)}\n".encode() + data for name, data in files)
    folder = os.path.join(directory, fuzzer)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, hashlib.sha1(case).hexdigest()[:12]), "wb") as file:
        file.write(case)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def printed(*words):
    return subprocess.run([os.path.join(bindir, "trax-sim"), *words], check=True, stdout=subprocess.PIPE).stdout


with tempfile.TemporaryDirectory() as work:
    subprocess.run([os.path.join(bindir, "../tests/bin/emulator-programs"), work], check=True)
    source = os.path.join(work, "a.c")
    with open(source, "w") as file:
        file.write(PROGRAM)
    for level in ("-O0", "-O2"):
        for debug in ((), ("-g",), ("-g", "-gdwarf-4")):
            elf = os.path.join(work, f"c{level}{''.join(debug)}.elf")
            subprocess.run([os.path.join(bindir, "clang"), level, *debug, "-nostdlib", "-o", elf, source], check=True)
    for elf in sorted(glob.glob(os.path.join(work, "*.elf"))):
        add("trax-sim-elf", "", ("a.elf", read(elf)))

for preset in ("1x32", "8x64"):
    add("trax-sim-config", "", ("m.cfg", printed("--config", preset, "--print-config")))
add("trax-sim-config", "memory.bandwidth_gbps=12.8 special.pipelined=true",
    ("m.cfg", b'preset = "4x32";\n# paper\nmemory: { latency_cycles = 0x10; /* low */ bandwidth_gbps = 1e3; };\n'))
add("trax-sim-config", "chip.tms=64 dcache.bytes=64 dcache.ways=4 icache.line_bytes=4096")


def packets(*lines):
    folder = os.path.join(directory, "trax-sim-gdb")
    os.makedirs(folder, exist_ok=True)
    case = "\n".join(lines).encode("latin-1")
    with open(os.path.join(folder, hashlib.sha1(case).hexdigest()[:12]), "wb") as file:
        file.write(case)


packets("qSupported:swbreak+;hwbreak+", "?", "Hg0", "qXfer:features:read:target.xml:0,ffb", "qfThreadInfo",
        "qsThreadInfo",
        "qXfer:threads:read::0,200", "qC", "qAttached", "g", "p20", "vCont?", "m1000,40", "mfffffff0,10", "T2",
        "qThreadExtraInfo,3")
packets("QStartNoAckMode", "Z0,1008,4", "vCont;c", "z0,1008,4", "vCont;s:1", "Z0,1008,4", "vCont;c", "Hg2",
        "vCont;s:2;c", "c", "c", "D")
packets("Z2,10004,4", "c", "c", "z2,10004,4", "Z3,10000,4", "c", "Z4,fffffff8,4", "c", "Z2,10000,4", "c", "c", "c",
        "vKill;1")
packets("P5=02000000", "P20=08100000", "M10000,4:01020304", "X10000,3:abc", "G" + "00" * 260, "vCont;r1000,1010:1;c",
        "s", "S05", "C0b;1008")
packets("vCont;c", "\x03", "qRcmd," + b"cycle".hex(), "qRcmd," + b"stats".hex(), "qRcmd," + b"registers".hex(),
        "qRcmd," + b"disassemble 0x1000 5".hex(), "qRcmd," + b"help".hex(), "vCont;c", "\x03", "k")
packets("Z0,1024,4", "Z0,1028,4", "c", "z0,1024,4", "vCont;s:1", "vCont;s:1", "vCont;s:1", "c", "c", "c", "c")
packets("c", "g", "?", "c")
packets("\0+$?#3f-$g#67$vCont;c#a8\x03$m10}")
