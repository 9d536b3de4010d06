"""Loads, stores and the atomic increment."""

import random

from computations import IMMEDIATES
from operands import INTEGERS
from program import UNWRITTEN, Program

MEMORY_END = 0x01000000  # of the suite's machine
LOCAL = 0xFFFFFE00
FIRST, LAST = 0x1000, MEMORY_END - 64  # blocks of 64 bytes at the two ends of global memory
LINK = ["-Ttext=0x2000", "-Tdata=0x40000", f"--section-start=.first={FIRST:#x}", f"--section-start=.last={LAST:#x}"]


def block(name, words):
    return [f'  .section {name}, "aw", @progbits', "  .p2align 6",
            f"{name[1:]}_block:"] + [f"  .word {word:#x}" for word in words]


def random_words(seed, count):
    source = random.Random(seed)
    return [source.getrandbits(32) for _ in range(count)]


def new_program(inst):
    program = Program(inst.mnemonic, inst.mnemonic, link=LINK)
    program.sections += block(".first", random_words("first", 16)) + block(".last", random_words("last", 16))
    program.begin()
    return program


def has_local(inst):
    return "IS_ATOMIC" not in inst.flags


def places(inst):
    """(condition, address) of the ends of the memories that the instruction reaches."""
    ends = [("first of global", FIRST), ("last of global", MEMORY_END - inst.bytes)]
    if has_local(inst):
        ends += [("first of local", LOCAL), ("last of local", 2**32 - inst.bytes)]
    return ends


def offsets(inst):
    return range(0, 4, inst.bytes)


def fill_local(program, words):
    """Local memory from its first byte."""
    for i, word in enumerate(words):
        program.constant("r4", word)
        program.emit(f"sw r4, {LOCAL - 2**32 + 4 * i}(r0)")


class Target:
    """A word of the signature: the place as the assembler writes it."""

    def __init__(self, program, words):
        self.first = program.reserve(words)

    def symbol(self, byte):
        return f"begin_signature+{4 * self.first + byte}"


# --- loads


class Unchecked:
    """One more word behind the results: what an increment changes for whose result nobody can wait (rd = r0)."""

    def __init__(self, program):
        self.program, self.word = program, program.unchecked
        program.unchecked += 1

    def symbol(self):
        return f"end_results+{4 * self.word}"


def load(program, inst, d, a, immediate=0):
    program.emit(inst.text(d, a, i=immediate))
    program.store(d)


def load_values(program, inst):
    words = INTEGERS + random_words("loads", 64) + [0x80FF7F00 ^ (k * 0x01010101) for k in range(0, 256, 8)]
    if "IS_ATOMIC" in inst.flags:
        target = Target(program, len(words))
        for i, word in enumerate(words):
            program.constant("r5", word)
            program.address("r4", target.symbol(4 * i))
            program.emit("sw r5, 0(r4)")
            load(program, inst, "r6", "r4")
            for reader in ("lw", "lwnt"):
                program.emit(f"{reader} r7, 0(r4)")
                program.store("r7")
            program.case("values")
        return
    program.table("values", words)
    program.address("r20", "values")
    program.address("r21", f"values+{4 * len(words)}")
    top = program.label()
    program.place(top)
    program.emit(inst.text("r6", "r20"), "sw r6, 0(r31)", "addi r31, r31, 4", f"addi r20, r20, {inst.bytes}",
                 f"bne r20, r21, {top}")
    count = len(words) * 4 // inst.bytes
    program.reserve(count)
    program.rebase()
    program.case("values", count)


def load_addresses(program, inst):
    """Through every immediate, to every alignment, at both ends of every memory."""
    if "IS_ATOMIC" in inst.flags:
        target = Target(program, 4)
        symbol = target.symbol
    else:
        program.table("bytes", random_words("bytes", 4))
        symbol = "bytes+{}".format
    source = random.Random(inst.name)
    for immediate in IMMEDIATES + [32764, 32766]:
        at = source.randrange(0, 16, inst.bytes)
        program.address("r4", f"{symbol(at)}-({immediate})")
        load(program, inst, "r6", "r4", immediate)
        program.case("immediate")
    for at in range(0, 8, inst.bytes):
        program.address("r4", symbol(0))
        load(program, inst, "r6", "r4", at)
        program.address("r4", symbol(at))
        load(program, inst, "r6", "r4")
        program.case("alignment", 2)
    if has_local(inst):
        fill_local(program, random_words("local", 128))
        for at in list(range(0, 16, inst.bytes)) + list(range(256, 272,
                                                              inst.bytes)) + list(range(496, 512, inst.bytes)):
            load(program, inst, "r6", "r0", LOCAL - 2**32 + at)
            program.constant("r4", LOCAL + at)
            load(program, inst, "r6", "r4")
            program.case("local", 2)
    for condition, address in places(inst):
        program.constant("r4", address)
        load(program, inst, "r6", "r4")
        program.case(condition)
        # The sum of base and immediate wraps.
        immediate = 0x7FF0 if address < 0x8000 else -0x7FF0
        program.constant("r4", address - immediate)
        load(program, inst, "r6", "r4", immediate)
        program.case("wrapping sum")


def load_registers(program, inst):
    program.table("sources", random_words("sources", 40))
    if "IS_ATOMIC" in inst.flags:
        target = Target(program, 40)
        symbol = target.symbol
    else:
        symbol = "sources+{}".format

    def place(number, d):
        """Of the numbered word; of a word for itself where it cannot be known when it is incremented."""
        return Unchecked(program).symbol() if not d and "IS_ATOMIC" in inst.flags else symbol(4 * number)

    for i, (condition, d, a) in enumerate((("rd = ra", "r4", "r4"), ("rd is r0", "r0", "r4"))):
        program.address("r4", place(i, d != "r0"))
        load(program, inst, d, a)
        if d == "r0":
            program.emit("addi r6, r0, 0")
            program.store("r6")
        program.case(condition)
    load(program, inst, "r6", "r0", FIRST)
    program.case("ra is r0")
    program.fill(lambda n: 0x1000000 + n)
    for operand in "da":
        for number in range(32):
            chosen = {"d": 4, "a": 5} | {operand: number}
            if chosen["d"] == chosen["a"]:
                chosen["d" if operand == "a" else "a"] = 6
            if chosen["a"]:
                program.address(f"r{chosen['a']}", place(number, chosen["d"]))
            load(program, inst, f"r{chosen['d']}", f"r{chosen['a']}", 0 if chosen["a"] else FIRST)
            program.case(f"every r{operand}")
    for number in (9, 0):
        program.reach(64)
        program.fill(lambda n: 0x1000000 * n + n)
        program.address("r12", place(number, number))
        program.emit(inst.text(f"r{number}", "r12"))
        program.store_all()
        program.case("bystanders")


def loading(inst):
    program = new_program(inst)
    load_values(program, inst)
    load_addresses(program, inst)
    load_registers(program, inst)
    program.end()
    return [program]


# --- stores


def store_values(program, inst):
    """Stores each value at each place of a word, whose other bytes keep their values."""
    words = INTEGERS + random_words("stores", 16)
    for at in offsets(inst):
        target = Target(program, len(words))
        for i, word in enumerate(words):
            program.constant("r5", word)
            program.address("r4", target.symbol(4 * i))
            program.emit(inst.text(a="r4", b="r5", i=at))
            program.case("values")
            program.case("alignment")


def read_back(program, address):
    program.constant("r7", address & ~3)
    program.emit("lw r8, 0(r7)")
    program.store("r8")


def store_addresses(program, inst):
    source = random.Random(inst.name)
    target = Target(program, 4 * len(IMMEDIATES))
    for i, immediate in enumerate(IMMEDIATES):
        program.address("r4", f"{target.symbol(16 * i + source.randrange(4, 12, inst.bytes))}-({immediate})")
        program.constant("r5", source.getrandbits(32))
        program.emit(inst.text(a="r4", b="r5", i=immediate))
        program.case("immediate")
    if has_local(inst):
        fill_local(program, [UNWRITTEN] * 128)
        for at in list(range(0, 16, inst.bytes)) + list(range(252, 260,
                                                              inst.bytes)) + list(range(496, 512, inst.bytes)):
            program.constant("r5", source.getrandbits(32))
            program.constant("r4", LOCAL + at)
            program.emit(inst.text(a="r4", b="r5"))
            program.case("local")
        for word in range(128):  # and nothing else has changed
            program.emit(f"lw r6, {LOCAL - 2**32 + 4 * word}(r0)")
            program.store("r6")
    for condition, address in places(inst):
        program.constant("r5", source.getrandbits(32))
        program.constant("r4", address)
        program.emit(inst.text(a="r4", b="r5"))
        read_back(program, address)
        program.case(condition)
        immediate = 0x7FF0 if address < 0x8000 else -0x7FF0
        program.constant("r5", source.getrandbits(32))
        program.constant("r4", address - immediate)
        program.emit(inst.text(a="r4", b="r5", i=immediate))
        read_back(program, address)
        program.case("wrapping sum")


def store_registers(program, inst):
    target = Target(program, 80)
    program.address("r4", target.symbol(0))
    program.emit(inst.text(a="r4", b="r4"))
    program.case("ra = rb")
    program.address("r4", target.symbol(8))
    program.emit(inst.text(a="r4", b="r0"))
    program.case("rb is r0")
    program.constant("r5", 0x12345678)
    program.emit(inst.text(a="r0", b="r5", i=FIRST + 8))
    read_back(program, FIRST + 8)
    program.case("ra is r0")
    program.emit(inst.text(a="r0", b="r0", i=FIRST + 12))
    read_back(program, FIRST + 12)
    program.case("ra = rb is r0")
    program.fill(lambda n: 0x01010101 * n)
    for k, operand in enumerate("ba"):
        for number in range(32):
            chosen = {"b": 4, "a": 5} | {operand: number}
            if chosen["a"] == chosen["b"]:
                chosen["b" if operand == "a" else "a"] = 6
            if chosen["a"]:
                program.address(f"r{chosen['a']}", target.symbol(8 + 4 * (32 * k + number)))
            program.emit(inst.text(a=f"r{chosen['a']}", b=f"r{chosen['b']}", i=0 if chosen["a"] else FIRST + 16))
            program.case(f"every r{operand}")
    read_back(program, FIRST + 16)
    program.reach(64)
    program.fill(lambda n: 0x01010101 * n)
    program.address("r12", target.symbol(4 * 79))
    program.emit(inst.text(a="r12", b="r9"))
    program.store_all()
    program.case("bystanders")


def storing(inst):
    program = new_program(inst)
    store_values(program, inst)
    store_addresses(program, inst)
    store_registers(program, inst)
    program.end()
    return [program]
