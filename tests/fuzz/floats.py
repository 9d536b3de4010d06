#!/usr/bin/env python3
"""Random floating-point expressions: the compiler's folding and the TP's arithmetic must give the host's bits.

    tests/fuzz/floats.py --seeds 1-200

Every expression of a program is there twice: of constants, which the compiler may fold, and of volatile objects of the
same values, which it may not. Operands are binary32, binary64 and integers of 32 and 64 bits, special values among
them; operations are the arithmetic ones, square root, comparisons, conversions and those of C's functions that are
exact. The program prints the bits of both. Its whole output must equal the host's at -O0. Any NaN
prints as "nan". Exit status: 0 if all agree, 1 otherwise.
"""

import random
import sys

import runner

LEVELS = ["-O0", "-O1", "-O2", "-O3", "-Os"]
EXPRESSIONS = 60  # in a program

PROLOGUE = """\
#include <math.h>
#include <stdio.h>
#include <string.h>
static void show_f(int n, char how, float value) {
  unsigned bits;
  memcpy(&bits, &value, sizeof bits);
  if (value != value)
    printf("%d%c nan\\n", n, how);
  else
    printf("%d%c %08x\\n", n, how, bits);
}
static void show_d(int n, char how, double value) {
  unsigned long long bits;
  memcpy(&bits, &value, sizeof bits);
  if (value != value)
    printf("%d%c nan\\n", n, how);
  else
    printf("%d%c %016llx\\n", n, how, bits);
}
static void show_i(int n, char how, int value) { printf("%d%c %d\\n", n, how, value); }
static void show_u(int n, char how, unsigned value) { printf("%d%c %u\\n", n, how, value); }
static void show_l(int n, char how, long long value) { printf("%d%c %lld\\n", n, how, value); }
static void show_m(int n, char how, unsigned long long value) { printf("%d%c %llu\\n", n, how, value); }
/* Conversions to integers, of numbers in range. */
#define TO_I(x) ((x) > -2147483649.0 && (x) < 2147483648.0 ? (int)(x) : 77)
#define TO_U(x) ((x) > -1.0 && (x) < 4294967296.0 ? (unsigned)(x) : 78u)
#define TO_L(x) ((x) >= -9223372036854775808.0 && (x) < 9223372036854775808.0 ? (long long)(x) : 79ll)
#define TO_M(x) ((x) > -1.0 && (x) < 18446744073709551616.0 ? (unsigned long long)(x) : 80ull)
"""

TYPES = {"f": "float", "d": "double", "i": "int", "u": "unsigned", "l": "long long", "m": "unsigned long long"}
FORMATS = {"f": (8, 23), "d": (11, 52)}


def float_literal(rng, kind):
    """A literal of any class: zeros, subnormals, halfway cases, infinities, NaN."""
    exponent_bits, fraction_bits = FORMATS[kind]
    bias = (1 << (exponent_bits - 1)) - 1
    suffix, pick = ("f" if kind == "f" else ""), rng.random()
    sign = rng.choice(["", "-"])
    if pick < 0.06:
        return f"__builtin_{rng.choice(['inf', 'huge_val'])}{suffix}()" if sign else f"(-__builtin_inf{suffix}())"
    if pick < 0.09:
        return f'__builtin_nan{suffix}("")'
    if pick < 0.16:
        return f"({sign}0.0{suffix})"
    if pick < 0.3:
        whole = rng.choice([1, 2, 3, 5, 7, 10, 16777217, 2147483648, 4294967295, 9223372036854775808])
        return f"({sign}{whole}.0{suffix})"
    fraction = rng.choice([rng.getrandbits(fraction_bits), rng.getrandbits(4),
                           (1 << fraction_bits) - 1 - rng.getrandbits(3),
                           rng.getrandbits(8) << (fraction_bits - 8)])
    exponent = rng.choice([rng.randint(-4, 34), rng.randint(-40, 70), rng.randint(1 - bias, bias),
                           rng.randint(1 - bias - fraction_bits, 1 - bias)])
    if exponent < 1 - bias:  # subnormal
        fraction = (1 << fraction_bits | fraction) >> (1 - bias - exponent)
        return f"({sign}{fraction:#x}p{1 - bias - fraction_bits}{suffix})"
    return f"({sign}{1 << fraction_bits | fraction:#x}p{exponent - fraction_bits}{suffix})"


def integer_literal(rng, kind):
    bits = 32 if kind in "iu" else 64
    value = rng.choice([rng.getrandbits(bits), rng.getrandbits(bits), rng.getrandbits(8),
                        (1 << rng.randint(0, bits - 1)) - rng.getrandbits(1),
                        (1 << bits) - 1 - rng.getrandbits(6)])
    if kind in "il":
        value = value - (1 << bits) if value >> (bits - 1) else value
        return f"((int)0x{value & 0xffffffff:x}u)" if kind == "i" else f"((long long)0x{value & (1 << 64) - 1:x}ull)"
    return f"{value}{'u' if kind == 'u' else 'ull'}"


class Generator:
    """Expressions over operands that are numbered, so that an operand can be a constant or an object."""

    def __init__(self, rng):
        self.rng = rng
        self.operands = []  # (kind, literal)

    def leaf(self, kind):
        literal = float_literal(self.rng, kind) if kind in "fd" else integer_literal(self.rng, kind)
        self.operands.append((kind, literal))
        return f"@{len(self.operands) - 1}@"

    def real(self, kind, depth):
        """An expression of type float or double."""
        rng = self.rng
        if depth == 0 or rng.random() < 0.1:
            return self.leaf(kind)
        s = "f" if kind == "f" else ""
        pick = rng.random()
        if pick < 0.5:
            return f"({self.real(kind, depth - 1)} {rng.choice('+-*/')} {self.real(kind, depth - 1)})"
        if pick < 0.58:
            name = rng.choice(["fabs", "sqrt", "floor", "ceil", "trunc", "rint", "round"])
            return f"{name}{s}({self.real(kind, depth - 1)})"
        if pick < 0.62:
            return f"copysign{s}({self.real(kind, depth - 1)}, {self.real(kind, depth - 1)})"
        if pick < 0.66:  # adding 0 hides the sign of a zero, which fmin and fmax may choose
            return (f"({rng.choice(['fmin', 'fmax'])}{s}({self.real(kind, depth - 1)}, {self.real(kind, depth - 1)}) + "
                    f"0.0{s})")
        if pick < 0.69:
            return f"fma{s}({self.real(kind, depth - 1)}, {self.real(kind, depth - 1)}, {self.real(kind, depth - 1)})"
        if pick < 0.74:
            return f"(-{self.real(kind, depth - 1)})"
        if pick < 0.82:
            return f"(({self.condition(depth - 1)}) ? {self.real(kind, depth - 1)} : {self.real(kind, depth - 1)})"
        source = rng.choice("fdiulm")
        return f"(({TYPES[kind]}){self.any(source, depth - 1)})"

    def condition(self, depth):
        kind = self.rng.choice("fd")
        left, right = self.real(kind, depth), self.real(kind, depth)
        pick = self.rng.random()
        if pick < 0.2:
            negation = self.rng.choice(["!", ""])
            return f"{negation}{self.rng.choice(['isunordered', 'islessgreater', 'isless'])}({left}, {right})"
        return f"{left} {self.rng.choice(['<', '<=', '>', '>=', '==', '!='])} {right}"

    def any(self, kind, depth):
        if kind in "fd":
            return self.real(kind, depth)
        if depth == 0 or self.rng.random() < 0.3:
            return self.leaf(kind)
        # The macro names its argument three times, so the argument is small.
        return f"TO_{kind.upper()}({self.real(self.rng.choice('fd'), min(depth - 1, 1))})"


def generate(rng):
    functions, calls = [], []
    for number in range(EXPRESSIONS):
        maker = Generator(rng)
        kind = rng.choice("ffffddddiulm")
        text = maker.any(kind, rng.randint(1, 5))
        constant = volatile = text
        objects = []
        for i, (operand, literal) in enumerate(maker.operands):
            objects.append(f"  volatile {TYPES[operand]} v{i} = {literal};\n")
            constant = constant.replace(f"@{i}@", literal)
            volatile = volatile.replace(f"@{i}@", f"w{i}")
        copies = "".join(f"  {TYPES[operand]} w{i} = v{i};\n" for i, (operand, _) in enumerate(maker.operands))
        functions.append(f"static void expression{number}(void) {{\n{''.join(objects)}{copies}"
                         f"  show_{kind}({number}, 'c', {constant});\n  show_{kind}({number}, 'v', {volatile});\n}}\n")
        calls.append(f"  expression{number}();\n")
    return PROLOGUE + "".join(functions) + "int main(void) {\n" + "".join(calls) + "  return 0;\n}\n"


def check(target, seed, directory, options):
    source = directory / "floats.c"
    source.write_text(generate(random.Random(f"floats {seed}")))
    output = runner.host(["floats.c"], directory, ["-O0", "-fno-builtin"])
    for level in LEVELS[: options.rounds]:
        built, image = directory / f"floats{level}.o", directory / f"floats{level}"
        target.compile([level, "-std=gnu17", "-c", source, "-o", built])
        target.link([built], image)
        runner.expect(target, image, output, level)


if __name__ == "__main__":
    sys.exit(runner.main("floats", __doc__.split("\n\n")[0], check, default="1-200"))
