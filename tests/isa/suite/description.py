"""The instructions as the build generated them from the ISA description (trax/instructions.inc, trax/numbers.h)."""

import re
from dataclasses import dataclass


class DescriptionError(Exception):
    """The description says something for which the suite has no tests; the message names the instruction."""


@dataclass(frozen=True)
class Instruction:
    name: str  # FCVT_W_S
    mnemonic: str  # fcvt.w.s
    syntax: str  # operands in the assembler's order: d, a, b registers; i u immediates; p target; s t f names
    format: str  # R, R1, I, SH, U, S, B, J, T, F, N
    unit: str
    mask: int  # bits that are fixed
    match: int  # and their values
    flags: frozenset
    bytes: int  # of an access to memory; 0: none
    group_a: int = 1  # registers that it reads from ra on
    group_b: int = 1  # and from rb on

    @property
    def opcode(self):
        return self.match >> 26

    @property
    def has_function(self):
        """Does a function code in bits 5..0 tell it from others of its opcode?"""
        return self.format in ("R", "R1")

    @property
    def reserved(self):
        """Bits that must be zero."""
        fixed = 0xFC000000 | (0x3F if self.has_function else 0)
        return self.mask & ~fixed

    @property
    def is_float(self):
        return self.unit in ("FP_ADD", "FP_MUL", "SPECIAL", "RAY_BOX", "RAY_TRIANGLE")

    def text(self, d="r0", a="r0", b="r0", i=0, p="0"):
        """A line of assembly."""
        values = {"d": d, "a": a, "b": b, "i": i, "u": i, "s": i, "t": i, "f": i, "p": p}
        return f"{self.mnemonic} " + re.sub("[a-z]", lambda letter: str(values[letter[0]]), self.syntax)


def read_instructions(path):
    """[Instruction], in the order of their encodings."""
    pattern = re.compile(
        r'^TRAX_INSTRUCTION\((\w+), "([^"]+)", "([^"]*)", (\w+), (\w+), (0x\w+)u, (0x\w+)u, ([^,]*), (\d+)\)$')
    instructions = []
    with open(path) as file:
        for number, line in enumerate(file, 1):
            if not line.startswith("TRAX_INSTRUCTION("):
                continue
            fields = pattern.match(line)
            if not fields:
                raise DescriptionError(f"{path}:{number}: not a line of an instruction: {line.strip()}")
            name, mnemonic, syntax, form, unit, mask, match, flags, size = fields.groups()
            groups = {letter: int(count) for letter, count in re.findall(r"TRAX_GROUP_([AB])\((\d+)\)", flags)}
            instructions.append(Instruction(name, mnemonic, syntax, form, unit, int(mask, 16), int(match, 16),
                                            frozenset(re.findall(r"TRAX_(\w+)", flags)), int(size), groups.get("A", 1),
                                            groups.get("B", 1)))
    if not instructions:
        raise DescriptionError(f"{path}: no instructions")
    return instructions


def read_constants(path):
    """{name: value} of the plain macros of trax/numbers.h."""
    with open(path) as file:
        return {name: int(value, 0) for name,
                value in re.findall(r"^#define (\w+) (0x[0-9A-Fa-f]+|\d+)u?\b", file.read(), re.M)}
