"""Instructions that compute a register from registers and an immediate: formats R, R1, I, SH, and U's lui."""

import itertools
import random

from program import Program

IMMEDIATES = sorted({0, 1, -1, 2, -2, 32767, -32768, 0x5555, -0x5556, 0x7F, 0x80, 0xFF, -0x80, -0x81,
                     0x1234} | {1 << bit for bit in range(15)} |
                    {~(1 << bit) for bit in range(15)})
UPPER = sorted({0, 1, 0xFFFF, 0x7FFF, 0x8000, 0x5555, 0xAAAA,
                0x1234} | {1 << bit for bit in range(16)} | {0xFFFF ^ 1 << bit for bit in range(16)})
POISON = 0x5A5


def value_of(inst, number):
    """A different value for every register, of the kind that the instruction computes with."""
    source = random.Random(f"{inst.name} {number}")
    if inst.is_float and not inst.mnemonic.startswith("fcvt.s"):
        return source.getrandbits(1) << 31 | source.randrange(124, 131) << 23 | source.getrandbits(23)
    if inst.mnemonic[:2] in ("sl", "sr") and inst.mnemonic[:3] != "slt":
        return source.getrandbits(27) << 5 | number  # a different shift for every register
    return source.getrandbits(32)


def immediates_of(inst):
    return {"I": IMMEDIATES, "SH": range(32), "U": UPPER}.get(inst.format, [0])


def values(program, inst, row):
    """Table-driven: every pair of two lists, and a list of pairs."""
    def loop_over(name, words):
        program.table(name, words)
        program.address("r20", name)
        program.address("r21", f"{name}+{4 * len(words)}")
        top = program.label()
        program.place(top)
        return top

    def result():
        program.emit("sw r6, 0(r31)", "addi r31, r31, 4")

    if "READS_RB" in inst.flags:
        top = loop_over("corners", row.corners)
        program.emit("lw r4, 0(r20)")
        program.address("r22", "corners")
        inner = program.label()
        program.place(inner)
        program.emit("lw r5, 0(r22)", f"addi r6, r0, {POISON}", inst.text("r6", "r4", "r5"))
        result()
        program.emit("addi r22, r22, 4", f"bne r22, r21, {inner}", "addi r20, r20, 4", f"bne r20, r21, {top}")
        program.reserve(len(row.corners) ** 2)
        program.case("values", len(row.corners) ** 2)
        if row.pairs:
            top = loop_over("pairs", [word for pair in row.pairs for word in pair])
            program.emit("lw r4, 0(r20)", "lw r5, 4(r20)", f"addi r6, r0, {POISON}", inst.text("r6", "r4", "r5"))
            result()
            program.emit("addi r20, r20, 8", f"bne r20, r21, {top}")
            program.reserve(len(row.pairs))
            program.case("values", len(row.pairs))
        if row.groups:
            groups(program, inst, row)
    else:
        immediates = immediates_of(inst)
        top = loop_over("corners", row.corners)
        program.emit("lw r4, 0(r20)")
        for immediate in immediates:
            program.emit(f"addi r6, r0, {POISON}", inst.text("r6", "r4", i=immediate))
            result()
        program.emit("addi r20, r20, 4", f"bne r20, r21, {top}")
        count = len(row.corners) * len(immediates)
        program.reserve(count)
        if inst.format != "R1":
            program.case("immediate", count)
        program.case("values", count)
    program.rebase()


def groups(program, inst, row):
    """Returns the contents of rd and of the groups of ra and rb."""
    words = len(row.groups[0])
    program.table("groups", [word for group in row.groups for word in group])
    program.address("r28", "groups")
    program.address("r29", f"groups+{4 * words * len(row.groups)}")
    top = program.label()
    program.place(top)
    program.emit(*(f"lw r{6 + word}, {4 * word}(r28)" for word in range(words)),
                 inst.text("r6", "r7", f"r{7 + inst.group_a}"))
    program.emit("sw r6, 0(r31)", "addi r31, r31, 4", f"addi r28, r28, {4 * words}", f"bne r28, r29, {top}")
    program.reserve(len(row.groups))
    program.case("values", len(row.groups))


def aliases(program, inst, row):
    """Every pattern of equal registers, on a few operands each."""
    source = random.Random(f"aliases {inst.name}")
    two = "READS_RB" in inst.flags
    patterns = {"rd = ra": ("r4", "r4", "r5")}
    if two:
        patterns |= {"rd = rb": ("r5", "r4", "r5"), "ra = rb": ("r6", "r4", "r4"), "rd = ra = rb": ("r4", "r4", "r4")}
    zeros = {"rd is r0": ("r0", "r4", "r5"), "ra is r0": ("r6", "r0", "r5"), "rd = ra is r0": ("r0", "r0", "r5")}
    if two:
        zeros |= {"rb is r0": ("r6", "r4", "r0"), "ra = rb is r0": ("r6", "r0", "r0"), "all are r0": ("r0", "r0", "r0")}
    for condition, (d, a, b) in (patterns | zeros).items():
        for number in range(12):
            immediate = source.choice(list(immediates_of(inst)))
            program.constant("r4", source.choice(row.corners) if number % 4 != 1 else 0)
            program.constant("r5", source.choice(row.corners) if number % 4 != 2 else 0)
            program.constant("r6", POISON)
            program.emit(inst.text(d, a, b, immediate))
            program.store(d)
            if d == "r0":
                program.emit("addi r6, r0, 0")  # r0 as another instruction sees it
                program.store("r6")
            program.case(condition)


# Values for the first and the second operand, from two that they have otherwise: so that whichever register is read in
# the place of the right one, one of the results differs, be it only a truth value.
_VARIANTS = [lambda a, b: (a, b), lambda a, b: (b, b), lambda a, b: (0, b), lambda a, b: (a, 0), lambda a,
             b: (b - 1, b), lambda a, b: (b + 1, b)]


def every_register(program, inst):
    """Every register as every operand, the others holding other values."""
    program.fill(lambda n: value_of(inst, n))
    for operand in inst.syntax.replace(",", ""):
        if operand not in "dab":
            continue
        for number, variant in itertools.product(range(32), _VARIANTS if inst.format in ("R", "I") else _VARIANTS[:1]):
            source = random.Random(f"{inst.name} {operand} {number} {_VARIANTS.index(variant)}")
            a, b, d = source.sample([n for n in range(1, 30) if n != number], 3)
            chosen = {"d": d, "a": a, "b": b} | {operand: number}
            immediate = source.choice([i for i in immediates_of(inst) if i not in (0, -1)] or [0])
            if variant is not _VARIANTS[0]:
                second = immediate if inst.format == "I" else value_of(inst, chosen["b"])
                for register, value in zip("ab", variant(value_of(inst, chosen["a"]), second)):
                    if chosen[register] and register in inst.syntax:
                        program.constant(f"r{chosen[register]}", value)
            program.emit(inst.text(*(f"r{chosen[field]}" for field in "dab"), immediate))
            program.store(f"r{chosen['d']}")
            for field in "dab":
                if 0 < chosen[field] < 30 and field in inst.syntax and (field == "d" or variant is not _VARIANTS[0]):
                    program.constant(f"r{chosen[field]}", value_of(inst, chosen[field]))
            program.case(f"every r{operand}")


def bystanders(program, inst):
    """All registers after it: none but rd has changed."""
    for d, a, b in ((9, 17, 3), (22, 12, 27), (0, 1, 2)):
        program.reach(64)
        program.fill(lambda n: value_of(inst, n))
        program.emit(inst.text(f"r{d}", f"r{a}", f"r{b}", immediates_of(inst)[-1]))
        program.store_all()
        program.case("bystanders")


def upper(program, inst):
    """lui: no register operand but rd."""
    for immediate in UPPER:
        program.constant("r6", POISON)
        program.emit(inst.text("r6", i=immediate))
        program.store("r6")
        program.case("values")
        program.case("immediate")
    program.emit(inst.text("r0", i=0x1234))
    program.store("r0")
    program.emit("addi r6, r0, 0")
    program.store("r6")
    program.case("rd is r0")


def computation(inst, row):
    program = Program(inst.mnemonic, inst.mnemonic)
    program.begin()
    if "READS_RA" in inst.flags:
        values(program, inst, row)
        aliases(program, inst, row)
    else:
        upper(program, inst)
    every_register(program, inst)
    bystanders(program, inst)
    program.end()
    return [program]
