"""Conditional branches, jal and jalr: condition, direction, distance, link."""

import random

from computations import IMMEDIATES
from operands import INTEGERS, integer_pairs
from program import Program

NEAR = (8, 12, 16, 32, 64, 128, 256, 512)  # bytes, within the text
LINK = ["-Ttext=0x1000", "-Tdata=0xb00000", "--section-start=.rodata=0xc00000"]
FILLER = 0  # an illegal word, which a wrong distance reaches


def outcome(program, condition):
    """Stores r6, which says where the branch has led."""
    program.store("r6")
    program.case(condition)


def branch_values(program, inst):
    program.table("corners", INTEGERS)
    end = f"corners+{4 * len(INTEGERS)}"
    outer, inner, taken = program.label(), program.label(), program.label()
    program.address("r20", "corners")
    program.address("r21", end)
    program.place(outer)
    program.emit("lw r4, 0(r20)")
    program.address("r22", "corners")
    program.place(inner)
    program.emit("lw r5, 0(r22)", "addi r6, r0, 1", inst.text(a="r4", b="r5", p=taken), "addi r6, r0, 2")
    program.place(taken)
    program.emit("sw r6, 0(r31)", "addi r31, r31, 4", "addi r22, r22, 4", f"bne r22, r21, {inner}", "addi r20, r20, 4",
                 f"bne r20, r21, {outer}")
    program.reserve(len(INTEGERS) ** 2)
    program.rebase()
    program.case("values", len(INTEGERS) ** 2)
    for a, b in integer_pairs():
        branch_to(program, inst, a, b, backward=False, condition="values")


def branch_to(program, inst, a, b, backward, condition, ra="r4", rb="r5"):
    if ra != "r0":
        program.constant(ra, a)
    if rb not in ("r0", ra):
        program.constant(rb, b)
    target, done, start = program.label(), program.label(), program.label()
    if backward:
        program.emit(f"jal r0, {start}")
        program.place(target)
        program.emit("addi r6, r0, 1", f"jal r0, {done}")
        program.place(start)
    program.emit(inst.text(a=ra, b=rb, p=target), "addi r6, r0, 2")
    if not backward:
        program.emit(f"jal r0, {done}")
        program.place(target)
        program.emit("addi r6, r0, 1")
    program.place(done)
    outcome(program, condition)


def branch_registers(program, inst):
    source = random.Random(inst.name)
    some = [0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x12345678]
    for a in some:
        for condition, ra, rb in (("ra = rb", "r4", "r4"), ("ra is r0", "r0", "r5"), ("rb is r0", "r4", "r0"),
                                  ("ra = rb is r0", "r0", "r0")):
            branch_to(program, inst, a, a, False, condition, ra, rb)
    program.fill(lambda n: n * 0x01000193 & 0xFFFFFFFF)
    for operand in "ab":
        for number in range(32):
            for value in (1, 0x80000000, 0x40000000):  # less, greater, equal
                other = source.choice([n for n in range(8, 30) if n != number])
                ra, rb = (number, other) if operand == "a" else (other, number)
                branch_to(program, inst, value, 0x40000000, False, f"every r{operand}", f"r{ra}", f"r{rb}")
    for a, b in ((0x80000000, 1), (1, 0x80000000), (1, 1)):
        program.reach(64)
        program.fill(lambda n: 0x01010101 * n)
        program.constant("r12", a)
        program.constant("r9", b)
        target = program.label()
        program.emit(inst.text(a="r12", b="r9", p=target), "addi r1, r0, 77")
        program.place(target)
        program.store_all()
        program.case("bystanders")


def near(program, line, condition):
    """A taken branch or jump, line(label), over each distance within the text."""
    for distance in NEAR:
        start, target, done = program.label(), program.label(), program.label()
        program.emit("addi r6, r0, 0", line(target))
        program.lines.append(f"  .fill {distance // 4 - 1}, 4, {FILLER}")
        program.place(target)
        program.emit("addi r6, r6, 1")
        outcome(program, condition)
        program.emit("addi r6, r0, 0", f"jal r0, {start}")
        program.place(target + "b")
        program.emit("addi r6, r6, 1", f"jal r0, {done}")
        program.lines.append(f"  .fill {max(distance // 4 - 2, 0)}, 4, {FILLER}")
        program.place(start)
        program.emit(line(target + "b"))
        program.place(done)
        outcome(program, condition)


def far(program, line, base, farthest, condition):
    """The same over each power of two up to the farthest, and over the limits, by sections of their own."""
    distances = [sign * 2**k for k in range(10,
                                            farthest.bit_length() - 1) for sign in (1, -1)] + [farthest - 4, -farthest]
    for i, distance in enumerate(distances):
        # The place of the branch within its block makes the target's address a multiple of 64.
        lead = -distance % 64
        section, back = f".at{i}", f"Lback{i}"
        address = base + 192 * i  # no sum or difference of two is a power of two
        program.link += [f"--section-start=.from{i}={address:#x}",
                         f"--section-start={section}={address + lead + distance:#x}"]
        program.sections += [f'  .section .from{i}, "ax", @progbits', f"Lfrom{i}:", f"  .fill {lead // 4}, 4, {FILLER}",
                             f"Lgo{i}:",
                             f"  {line(f'Lto{i}')}", "  addi r6, r0, 0", "  jalr r0, 0(r7)",
                             f'  .section {section}, "ax", @progbits', f"Lto{i}:", f"  addi r6, r0, {i + 1}",
                             "  jalr r0, 0(r7)"]
        program.address("r7", back)
        program.address("r8", f"Lgo{i}")
        program.emit("jalr r0, 0(r8)")
        program.place(back)
        outcome(program, condition)


def branching(inst, row):
    program = Program(inst.mnemonic, inst.mnemonic, link=LINK)
    program.begin()
    branch_values(program, inst)
    for a, b in integer_pairs()[:64] + [(a, b) for a in INTEGERS[::5] for b in INTEGERS[::5]]:
        branch_to(program, inst, a, b, True, "backward")
    branch_registers(program, inst)
    a, b = row.taken
    program.constant("r4", a)
    program.constant("r5", b)
    near(program, lambda label: inst.text(a="r4", b="r5", p=label), "distance")
    far(program, lambda label: inst.text(a="r4", b="r5", p=label), 0x60000, 1 << 17, "distance")
    # Not taken, a branch goes on wherever its target is: itself, nowhere.
    a, b = row.not_taken
    program.constant("r4", a)
    program.constant("r5", b)
    for target in ("0", "-131072", "131068", "-4", "4"):
        program.emit("addi r6, r0, 5", inst.text(a="r4", b="r5", p=target), "addi r6, r6, 1")
        outcome(program, "not taken to nowhere")
    program.end()
    return [program]


# --- jumps


def jump_to(program, line, d, condition):
    """Forward and backward; stores the link, an address and the same in every implementation, and where it led.
    line(label): assembly."""
    for backward in (False, True):
        target, done, start = program.label(), program.label(), program.label()
        program.emit("addi r6, r0, 2")
        if backward:
            program.emit(f"jal r0, {start}")
            program.place(target)
            program.emit("addi r6, r6, 4", f"jal r0, {done}")
            program.place(start)
        line(target)
        program.emit("addi r6, r6, 8")
        if not backward:
            program.place(target)
            program.emit("addi r6, r6, 1")
        program.place(done)
        program.store(d)
        outcome(program, condition)
        program.case("backward" if backward else "forward")


def jump_and_link(inst, row):
    program = Program(inst.mnemonic, inst.mnemonic, link=LINK)
    program.begin()
    for number in range(32):
        if number != 6:  # r6 counts
            jump_to(program, lambda label: program.emit(inst.text(f"r{number}", p=label)), f"r{number}", "every rd")
    target = program.label()
    program.emit(inst.text("r6", p=target), "addi r6, r0, 0")
    program.place(target)
    outcome(program, "every rd")
    program.emit(inst.text("r0", p="4"), "addi r6, r0, 0")
    program.store("r0")
    outcome(program, "rd is r0")
    near(program, lambda label: inst.text("r0", p=label), "distance")
    far(program, lambda label: inst.text("r9", p=label), 0x600000, 1 << 22, "distance")
    program.store("r9")
    program.reach(64)
    program.fill(lambda n: 0x01010101 * n)
    program.emit(inst.text("r12", p="4"))
    program.store_all()
    program.case("bystanders")
    program.end()
    return [program]


def jump_indirect(inst, row):
    program = Program(inst.mnemonic, inst.mnemonic, link=LINK)
    program.begin()

    def jump(d, a, immediate=0):
        def line(label):
            program.address(a, f"{label}-({immediate})")
            program.emit(inst.text(d, a, i=immediate))
        return line

    for number in range(1, 32):
        if number != 6:
            jump_to(program, jump(f"r{number}", "r4" if number != 4 else "r5"), f"r{number}", "every rd")
            jump_to(program, jump("r4" if number != 4 else "r5", f"r{number}"), "r4" if number != 4 else "r5",
                    "every ra")
    for operand in "da":
        target = program.label()
        program.address("r6" if operand == "a" else "r5", target)
        program.emit(inst.text("r6" if operand == "d" else "r5", "r6" if operand == "a" else "r5"), "addi r6, r0, 0")
        program.place(target)
        outcome(program, f"every r{operand}")
    jump_to(program, jump("r0", "r4"), "r0", "rd is r0")
    target = program.label()
    program.address("r4", target)
    program.emit(inst.text("r0", "r4"))
    program.place(target)
    program.emit("addi r6, r0, 0")  # at once
    outcome(program, "rd is r0")
    program.case("every rd")
    for _ in range(3):
        jump_to(program, jump("r4", "r4"), "r4", "rd = ra")
    for immediate in IMMEDIATES:
        jump_to(program, jump("r5", "r4", immediate), "r5", "immediate")
    program.address("r7", "Lafter_low")
    program.sections += ['  .section .low, "ax", @progbits', "  addi r6, r0, 9", "  jalr r0, 0(r7)"]
    program.link[0] = "-Ttext=0x2000"  # above .low
    program.link.append("--section-start=.low=0x1000")
    program.emit(inst.text("r5", "r0", i=0x1000))
    program.place("Lafter_low")
    outcome(program, "ra is r0")
    program.case("every ra")
    program.reach(64)
    program.fill(lambda n: 0x01010101 * n)
    target = program.label()
    program.address("r9", target)
    program.emit(inst.text("r12", "r9"))
    program.place(target)
    program.store_all()
    program.case("bystanders")
    program.end()
    return [program]
