#!/usr/bin/env python3
"""The compiler's constant folding must give the TP's results.

    tests/isa/oracle/folding.py                  corner values, and 60 numbered pairs
    tests/isa/oracle/folding.py --pairs 5000
    tests/isa/oracle/folding.py --every 3        every third pair of corner values

Each case is an operation on constants, compiled where each of the compiler's folders meets it:

    front end        the initialiser of a C++ object at -O0
    optimiser        a constructor at -O2, which stores the result into an object
    code generator   a function of LLVM IR, compiled at -O2 without the optimiser, whose result a program prints on the
                     TP

The first two results are read out of the object's data; a case that is not folded there is counted. All results must be
the oracle's. Two things are the language's, and are counted: a NaN may have either sign and an operand's payload
(LLVM's language reference, "Floating-Point NaN values"), and a conversion to an integer out of range may give anything
in C. Exit status: 0 if there is no other difference, else 1.
"""

import argparse
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "fuzz"))
import elf  # noqa: E402
from elf_files import EXECINSTR  # noqa: E402

QUIET, INFINITY = 0x7FC00000, 0x7F800000
PIECE = 30000  # cases in a file: each is a section, and there can be 65,000

# name: (operands, C, LLVM IR, result is a float; the oracle's operation, whether its operands are exchanged, whether it
# is negated)
OPERATIONS = {
    "fadd": (2, "a + b", "fadd float %a, %b", True, "fadd", False, False),
    "fsub": (2, "a - b", "fsub float %a, %b", True, "fsub", False, False),
    "fmul": (2, "a * b", "fmul float %a, %b", True, "fmul", False, False),
    "fdiv": (2, "a / b", "fdiv float %a, %b", True, "fdiv", False, False),
    "fminf": (2, "__builtin_fminf(a, b)", "call float @llvm.minnum.f32(float %a, float %b)", True, "fmin", False,
              False),
    "fmaxf": (2, "__builtin_fmaxf(a, b)", "call float @llvm.maxnum.f32(float %a, float %b)", True, "fmax", False,
              False),
    "==": (2, "a == b", "fcmp oeq float %a, %b", False, "feq", False, False),
    "!=": (2, "a != b", "fcmp une float %a, %b", False, "feq", False, True),
    "<": (2, "a < b", "fcmp olt float %a, %b", False, "flt", False, False),
    "<=": (2, "a <= b", "fcmp ole float %a, %b", False, "fle", False, False),
    ">": (2, "a > b", "fcmp ogt float %a, %b", False, "flt", True, False),
    ">=": (2, "a >= b", "fcmp oge float %a, %b", False, "fle", True, False),
    "!(<)": (2, "!(a < b)", "fcmp uge float %a, %b", False, "flt", False, True),
    "!(>=)": (2, "!(a >= b)", "fcmp ult float %a, %b", False, "fle", True, True),
    "rsqrt": (1, "__builtin_trax_rsqrt(a)", "call float @__builtin_trax_rsqrt(float %a)", True, "frsqrt", False, False),
    "sqrtf": (1, "__builtin_sqrtf(a)", "call float @llvm.sqrt.f32(float %a)", True, "sqrtf", False, False),
    "(int)": (1, "(int)a", "fptosi float %a to i32", False, "fcvt.w.s", False, False),
    "(unsigned)": (1, "(unsigned)a", "fptoui float %a to i32", False, "fcvt.wu.s", False, False),
    "fptosi.sat": (1, None, "call i32 @llvm.fptosi.sat.i32.f32(float %a)", False, "fcvt.w.s", False, False),
    "fptoui.sat": (1, None, "call i32 @llvm.fptoui.sat.i32.f32(float %a)", False, "fcvt.wu.s", False, False),
    "(float)int": (1, "(float)(int)x", "sitofp i32 %x to float", True, "fcvt.s.w", False, False),
    "(float)unsigned": (1, "(float)x", "uitofp i32 %x to float", True, "fcvt.s.wu", False, False),
}
MAGNITUDES = [0, 1, 3, 0x007FFFFF, 0x00800000, 0x00800001, 0x33800000, 0x33800001, 0x3EAAAAAB, 0x3F000000, 0x3F7FFFFF,
              0x3F800000, 0x3F800001,
              0x40400000, 0x4B000001, 0x4EFFFFFF, 0x4F000000, 0x4F7FFFFF, 0x4F800000, 0x5F800000, 0x73000000,
              0x7F000000, 0x7F7FFFFF, INFINITY,
              0x7F800001, 0x7FA00000, QUIET, 0x7FC01234]
MORE_OF_ONE = [2, 5, 0x1FB504F3, 0x3DCCCCCD, 0x3F800002, 0x3FC00000, 0x3FFFFFFF, 0x40000000, 0x40800000, 0x41200000,
               0x4B7FFFFF, 0x4B800001,
               0x7FFFFFFF, 0x00FFFFFF, 0x01000001, 0x01000003, 0x02000003, 0x7FFFFF80, 0x7FFFFFBF, 0x7FFFFFC0,
               0x55555555]


def is_nan(bits):
    return bits & 0x7FFFFFFF > INFINITY


class Case:
    def __init__(self, number, name, a, b):
        self.number, self.name, self.a, self.b = number, name, a, b
        self.operands, self.c, self.ir, self.is_float, self.asks, self.exchanged, self.negated = OPERATIONS[name]
        self.expected = None

    def question(self):
        words = [self.a] if self.operands == 1 else [self.b, self.a] if self.exchanged else [self.a, self.b]
        return " ".join([self.asks] + [f"{word:08x}" for word in words])

    def out_of_range(self):
        """A conversion to an integer whose value C leaves open."""
        if self.name not in ("(int)", "(unsigned)"):
            return False
        if is_nan(self.a):
            return True
        value = struct.unpack("<f", struct.pack("<I", self.a))[0]
        return not (-2.0**31 <= value < 2.0**31 if self.name == "(int)" else -1 < value < 2.0**32)

    def nan_allowed(self, result):
        """LLVM's rules for a NaN: either sign, and the payload of the canonical one or of an operand, made quiet or
        not."""
        if not self.is_float or not is_nan(self.expected) or not is_nan(result):
            return False
        operands = [word & 0x7FFFFFFF for word in ([self.a,
                                                    self.b] if self.operands == 2 else [self.a]) if is_nan(word)]
        return result & 0x7FFFFFFF in [QUIET, *operands, *(word | QUIET for word in operands)]

    def __str__(self):
        return f"{self.name} of {self.a:08x}" + (f" {self.b:08x}" if self.operands == 2 else "")


def all_cases(oracle_sweep, pairs, every, chosen):
    values = [magnitude | sign for magnitude in MAGNITUDES for sign in (0, 0x80000000)]
    two = [(a, b) for a in values for b in values][::every]
    lines = subprocess.run([oracle_sweep, "24", "0", str(pairs), "1"], capture_output=True, text=True,
                           check=True).stdout.splitlines()
    two += [tuple(int(word, 16) for word in line.split()[-2:]) for line in lines if line.startswith("fadd ")]
    one = values + [word | sign for word in MORE_OF_ONE for sign in (0, 0x80000000)] + [a for a, _ in two[-pairs:]]
    cases = []
    for name, operation in OPERATIONS.items():
        if chosen not in (None, name):
            continue
        for a, b in two if operation[0] == 2 else [(a, 0) for a in one]:
            cases.append(Case(len(cases), name, a, b))
    return cases


def ask(oracle, cases):
    text = "".join(case.question() + "\n" for case in cases)
    answers = subprocess.run([oracle], input=text, capture_output=True, text=True, check=True).stdout.split()
    for case, answer in zip(cases, answers, strict=True):
        case.expected = int(answer, 16) ^ case.negated


def run(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(
            f"folding.py: {' '.join(str(word) for word in command)} ended with status {done.returncode}\n"
            f"{done.stderr[:2000]}"
        )
    return done.stdout


def objects(path, cases):
    """{case number: value, or None if code computes it}, of objects c0, c1, ... with sections of their own."""
    sections = elf.read(path)
    left = set()
    for flags, _, _, relocations in sections.values():
        if flags & EXECINSTR:
            left |= {int(found[1]) for _, _, symbol,
                     _ in relocations if (found := re.search(r"(?:^|\.)c(\d+)(?:\+0)?$", symbol))}
    values = {}
    for case in cases:
        found = [sections[name] for kind in (".data", ".rodata",
                                             ".bss") if (name := f"{kind}.c{case.number}") in sections]
        if len(found) != 1:
            sys.exit(f"folding.py: {path} has no object c{case.number}")
        content = found[0][2]  # bytes, or the size of zeros
        values[case.number] = None if case.number in left else 0 if isinstance(content, int) else struct.unpack(
            "<I", content)[0]
    return values


class Compiler:
    def __init__(self, build, folder, flags):
        self.clang, self.sim, self.folder, self.flags = build / "bin/clang", build / "bin/trax-sim", folder, flags

    def compile(self, name, text, flags):
        source, built = self.folder / name, self.folder / (name + ".o")
        source.write_text(text)
        run([self.clang, "--target=trax", "-w", "-c", source, "-o", built, *flags, *self.flags])
        return built

    def front_end(self, cases):
        lines = ["#define F(x) __builtin_bit_cast(float, x)", "#define BITS(x) __builtin_bit_cast(unsigned, x)"]
        for case in cases:
            text = case.c
            for letter, word in (("a", case.a), ("b", case.b)):
                text = re.sub(rf"\b{letter}\b", f"F({word:#x}u)", text)
            text = re.sub(r"\bx\b", f"{case.a:#x}u", text)
            lines.append(f'extern "C" {{ extern unsigned c{case.number}; unsigned c{case.number} = '
                         f"{f'BITS({text})' if case.is_float else f'(unsigned)({text})'}; }}")
        return objects(self.compile("front.cpp", "\n".join(lines) + "\n", ["-O0", "-std=c++20"]), cases)

    def optimiser(self, cases):
        lines = ["static inline float F(unsigned u) { float f; __builtin_memcpy(&f, &u, 4); return f; }",
                 "static inline unsigned BITS(float f) { unsigned u; __builtin_memcpy(&u, &f, 4); return u; }"]
        for case in cases:
            n = case.number
            lines.append(
                f"unsigned c{n};\n__attribute__((constructor)) static void f{n}(void) {{\n  unsigned x = "
                f"{case.a:#x}u;\n"
                f"  float a = F(x), b = F({case.b:#x}u);\n  c{n} = "
                f"{f'BITS({case.c})' if case.is_float else f'(unsigned)({case.c})'};\n}}"
            )
        return objects(self.compile("optimiser.c", "\n".join(lines) + "\n", ["-O2", "-std=gnu17"]), cases)

    def code_generator(self, cases):
        lines = []
        for case in cases:
            parts = [f"define i32 @f{case.number}() section \".text.f{case.number}\" {{"]
            text = case.ir.replace("%a",
                                   f"bitcast (i32 {case.a} to float)").replace("%b", f"bitcast (i32 {case.b} to float)")
            text = text.replace("%x", str(case.a))
            parts.append(f"  %r = {text}")
            kind = "zext i1 %r to i32" if "fcmp" in case.ir else "add i32 %r, 0"
            kind = "bitcast float %r to i32" if case.is_float else kind
            lines += parts + [f"  %i = {kind}", "  ret i32 %i", "}"]
        table = ", ".join(f"ptr @f{case.number}" for case in cases)
        lines.append(f"@table = constant [{len(cases)} x ptr] [{table}]\n@count = constant i32 {len(cases)}")
        lines += [f"declare {declaration}" for declaration in (
            "float @llvm.minnum.f32(float, float)", "float @llvm.maxnum.f32(float, float)",
            "float @__builtin_trax_rsqrt(float)",
            "float @llvm.sqrt.f32(float)", "i32 @llvm.fptosi.sat.i32.f32(float)",
            "i32 @llvm.fptoui.sat.i32.f32(float)")]
        flags = ["-O2", "-Xclang", "-disable-llvm-passes"]
        built = self.compile("generator.ll", "\n".join(lines) + "\n", flags)
        driver = self.compile(
            "driver.c", "#include <stdio.h>\nextern unsigned (*const table[])(void);\nextern const unsigned count;\n"
            'int main(void) {\n  for (unsigned i = 0; i < count; i++)\n    printf("%08x\\n", table[i]());\n}\n',
            ["-O2"])
        image = self.folder / "generator.elf"
        run([self.clang, "--target=trax", built, driver, "-o", image])
        printed = run([self.sim, "--engine", "functional", "--quiet", image]).split()
        return {case.number: int(word, 16) for case, word in zip(cases, printed, strict=True)}


def compare(folder, cases, fold):
    """Returns the number of differences. `fold` takes cases and returns their values, None for those not folded."""
    values = {}
    for first in range(0, len(cases), PIECE):
        values.update(fold(cases[first:first + PIECE]))
    left = nans = open_ = same = 0
    wrong = []
    for case in cases:
        value = values[case.number]
        if value is None:
            left += 1
        elif value == case.expected:
            same += 1
        elif case.out_of_range():
            open_ += 1
        elif case.nan_allowed(value):
            nans += 1
        else:
            wrong.append(f"  {case}: {folder} {value:08x}, the oracle {case.expected:08x}")
    print(
        f"{folder}: {len(cases)} cases, {same} with the oracle's bits, {nans} with another NaN, {open_} out of range, "
        f"{left} not folded, "
        f"{len(wrong)} differ", flush=True)
    for line in wrong[:20]:
        print(line)
    return len(wrong)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=HERE / "../../../build", help="the build folder")
    parser.add_argument("--pairs", type=int, default=60, help="numbered pairs besides the corner values (default: 60)")
    parser.add_argument("--every", type=int, default=1,
                        help="of the pairs of corner values every so many (default: all)")
    parser.add_argument("--operation", choices=list(OPERATIONS), help="one operation only")
    parser.add_argument("--flags", default="", help="more flags for the compiler: to see that differences are found")
    options = parser.parse_args()
    build = options.build.resolve()
    cases = all_cases(build / "tests/bin/isa-oracle-sweep", options.pairs, options.every, options.operation)
    ask(build / "tests/bin/isa-oracle", cases)
    in_c = [case for case in cases if case.c]
    with tempfile.TemporaryDirectory() as folder:
        compiler = Compiler(build, pathlib.Path(folder), options.flags.split())
        wrong = compare("front end", in_c, compiler.front_end)
        wrong += compare("optimiser", in_c, compiler.optimiser)
        wrong += compare("code generator", cases, compiler.code_generator)
    return wrong != 0


if __name__ == "__main__":
    sys.exit(main())
