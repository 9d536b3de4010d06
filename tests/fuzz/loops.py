#!/usr/bin/env python3
"""Random nests of loops over arrays: what the compiler does to addresses, counters and loads must give the host's bits.

    tests/fuzz/loops.py --seeds 1-200

Loops count up and down, from and to constants, arguments and the counters around them. Subscripts are sums of counters.
Arrays are reached by name and by pointers that may point to the same one, whole and by bytes. Some loads stay the same
while their loop stores close by, and some loops end at what they store. The program prints a checksum of all arrays
after each function. Its whole output must equal the host's at -O0. Exit status: 0 if all agree, 1
otherwise.
"""

import random
import sys

import runner

LEVELS = ["-O2", "-O3"]
FUNCTIONS = 24  # in a program
FURTHER = 6     # of each other kind

PROLOGUE = """\
#include <stdio.h>
#define HIDDEN __attribute__((noinline)) static
static int a[20][20], b[20][20], v[20], w[400];
static unsigned char c[20][20];
static short h[20][20];
static unsigned sum;
static void mix(const void *memory, unsigned size) {
  const unsigned char *bytes = memory;
  for (unsigned i = 0; i < size; i++)
    sum = (sum ^ bytes[i]) * 16777619;
}
static void show(int number) {
  mix(a, sizeof a), mix(b, sizeof b), mix(v, sizeof v), mix(w, sizeof w), mix(c, sizeof c), mix(h, sizeof h);
  printf("%d %08x\\n", number, sum);
}
static void fill(void) {
  unsigned r = 36;
  for (int i = 0; i < 400; i++) {
    r = r * 1664525 + 1013904223;
    (&a[0][0])[i] = (int)r >> 20, (&b[0][0])[i] = (int)(r << 7) >> 24, w[i] = (int)r >> (r >> 28);
    (&c[0][0])[i] = r >> 9, (&h[0][0])[i] = r >> 13, v[i % 20] = (int)r >> 24;
  }
}
HIDDEN int later(int a, int b) { return a > b ? a : b; }
HIDDEN void touch(int i) { a[i][i] ^= 5, v[i]++; }
"""
PARAMETERS = "int n, int m, int (*x)[20], int (*y)[20], int *p, int *q"


class Generator:
    """A function: loops around statements. Counters stay from 0 to 9, subscripts below 20."""

    def __init__(self, rng):
        self.rng, self.counters, self.names = rng, [], 0

    def index(self):
        rng = self.rng
        if not self.counters or rng.random() < 0.08:
            return rng.choice(["n", "m", str(rng.randint(0, 12))])
        one, other = rng.choice(self.counters), rng.choice(self.counters)
        return rng.choice([one, one, one, f"{one} + {rng.randint(1, 3)}", f"{one} + {other}", f"{one} - {other} + 9"])

    def place(self):
        first, second = self.index(), self.index()
        if self.rng.random() < 0.25:
            second = first
        return self.rng.choice([f"a[{first}][{second}]", f"x[{first}][{second}]", f"y[{first}][{second}]",
                                f"b[{first}][{second}]", f"x[{first}][{second}]", f"c[{first}][{second}]",
                                f"h[{first}][{second}]", f"v[{first}]", f"p[{first}]", f"q[{first}]",
                                f"w[({first}) * n + {second}]", f"p[({first}) * 20 + {second}]", "s",
                                f"((unsigned char *)x)[({first}) * 80 + ({second}) * {self.rng.choice([1, 4])}]",
                                f"((unsigned char *)v)[{first} + {second}]"])

    def value(self, depth):
        rng = self.rng
        if depth == 0 or rng.random() < 0.2:
            return rng.choice([self.place(), self.place(), self.place(), *self.counters, str(rng.randint(-9, 9))])
        left, right = self.value(depth - 1), self.value(depth - 1)
        return rng.choice([f"({left} + {right})", f"({left} - {right})", f"({left} * {right})",
                           f"(({left} >> 1) / ({right} | 1))", f"(({left} >> 1) % ({right} | 1))",
                           f"({left} < {right} ? {left} : {right})"])

    def statement(self, depth, indent):
        rng, pick = self.rng, self.rng.random()
        if depth > 0 and pick < 0.45:
            return self.loop(depth - 1, indent)
        if pick < 0.53:
            return f"{indent}if ({self.value(1)} > {self.value(0)})\n  " + self.statement(0, indent)
        if pick < 0.56 and self.counters:
            leave = rng.choice(["break", "continue"])
            return f"{indent}if ({self.value(1)} == {rng.randint(-3, 3)})\n{indent}  {leave};\n"
        if pick < 0.59:
            return f"{indent}touch({self.index()});\n"
        if pick < 0.75:
            place = self.place()
            return f"{indent}{place} = ({place} >> 1) / ({self.place()} | 1);\n"
        return f"{indent}{self.place()} {rng.choice(['=', '=', '+=', '-=', '^='])} {self.value(rng.randint(0, 2))};\n"

    def loop(self, depth, indent):
        rng = self.rng
        counter = f"i{self.names}"
        self.names += 1
        low = rng.choice(["0", "0", "1", *self.counters, *(f"{other} + 1" for other in self.counters)])
        high = rng.choice(["n", "n", "m", "5", "9", *self.counters])
        kind = rng.random()
        if kind < 0.6:
            step = rng.choice(["++", "++", "++", " += 2"])
            head = f"for (int {counter} = {low}; {counter} {rng.choice(['<', '<='])} {high}; {counter}{step})"
        elif kind < 0.75:
            head = f"for (int {counter} = 0; {counter} != {rng.choice(['n', 'm', '7'])}; {counter}++)"
        else:
            head = f"for (int {counter} = {high}; {counter} >= {low}; {counter}--)"
        if low not in ("0", "1") and low.endswith("1"):  # 10 at most, when the loop ends
            head = head.replace("<=", "<")
        self.counters.append(counter)
        body = "".join(self.statement(depth, indent + "  ") for _ in range(rng.randint(1, 3)))
        self.counters.remove(counter)
        return f"{indent}{head} {{\n{body}{indent}}}\n"

    def until(self):
        """A loop whose end its own stores may change."""
        self.counters.append("i")
        body = self.statement(0, "    ") + self.loop(0, "    ") + self.statement(0, "    ")
        return f"  int i = 0, end;\n  do {{\n    end = later({self.place()} & 7, i);\n{body}  }} while (i++ != end);\n"

    def across(self):
        """A loop whose stores reach, pass or leave a word that it loads."""
        rng, more, away = self.rng, self.rng.randint(0, 3), self.rng.randint(-1, 6)
        head, word = rng.choice([("int i = 0; i < n; i++", more + away),
                                 ("int i = 9; i > 9 - n; i--", 9 + more - away)])
        array = rng.choice("pqvvw")
        store = rng.choice([f"{array}[i + {more}] {rng.choice(['=', '+=', '^='])} s;"] * 2 + [f"touch(i + {more});"])
        body = [store, f"s = s * 3 + {array}[{max(word, 0)}];"]
        rng.shuffle(body)
        return f"  for ({head}) {{\n    {body[0]}\n    {body[1]}\n  }}\n"


def generate(rng):
    bodies = [lambda own: "".join(own.loop(2, "  ") for _ in range(own.rng.randint(1, 2)))] * FUNCTIONS
    functions, calls = [], []
    for number, body in enumerate([*bodies, *[Generator.until, Generator.across] * FURTHER]):
        functions.append(f"HIDDEN int function{number}({PARAMETERS}) {{\n  int s = n;\n"
                         f"{body(Generator(rng))}  return s;\n}}\n")
        for _ in range(2):
            arguments = ", ".join([str(rng.randint(1, 9)), str(rng.randint(1, 9)), rng.choice("ab"), rng.choice("ab"),
                                   rng.choice(["w", "w", "&a[0][0]", "&b[0][0]"]),
                                   rng.choice(["v", "w", "w + 3", "&a[2][1]"])])
            calls.append(f"  fill(), sum ^= (unsigned)function{number}({arguments}), show({number});\n")
    return PROLOGUE + "".join(functions) + "int main(void) {\n" + "".join(calls) + "  return 0;\n}\n"


def check(target, seed, directory, options):
    source = directory / "loops.c"
    source.write_text(generate(random.Random(f"loops {seed}")))
    output = runner.host(["loops.c"], directory, ["-O0", "-fwrapv"])
    for level in LEVELS[: options.rounds]:
        built, image = directory / f"loops{level}.o", directory / f"loops{level}"
        target.compile([level, "-std=gnu17", "-fwrapv", "-w", "-c", source, "-o", built])
        target.link([built], image)
        runner.expect(target, image, output, level)


if __name__ == "__main__":
    sys.exit(runner.main("loops", __doc__.split("\n\n")[0], check, default="1-200"))
