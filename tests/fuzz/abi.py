#!/usr/bin/env python3
"""Random calls: the caller compiled at one level, the callee at another, must agree on every argument and result.

    tests/fuzz/abi.py --seeds 1-200

A program is three files. The callee checks each argument member by member, spoils its copies and returns a value; the
caller checks the value, that its own objects are unchanged and that its registers are; between them are functions that
pass their arguments on, as tail calls where the compiler can. Arguments are scalars of all types, complex numbers,
structs and unions by value (nested, with arrays, bit-fields, packed, over-aligned, empty), named and variadic, and
functions to call back. The host runs each program too: that proves the test, not the ABI. Exit status: 0 if all agree,
1 otherwise.
"""

import random
import sys

import runner
from toolchain import Failure

LEVELS = ["-O0", "-O1", "-O2", "-O3", "-Os", "-Oz"]
FUNCTIONS = 12  # in a program

PROLOGUE = """\
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
static inline void check(int holds, const char *file, int line) {
  if (!holds) {
    printf("%s:%d\\n", file, line);
    exit(1);
  }
}
#define CHECK(x) check(!!(x), __FILE_NAME__, __LINE__)
"""


def integer(rng, bits, signed):
    value = rng.choice([0, 1, (1 << bits) - 1, 1 << (bits - 1), rng.getrandbits(bits), rng.getrandbits(bits),
                        rng.getrandbits(max(1, bits // 2))])
    if signed and value >> (bits - 1):
        value -= 1 << bits
    if value == -(1 << 63):
        return "(-0x7fffffffffffffffLL - 1)"
    return f"{value}{'ll' if signed else 'ull'}" if bits > 31 else str(value)


def floating(rng, double):
    digits, exponent = (52, 1000) if double else (23, 120)
    fraction = rng.getrandbits(digits) << (0 if double else 1)
    text = f"0x1.{fraction:0{13 if double else 6}x}p{rng.randint(-exponent, exponent)}"
    return rng.choice(["", "-"]) + text + ("" if double else "f")


class Scalar:
    def __init__(self, name, literal, promoted=None):
        self.name, self.literal, self.promoted = name, literal, promoted or name

    def declare(self, name):
        return f"{self.name} {name}"

    def value(self, rng):
        return self.literal(rng)

    def initial(self, value):
        return value

    def checks(self, path, value):
        yield f"{path} == ({self.name}){value}" if self.name != "_Bool" else f"{path} == {value}"


class Complex(Scalar):
    def __init__(self, name, double):
        super().__init__(name, None)
        self.double = double

    def value(self, rng):
        return floating(rng, self.double), floating(rng, self.double)

    def initial(self, value):
        return f"__builtin_complex({value[0]}, {value[1]})"

    def checks(self, path, value):
        yield f"__real__ {path} == {value[0]} && __imag__ {path} == {value[1]}"


class Array:
    def __init__(self, element, length):
        self.element, self.length = element, length

    def declare(self, name):
        return f"{self.element.name} {name}[{self.length}]"

    def value(self, rng):
        return [self.element.value(rng) for _ in range(self.length)]

    def initial(self, value):
        return "{" + ", ".join(map(self.element.initial, value)) + "}"

    def checks(self, path, value):
        for i, item in enumerate(value):
            yield from self.element.checks(f"{path}[{i}]", item)


class BitField(Scalar):
    def __init__(self, name, bits, signed):
        super().__init__(name, lambda rng: integer(rng, bits, signed))
        self.bits = bits

    def declare(self, name):
        return f"{self.name} {name} : {self.bits}"


class Aggregate:
    """A struct, or a union whose first member counts."""

    def __init__(self, kind, name, fields, attribute):
        self.name, self.promoted = f"{kind} {name}", f"{kind} {name}"
        self.fields = fields
        members = "".join(f"  {field.declare(f'm{i}')};\n" for i, field in enumerate(fields))
        self.definition = f"{kind} {name} {{\n{members}}}{attribute};\n"
        self.counted = fields[:1] if kind == "union" else fields

    def declare(self, name):
        return f"{self.name} {name}"

    def value(self, rng):
        return [field.value(rng) for field in self.counted]

    def initial(self, value):
        return "{" + ", ".join(field.initial(item) for field, item in zip(self.counted, value)) + "}"

    def checks(self, path, value):
        for i, (field, item) in enumerate(zip(self.counted, value)):
            yield from field.checks(f"{path}.m{i}", item)


def scalars():
    types = [Scalar("_Bool", lambda rng: rng.choice("01"), "int"),
             Scalar("float", lambda rng: floating(rng, False), "double"),
             Scalar("double", lambda rng: floating(rng, True)),
             Scalar("void *", lambda rng: f"(void *){rng.getrandbits(31)}"),
             Scalar("enum colour", lambda rng: rng.choice(["RED", "BLUE"])),
             Complex("float _Complex", False), Complex("double _Complex", True)]
    for name, bits in (("char", 8), ("short", 16), ("int", 32), ("long", 32), ("long long", 64)):
        for sign in ("signed", "unsigned"):
            types.append(
                Scalar(f"{sign} {name}", lambda rng, bits=bits, sign=sign: integer(rng, bits, sign == "signed"),
                       "int" if bits < 32 else None))
    return types


def make_field(rng, types, aggregates):
    pick = rng.random()
    if pick < 0.15:
        bits = rng.choice([8, 16, 32, 32, 64])
        signed = rng.random() < 0.5
        name = {8: "char", 16: "short", 32: "int", 64: "long long"}[bits]
        width = rng.randint(2, bits)
        return BitField(f"{'signed' if signed else 'unsigned'} {name}", width, signed)
    if pick < 0.3 and aggregates:
        return rng.choice(aggregates)
    if pick < 0.45:
        return Array(rng.choice(types), rng.randint(1, 5))
    return rng.choice(types)


def make_aggregates(rng, types):
    aggregates = []
    for i in range(10):
        fields = [make_field(rng, types, aggregates) for _ in range(rng.choice([0, 1, 1, 2, 2, 3, 4, 5, 8]))]
        union = rng.random() < 0.2 and fields
        attribute = rng.choice(["", "", "", "", " __attribute__((packed))",
                                f" __attribute__((aligned({rng.choice([8, 16])})))"])
        aggregates.append(Aggregate("union" if union else "struct", f"{'u' if union else 's'}{i}", fields, attribute))
    return aggregates


class Function:
    """A function of a random type, with one call of it: its arguments and result."""

    def __init__(self, rng, number, types):
        self.name = f"function{number}"
        count = rng.choice([0, 1, 2, 3, 4, 5, 7, 10, 14])
        self.parameters = [rng.choice(types) for _ in range(count)]
        self.result = rng.choice([None, *types[: len(types)]])
        self.variadic = [rng.choice(types) for _ in range(rng.randint(1, 7))] if count and rng.random() < 0.35 else []
        self.values = [kind.value(rng) for kind in self.parameters + self.variadic]
        self.returned = self.result.value(rng) if self.result else None
        self.called_back = rng.random() < 0.3

    def result_name(self):
        return self.result.name if self.result else "void"

    def prototype(self, name, extra=()):
        parameters = [f"{kind.name} p{i}" for i, kind in enumerate(self.parameters)]
        if self.called_back:
            parameters.append(
                f"{self.result_name()} (*back)(int, {self.result_name() if self.result else 'int'}, double)")
        parameters = [*extra, *parameters] or ["void"]
        return f"{self.result_name()} {name}({', '.join(parameters)}{', ...' if self.variadic else ''})"

    def callee(self):
        lines = [self.prototype(self.name) + " {"]
        for i, kind in enumerate(self.parameters):
            lines += [f"  CHECK({text});" for text in kind.checks(f"p{i}", self.values[i])]
        if self.variadic:
            last = "back" if self.called_back else f"p{len(self.parameters) - 1}"
            lines += ["  va_list list, again;", f"  va_start(list, {last});", "  va_copy(again, list);"]
            for name in ("list", "again"):
                for i, kind in enumerate(self.variadic):
                    lines += ["  {", f"    {kind.promoted} v = va_arg({name}, {kind.promoted});", "    (void)&v;"]
                    lines += [
                        f"    CHECK({text});"
                        for text in kind.checks("v", self.values[len(self.parameters) + i])] + ["  }"]
            lines += ["  va_end(again);", "  va_end(list);"]
        for i, kind in enumerate(self.parameters):
            lines.append(f"  __builtin_memset(&p{i}, 0xa5, sizeof p{i});")
            lines.append(f'  __asm__ volatile("" : : "r"(&p{i}) : "memory");')
        if self.result:
            lines.append(f"  {self.result.name} result = {self.result.initial(self.returned)};")
        if self.called_back and self.result:
            lines.append("  return back(7, result, 0.5);")
        elif self.called_back:
            lines.append("  back(7, 3, 0.5);")
        elif self.result:
            lines.append("  return result;")
        return "\n".join(lines) + "\n}\n"

    def forwarder(self):
        """Passes on its arguments but for the first, which is its own."""
        arguments = [f"p{i}" for i in range(len(self.parameters))] + ["back"] * self.called_back
        extra = "long long first"
        return (f"{self.prototype(self.name + '_on', [extra])} {{\n  CHECK(first == 0x123456789abLL);\n"
                f"  {'return ' if self.result else ''}{self.name}({', '.join(arguments)});\n}}\n")

    def caller(self, rng):
        """Calls the function directly, by a pointer, and through the one that passes on."""
        lines = [f"static void call_{self.name}(void) {{"]
        kinds = self.parameters + self.variadic
        lines += [f"  {kind.name} a{i} = {kind.initial(self.values[i])};" for i, kind in enumerate(kinds)]
        arguments = [f"a{i}" for i in range(len(self.parameters))] + [f"back_{self.name}"] * self.called_back
        arguments += [f"a{i}" for i in range(len(self.parameters), len(kinds))]
        lines += [f"  int k{i} = live[{i}];" for i in range(10)]
        pointer = self.prototype("(*volatile pointer)") + f" = {self.name};"
        lines.append("  " + pointer)
        calls = [(self.name, arguments), ("pointer", arguments)]
        if not self.variadic:
            calls.append((self.name + "_on", ["0x123456789abLL", *arguments]))
        rng.shuffle(calls)
        for name, given in calls:
            call = f"{name}({', '.join(given)})"
            if self.result:
                lines += ["  {", f"    {self.result.name} r = {call};", "    (void)&r;"]
                lines += [f"    CHECK({text});" for text in self.result.checks("r", self.returned)] + ["  }"]
            else:
                lines.append(f"  {call};")
            lines += [f"  CHECK({text});" for i,
                      kind in enumerate(kinds) for text in kind.checks(f"a{i}", self.values[i])]
            lines.append("  CHECK(" + " && ".join(f"k{i} == {i * 1234567}" for i in range(10)) + ");")
        back = ""
        if self.called_back:
            kind = self.result_name() if self.result else "int"
            back = (f"static {self.result_name()} back_{self.name}(int one, {kind} two, double three) {{\n  CHECK(one "
                    f"== 7 && three == 0.5);\n")
            back += "  return two;\n}\n" if self.result else "  CHECK(two == 3);\n}\n"
        return back + "\n".join(lines) + "\n}\n"


def generate(rng):
    """The program's files: {name: text}."""
    types = scalars()
    aggregates = make_aggregates(rng, types)
    functions = [Function(rng, i, types + 2 * aggregates) for i in range(FUNCTIONS)]
    header = PROLOGUE + "enum colour { RED, BLUE = 70000 };\n" + "".join(kind.definition for kind in aggregates)
    header += "".join(function.prototype(function.name) + ";\n" for function in functions)
    plain = [function for function in functions if not function.variadic]
    header += "".join(function.prototype(function.name + "_on", ["long long first"]) + ";\n" for function in plain)
    include = '#include "calls.h"\n'
    live = "volatile int live[10] = {" + ", ".join(str(i * 1234567) for i in range(10)) + "};\n"
    main = "int main(void) {\n" + "".join(f"  call_{function.name}();\n"
                                          for function in functions) + '  puts("ok");\n  return 0;\n}\n'
    return {
        "calls.h": header,
        "callee.c": include + "".join(function.callee() for function in functions),
        "between.c": include + "".join(function.forwarder() for function in plain),
        "caller.c": include + live + "".join(function.caller(rng) for function in functions) + main,
    }


def check(target, seed, directory, options):
    rng = random.Random(f"abi {seed}")
    files = generate(rng)
    for name, text in files.items():
        (directory / name).write_text(text)
    sources = [name for name in files if name.endswith(".c")]
    if runner.host(sources, directory, ["-O1"]) != b"ok\n":
        raise Failure("the test itself is wrong: it fails on the host", f"gcc -m32 in {directory}")
    for _ in range(options.rounds):
        objects = []
        levels = [rng.choice(LEVELS) for _ in sources]
        for source, level in zip(sources, levels):
            objects.append(directory / f"{source}{level}.o")
            command = [level, "-std=gnu17", "-c", directory / source, "-o", objects[-1]]
            try:
                target.compile(command)
            except Failure as failure:
                if "-mstack=global has room" not in str(failure):
                    raise
                target.compile([*command, "-mstack=global"])
        image = directory / "program"
        target.link(objects, image)
        runner.expect(target, image, b"ok\n", " ".join(map("".join, zip(sources, levels))))


if __name__ == "__main__":
    sys.exit(runner.main("abi", __doc__.split("\n\n")[0], check, default="1-200"))
