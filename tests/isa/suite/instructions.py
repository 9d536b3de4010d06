"""A row for each instruction: the operands of its tests. The conditions follow from its format; an instruction
without a row, or a row without an instruction, is an error that stops the build."""

from dataclasses import dataclass, field

import operands
from branches import branching, jump_and_link, jump_indirect
from computations import computation
from description import DescriptionError
from memory import loading, storing
from system import fencing, halting, read_special, trapping


@dataclass(frozen=True)
class Row:
    """Operands: every pair of two corners (or each corner), and further pairs."""

    corners: list = field(default_factory=list)
    pairs: list = field(default_factory=list)
    groups: list = field(default_factory=list)  # of rd's old value and the registers of both groups
    taken: tuple = None  # operands with which a branch is taken
    not_taken: tuple = None


_integer = Row(operands.INTEGERS, operands.integer_pairs())
_immediate = Row(operands.INTEGERS)
_sum = Row(operands.FLOATS, operands.sums())
_comparison = Row(operands.FLOATS, operands.neighbours())
_memory = Row()

ROWS = {
    "ADD": _integer, "SUB": _integer, "AND": _integer, "OR": _integer, "XOR": _integer, "SLL": _integer,
    "SRL": _integer, "SRA": _integer, "SLT": _integer, "SLTU": _integer, "CMOVNZ": _integer, "CMOVZ": _integer,
    "MIN": _integer, "MAX": _integer, "MINU": _integer, "MAXU": _integer, "MUL": _integer, "MULH": _integer,
    "MULHU": _integer, "FADD": _sum, "FSUB": _sum, "FMUL": Row(operands.FLOATS, operands.products()),
    "FDIV": Row(operands.FLOATS, operands.quotients()),
    "FMIN": _comparison, "FMAX": _comparison, "FEQ": _comparison, "FLT": _comparison, "FLE": _comparison,
    "FBOX": Row(operands.FLOATS[::5], groups=operands.boxes()),
    "FTRI": Row(operands.FLOATS[::5], groups=operands.triangles()),
    "FRSQRT": Row(operands.reciprocal_root_operands()),
    "FCVT_W_S": Row(operands.floats_to_convert()), "FCVT_WU_S": Row(operands.floats_to_convert()),
    "FCVT_S_W": Row(operands.integers_to_convert()), "FCVT_S_WU": Row(operands.integers_to_convert()),
    "ADDI": _immediate, "ANDI": _immediate, "ORI": _immediate, "XORI": _immediate, "SLTI": _immediate,
    "SLTIU": _immediate, "SLLI": _immediate, "SRLI": _immediate, "SRAI": _immediate, "LUI": _immediate,
    "LB": _memory, "LBU": _memory, "LH": _memory, "LHU": _memory, "LW": _memory, "LWNT": _memory, "SB": _memory,
    "SH": _memory, "SW": _memory, "SWNT": _memory, "AINC": _memory,
    "BEQ": Row(taken=(7, 7), not_taken=(7, 8)), "BNE": Row(taken=(7, 8), not_taken=(7, 7)),
    "BLT": Row(taken=(0xFFFFFFFF, 1), not_taken=(1, 0xFFFFFFFF)),
    "BGE": Row(taken=(1, 0xFFFFFFFF), not_taken=(0xFFFFFFFF, 1)),
    "BLTU": Row(taken=(1, 0xFFFFFFFF), not_taken=(0xFFFFFFFF, 1)),
    "BGEU": Row(taken=(0xFFFFFFFF, 1), not_taken=(1, 0xFFFFFFFF)),
    "JAL": Row(), "JALR": Row(), "RDSR": Row(), "TRAP": Row(), "HALT": Row(), "FENCE": Row(),
}


def check_rows(instructions):
    names = {inst.name for inst in instructions}
    wrong = [
        f"{inst.mnemonic} ({inst.name}) has no test: add a row to tests/isa/suite/instructions.py"
        for inst in instructions if inst.name not in ROWS]
    wrong += [
        f"{name} has tests in tests/isa/suite/instructions.py, but the description does not have it" for name in ROWS
        if name not in names]
    if wrong:
        raise DescriptionError("\n".join(wrong))


_SYNTAXES = {  # by format, the operands for which there are conditions
    "R": {"d,a,b"}, "R1": {"d,a"}, "I": {"d,a,i", "d,i(a)"}, "SH": {"d,a,i"}, "U": {"d,u", "d,s"}, "S": {"b,i(a)"},
    "B": {"a,b,p"}, "J": {"d,p"}, "T": {"a,t"}, "F": {"f"}, "N": {""}}


def programs(inst, constants):
    """The instruction's programs, without its faults."""
    if inst.syntax not in _SYNTAXES.get(inst.format, ()):
        raise DescriptionError(
            f"{inst.mnemonic}: operands \"{inst.syntax}\" in format {inst.format} are unknown to tests/isa/suite")
    row = ROWS[inst.name]
    if inst.format == "N":
        return halting(inst)
    if inst.format == "F":
        return fencing(inst, constants)
    if inst.format == "T":
        return trapping(inst, constants)
    if inst.syntax == "d,s":
        return read_special(inst, constants)
    if inst.format == "J":
        return jump_and_link(inst, row)
    if inst.format == "B":
        return branching(inst, row)
    if inst.format == "S":
        return storing(inst)
    if inst.syntax == "d,i(a)":
        return loading(inst) if inst.bytes else jump_indirect(inst, row)
    return computation(inst, row)
