"""The programs that the fuzz tests run: the compiler and emulator of a build, and the host's compiler.

Every command has a time limit and is kept as text, so that a failure can name the command that reproduces it.
"""

import dataclasses
import hashlib
import os
import pathlib
import shlex
import shutil
import subprocess

SECONDS = 1800  # for a step that has no limit of its own: a compiler that takes a minute is no failure on a busy host

# i386 has the TP's data model: 32-bit int, long and pointers, 8-byte scalars aligned to 4, signed char, bit-fields
# alike. SSE computes binary32 and binary64 as such, x87 would not.
HOST_COMPILER = ["gcc", "-m32", "-msse2", "-mfpmath=sse", "-ffp-contract=off", "-fwrapv", "-w"]


class SetupError(Exception):
    """Something that the tests need is missing."""


class Failure(Exception):
    """A program does not do what it must. The message is a line; `command` reproduces it, `undefined` says whether
    undefined behaviour of the program would explain it."""

    def __init__(self, message, command, undefined=False):
        super().__init__(message)
        self.command = command
        self.undefined = undefined


@dataclasses.dataclass
class Result:
    """The result of a command. Its status is None if it did not end in time, and -N if signal N ended it."""

    command: str
    status: int
    output: bytes
    error: str

    def reason(self):
        if self.status is None:
            what = "does not end"
        elif self.status < 0:
            what = f"ends by signal {-self.status}"
        else:
            what = f"ends with status {self.status}"
        lines = [line for line in self.error.splitlines() if line.strip()]
        named = [line for line in lines if "rror" in line or "fault" in line or "ssert" in line]
        return ": ".join([what] + (named or lines)[:1])


def run(command, seconds=SECONDS, cwd=None):
    command = [str(word) for word in command]
    text = shlex.join(command)
    try:
        done = subprocess.run(command, capture_output=True, timeout=seconds, stdin=subprocess.DEVNULL, check=False,
                              cwd=cwd)
    except subprocess.TimeoutExpired as expired:
        return Result(text, None, expired.stdout or b"", (expired.stderr or b"").decode(errors="replace"))
    return Result(text, done.returncode, done.stdout, done.stderr.decode(errors="replace"))


def require_programs(packages):
    """Raises SetupError unless each program or file (the keys) of a package (the values) is there."""
    missing = {package for name, package in packages.items() if not (shutil.which(name) or os.path.exists(name))}
    if missing:
        raise SetupError(f"missing on this host: install {' '.join(sorted(missing))} (./setup.sh does)")


def require_host_compiler(work):
    """Raises SetupError unless the host compiles and runs 32-bit programs."""
    source = work / "host.c"
    source.write_text("#include <stdio.h>\nint main(void) { return sizeof(long) == 4 && puts(\"ok\") > 0 ? 0 : 1; }\n")
    for command in ([*HOST_COMPILER, source, "-o", work / "host"], [work / "host"]):
        result = run(command)
        if result.status != 0:
            raise SetupError("the host cannot compile and run 32-bit programs: install gcc-multilib libc6-dev-i386 "
                             f"(./setup.sh does)\n  {result.command}\n  {result.reason()}")


class Target:
    """Compiler, linker and emulator of a build directory."""

    def __init__(self, build, flags=()):
        self.build = pathlib.Path(build).resolve()
        self.clang, self.clangxx, self.sim = (self.build / "bin" / name for name in ("clang", "clang++", "trax-sim"))
        self.flags = ["--target=trax", "-w", "-mllvm", "-verify-machineinstrs", *flags]
        self.compiled = {}  # object: (arguments, language)
        for program in (self.clang, self.sim, self.build / "lib/trax/libc.a"):
            if not program.exists():
                raise SetupError(f"{program} does not exist: build first, or name the build directory with --build")

    def fingerprint(self):
        """Changes whenever the toolchain does."""
        digest = hashlib.sha256(" ".join(self.flags).encode())
        for name in ("bin/clang", "bin/trax-ld", "bin/trax-sim", "lib/trax/crt0.o", "lib/trax/libc.a"):
            digest.update((self.build / name).read_bytes())
        return digest.hexdigest()[:16]

    def compile(self, arguments, language="c"):
        """Runs the compiler; raises Failure if it does not succeed."""
        compiler = self.clangxx if language == "c++" else self.clang
        result = run([compiler, *self.flags, *arguments])
        if result.status != 0:
            raise Failure(f"the compiler {result.reason()}", result.command)
        if "-o" in arguments:
            self.compiled[arguments[arguments.index("-o") + 1]] = arguments, language
        return result

    def link(self, objects, image):
        """Links with the stack in local memory, or in global memory if the linker says that it does not fit. Returns
        which of them. The objects are compiled for it again then."""
        command = [self.clang, *self.flags, *objects, "-o", image]
        result = run(command)
        if result.status == 0:
            return "local"
        if "stack" not in result.error:
            raise Failure(f"the linker {result.reason()}", result.command)
        for name in objects:
            if name in self.compiled:
                arguments, language = self.compiled[name]
                self.compile([*arguments, "-mstack=global"], language)
        result = run([*command, "-mstack=global", "-mstack-size=1048576"])
        if result.status != 0:
            raise Failure(f"the linker {result.reason()}", result.command)
        return "global"

    def simulate(self, image, max_cycles, engine="fast", options=()):
        """The result of a run; its status is None if it passed max_cycles."""
        command = [self.sim, "--quiet", "--engine", engine, "--max-cycles", max_cycles, *options, image]
        result = run(command, seconds=SECONDS + max_cycles // 1_000_000)
        if result.status == 124 and "has not ended" in result.error:
            result.status = None
        return result
