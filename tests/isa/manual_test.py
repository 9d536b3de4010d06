#!/usr/bin/env python3
"""The tables of docs/isa.md against the oracle and the assembler: manual_test.py ISA_MD ISA_ORACLE TRAX_MC

The generator computes the tables of arithmetic with the emulator's functions, over a few operands of each class. Here
the oracle answers, over many: every entry must hold for all of them, and none may say less than it could. Shorthands
must assemble to their expansions, and be printed or not as the table says."""

import random
import re
import subprocess
import sys
import tempfile

SIGN, INF, NAN = 0x80000000, 0x7F800000, 0x7FC00000
CONSTANTS = {"NaN": NAN, "+inf": INF, "-inf": SIGN | INF, "+0": 0, "-0": SIGN, "0": 0, "1": 1}
EACH = 25  # operands of a class that has so many


def members(name, numbers):
    """Words of an operand class, both ends among them."""
    sign, kind = (SIGN if name[0] == "-" else 0), name.lstrip("+-")
    if kind == "NaN":
        return [NAN, 0x7F800001, 0x7FFFFFFF, 0xFFC00000, 0xFF800001, 0xFFFFFFFF] + [
            numbers.choice((0, SIGN)) | INF | numbers.randint(1, 0x7FFFFF) for _ in range(EACH)]
    if kind == "inf":
        return [sign | INF]
    if kind == "0":
        return [sign]
    low, high = {"subnormal": (1, 0x7FFFFF), "normal": (0x800000, INF - 1)}[kind]
    return [sign | low, sign | high] + [sign | numbers.randint(low, high) for _ in range(EACH)]


def rows_of(text, heading):
    """Tables, as lists of cells, of the section with this heading."""
    section = re.split(r"\n#", text.split(f"# {heading}\n", 1)[1], maxsplit=1)[0]
    return [[[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()
             if not line.startswith("| ---")] for table in re.findall(r"(?:^\|.*\n)+", section + "\n", re.M)]


class Oracle:
    """Collects questions, and asks them all at once."""

    def __init__(self, program):
        self.program, self.questions, self.checks = program, [], []

    def ask(self, question, check):
        self.questions.append(question)
        self.checks.append(check)

    def answer(self):
        done = subprocess.run([self.program], input="\n".join(self.questions) + "\n", capture_output=True, text=True,
                              check=True)
        answers = [int(line, 16) for line in done.stdout.split()]
        assert len(answers) == len(self.questions)
        for check, value in zip(self.checks, answers):
            check(value)


class Entry:
    """An entry of a table of special cases: the answers over its two classes."""

    def __init__(self, operation, a, b, text):
        self.name, self.text, self.cases = f"{operation} {a} {b}".rstrip(), text, []

    def wrong(self):
        values = {"a": lambda a, b, r: r == a, "b": lambda a, b, r: r == b, "-b": lambda a, b, r: r == b ^ SIGN}
        if self.text in CONSTANTS:
            holds = all(result == CONSTANTS[self.text] for _, _, result in self.cases)
        elif self.text in values:
            holds = all(values[self.text](*case) for case in self.cases)
        else:  # r and c: nothing simpler is true
            results = {result for _, _, result in self.cases}
            holds = self.text in ("r", "c") and len(results) > 1 and not any(
                all(value(*case) for case in self.cases) for value in values.values())
        return None if holds else f"{self.name}: '{self.text}' does not hold"


def ask_special_cases(text, oracle, numbers):
    entries = []

    def ask(operation, a, b, cell):
        entry = Entry(operation, a, b, cell)
        entries.append(entry)
        for x in members(a, numbers):
            for y in members(b, numbers) if b else [0]:
                question = f"{operation} {x:x} {y:x}" if b else f"{operation} {x:x}"
                oracle.ask(question, lambda result, x=x, y=y: entry.cases.append((x, y, result)))

    for table in rows_of(text, "Special cases"):
        head, *rows = table
        operation = head[0].split("`")[1] if "`" in head[0] else None
        for row in rows:
            for column, cell in zip(head[1:], row[1:]):
                if operation:
                    ask(operation, row[0], column, cell)
                else:
                    ask(row[0].strip("`"), column, "", cell)
    return entries


def ask_examples(text, oracle, wrong):
    """Rounding: a row is one question. Conversions: a row is one for each operation in the head."""
    count = 0

    def ask(question, wanted):
        nonlocal count
        count += 1
        oracle.ask(
            question, lambda result: result == int(wanted, 16) or wrong.append(
                f"{question}: {wanted} in the table, 0x{result:08X}"))

    for table in rows_of(text, "Rounding"):
        for operation, a, b, result, *_ in table[1:]:
            ask(" ".join([operation.strip("`"), a[2:], b[2:]]).strip(), result)
    for table in rows_of(text, "Conversions"):
        for row in table[1:]:
            for operation, result in zip(table[0][2:], row[2:]):
                ask(f"{operation.strip('`')} {row[0][2:]}", result)
    return count


def reduced(value, bits):
    """In integers: to nearest, ties to the even multiple, at one bit upwards in magnitude."""
    exponent, significand = value >> 23 & 0xFF, value & 0x7FFFFF | 0x800000
    if exponent in (0, 255):
        return value
    unit = 1 << 24 - bits
    quotient, rest = divmod(significand, unit)
    quotient += rest * 2 > unit or rest * 2 == unit and rest > 0 and (quotient % 2 == 1 or bits == 1)
    magnitude = (exponent << 23) + quotient * unit - 0x800000
    return value & SIGN | magnitude


def check_reduced(text, wrong):
    (head, *rows), = rows_of(text, "Reduced precision")
    bits = [int(re.search(r"\d+", cell)[0]) for cell in head[:-1]]
    for row in rows:
        value = int(row[0], 16)
        for count, cell in zip(bits, row):
            if reduced(value, count) != int(cell, 16):
                wrong.append(f"{row[0]} to {count} bits: {cell} in the table, 0x{reduced(value, count):08X}")
    return len(rows) * len(bits)


def print_assembly(mc, source, *options):
    with tempfile.NamedTemporaryFile("w", suffix=".s") as file:
        file.write(source)
        file.flush()
        done = subprocess.run([mc, *options, file.name], capture_output=True, text=True)
    if done.returncode:
        return done.stderr
    return [
        " ".join(line.split()) for line in done.stdout.splitlines()
        if line.startswith("\t") and not line.startswith("\t.")]


def check_shorthands(text, mc, wrong):
    table, = rows_of(text, "Shorthands")
    for shorthand, expansion, printed in table[1:]:
        shorthand = shorthand.strip("`")
        is_large = expansion.startswith("if imm does not fit")
        operands = {"rd": "r5", "ra": "r6", "rb": "r7", "offset": "here",
                    "imm": "0x12348765" if is_large else "here" if shorthand.startswith("la") else "-7"}

        def fill(line):
            return re.sub(r"\b(rd|ra|rb|imm|offset)\b", lambda match: operands[match[0]], line)
        whole = "here:\n" + "\n".join(fill(line) for line in re.findall(r"`([a-z]\S* ?[^`]*)`", expansion)) + "\n"
        ours = print_assembly(mc, "here:\n" + fill(shorthand) + "\n", "-M", "no-aliases")
        theirs = print_assembly(mc, whole, "-M", "no-aliases")
        if ours != theirs or not isinstance(ours, list) or not ours:
            wrong.append(f"{shorthand}: assembles to {ours}, but {expansion} to {theirs}")
        preferred = print_assembly(mc, whole)
        is_printed = len(preferred) == 1 and preferred[0] == fill(shorthand)
        if is_printed != (printed == "yes"):
            wrong.append(f"{shorthand}: the disassembler prints {preferred}")
    return len(table) - 1


def main():
    manual, oracle, mc = sys.argv[1:]
    text = open(manual).read()
    oracle = Oracle(oracle)
    wrong = []
    entries = ask_special_cases(text, oracle, random.Random(1))
    examples = ask_examples(text, oracle, wrong)
    oracle.answer()
    wrong += filter(None, (entry.wrong() for entry in entries))
    examples += check_reduced(text, wrong)
    shorthands = check_shorthands(text, mc, wrong)
    for line in wrong:
        print(line)
    print(
        f"{len(entries)} entries over {len(oracle.questions)} operands, {examples} examples, {shorthands} shorthands, "
        f"{len(wrong)} wrong"
    )
    # Nine tables of 9 x 9, and a row of 9: a section that is not found is no proof.
    return 1 if wrong or len(entries) != 9 * 81 + 9 or examples < 100 or shorthands < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
