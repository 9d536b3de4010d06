#!/usr/bin/env python3
"""all_builtins.py HEADERS CLANG... FOLDER: the compiler ends without a crash for each of clang's builtins, with every
kind of argument that it takes.

The builtins are those of clang's own list; of the calls of those that take several, every sixth, at one level by
turns; with TRAX_LEVELS=all in the environment all, at every level. A call that the front end refuses, with an error
at its place, is left out; what the code generator is then given must end with status 0, or with errors and status 1.
Calls that crash it are printed."""

import concurrent.futures
import itertools
import os
import re
import subprocess
import sys

LIST = "clang/Basic/Builtins.inc"
TYPES = {"v": "void", "b": "_Bool", "c": "char", "s": "short", "i": "int", "h": "__fp16", "x": "_Float16",
         "y": "__bf16", "f": "float", "d": "double",
         "z": "unsigned", "w": "int", "Y": "int", "p": "int"}
PARAMETERS = {"float": "f", "double": "d", "int": "i", "long long": "ll", "char": "c", "_Bool": "b", "void": "p",
              "_Complex float": "cf",
              "_Complex double": "cd", "fvector": "vf", "ivector": "vi"}
# For builtins that check their own arguments.
SHAPES = ["", "f", "d", "i", "ll", "c", "vf", "vi", "fp", "dp", "ip", "f, f", "d, d", "i, i", "ll, ll", "vf, vf",
          "vi, vi", "f, i", "d, i", "f, f, f", "d, d, d", "vf, vf, vf", "i, i, &i", "ll, ll, &ll", "ip, i", "llp, ll",
          "ip, 0", "ip, ip", "ip, ip, 5", "llp, llp, 5", "ip, i, 5", "llp, ll, 5", "fp, f, 5", "ip, i, 5, 1",
          "llp, ll, 5, 1", "ip, ip, ip, 5", "ip, ip, i, 0, 5, 5", "llp, llp, ll, 0, 5, 5", "ip, ip, ip, 0, 5, 5",
          "(_Atomic int *)ip", "(_Atomic int *)ip, 5", "(_Atomic int *)ip, i, 5", "(_Atomic long long *)llp, ll, 5",
          "(_Atomic float *)fp, f, 5", "(_Atomic int *)ip, ip, i, 5, 5", "ip, i, i", "llp, ll, ll", "f, 3", "d, 3",
          "f, 0x207", "d, 0x207", "0, 1, 2, 3, 4, f", "0, 1, 2, 3, 4, d", "vi, vi, 0, 1, 2, 3", "vf, vf, 0, 5, 2, 7",
          "vi, fvector", "vf, ivector", "1, i, f", "int, int", "i, 1", "ip, 1, 4", "(char *)ip, 1, 4",
          "ip, 4", "4", "0", "i, i, i, &i", "&i, 4, 5"]
HEADER = """typedef float fvector __attribute__((vector_size(16)));
typedef int ivector __attribute__((vector_size(16)));
extern void sink(const volatile void *);
"""


def argument(text):
    """The first type of a signature as an argument, and the rest; None if it is of no type here."""
    match = re.match(r"([ILUSZWNO]*)(X?)([ILUS]*)([a-zY.])([*&CDR0-9]*)", text)
    if not match or match[4] not in TYPES or match[2] and match[4] not in "fd":
        return None, ""
    modifiers, base, suffix = match[1] + match[3], TYPES[match[4]], match[5]
    name = ("unsigned " if "U" in modifiers else "") + ("long " *
                                                        (2 if "W" in modifiers else modifiers.count("L"))) + base
    name = "long double" if "L" in modifiers and base == "double" else "_Complex " + base if match[2] else name
    if "*" in suffix:
        value = f"({name} {'*' * suffix.count('*')})p"
    elif base == "void":
        value = None
    elif "I" in modifiers:
        value = "1"
    else:
        halves = ("__fp16", "_Float16", "__bf16")
        letter = "cf" if match[2] else "d" if base in ("float", "double") else "f" if base in halves else "ll"
        value = f"({name}){letter}"
    return value, text[match.end():]


def signature(text):
    values = []
    rest = argument(text)[1]
    while rest and rest != ".":
        value, rest = argument(rest)
        if value is None:
            return None
        values.append(value)
    return ", ".join(values)


def calls(path, form):
    with open(path, encoding="utf-8") as file:
        for name, types, attributes in re.findall(r'^[A-Z_]*BUILTIN\((__\w+), "([^"]*)", "([^"]*)"', file.read(),
                                                  re.MULTILINE):
            own = signature(types)
            for values in dict.fromkeys(SHAPES if "t" in attributes or "." in types or own is None else [own]):
                yield form.format(f"{name}({values})")


def chosen(lines, step):
    """Every step-th of the calls of a builtin, beginning with another one for each."""
    for number, (_, group) in enumerate(itertools.groupby(lines, builtin)):
        group = list(group)
        yield from group if len(group) == 1 else group[number % step::step]


def program(lines):
    parameters = ", ".join(f"{kind} {'*' if name == 'p' else ''}{name}" for kind, name in PARAMETERS.items())
    text = [HEADER]
    for number, line in lines.items():
        text.append(
            f"#line {number} \"call\"\nvoid f{number}({parameters}, float *fp, double *dp, int *ip, long long *llp) {{ "
            f"{line} }}\n"
        )
    return "".join(text)


def builtin(line):
    return re.search(r"__(?!auto_type)\w+\(", line)[0]


class Compiler:
    def __init__(self, clang, folder, options):
        self.command = [*clang, "-w", "-ferror-limit=0", "-fno-crash-diagnostics", "-fno-color-diagnostics",
                        "-fno-caret-diagnostics",
                        *options]
        self.folder = folder

    def run(self, lines, name, *options):
        path = os.path.join(self.folder, name + ".c")
        with open(path, "w", encoding="utf-8") as file:
            file.write(program(lines))
        done = subprocess.run([*self.command, *options, path], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              check=False)
        return done.returncode, done.stderr.decode(errors="replace")

    def accepted(self, lines, name, *options, whole=False):
        """Without the lines that have errors, or all calls of their builtins, until there are none. The code generator
        stops at the first error, and has then taken the lines before it."""
        rest = lines
        while True:
            status, words = self.run(rest, name, *options)
            wrong = {int(number) for number in re.findall(r"^call:(\d+):\d+: (?:fatal )?error: ", words,
                                                          re.MULTILINE)} & rest.keys()
            if status != 1 or not wrong:
                return lines
            names = {builtin(rest[number]) for number in wrong} if whole else ()
            lines = {number: line for number,
                     line in lines.items() if number not in wrong and not any(name in line for name in names)}
            rest = {number: line for number, line in lines.items() if number > max(wrong)} if whole else lines

    def crashes(self, lines, name, *options):
        """The lines that end the compiler otherwise than an error at a place does, with its words."""
        found = []
        while True:
            status, words = self.run(lines, name, *options)
            wrong = {int(number) for number in re.findall(r"^call:(\d+):\d+: error: ", words,
                                                          re.MULTILINE)} & lines.keys()
            if status != 1 or not wrong:
                wrong = {int(number) for number in re.findall(r"on function '@f(\d+)'", words)[:1]} & lines.keys()
                found += [(lines[number], words) for number in wrong]
            if status == 0 or not wrong:
                return found + ([("?", words)] if status else [])
            lines = {number: line for number, line in lines.items() if number not in wrong}


def main():
    headers, clang, folder = sys.argv[1], sys.argv[2:-1], sys.argv[-1]
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(headers, LIST)
    levels = {"O0": ["-O0"], "strict": ["-O1", "-ffp-model=strict", "-Xclang", "-fexperimental-strict-floating-point"]}
    whole = os.environ.get("TRAX_LEVELS") == "all"
    if whole:
        levels |= {"O2": ["-O2"], "global": ["-O1", "-mstack=global"]}
    step = 1 if whole else 6
    # Those without a result are those of which no call has one.
    every = dict(enumerate(chosen(calls(path, "__auto_type r = {}; sink(&r);"), step), 1))
    lines = Compiler(clang, folder, []).accepted(every, "syntax", "-fsyntax-only")
    known = {builtin(line) for line in lines.values()}
    others = dict(enumerate((line for line in chosen(calls(path, "{};"), step) if builtin(line) not in known),
                            len(every) + 1))
    lines |= Compiler(clang, folder, []).accepted(others, "syntax", "-fsyntax-only")
    lines = Compiler(clang, folder, []).accepted(lines, "code", "-S", "-emit-llvm", "-o", os.devnull, whole=True)
    if len(lines) < 1000 / step:
        sys.exit(f"{path}: only {len(lines)} calls of {len(every)} are calls")
    failed = False
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        parts = [lines if whole else dict(list(lines.items())[turn::len(levels)]) for turn in range(len(levels))]
        jobs = {name: pool.submit(Compiler(clang, folder, options).crashes, part, name, "-c", "-o",
                                  os.path.join(folder, name + ".o"))
                for part, (name, options) in zip(parts, levels.items())}
        for name, job in jobs.items():
            for line, words in job.result():
                failed = True
                print(f"{name}: {line}\n{words}", file=sys.stderr)
    print(f"{len(lines)} calls, {len(levels) if whole else 1} times")
    return failed


if __name__ == "__main__":
    sys.exit(main())
