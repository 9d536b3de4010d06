"""A thread's own accesses: every load sees the latest store to each of its bytes, whatever the sizes, the instructions
and the places."""

import random

from program import Program

_STORES = {"sb": 1, "sh": 2, "sw": 4, "swnt": 4}
_LOADS = {"lb": 1, "lbu": 1, "lh": 2, "lhu": 2, "lw": 4, "lwnt": 4}
LOCAL = -512


def sizes(program, memory, base):
    """Each store, then each load that overlaps it, at every place in a word: behind one another and with another store
    between."""
    value = random.Random(memory)
    for store, stored in _STORES.items():
        for load, loaded in _LOADS.items():
            for at in range(0, 4, stored):
                for place in range(0, 4, loaded):
                    if place < at + stored and at < place + loaded:
                        program.constant("r5", value.getrandbits(32))
                        program.constant("r7", value.getrandbits(32))
                        program.emit(f"sw r7, {base}(r4)", f"{store} r5, {base + at}(r4)",
                                     f"{load} r6, {base + place}(r4)")
                        program.store("r6")
                        program.case(f"{memory}: a load behind a store")


def sequences(program, memory, base, span):
    """Random stores and loads within a few lines, in bursts that touch, overlap and leave gaps."""
    source = random.Random(f"{memory} sequences")
    stores, loads = list(_STORES), list(_LOADS)
    at = 0
    for _ in range(400):
        if source.random() < 0.55:
            name = source.choice(stores)
            at = source.choice((at, at + 4, at - 4, at + 1, at + 2,
                                source.randrange(span))) % span // _STORES[name] * _STORES[name]
            program.constant("r5", source.getrandbits(32))
            program.emit(f"{name} r5, {base + at}(r4)")
        elif memory == "global" and source.random() < 0.15:
            program.emit(f"ainc r6, {base + at // 4 * 4}(r4)")
            program.store("r6")
            program.case("global: increments among stores and loads")
        else:
            name = source.choice(loads)
            place = source.choice((at, at, source.randrange(span))) // _LOADS[name] * _LOADS[name]
            program.emit(f"{name} r6, {base + place}(r4)")
            program.store("r6")
            program.case(f"{memory}: stores and loads")
    for word in range(0, span, 4):
        program.emit(f"lw r6, {base + word}(r4)")
        program.store("r6")
        program.case(f"{memory}: what is left")


def cached(program):
    """A line that is in the cache, then a store or an increment past it: the next load is not stale."""
    value = random.Random("cached")
    for change in ("sw", "sb", "swnt", "ainc"):
        for reader in ("lw", "lbu", "lwnt"):
            program.constant("r5", value.getrandbits(32))
            program.emit("lw r6, 512(r4)", "lw r6, 516(r4)", f"{change} {'r5' if change != 'ainc' else 'r7'}, 512(r4)")
            if change == "ainc":
                program.store("r7")
            program.emit(f"{reader} r6, 512(r4)")
            program.store("r6")
            program.case("global: a line of the cache")
            # As far away as makes a line of a small direct-mapped cache give way, and back.
            program.emit("lw r6, 512(r9)", "lw r6, 512(r4)")
            program.store("r6")
            program.case("global: a line that had to go")


def programs():
    program = Program("own-accesses", "own accesses")
    program.begin()
    program.address("r4", "scratch")
    program.address("r9", "scratch+0x4000")
    sizes(program, "global", 0)
    sequences(program, "global", 16, 192)
    cached(program)
    program.emit("addi r4, r0, 0")
    sizes(program, "local", LOCAL)
    sequences(program, "local", LOCAL + 16, 192)
    program.end()
    program.sections += ["  .bss", "  .p2align 6", "scratch: .zero 0x5000"]
    return [program]
