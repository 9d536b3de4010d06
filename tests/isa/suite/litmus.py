"""Litmus tests of the memory order (docs/isa.md, "Order"): a few accesses of two to four threads, many times with other
delays. The result is the number of outcomes that no rule allows: 0. The allowed outcomes are not counted.

In the names of the tests x and y are words of lines of their own, 0 at first; the threads 0 and 1 belong to one TM, 2
and 3 to another."""

from dataclasses import dataclass

from program import Program

ROUNDS = 48
STRIDE = 256  # bytes for each round's x and y, on new lines
THREADS = 4


@dataclass(frozen=True)
class Test:
    """threads: {number: lines}, with r8, r9 the addresses of x and y, r10, r11 (0 at first) what is observed, r12 = 1,
    r13 = 2. forbidden: [{place: value}]: (thread, "r10"), "x" or "y"."""

    name: str
    rule: str
    threads: dict
    forbidden: list


def _use(register):
    return f"add r0, {register}, r0"


def _wait(address):
    return [f"{{label}}:  lwnt r14, 0({address})", "beq r14, r0, {label}"]


def tests():
    made = []

    def add(name, rule, threads, *forbidden):
        made.append(Test(name, rule, threads, list(forbidden)))

    for where, writer, reader in (("of one TM", 0, 1), ("of two TMs", 0, 2), ("of two TMs, downwards", 3, 1)):
        old_data = {(reader, "r10"): 1, (reader, "r11"): 0}
        look = ["lwnt r10, 0(r9)", _use("r10"), "lwnt r11, 0(r8)"]

        def pair(name, rule, first, second, *forbidden):
            add(f"{name}, threads {where}", rule, {writer: first, reader: second}, *forbidden)

        # fence w waits for stores; a result that is used is there.
        for store in ("sw", "swnt"):
            pair(f"message passing, {store}", "fence w waits for stores",
                 [f"{store} r12, 0(r8)", "fence w", f"{store} r12, 0(r9)"], look,
                 old_data)
        pair("message passing, a byte of it", "fence w waits for stores", ["sb r12, 3(r8)", "fence w", "sh r12, 0(r9)"],
             look, old_data)
        pair("message passing, fence rw", "fence rw waits for stores", ["sw r12, 0(r8)", "fence rw", "sw r12, 0(r9)"],
             look, old_data)
        pair("two stores each", "fence w waits for stores", ["sw r12, 0(r8)", "fence w", "sw r13, 0(r9)"],
             ["swnt r12, 0(r9)", "fence w", "swnt r13, 0(r8)"], {"x": 1, "y": 1})
        pair("a store behind what was seen", "fence w waits for stores", ["sw r13, 0(r8)", "fence w", "sw r12, 0(r9)"],
             ["lwnt r10, 0(r9)", _use("r10"), "sw r12, 0(r8)"], {(reader, "r10"): 1, "x": 2})
        pair("an increment behind a store", "fence w waits for stores", ["sw r12, 0(r8)", "fence w", "ainc r10, 0(r9)"],
             look, old_data)
        pair("a store behind an increment", "an increment waited for is performed",
             ["ainc r10, 0(r8)", _use("r10"), "sw r12, 0(r9)"], look,
             old_data)
        for register in ("r10", "r0"):
            pair(f"a store behind an increment into {register}", "fence w waits for increments",
                 [f"ainc {register}, 0(r8)", "fence w", "sw r12, 0(r9)"], look, old_data)
        pair("a store behind an increment", "fence r waits for increments",
             ["ainc r10, 0(r8)", "fence r", "sw r12, 0(r9)"], look, old_data)
        # Loads that are used, or waited for by a fence.
        both = {(writer, "r10"): 1, (reader, "r10"): 1}
        pair("load buffering, used", "a result used is a load performed",
             ["lwnt r10, 0(r8)", _use("r10"), "sw r12, 0(r9)"],
             ["lwnt r10, 0(r9)", _use("r10"), "sw r12, 0(r8)"], both)
        for load in ("lwnt", "lw"):
            for kind in ("r", "w", "rw"):
                pair(f"load buffering, {load}", f"fence {kind} waits for loads",
                     [f"{load} r10, 0(r8)", f"fence {kind}", "sw r12, 0(r9)"],
                     [f"{load} r10, 0(r9)", f"fence {kind}", "sw r12, 0(r8)"], both)
        pair("message passing", "fence r waits for loads", ["sw r12, 0(r8)", "fence w", "sw r12, 0(r9)"],
             ["lwnt r10, 0(r9)", "fence r", "lwnt r11, 0(r8)"], old_data)
        # The cache is emptied.
        for kind in ("r", "rw"):
            pair("message passing to a cache", f"fence {kind} empties the cache",
                 ["sw r12, 0(r8)", "fence w", "sw r12, 0(r9)"],
                 ["lw r14, 0(r8)", _use("r14"), "lwnt r10, 0(r9)", f"fence {kind}", "lw r11, 0(r8)"], old_data)
            pair("message passing of an increment to a cache", f"fence {kind} empties the cache",
                 ["ainc r0, 0(r8)", "fence w", "sw r12, 0(r9)"],
                 ["lw r14, 0(r8)", _use("r14"), "lwnt r10, 0(r9)", f"fence {kind}", "lbu r11, 0(r8)"], old_data)
        pair("message waited for", "stores are performed in finite time", ["sw r12, 0(r8)", "fence w", "sw r12, 0(r9)"],
             ["lw r14, 0(r8)", *_wait("r9"), "fence r", "lw r11, 0(r8)"], {(reader, "r11"): 0})
        pair("an answer waited for", "stores are performed in finite time",
             ["sw r12, 0(r8)", *_wait("r9"), "lwnt r11, 0(r8)"],
             [*_wait("r8"), "sw r12, 0(r9)"], {(writer, "r11"): 0})
        # Both directions.
        none = {(writer, "r10"): 0, (reader, "r10"): 0}
        for kinds, load in ((("w",), "lwnt"), (("rw",), "lwnt"), (("rw",), "lw"), (("w", "r"), "lw")):
            fences = [f"fence {kind}" for kind in kinds]
            pair(f"store buffering, {', '.join(fences)}, {load}", f"{fences[0]} waits for stores",
                 ["lw r14, 0(r9)", "sw r12, 0(r8)", *fences, f"{load} r10, 0(r9)"],
                 ["lw r14, 0(r8)", "sw r12, 0(r9)", *fences, f"{load} r10, 0(r8)"], none)
        # One word.
        pair("coherence of loads", "accesses to one word keep their order", ["sw r12, 0(r8)", "sw r13, 0(r8)"],
             ["lwnt r10, 0(r8)", "lwnt r11, 0(r8)"], old_data, {(reader, "r10"): 2, (reader, "r11"): 0},
             {(reader, "r10"): 2, (reader, "r11"): 1}, {"x": 1})
        for load in ("lw", "lwnt", "lbu"):
            pair(f"a load and the thread's later store, {load}", "accesses to one word keep their order",
                 [f"{load} r10, 0(r8)", "sw r12, 0(r8)"],
                 [f"{load} r10, 0(r9)", "sb r12, 0(r9)"], {(writer, "r10"): 1}, {(reader, "r10"): 1})
        pair("an increment behind a store to its word", "accesses to one word keep their order",
             ["sw r13, 0(r8)", "ainc r10, 0(r8)"],
             ["lwnt r11, 0(r8)"], {(writer, "r10"): 0}, {(reader, "r11"): 1}, {"x": 2})
        pair("bytes of one word", "a store changes its own bytes", ["sb r12, 0(r8)"], ["sb r13, 1(r8)"], {"x": 0x0001},
             {"x": 0x0200}, {"x": 0})
        pair("increments of one word", "an increment is one step", ["ainc r10, 0(r8)", "ainc r11, 0(r8)"],
             ["ainc r10, 0(r8)", "ainc r11, 0(r8)"],
             *[{(writer, a): n, (reader, b): n} for a in ("r10", "r11") for b in ("r10", "r11") for n in range(4)],
             *[{"x": n} for n in range(4)])
    add("independent reads of independent writes", "there is one order",
        {0: ["sw r12, 0(r8)"], 2: ["sw r12, 0(r9)"], 1: ["lwnt r10, 0(r8)", _use("r10"), "lwnt r11, 0(r9)"],
         3: ["lwnt r10, 0(r9)", _use("r10"), "lwnt r11, 0(r8)"]},
        {(1, "r10"): 1, (1, "r11"): 0, (3, "r10"): 1, (3, "r11"): 0})
    for first, second, third in ((0, 1, 2), (2, 0, 3), (1, 3, 0)):
        add(f"handed on, threads {first}, {second}, {third}", "there is one order",
            {first: ["sw r12, 0(r8)"], second: [*_wait("r8"), "sw r12, 0(r9)"],
             third: [*_wait("r9"), "lwnt r11, 0(r8)"]}, {(third, "r11"): 0})
    add("plain loads behind a message within a TM", "the threads of a TM share its cache",
        {0: ["sw r12, 0(r8)", "fence w", "sw r12, 0(r9)"],
         1: ["lw r14, 0(r8)", _use("r14"), *_wait("r9"), "lw r11, 0(r8)"]}, {(1, "r11"): 0})
    add("plain loads within a TM", "the threads of a TM share its cache",
        {0: ["lw r14, 0(r8)", _use("r14"), "sw r12, 0(r8)", "fence w", "sw r12, 0(r9)"],
         1: ["lw r14, 0(r8)", "lw r10, 0(r9)", _use("r10"), "lw r11, 0(r8)"]}, {(1, "r10"): 1, (1, "r11"): 0})
    return made


def one(test, index, common):
    program = Program(f"litmus-{index}", "memory order", 2, 2)
    program.lines += common
    program.place("_start")
    program.emit("rdsr r4, thread", "addi r5, r0, 0", "addi r12, r0, 1", "addi r13, r0, 2")
    program.address("r6", "words")
    program.address("r7", "seen")
    program.address("r28", "arrived")
    program.emit("slli r14, r4, 3", "add r7, r7, r14", "slli r15, r4, 2", "addi r15, r15, 3")
    program.place("Lround")
    program.emit(f"barrier {THREADS}", "addi r10, r0, 0", "addi r11, r0, 0", "addi r8, r6, 0", "addi r9, r6, 128")
    # A delay of its own for each thread and round.
    program.emit("mul r14, r5, r15", "andi r14, r14, 31")
    program.place("Ldelay")
    program.emit("addi r14, r14, -1", "bge r14, r0, Ldelay")
    for thread, lines in test.threads.items():
        behind, label = program.label(), program.label("Lwait")
        program.emit(f"addi r14, r0, {thread}", f"bne r4, r14, {behind}")
        for line in lines:
            place, colon, rest = line.format(label=label).partition(":  ")
            if colon:
                program.place(place)
            program.emit(rest if colon else place)
        program.emit("jal r0, Lkeep")
        program.place(behind)
    program.place("Lkeep")
    program.emit("addi r14, r0, 12")  # the results are not needed yet: they may come late
    program.place("Llate")
    program.emit("addi r14, r14, -1", "bge r14, r0, Llate")
    program.emit("sw r10, 0(r7)", "sw r11, 4(r7)", f"addi r6, r6, {STRIDE}", "addi r7, r7, 32", "addi r5, r5, 1",
                 f"addi r14, r0, {ROUNDS}",
                 "bne r5, r14, Lround", f"barrier {THREADS}", "beq r4, r0, Lcount", "halt")
    program.place("Lcount")
    program.rebase()
    program.address("r6", "words")
    program.address("r7", "seen")
    program.emit(f"addi r5, r0, {ROUNDS}", "addi r20, r0, 0")
    program.place("Lnext")
    for outcome in test.forbidden:
        allowed = program.label()
        for place, value in outcome.items():
            if isinstance(place, tuple):
                program.emit(f"lwnt r14, {8 * place[0] + (4 if place[1] == 'r11' else 0)}(r7)")
            else:
                program.emit(f"lwnt r14, {0 if place == 'x' else 128}(r6)")
            program.emit(f"addi r15, r0, {value}", f"bne r14, r15, {allowed}")
        program.emit("addi r20, r20, 1")
        program.place(allowed)
    program.emit(f"addi r6, r6, {STRIDE}", "addi r7, r7, 32", "addi r5, r5, -1", "bne r5, r0, Lnext")
    program.store("r20")
    program.case(f"{test.rule}: {test.name}", ROUNDS)
    program.end()
    program.sections += ["  .bss", "  .p2align 8", f"words: .zero {ROUNDS * STRIDE}", f"seen: .zero {ROUNDS * 32}",
                         "  .p2align 6", "arrived: .zero 64"]
    return program


def programs(common):
    return [one(test, index, common) for index, test in enumerate(tests())]
