"""The comments by which a program of gcc's test suite says how it wants to be compiled, and for which machines it is
meant.

Understood are dg-do, dg-options, dg-additional-options, dg-skip-if, dg-require-* and dg-error, with target selectors
(gcc's internals manual, "Directives" and "Selectors"). What a target is and has is answered for trax.
"""

import fnmatch
import re
from dataclasses import dataclass, field

TRIPLET = "trax-unknown-elf"

# Requirements of programs that a bare machine with this ABI does not meet. Everything else they ask for is taken as
# present, so that a program is tried rather than skipped.
LACKING = {
    "dfp": "decimal floating point",
    "fgraphite": "an option of gcc's own optimizer",
    "fileio": "files",
    "fopenmp": "OpenMP",
    "fpic": "position-independent code: addresses are absolute",
    "int128": "no __int128 on a 32-bit machine",
    "mmap": "mmap",
    "pthread": "POSIX threads",
    "signal": "signals",
}
# Names that a selector may use and that are not true here.
UNTRUE = set(LACKING) | {
    "avr_tiny", "freestanding", "hard_float", "ia32", "keeps_null_pointer_checks", "llp64", "lp64", "lra",
    "newlib_nano_io", "pie",
    "short_enums", "vxworks_kernel"}


class Malformed(Exception):
    """A directive that this reader does not understand."""


def words(text):
    """Split a Tcl list into its words; a braced word keeps its inside as one string."""
    result, position = [], 0
    while position < len(text):
        char = text[position]
        if char.isspace():
            position += 1
        elif char == "{":
            depth, end = 1, position + 1
            while end < len(text) and depth:
                depth += {"{": 1, "}": -1}.get(text[end], 0)
                end += 1
            if depth:
                raise Malformed(f"unbalanced braces: {text}")
            result.append(text[position + 1:end - 1])
            position = end
        elif char == '"':
            end = position + 1
            while end < len(text) and text[end] != '"':
                end += 2 if text[end] == "\\" else 1
            if end >= len(text):
                raise Malformed(f"unbalanced quotes: {text}")
            result.append(text[position + 1:end])
            position = end + 1
        else:
            end = position
            while end < len(text) and not text[end].isspace():
                end += 1
            result.append(text[position:end])
            position = end
    return result


def selected(selector):
    """Is trax among the targets that a selector names? It is a list of triplet patterns and names, or an expression of
    !, && and ||."""
    parts = words(selector)
    if "||" in parts or "&&" in parts:
        operator = "||" if "||" in parts else "&&"
        sides, side = [], []
        for part in parts:
            if part == operator:
                sides.append(side)
                side = []
            else:
                side.append(part)
        sides.append(side)
        values = [selected(" ".join("{" + part + "}" for part in side)) for side in sides]
        return any(values) if operator == "||" else all(values)
    if parts and parts[0] == "!":
        return not selected(" ".join("{" + part + "}" for part in parts[1:]))
    if len(parts) == 1 and " " in parts[0].strip():
        return selected(parts[0])
    return any(is_target(part) for part in parts)


def is_target(name):
    return fnmatch.fnmatchcase(TRIPLET, name) if "-" in name else name not in UNTRUE


@dataclass
class Directives:
    """What a program's comments ask for."""

    action: str = ""  # of dg-do: run, link, assemble, compile or preprocess; "" where it says nothing
    options: list = field(default_factory=list)
    unsupported: str = ""  # why gcc's own driver would not try it on this machine, or ""
    errors: bool = False  # the compiler has to refuse it


def read(text, given):
    """Read the directives of a program's text for compiling it with the options given."""
    result = Directives()
    for match in re.finditer(r"\{\s*(dg-[a-z-]+)((?:[^{}]|\{(?:[^{}]|\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\})*\})*)\}",
                             text):
        arguments = words(match.group(2))
        targets = [words(argument) for argument in arguments if argument.split()[:1] == ["target"]]
        applies = not targets or selected(" ".join("{" + part + "}" for part in targets[0][1:]))
        name = match.group(1)
        if name == "dg-do":
            if applies:
                result.action = arguments[0]
            else:
                result.unsupported = "for another machine"
        elif name in ("dg-options", "dg-additional-options") and applies:
            result.options += [option for word in words(arguments[0]) for option in word.split()]
        elif name == "dg-require-effective-target" and arguments[0] in LACKING and applies:
            result.unsupported = LACKING[arguments[0]]
        elif name == "dg-require-dll":
            result.unsupported = "shared libraries"
        elif name == "dg-require-profiling":
            result.unsupported = "profiling writes files"
        elif name == "dg-skip-if" and selected(arguments[1]) and skips(arguments[2:], ["-w", *given, *result.options]):
            result.unsupported = arguments[0] or "for another machine"
        elif name == "dg-error" and applies:
            result.errors = True
    return result


def skips(patterns, options):
    """The two further lists of dg-skip-if: some option of the first must be given, none of the second."""
    included = words(patterns[0]) if patterns else ["*"]
    excluded = words(patterns[1]) if len(patterns) > 1 else []

    def given(pattern):
        return pattern == "*" or any(fnmatch.fnmatchcase(option, pattern) for option in options)

    return any(given(pattern) for pattern in included) and not any(given(pattern) for pattern in excluded if pattern)
