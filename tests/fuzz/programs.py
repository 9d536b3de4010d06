"""Csmith's programs: what options a seed has, and what the host says that its program prints.

Csmith: X. Yang, Y. Chen, E. Eide, J. Regehr, Finding and Understanding Bugs in C Compilers, PLDI 2011. Its programs print a
checksum of their global variables and have, with few exceptions, no undefined behaviour.
"""

import dataclasses
import pathlib
import resource
import shlex
import signal

from toolchain import HOST_COMPILER, run

INCLUDE = "/usr/include/csmith"
# Processor time: nearly all programs take milliseconds to be made and to run, or for ever.
CSMITH_SECONDS, HOST_SECONDS = 3, 1

# A seed's profile is PROFILES[seed % len(PROFILES)]: options of Csmith, flags of the compilers, language. Arithmetic that is
# defined for all operands goes through functions unless USE_MATH_MACROS makes it macros.
PROFILES = [
    ("default", "", "", "c"),
    ("float", "--float", "", "c"),
    ("builtins", "--builtins --disable-builtin-kinds x86", "", "c"),
    ("structs", "--max-struct-fields 20 --max-union-fields 8 --max-funcs 14", "-DUSE_MATH_MACROS", "c"),
    ("arrays", "--max-array-dim 4 --max-array-len-per-dim 6", "", "c"),
    ("calls", "--max-funcs 30 --max-block-size 2 --max-expr-complexity 6", "", "c"),
    ("random", "--random-random", "-DUSE_MATH_MACROS", "c"),
    ("deep", "--max-block-depth 7 --max-expr-complexity 20", "", "c"),
    ("pointers", "--max-pointer-depth 5 --no-volatiles", "-DUSE_MATH_MACROS", "c"),
    ("c++", "--lang-cpp --no-pointers --max-struct-fields 16", "-std=gnu++98", "c++"),
    ("mixed", "--float --builtins --disable-builtin-kinds x86 --no-volatiles", "", "c"),
    ("small", "--max-funcs 4 --max-block-size 3 --inline-function-prob 90", "", "c"),
]


@dataclasses.dataclass
class Program:
    seed: int
    profile: str
    language: str
    source: pathlib.Path
    flags: list


class Skip(Exception):
    """A program that cannot be compared; the message is the reason in a word or two."""


def generate(seed, directory):
    """Writes the seed's program into a directory."""
    profile, options, flags, language = PROFILES[seed % len(PROFILES)]
    source = directory / ("program.cpp" if language == "c++" else "program.c")
    csmith = ["prlimit", f"--cpu={CSMITH_SECONDS}", "csmith", "--seed", seed, "--output", source, *shlex.split(options)]
    result = run(csmith, cwd=directory)
    if result.status in (None, -signal.SIGXCPU, -signal.SIGKILL):
        raise Skip("csmith takes too long")
    if result.status != 0:
        raise Skip("csmith fails")
    return Program(seed, profile, language, source, shlex.split(flags) + ["-I", INCLUDE])


def host_compile(program, binary, flags=("-O0",)):
    # Csmith's programs need no C++ library, so no 32-bit one is asked for.
    language = ["-x", "c++", "-nostdinc++"] if program.language == "c++" else ["-x", "c"]
    return run([*HOST_COMPILER, *language, *flags, *program.flags, program.source, "-o", binary])


def expected(program, directory):
    """(what the program prints on the host, processor time in seconds)."""
    result = host_compile(program, directory / "host")
    if result.status is None:
        raise Skip("the host's compiler takes too long")
    if result.status != 0:
        raise Skip("the host's compiler refuses it")
    # Without argument the programs print one line, the checksum.
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    result = run(["prlimit", f"--cpu={HOST_SECONDS}", directory / "host"])
    if result.status in (None, -signal.SIGXCPU, -signal.SIGKILL):
        raise Skip("takes too long on the host")
    if result.status != 0 or not result.output.startswith(b"checksum = "):
        raise Skip("fails on the host")
    return result.output, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def undefined_behaviour(program, directory):
    """Whether the host's sanitizer finds undefined behaviour in the program."""
    flags = ("-O1", "-fsanitize=undefined", "-fsanitize-undefined-trap-on-error")
    if host_compile(program, directory / "host-sanitized", flags).status != 0:
        return False
    result = run([directory / "host-sanitized"])
    return result.status in (-signal.SIGILL, -signal.SIGTRAP)
