"""What ends the machine: each case starts at an entry of its own and has an image for itself, with the same bytes but
for the entry. A case stores the first word of the signature, faults, and stores what must not be seen."""

from memory import LOCAL, MEMORY_END, has_local
from program import Program

NULL_END = 0x1000
STACK_WINDOW = LOCAL - 0x10000  # accesses from here to local memory are a stack that grew too deep
DATA, TEXT = 0x3000, 0x1000


KINDS = {"reserved bits": "illegal", "unknown number": "illegal", "unused opcode": "illegal",
         "unused function": "illegal",
         "code abort": "abort", "local fault": "local"}  # of conditions that are not called like their fault


class FaultProgram(Program):
    def __init__(self, name, of):
        super().__init__(name, of, link=[f"-Ttext={TEXT:#x}", f"-Tdata={DATA:#x}"])
        self.checked = False
        self.results = 6

    def entry(self, label, conditions, lines, constants=()):
        """lines: the fault. constants: registers and their values before."""
        label = label.replace(".", "_").replace("-", "_")
        if label in self.entries:
            raise ValueError(f"{self.name}: two cases {label}")
        self.entries[label] = dict.fromkeys([conditions] if isinstance(conditions, str) else conditions, 1)
        first = conditions if isinstance(conditions, str) else conditions[0]
        self.faults[label] = KINDS.get(first, first)
        self.place(label)
        self.address("r31", "begin_signature")
        self.constant("r29", 0x600D)
        for register, value in constants:
            if isinstance(value, str):
                self.address(register, value)
            else:
                self.constant(register, value)
        self.emit("sw r29, 0(r31)", *lines, "sw r29, 4(r31)", "trap r0, exit")


def legal(word, instructions, limits):
    for inst in instructions:
        if word & inst.mask == inst.match:
            return inst.name not in limits or word & 0xFFFF in limits[inst.name]
    return False


def illegal_words(inst, instructions, limits):
    """{label: (condition, word)}: a reserved field that is not zero, a number that is none of its limits' range."""
    base = inst.match | (~inst.mask & 0x03FFFFFF & (0x01234800 if inst.format != "J" else 0))
    if inst.name in limits:
        base = base & 0xFFFF0000 | limits[inst.name][0]
    words = {}
    for bit in range(32):
        if inst.reserved >> bit & 1:
            words[f"bit{bit}"] = ("reserved bits", base ^ 1 << bit)
    if inst.reserved & (inst.reserved - 1):
        words["all_bits"] = ("reserved bits", base | inst.reserved)
    if inst.name in limits:
        behind = limits[inst.name].stop
        numbers = {behind, behind + 1, 0xFFFF, *range(limits[inst.name].start)} | {
            1 << bit | limits[inst.name].start for bit in range(16) if 1 << bit >= behind}
        for number in sorted(numbers):
            words[f"number{number}"] = ("unknown number", base & 0xFFFF0000 | number)
    for label, (_, word) in words.items():
        if legal(word, instructions, limits):
            raise ValueError(f"{inst.name}: {label} is legal: {word:#010x}")
    return words


def illegal_program(inst, instructions, limits):
    words = illegal_words(inst, instructions, limits)
    program = FaultProgram(f"{inst.mnemonic}-illegal", inst.mnemonic)
    for label, (condition, word) in words.items():
        program.entry(label, condition, [f".word {word:#010x}"])
    return [program] if words else []


def unused_programs(instructions):
    """Opcodes without an instruction, and function codes without one, several words each in one program."""
    used = {inst.opcode for inst in instructions}
    program = FaultProgram("unused-opcodes", "illegal words")
    for opcode in range(64):
        if opcode not in used:
            for fields in (0, 0x01234805):
                program.entry(f"opcode{opcode}_{'fields' if fields else 'zeros'}", "unused opcode",
                              [f".word {opcode << 26 | fields:#010x}"])
    program.entry("ones", "unused opcode", [".word 0xffffffff"])
    programs = [program]
    for opcode in sorted(used):
        there = [inst for inst in instructions if inst.opcode == opcode]
        if not all(inst.has_function for inst in there):
            continue
        functions = {inst.match & 0x3F for inst in there}
        program = FaultProgram(f"unused-functions-{opcode}", "illegal words")
        for function in range(64):
            if function not in functions:
                fields = 0x01230000 if all(inst.format == "R1" for inst in there) else 0x01234800
                program.entry(f"function{function}", "unused function",
                              [f".word {opcode << 26 | fields | function:#010x}"])
        programs.append(program)
    return programs


# --- accesses


def access(inst, immediate=0):
    return inst.text("r6", "r4", "r29", i=immediate)


def access_program(inst):
    """Every kind of fault that the instruction's address can have, at the limits of its range, and which of two comes
    first."""
    program = FaultProgram(f"{inst.mnemonic}-faults", inst.mnemonic)
    program.data += ["constants: .word 1, 2, 3, 4"]
    size = inst.bytes

    def at(label, condition, address, immediate=0):
        base = f"{address}-({immediate})" if isinstance(address, str) else address - immediate
        program.entry(label, condition, [access(inst, immediate)], [("r4", base)])

    at("null_first", "null", 0)
    at("null_last", "null", NULL_END - size)
    at("null_immediate", "null", 8, -32764 // size * size)
    at("unmapped_first", "unmapped", MEMORY_END)
    at("unmapped_middle", "unmapped", 0x80000000)
    at("unmapped_last", "unmapped", STACK_WINDOW - size)
    at("unmapped_immediate", "unmapped", MEMORY_END + 256, 32767 // size * size)
    at("stack_first", "stack", STACK_WINDOW)
    at("stack_last", "stack", LOCAL - size)
    at("stack_zero", "stack", LOCAL - size, LOCAL - size - 2**32)
    if size > 1:
        for k in range(1, size):
            at(f"misaligned_{k}", "misaligned", f"begin_signature+{8 + k}")
            at(f"misaligned_immediate_{k}", "misaligned", f"begin_signature+{8 + k}", k)
            at(f"misaligned_base_{k}", "misaligned", f"begin_signature+{8 + k}", 4)
            at(f"misaligned_local_{k}", "misaligned", LOCAL + 16 + k)
        at("misaligned_end", "misaligned", MEMORY_END - 1)
        at("misaligned_local_end", "misaligned", 2**32 - 1)
        at("null_misaligned", ("null", "order of faults"), NULL_END - 1)
        at("unmapped_misaligned", ("unmapped", "order of faults"), MEMORY_END + 1)
        at("stack_misaligned", ("stack", "order of faults"), LOCAL - 1)
    if inst.flags & {"IS_STORE", "IS_ATOMIC"}:
        at("readonly_data", "readonly", "constants+4")
        at("readonly_text", "readonly", "readonly_text")
        if size < 4:
            at("readonly_middle", "readonly", f"constants+{4 + size}")
        if size > 1:
            at("readonly_misaligned", ("misaligned", "order of faults"), "constants+5")
    if not has_local(inst):
        at("local_first", "local fault", LOCAL)
        at("local_last", "local fault", 2**32 - 4)
    return [program]


# --- fetching


def fetch_program(inst, row):
    """Branches and jumps to where nothing can be executed. The instruction itself has taken effect: the fault is its
    target's."""
    program = FaultProgram(f"{inst.mnemonic}-faults", inst.mnemonic)
    targets = {"null": 0, "null_last": NULL_END - 4, "data": DATA, "rodata": "constants", "behind": "text_end"}
    if inst.format == "I":
        targets |= {"local": LOCAL, "last": 2**32 - 4, "unmapped": MEMORY_END, "far": 0x80000000}
    program.data += ["constants: .word 0xa8000000"]  # halt
    program.sections += ['  .section .zend, "ax", @progbits', "  addi r6, r0, 1", "text_end:"]
    program.link.append("--section-start=.zend=0x2000")
    for name, target in targets.items():
        if inst.format == "B":
            a, b = row.taken
            program.entry(name, "fetch", [inst.text(a="r4", b="r5", p=f"to_{name}")], [("r4", a), ("r5", b)])
            program.sections.append(f"  .set to_{name}, {target}")
        elif inst.format == "J":
            program.entry(name, "fetch", [inst.text("r1", p=f"to_{name}")])
            program.sections.append(f"  .set to_{name}, {target}")
        else:
            program.entry(name, "fetch", [inst.text("r1", "r4")], [("r4", target)])
    if inst.format == "I":
        for k in (1, 2, 3):
            program.entry(f"misaligned_{k}", "misaligned-pc", [inst.text("r1", "r4")], [("r4", f"to_text+{k}")])
            program.entry(f"misaligned_immediate_{k}", "misaligned-pc", [inst.text("r1", "r4", i=k)],
                          [("r4", "to_text")])
        program.entry("misaligned_data", ("misaligned-pc", "order of faults"), [inst.text("r1", "r4")],
                      [("r4", DATA + 2)])
        program.entry("misaligned_null", ("misaligned-pc", "order of faults"), [inst.text("r1", "r4")], [("r4", 1)])
        program.place("to_text")
        program.emit("halt")
    return [program]


def trap_program(inst, constants):
    """The abort trap, and strings that leave memory."""
    program = FaultProgram(f"{inst.mnemonic}-faults", inst.mnemonic)
    program.data += ['message: .asciz "the end"']
    abort, puts = constants["TRAX_TRAP_ABORT"], constants["TRAX_TRAP_PUTS"]
    program.entry("abort", "code abort", [inst.text(a="r4", i=abort)], [("r4", "message")])
    program.entry("abort_odd", "code abort", [inst.text(a="r4", i=abort)], [("r4", "message+1")])
    program.entry("abort_silently", "code abort", [inst.text(a="r0", i=abort)])
    program.entry("abort_nowhere", "code abort", [inst.text(a="r4", i=abort)], [("r4", 0x80000000)])
    for name, address, condition in (("null", 0, "null"), ("null_last", NULL_END - 1, "null"),
                                     ("end", MEMORY_END, "unmapped"),
                                     ("far", 0x80000000, "unmapped"), ("stack", LOCAL - 1, "stack")):
        program.entry(f"puts_{name}", condition, [inst.text(a="r4", i=puts)], [("r4", address)])
    host = constants["TRAX_TRAP_HOST"]
    for name, address, condition in (("null", 0, "null"), ("end", MEMORY_END, "unmapped"),
                                     ("part", MEMORY_END - 20, "unmapped"),
                                     ("stack", LOCAL - 4, "stack"), ("odd", "message+1", "misaligned"),
                                     ("local_end", -20, "unmapped"),
                                     ("constant", "message", "readonly")):
        program.entry(f"host_{name}", condition, [inst.text(a="r4", i=host)], [("r4", address)])
    fill = ["addi r6, r0, 64", f"addi r5, r0, {-16}"] + [f"sb r6, {k}(r5)" for k in range(16)]
    program.entry("puts_local_end", "unmapped", [*fill, inst.text(a="r5", i=puts)])
    program.link.append(f"--section-start=.last={MEMORY_END - 64:#x}")
    program.sections += ['  .section .last, "aw", @progbits', "  .fill 64, 1, 65"]
    program.entry("puts_memory_end", "unmapped", [inst.text(a="r5", i=puts)], [("r5", MEMORY_END - 8)])
    return [program]


def fault_programs(inst, row, instructions, limits, constants):
    programs = illegal_program(inst, instructions, limits)
    if inst.bytes:
        programs += access_program(inst)
    elif "IS_BRANCH" in inst.flags:
        programs += fetch_program(inst, row)
    elif inst.format == "T":
        programs += trap_program(inst, constants)
    return programs
