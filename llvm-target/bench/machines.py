"""Compilers with a way to count the instructions that their programs execute."""

import functools
import json
import re
import shutil
import struct
import subprocess
import threading
from pathlib import Path

BENCH = Path(__file__).resolve().parent
ROOT = BENCH.parent.parent
SECONDS = 600

# The start of the library's square roots where there is no reciprocal square root: single precision suffices.
LIBRARY_SQRT = "-D__builtin_sqrt(x)=__builtin_sqrtf((float)(x))"
COMMON = ["-std=c17", "-fno-math-errno", "-Wall", "-Wextra", "-Werror", "-I", str(ROOT / "raytracer/device"), "-I",
          str(ROOT / "raytracer/include"), "-I", str(ROOT / "raytracer"), "-I", str(ROOT / "isa/include")]
RISCV = ["--target=riscv32", "-mabi=ilp32"]
PACKAGES = {"clang-19": "clang-19", "nm": "binutils", "llvm-size-19": "llvm-19", "ld.lld-19": "lld-19",
            "qemu-riscv32": "qemu-user", "cc": "gcc"}


class Failure(Exception):
    """An error that ends the program with a message."""


def run(command):
    """Run a command; return what it printed to standard output and to standard error."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=SECONDS,
                              check=False,
                              stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired as expired:
        raise Failure(f"{' '.join(map(str, command))}\n  did not end in {SECONDS} s") from expired
    if done.returncode != 0:
        raise Failure(
            f"{' '.join(map(str, command))}\n  ended with status {done.returncode}\n{done.stderr}{done.stdout}")
    return done.stdout, done.stderr


def run_logged(command, counter):
    """Run a command whose standard error the program `counter` reads; return what both printed to standard output."""
    with subprocess.Popen([counter], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as counting:
        try:
            done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=counting.stdin,
                                  text=True, timeout=SECONDS, check=False,
                                  stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired as expired:
            raise Failure(f"{' '.join(map(str, command))}\n  did not end in {SECONDS} s") from expired
        counted, _ = counting.communicate()
    if done.returncode != 0 or counting.returncode != 0:
        raise Failure(
            f"{' '.join(map(str, command))}\n  ended with status {done.returncode}, its counter with "
            f"{counting.returncode}"
        )
    return done.stdout, counted


@functools.lru_cache(maxsize=None)
def takes_plugins():
    """Whether qemu takes plugins. Debian 13's is linked statically and takes none."""
    return "-plugin" in run(["qemu-riscv32", "-help"])[0]


class Trax:
    """Our compiler, counted by the simulator."""

    def __init__(self, build, work):
        self.build, self.work, self.name = build, work, "trax"
        self.compiler = [build / "bin/clang", "--target=trax"]

    def link(self, objects, output):
        run([*self.compiler, *objects, "-o", output])

    def execute(self, program, *words):
        """Run a program; return what it printed and how many instructions it took."""
        statistics = program.with_suffix(".json")
        printed, _ = run([self.build / "bin/trax-sim", "--engine", "functional", "--quiet", "--stats", statistics,
                          program, *words])
        return printed, json.loads(statistics.read_text())["instructions"]


class Riscv:
    """Debian's clang for RISC-V, counted by qemu."""

    def __init__(self, build, work, name="riscv", flags=(), library=True, extensions=""):
        self.build, self.work, self.name = build, work, name
        self.compiler = ["clang-19", *RISCV, f"-march=rv32im{extensions}_zfinx", "-nostdlibinc", "-idirafter",
                         build / "lib/trax/include", "-I", BENCH / "twin",
                         *flags]
        if not library:  # to compile only
            return
        how = ["-shared", "-fPIC", BENCH / "count_plugin.c"] if takes_plugins() else [BENCH / "count_trace.c"]
        self.counter = work / f"{name}-count"
        run(["cc", "-O2", "-Wall", "-Wextra", "-Werror", *how, "-o", self.counter])
        self.library, self.places, self.growing = self.make_library(), self.find_sources(), threading.Lock()

    def make_library(self):
        """Return the initial objects and archives. add_sources adds the parts that kernels need."""
        return []

    def find_sources(self):
        """Return the source of each symbol of the runtime, from the symbols of our library."""
        sources = {f"{source.name}.o": source for part in ("builtins", "math", "string")
                   for source in (ROOT / "runtime" / part).glob("*.c")}
        listed, _ = run(["nm", "-A", "--defined-only", self.build / "lib/trax/libc.a"])
        found = re.findall(r":([^:]+):\w+ [TW] (\S+)$", listed, re.MULTILINE)
        return {symbol: sources[member] for member, symbol in found if member in sources}

    def add_sources(self, sources):
        """Compile sources of the runtime with its flags, and add them to the library."""
        command = [*self.compiler, "-std=c17", "-D_DEFAULT_SOURCE", "-O2", "-ffreestanding", "-fno-builtin",
                   "-fno-math-errno", "-ffunction-sections", LIBRARY_SQRT, f"-I{ROOT / 'isa/include'}",
                   f"-I{self.build / 'runtime/math'}"]
        with self.growing:
            for source in sources:
                made = self.work / f"{self.name}-{source.parent.name}-{source.stem}.o"
                if made not in self.library:
                    run([*command, "-c", source, "-o", made])
                    self.library.append(made)

    def link(self, objects, output):
        """Link, with the parts of the runtime that the linker's errors name."""
        while True:
            added = list(self.library)
            try:
                run(["ld.lld-19", "--gc-sections", "--error-limit=0", *objects, "--start-lib", *added, "--end-lib",
                     "-o", output])
                return
            except Failure as failure:
                lacks = re.findall(r"undefined symbol: (\S+)", str(failure))
                sources = sorted({self.places[symbol] for symbol in lacks if symbol in self.places})
                if not sources:
                    raise
                self.add_sources(sources)
                if self.library == added:
                    raise

    def execute(self, program, *words):
        qemu = ["qemu-riscv32", "-cpu", "rv32,zfinx=true,zbb=true,f=false,d=false"]
        if takes_plugins():
            printed, counted = run([*qemu, "-plugin", self.counter, program, *words])
        else:
            qemu[-1] += ",zfa=false"  # which needs f in the releases without plugins
            printed, counted = run_logged([*qemu, "-d", "in_asm,exec,nochain", program, *words],
                                          self.counter)
        return printed, int(counted.split()[1])


class Host:
    """The host, whose results are the reference."""

    def __init__(self, work, name):
        self.work, self.name = work, name
        self.compiler = ["clang-19", "-DHOST", "-ffp-contract=off", "-I", BENCH / "twin"]

    def link(self, objects, output):
        run([*self.compiler, *objects, "-lm", "-o", output])

    def execute(self, program, *words):
        return run([program, *words])[0], None


@functools.lru_cache(maxsize=None)
def compiled(machine, source, flags, level="-O3"):
    """The object of a source, which is compiled once."""
    name = machine.work / "-".join([machine.name + level, source.stem,
                                    *(flag.strip("-").replace("=", "") for flag in flags)])
    run([*machine.compiler, *COMMON, level, *flags, "-c", source, "-o", f"{name}.o"])
    return f"{name}.o"


DRIVER = threading.Lock()  # kernels share it


@functools.lru_cache(maxsize=None)
def linked(machine, source, flags, level):
    """The program of a kernel and its driver."""
    kernel = compiled(machine, source, flags, level)
    with DRIVER:
        driver = compiled(machine, BENCH / "driver.c", ())
    program = machine.work / f"{Path(kernel).stem}.elf"
    machine.link([driver, kernel], program)
    return program


def build_and_run(machine, source, *words, flags=(), level="-O3"):
    """Run a kernel with these arguments of its driver; return (checksum, measure, executed instructions)."""
    program = linked(machine, source, flags, level)
    printed, count = machine.execute(program, *words)
    try:
        checksum, measure = (int(word, 16) for word in printed.split())
    except ValueError as error:
        raise Failure(f"{program} printed {printed!r}") from error
    return checksum, struct.unpack("<f", struct.pack("<I", measure))[0], count


def measure_kernel(machine, source, level="-O3"):
    """Return a kernel's result and how many instructions a repetition executes."""
    _, _, once = build_and_run(machine, source, "1", level=level)
    checksum, measure, twice = build_and_run(machine, source, "2", level=level)
    return (checksum, measure), twice - once


def check_counter(machine):
    """Check that the counter counts a loop of three instructions correctly."""
    counts = [build_and_run(machine, BENCH / "counted_loop.c", "1", flags=(f"-DITERATIONS={n}",))[2]
              for n in (100000, 200000)]
    if counts[1] - counts[0] != 300000:
        raise Failure(f"the counter of {machine.name} finds {counts[1] - counts[0]} instructions in a loop of 300000")


def check_programs(build):
    missing = [program for program in PACKAGES if not shutil.which(program)]
    if missing:
        packages = sorted({PACKAGES[program] for program in missing})
        raise Failure(f"not found: {', '.join(missing)}; Debian: apt-get install {' '.join(packages)}")
    for path in (build / "bin/clang", build / "bin/trax-sim", build / "lib/trax/libc.a"):
        if not path.exists():
            raise Failure(f"{path} is missing; build it first (ninja -C {build})")
