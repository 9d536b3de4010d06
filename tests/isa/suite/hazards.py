"""Hazards of a pipeline, a slow unit or a scoreboard: results used at once, results overwritten at once, and operands
overwritten at once. Every instruction that writes a register stands before each kind of reader, at several
distances."""

import random

from program import Program

READERS = {  # line with X for the register read, and the register that holds the outcome
    "add": ("add r20, X, r1", "r20"), "fmul": ("fmul r20, X, r2", "r20"), "fdiv": ("fdiv r20, r2, X", "r20"),
    "mul": ("mul r20, X, X", "r20"),
    "frsqrt": ("frsqrt r20, X", "r20"), "cmovnz": ("cmovnz r20, r1, X", "r20"),
    "sw": ("sw X, 0(r4)\n  lw r20, 0(r4)", "r20"),
    "sb": ("sb X, -8(r0)\n  lw r20, -8(r0)", "r20"), "swnt": ("swnt X, 0(r4)\n  lw r20, 0(r4)", "r20"),
}
OVERWRITERS = ["addi X, r0, 77", "fadd X, r2, r3", "mul X, r1, r1", "lui X, 0x1234", "lw X, 4(r5)", "lbu X, -12(r0)",
               "fdiv X, r3, r2", "frsqrt X, r3",
               "rdsr X, threads"]


def producers(instructions):
    """[(mnemonic, line with X for rd)]: every instruction that writes a register and goes on behind itself."""
    lines = []
    for inst in instructions:
        if "WRITES_RD" not in inst.flags or "IS_BRANCH" in inst.flags:
            continue
        if inst.bytes:
            lines.append((inst.mnemonic, inst.text("X", "r5", i=8 if "IS_ATOMIC" not in inst.flags else 32)))
            if not inst.flags & {"IS_NONTEMPORAL", "IS_ATOMIC"}:
                lines.append((inst.mnemonic, inst.text("X", "r0", i=-16)))
        elif inst.syntax == "d,s":
            lines.append((inst.mnemonic, inst.text("X", i="threads")))
        else:
            a, b = ("r2", "r3") if inst.is_float else ("r1", "r6")
            lines.append((inst.mnemonic, inst.text("X", a, b, 5)))
    return lines


def setup(program):
    source = random.Random("hazards")
    program.begin()
    program.constant("r1", 0x00123457)
    program.constant("r2", 0x40490FDB)
    program.constant("r3", 0x3FB504F3)
    program.address("r4", "scratch")
    program.address("r5", "words")
    program.constant("r6", 0x0000FEDC)
    for at in (-4, -8, -12, -16):
        program.constant("r7", source.getrandbits(32))
        program.emit(f"sw r7, {at}(r0)")
    program.sections += ["  .data", "  .p2align 6",
                         "words: .word 0x3f9d70a4, 0xc1234567, 0x42f6e979, 0x40000000, 5, 6, 7, 8, 9",
                         "  .p2align 6", "scratch: .zero 64"]


def used_at_once(program, lines):
    for mnemonic, producer in lines:
        for reader, (line, outcome) in READERS.items():
            for distance in (0, 1, 3):
                program.constant("r20", 0x7EEF0000)
                program.constant("r19", 0x00BAD000)
                program.emit(producer.replace("X", "r19"), *["addi r21, r21, 1"] * distance,
                             *line.replace("X", "r19").split("\n  "))
                program.store(outcome)
                program.case("used at once" if distance == 0 else "used soon")


def overwritten_at_once(program, lines):
    """The later write stays."""
    for mnemonic, producer in lines:
        for overwriter in OVERWRITERS:
            program.constant("r19", 0x00BAD000)
            program.emit(producer.replace("X", "r19"), overwriter.replace("X", "r19"))
            program.store("r19")
            program.case("overwritten at once")
            program.constant("r19", 0x00BAD000)
            program.emit(overwriter.replace("X", "r19"), producer.replace("X", "r19"))
            program.store("r19")
            program.case("overwritten at once")


def operands_overwritten(program, instructions):
    """The instruction has read its operands when the next one writes them."""
    for inst in instructions:
        if "READS_RA" not in inst.flags or "WRITES_RD" not in inst.flags or "IS_BRANCH" in inst.flags:
            continue
        if inst.bytes:
            program.address("r17", "words")
            immediate = 8 if "IS_ATOMIC" not in inst.flags else 32
        else:
            program.constant("r17", 0x40A00000)
            immediate = 3
        program.constant("r18", 0x3F9D70A4)
        program.constant("r19", 7)
        program.emit(inst.text("r19", "r17", "r18", immediate), "addi r17, r0, 1", "lui r18, 0x1111")
        program.store("r19")
        program.case("operands overwritten at once")


def chains(program):
    """Long dependent chains through all units."""
    source = random.Random("chains")
    steps = ["add r10, r10, r1", "xori r10, r10, 0x35", "fadd r10, r10, r2", "fmul r10, r3, r10", "fdiv r10, r10, r2",
             "frsqrt r10, r10",
             "mul r10, r10, r6", "fcvt.s.wu r10, r10", "fcvt.w.s r10, r10", "sw r10, 0(r4)\n  lw r10, 0(r4)",
             "sw r10, -4(r0)\n  lhu r10, -4(r0)",
             "swnt r10, 8(r4)\n  lwnt r10, 8(r4)", "slli r10, r10, 3", "srai r10, r10, 1", "fmax r10, r10, r3",
             "mulh r10, r10, r10"]
    for _ in range(40):
        program.constant("r10", source.getrandbits(32))
        for step in source.choices(steps, k=16):
            program.emit(*step.split("\n  "))
        program.store("r10")
        program.case("chains through all units", 16)


def branches(program):
    """A branch on a result that is just coming, and the link of a jump used at once."""
    for producer in ("addi r19, r0, 5", "fdiv r19, r2, r2", "lw r19, 12(r5)", "frsqrt r19, r2", "mul r19, r1, r0",
                     "lwnt r19, 16(r5)"):
        for branch in ("beq r19, r0", "bne r19, r0", "blt r19, r1", "bgeu r1, r19"):
            target = program.label()
            program.emit("addi r20, r0, 1", producer, f"{branch}, {target}", "addi r20, r0, 2")
            program.place(target)
            program.store("r20")
            program.case("a branch on a result that is coming")
    for jump in ("jal r19, {}", "jalr r19, 0(r18)"):
        target = program.label()
        program.address("r18", target)
        program.emit(jump.format(target), "addi r20, r0, 9")
        program.place(target)
        program.emit("addi r20, r19, 4")
        program.store("r20")
        program.case("a link used at once")


def programs(instructions):
    program = Program("results-in-order", "results in order")
    setup(program)
    lines = producers(instructions)
    used_at_once(program, lines)
    overwritten_at_once(program, lines)
    operands_overwritten(program, instructions)
    chains(program)
    branches(program)
    program.end()
    return [program]
