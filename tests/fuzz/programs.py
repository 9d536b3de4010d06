"""Csmith's programs: the options of a seed, and the host's output of its program.

Csmith: X. Yang, Y. Chen, E. Eide, J. Regehr, Finding and Understanding Bugs in C Compilers, PLDI 2011. Its programs
print a checksum of their global variables and have, with few exceptions, no undefined behaviour.
"""

import dataclasses
import hashlib
import json
import pathlib
import resource
import shlex
import signal

from toolchain import HOST_COMPILER, run

INCLUDE = "/usr/include/csmith"
# Processor time: nearly all programs take milliseconds to be made and to run, or for ever.
CSMITH_SECONDS, HOST_SECONDS = 2, 1

# A seed's profile is PROFILES[seed % len(PROFILES)]: options of Csmith, flags of the compilers, language. Arithmetic
# that is defined for all operands goes through functions unless USE_MATH_MACROS makes it macros.
PROFILES = [
    ("default", "", "", "c"),
    ("float", "--float", "", "c"),
    ("builtins", "--builtins --disable-builtin-kinds x86", "", "c"),
    ("structs", "--max-struct-fields 16 --max-union-fields 8", "-DUSE_MATH_MACROS", "c"),
    ("arrays", "--max-array-dim 4 --max-array-len-per-dim 6", "", "c"),
    ("calls", "--max-funcs 30 --max-block-size 2 --max-expr-complexity 6", "", "c"),
    ("random", "--random-random", "-DUSE_MATH_MACROS", "c"),
    ("deep", "--max-block-depth 6 --max-expr-complexity 14", "", "c"),
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
    options: list  # of csmith
    flags: list  # of the compilers


class Skip(Exception):
    """A program that cannot be compared; the message is the reason in a word or two."""


def describe(seed, directory):
    profile, options, flags, language = PROFILES[seed % len(PROFILES)]
    source = directory / ("program.cpp" if language == "c++" else "program.c")
    return Program(seed, profile, language, source, shlex.split(options), shlex.split(flags) + ["-I", INCLUDE])


def generate(seed, directory):
    """Writes the seed's program into a directory."""
    program = describe(seed, directory)
    csmith = ["prlimit", f"--cpu={CSMITH_SECONDS}", "csmith", "--seed", seed, "--output", program.source,
              *program.options]
    result = run(csmith, cwd=directory)
    if result.status in (None, -signal.SIGXCPU, -signal.SIGKILL):
        raise Skip("csmith takes too long")
    if result.status != 0:
        raise Skip("csmith fails")
    return program


def host_compile(program, binary, flags=("-O0",), compiler=HOST_COMPILER[0]):
    # Csmith's programs need no C++ library, so no 32-bit one is asked for.
    language = ["-x", "c++", "-nostdinc++"] if program.language == "c++" else ["-x", "c"]
    return run([compiler, *HOST_COMPILER[1:], *language, *flags, *program.flags, program.source, "-o", binary])


def expected(program, directory):
    """Returns (the program's output on the host, processor time in seconds)."""
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


def obtain(seed, cache, directory):
    """Puts the seed's program into a directory; returns (program, what it prints, processor time on the host). Programs
    and output are kept in the directory `cache`, since they take as long as compiling for the TP."""
    settings = hashlib.sha256(repr((PROFILES, CSMITH_SECONDS, HOST_SECONDS, HOST_COMPILER)).encode()).hexdigest()[:8]
    kept = cache / f"{settings}-{seed}.json"
    if not kept.exists():
        known = {}
        try:
            program = generate(seed, directory)
            output, known["seconds"] = expected(program, directory)
            known["output"] = output.decode()
            known["source"] = program.source.read_text()
        except Skip as skip:
            known["skip"] = str(skip)
        fresh = directory / "known.json"
        fresh.write_text(json.dumps(known))
        fresh.replace(kept)
    known = json.loads(kept.read_text())
    if "skip" in known:
        raise Skip(known["skip"])
    program = describe(seed, directory)
    program.source.write_text(known["source"])
    return program, known["output"].encode(), known["seconds"]


def undefined_behaviour(program, directory):
    """Whether a sanitizer of the host finds undefined behaviour in the program: gcc's or clang's, which look for
    different things."""
    traps = {"gcc": ["-fsanitize-undefined-trap-on-error"], "clang-19": ["-fsanitize-trap=undefined"]}
    for compiler, trap in traps.items():
        binary = directory / f"host-{compiler}"
        built = host_compile(program, binary, ["-O1", "-fno-wrapv", "-fsanitize=undefined", *trap], compiler)
        if built.status == 0 and run([binary]).status in (-signal.SIGILL, -signal.SIGTRAP):
            return True
    return False
