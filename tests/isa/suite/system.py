"""rdsr, trap, fence and halt."""

from program import Program


def read_special(inst, constants):
    """On 2 TMs of 3 TPs, so that no two of the numbers are the same. A thread writes a row of its own; thread 0
    compares."""
    tms, tps, count = 2, 3, constants["TRAX_SR_COUNT"]
    constant_ones = [constants[f"TRAX_SR_{name}"] for name in ("THREAD", "TM", "TP", "THREADS")]
    cycle, cycle_high = constants["TRAX_SR_CYCLE"], constants["TRAX_SR_CYCLEH"]
    if sorted(constant_ones + [cycle, cycle_high]) != list(range(count)):
        raise ValueError("a special register has no test: add it to tests/isa/suite/system.py")
    program = Program(inst.mnemonic, inst.mnemonic, tms, tps)
    program.begin()
    threads, row = tms * tps, 128
    first = program.reserve(threads * row)
    thread = constants["TRAX_SR_THREAD"]
    program.emit(inst.text("r29", i=thread), "slli r28, r29, 9")
    program.address("r27", f"begin_signature+{4 * first}")
    program.emit("add r27, r27, r28")
    at = 0

    def keep(register):
        nonlocal at
        program.emit(f"sw {register}, {4 * at}(r27)")
        at += 1

    for number in constant_ones:
        program.emit(inst.text("r4", i=number))
        keep("r4")
        program.case("every special register")
    for register in [n for n in range(32) if n != 27]:
        program.emit(inst.text(f"r{register}", i=constants["TRAX_SR_TP"]))
        keep(f"r{register}")
        program.case("rd is r0" if register == 0 else "every rd")
    program.emit("addi r26, r27, 0", inst.text("r27", i=constants["TRAX_SR_TP"]), "addi r4, r27, 0", "addi r27, r26, 0")
    keep("r4")
    program.case("every rd")
    # Time never goes back: not within a register, nor in the number that both make. Two reads are at least a cycle
    # apart.
    for _ in range(4):
        program.emit(inst.text("r4", i=cycle_high), inst.text("r5", i=cycle), inst.text("r6", i=cycle_high),
                     inst.text("r7", i=cycle))
        program.emit("sltu r8, r7, r5", "sltu r9, r6, r4", "slt r10, r6, r4", "or r8, r8, r9", "or r8, r8, r10")
        program.emit("sltu r10, r5, r7")
        keep("r8")
        keep("r4")
        keep("r6")
        keep("r10")
        program.case("cycle counters", 3)
    program.case("every special register", 2)
    for number in range(1, 30):
        if number != 27:
            program.constant(f"r{number}", 0x01010101 * number)
    program.emit(inst.text("r9", i=constants["TRAX_SR_THREADS"]))
    for number in range(30):
        if number != 27:  # an address that only this thread has
            keep(f"r{number}")
    program.case("bystanders")
    # The last thread to come here compares.
    program.address("r4", "arrived")
    program.emit("fence rw", "ainc r5, 0(r4)", f"addi r6, r0, {threads - 1}", "beq r5, r6, Llast", "trap r0, exit")
    program.place("Llast")
    program.emit("fence rw")
    program.sections += ['  .section .counter, "aw", @progbits', "arrived: .word 0"]
    program.end()
    return [program]


def trapping(inst, constants):
    """Each code; those that end the thread or the machine have images of their own (faults.py has abort)."""
    codes = {name: constants[f"TRAX_TRAP_{name}"] for name in ("EXIT", "PUTC", "ABORT", "RAYS", "ITEMS", "PUTS",
                                                               "KINDS", "HOST")}
    if sorted(codes.values()) != list(range(constants["TRAX_TRAP_COUNT"])):
        raise ValueError("a trap has no test: add it to tests/isa/suite/system.py")
    program = Program(inst.mnemonic, inst.mnemonic)
    program.begin()
    program.fill(lambda n: 0x40 + n + 0x01010100 * n)
    for number in range(30):
        program.emit(inst.text(a=f"r{number}", i=codes["PUTC"]))
        program.output += bytes([0x40 + number if number else 0])
        program.case("every ra")
    program.case("ra is r0")
    program.emit("addi r28, r31, 0", "addi r29, r30, 0")
    for number in (30, 31):
        program.emit(f"addi r{number}, r0, {0x40 + number}", inst.text(a=f"r{number}", i=codes["PUTC"]))
        program.output += bytes([0x40 + number])
        program.case("every ra")
    program.emit("addi r31, r28, 0", "addi r30, r29, 0")
    program.case("code putc")
    for text in ("one\\n", "", "x" * 70 + "\\n", "abcdefg"):
        label = program.label("text")
        program.data += [f'{label}: .asciz "{text}"']
        program.address("r4", label)
        program.emit(inst.text(a="r4", i=codes["PUTS"]))
        program.output += text.replace("\\n", "\n").encode()
        program.case("code puts")
    for start in (-512, -13, -4):  # in local memory: at its first byte, anywhere, and up to its last byte
        for i, letter in enumerate(b"loc" if start == -4 else b"local"):
            program.emit(f"addi r4, r0, {letter}", f"sb r4, {start + i}(r0)")
        length = 3 if start == -4 else 5
        program.emit(f"sb r0, {start + length}(r0)", f"addi r4, r0, {start}", inst.text(a="r4", i=codes["PUTS"]))
        program.output += b"local"[:length]
        program.case("code puts")
    program.data += [".p2align 2"]
    program.sections += ['  .section .block, "aw", @progbits', "  .p2align 2", "host_call: .word 0, 1, 2, 3, 4, 5"]
    program.address("r4", "host_call")
    program.emit(inst.text(a="r4", i=codes["HOST"]), "lw r5, 0(r4)", "lw r6, 4(r4)")
    program.store("r5")
    program.store("r6")
    program.case("code host")
    # The last words of local memory.
    program.emit("sw r0, -24(r0)", "addi r4, r0, -24", inst.text(a="r4", i=codes["HOST"]), "lw r5, -24(r0)")
    program.store("r5")
    program.case("code host")
    program.fill(lambda n: 0x01010101 * n)
    for name in ("RAYS", "ITEMS", "KINDS"):
        for a in ("r0", "r7"):
            program.emit(inst.text(a=a, i=codes[name]))
            program.case(f"code {name.lower()}")
    program.store_all()
    program.case("bystanders")
    program.end()
    return [program, exits(inst, codes["EXIT"])]


def exits(inst, code):
    """Exit statuses, each in an image of its own. Instructions after the trap have no effect."""
    program = Program(f"{inst.mnemonic}-exit", inst.mnemonic)
    program.checked = False
    program.results = 2
    for status in (0, 1, 42, 255, 256, 0x80000003):
        label = f"status_{status}"
        program.place(label)
        program.address("r31", "begin_signature")
        program.constant("r5", 0x600D)
        program.constant("r7", status)
        program.emit("sw r5, 0(r31)", inst.text(a="r7", i=code), "sw r5, 4(r31)", "halt")
        program.entries[label] = {"code exit": 1}
        program.statuses[label] = status & 0xFF
    return program


def fencing(inst, constants):
    """A fence has no effect within one thread. litmus.py tests its effect on the order of accesses."""
    program = Program(inst.mnemonic, inst.mnemonic)
    program.begin()
    for name in ("R", "W", "RW"):
        kind = constants[f"TRAX_FENCE_{name}"]
        program.reach(64)
        program.fill(lambda n: 0x01010101 * n)
        program.emit(inst.text(i=kind))
        program.store_all()
        program.case("bystanders")
        program.address("r4", "word")
        for before, after in (("sw r5, 0(r4)", "lw r6, 0(r4)"), ("swnt r5, 0(r4)", "lw r6, 0(r4)"),
                              ("lw r6, 0(r4)", "sw r6, 4(r4)"),
                              ("ainc r6, 0(r4)", "lw r7, 0(r4)"), ("ainc r0, 0(r4)", "lw r6, 0(r4)"),
                              ("sw r5, -8(r0)", "lw r6, -8(r0)"),
                              ("fdiv r6, r5, r7", "addi r7, r6, 1"), ("mul r6, r5, r7", "sw r6, 0(r4)")):
            if kind == constants["TRAX_FENCE_R"] and before.startswith("ainc r0"):
                continue  # it waits for results
            program.emit(before, inst.text(i=kind), after)
            for register in ("r6", "r7"):
                program.store(register)
            program.case(f"kind {name.lower()}")
    program.end()
    program.sections += ["  .data", "  .p2align 6", "word: .word 7, 8"]
    return [program]


def halting(inst):
    program = Program(inst.mnemonic, inst.mnemonic, 2, 2)
    program.checked = False
    program.results = 8
    program.place("_start")
    # Each thread ends alone; the others go on.
    program.emit("rdsr r4, thread", "slli r5, r4, 3")
    program.address("r31", "begin_signature")
    program.emit("add r31, r31, r5", "addi r6, r4, 17", "slli r7, r4, 5")
    program.place("Lwait")
    program.emit("addi r7, r7, -1", "bge r7, r0, Lwait", "sw r6, 0(r31)", "halt", "sw r6, 4(r31)", "trap r6, exit")
    program.case("ends the thread", 4)
    return [program]
