#!/usr/bin/env python3
"""Mutants of the instructions' statements: writes trax/semantics.inc with every mutant as a case, and the list of them.

    statements.py SEMANTICS INSTRUCTIONS OUT_SEMANTICS OUT_LIST

SEMANTICS and INSTRUCTIONS are the tables that trax-isa-gen makes from the description. A statement is changed by rules
over its text, so that an instruction that is added has its mutants too; one that has none is an error.
"""

import re
import sys

SIGNED = r"trax_signed\((\w+)\)"

# The statement does not contain their effects: decode.c and machine.c have their other mutants.
CALLS = {"RD = SPECIAL_REGISTER(IMM);", "TRAP(RA, IMM);", "HALT();", "FENCE(IMM);", "RD = ATOMIC_INC(RA + IMM);"}

COMMUTATIVE = re.compile(r"trax_(mulh|fadd|fmul|fmin|fmax|feq)\(")

# Operators that may be mistaken for each. Commutative operands are not exchanged.
OPERATORS = {
    " + ": [" - ", " | "],
    " - ": [" + ", " ^ "],
    " & ": [" | ", " ^ "],
    " | ": [" & ", " ^ "],
    " ^ ": [" & ", " | "],
    " * ": [" + "],
    " << ": [" >> "],
    " >> ": [" << "],
    " < ": [" <= ", " > "],
    " >= ": [" > ", " < "],
    " == ": [" != "],
    " != ": [" == "],
}

# Regular expression, replacement, description of the fault.
REWRITES = [
    (r"\bRA\b", "RB", "rb is read for ra"),
    (r"\bRB\b", "RA", "ra is read for rb"),
    (r"\bRA\b", "0", "ra reads as 0"),
    (r"\bRB\b", "0", "rb reads as 0"),
    (r"\bRA\b", "(RA & 0xFFFFu)", "the upper half of ra is lost"),
    (r"\bRA\b", "(RA & 0x7FFFFFFFu)", "bit 31 of ra is lost"),
    (r"\bRB\b", "(RB & 0x7FFFFFFFu)", "bit 31 of rb is lost"),
    (r"\bIMM\b", "0", "the immediate is 0"),
    (r"\bIMM\b", "(IMM + 1)", "the immediate is one more"),
    (r"= PC \+ IMM", "= IMM", "the target is absolute"),
    (r"= PC \+ IMM", "= PC + IMM + 4", "the target counts from the next instruction"),
    (r"= RA \+ IMM", "= PC + RA + IMM", "the target is relative"),
    (r"= RA \+ IMM", "= (RA + IMM) & ~3u", "the lowest bits of the target are dropped"),
    (r"= PC \+ 4", "= PC", "the link is the instruction itself"),
    (r"= PC \+ 4", "= PC + 8", "the link is one instruction late"),
    (r"RB & 31", "RB & 15", "only four bits of the shift amount count"),
    (r"(\w+) << \(RB & 31\)", r"(RB > 31 ? 0 : \1 << (RB & 31))",
     "shift amounts of 32 and more are not taken modulo 32"),
    (r"(\w+) >> \(RB & 31\)", r"(RB > 31 ? 0 : \1 >> (RB & 31))",
     "shift amounts of 32 and more are not taken modulo 32"),
    (r"trax_sra\(RA, RB & 31\)", "trax_sra(RA, RB > 31 ? 31 : RB)",
     "shift amounts of 32 and more are not taken modulo 32"),
    (r"(\w+) >> \(?(RB & 31|IMM)\b\)?", r"trax_sra(\1, \2)", "copies of the sign are shifted in"),
    (r"trax_sra\((\w+), ([^)]*)\)", r"(\1 >> (\2))", "zeros are shifted in"),
    (r"<< 16", "<< 15", "shifted by 15"),
    (r">> 32", ">> 31", "shifted by 31"),
    (SIGNED + " (<|>=) " + SIGNED, r"\1 \2 \3", "compared as unsigned numbers"),
    (r"\b(RA) (<|>=) (RB|IMM)", r"trax_signed(\1) \2 trax_signed(\3)", "compared as signed numbers"),
    (SIGNED + " (<|>=) " + SIGNED, r"trax_signed(\3) \2 trax_signed(\1)", "the operands are exchanged"),
    (r"\b(RA) (<|>=) (RB|IMM)", r"\3 \2 \1", "the operands are exchanged"),
    (r"RA - RB", "RB - RA", "the operands are exchanged"),
    (r"RA << \(RB & 31\)", "RB << (RA & 31)", "the operands are exchanged"),
    (r"RA >> \(RB & 31\)", "RB >> (RA & 31)", "the operands are exchanged"),
    (r"\(RA, RB\)", "(RB, RA)", "the operands are exchanged"),
    (r"trax_mulh\((\w+), (\w+)\)", r"(uint32_t)(((uint64_t)\1 * \2) >> 32)", "the product is unsigned"),
    (r"trax_mulh\((\w+), (\w+)\)", r"(uint32_t)((uint64_t)((int64_t)trax_signed(\1) * (int64_t)\2) >> 32)",
     "the second factor is unsigned"),
    (r"\(uint32_t\)\(\(\(uint64_t\)RA \* RB\) >> 32\)", "trax_mulh(RA, RB)", "the product is signed"),
    (r"\(uint32_t\)\(\(\(uint64_t\)RA \* RB\) >> 32\)", "RA * RB", "the low word of the product"),
    (r"trax_mulh\(RA, RB\)", "RA * RB", "the low word of the product"),
    (r"RA \* RB;", "(RA & 0xFFFFFFu) * (RB & 0xFFFFFFu);", "factors have 24 bits"),
    (r"RA \* RB;", "(uint32_t)(((uint64_t)RA * RB) >> 32);", "the high word of the product"),
    (r"GROUP_A\(", "GROUP_B(", "a register behind rb for one behind ra"),
    (r"GROUP_B\(", "GROUP_A(", "a register behind ra for one behind rb"),
    (r"GROUP_([AB])\((\d)\)", r"GROUP_\1(\2 ^ 1)", "the register beside it"),
    (r"GROUP_([AB])\((\d)\)", r"GROUP_\1(\2 + 8)", "eight registers further"),
    (r"trax_fadd", "trax_fsub", "a difference"),
    (r"trax_fsub", "trax_fadd", "a sum"),
    (r"trax_fmul", "trax_fdiv", "a quotient"),
    (r"FPDIV", "trax_fmul", "a product"),
    (r"trax_fmin", "trax_fmax", "the greater operand"),
    (r"trax_fmax", "trax_fmin", "the lesser operand"),
    (r"trax_flt", "trax_fle", "less or equal"),
    (r"trax_fle", "trax_flt", "less"),
    (r"trax_feq\((\w+), (\w+)\)", r"(\1 == \2)", "the words are compared"),
    (r"trax_fcvt_w_s", "trax_fcvt_wu_s", "unsigned"),
    (r"trax_fcvt_wu_s", "trax_fcvt_w_s", "signed"),
    (r"trax_fcvt_s_w\b", "trax_fcvt_s_wu", "unsigned"),
    (r"trax_fcvt_s_wu", "trax_fcvt_s_w", "signed"),
    (r"trax_sext(?:8|16)(\(LOAD\d+\(RA \+ IMM\)\))", r"\1", "zeros above"),
    (r"trax_sext8", "trax_sext16", "extended from bit 15"),
    (r"trax_sext16", "trax_sext8", "extended from bit 7"),
    (r"= LOAD8\(RA \+ IMM\)", "= trax_sext8(LOAD8(RA + IMM))", "sign extended"),
    (r"= LOAD16\(RA \+ IMM\)", "= trax_sext16(LOAD16(RA + IMM))", "sign extended"),
    (r"LOAD8\(", "LOAD16(", "a half word is loaded"),
    (r"LOAD16\(", "LOAD8(", "a byte is loaded"),
    (r"LOAD32(_NONTEMPORAL)?\(", "LOAD16(", "a half word is loaded"),
    (r"STORE8\(", "STORE16(", "a half word is stored"),
    (r"STORE16\(", "STORE8(", "a byte is stored"),
    (r"STORE16\(", "STORE32(", "a word is stored"),
    (r"STORE32(_NONTEMPORAL)?\(", "STORE16(", "a half word is stored"),
    (r"((?:LOAD|STORE)8)\(RA \+ IMM", r"\1((RA + IMM) ^ 1", "the other byte of the half word"),
    (r"((?:LOAD|STORE)8)\(RA \+ IMM", r"\1((RA + IMM) ^ 3", "the bytes of a word are counted from the top"),
    (r"((?:LOAD|STORE)16)\(RA \+ IMM", r"\1((RA + IMM) ^ 2", "the other half word of the word"),
    (r"((?:LOAD|STORE)32(?:_NONTEMPORAL)?)\(RA \+ IMM", r"\1((RA + IMM) ^ 4", "the other word of two"),
    (r"LOAD16(\(RA \+ IMM\))", r"(LOAD16\1 << 8 | LOAD16\1 >> 8)", "big endian"),
    (r"(LOAD32(?:_NONTEMPORAL)?\(RA \+ IMM\))", r"__builtin_bswap32(\1)", "big endian"),
    (r"STORE16\(RA \+ IMM, RB\)", "STORE16(RA + IMM, RB << 8 | (RB >> 8 & 0xFF))", "big endian"),
    (r"STORE32(_NONTEMPORAL)?\(RA \+ IMM, RB\)", "STORE32(RA + IMM, __builtin_bswap32(RB))", "big endian"),
    (r"((?:LOAD|STORE)\d+(?:_NONTEMPORAL)?)\(RA \+ IMM",
     r"\1((RA + IMM >= 0xFFFFFE00u ? RA + IMM : (RA + IMM) & ~0x40u)",
     "bit 6 of global addresses is lost"),
    (r"((?:LOAD|STORE)\d+(?:_NONTEMPORAL)?)\(RA \+ IMM",
     r"\1((RA + IMM >= 0xFFFFFE00u ? (RA + IMM) & ~0x100u : RA + IMM)",
     "bit 8 of local addresses is lost"),
]

SPECIAL_REGISTERS = [
    (0, "tp->number", "thread is tp"),
    (0, "tm->number", "thread is tm"),
    (0, "SPECIAL_REGISTER(0) + 1", "thread counts from 1"),
    (0, "tp->number * tm->config->chip.tms + tm->number", "thread counts the TMs first"),
    (1, "0", "tm is 0"),
    (1, "tm->number + 1", "tm counts from 1"),
    (2, "0", "tp is 0"),
    (2, "tp->number + 1", "tp counts from 1"),
    (2, "SPECIAL_REGISTER(0)", "tp is thread"),
    (3, "tm->tps", "threads is the number of a TM's"),
    (3, "tm->config->chip.tms", "threads is the number of TMs"),
    (3, "SPECIAL_REGISTER(3) - 1", "threads is the highest thread"),
    (4, "0", "cycle is 0"),
    (4, "~(uint32_t)t", "cycle counts down"),
    (4, "(uint32_t)t & 0xFu", "cycle has four bits"),
    (5, "1", "cycleh is 1"),
    (5, "(uint32_t)t", "cycleh is cycle"),
]

TRAPS = [
    (0, "", "exit is ignored"),
    (1, "", "putc is ignored"),
    (1, "TRAP(RA + 1, 1);", "putc writes the next character"),
    (2, "", "abort is ignored"),
    (2, "TRAP(0, 0);", "abort is exit"),
    (3, "", "rays is ignored"),
    (3, "TRAP(RA, 4);", "rays counts items"),
    (4, "", "items is ignored"),
    (4, "TRAP(RA, 3);", "items counts rays"),
    (5, "", "puts is ignored"),
    (5, "TRAP(RA + 1, 5);", "puts begins a byte late"),
    (6, "", "kinds is ignored"),
    (6, "TRAP(RA, 3);", "kinds counts rays"),
]


def rewrite(statement, flags):
    """Every operator and every rule of REWRITES, at every place where it applies."""
    if statement in CALLS:
        return
    for operator, others in OPERATORS.items():
        for match in re.finditer(re.escape(operator), statement):
            for other in others:
                if "trax_signed" in statement and other.strip(
                ) in "|^&" or "(uint64_t)" in statement and other == " << ":
                    continue
                yield statement[:match.start()] + other + statement[match.end(
                ):], f"{other.strip()} for {operator.strip()}"
    for pattern, replacement, what in REWRITES:
        if "rb is read" in what and "TRAX_READS_RB" not in flags or "exchanged" in what and COMMUTATIVE.search(
                statement):
            continue
        for match in re.finditer(pattern, statement):
            yield statement[:match.start()] + match.expand(replacement) + statement[match.end():], what


def conditions(statement):
    match = re.fullmatch(r"if \((.*)\) (.*)", statement)
    if match:
        yield match[2], "the condition always holds"
        yield "", "the condition never holds"


def results(statement, flags):
    """Yields changes of any result."""
    if "TRAX_WRITES_RD" not in flags or "ATOMIC_INC" in statement:
        return
    yield f"const uint32_t kept = RD; {statement} RD = kept;", "rd is not written"
    yield (f"const uint32_t kept = RD; {statement} const uint32_t result = RD; RD = kept; "
           "if (inst->rd) tp->reg[inst->rd ^ 1] = result;"), "the register beside rd is written"
    yield f"{statement} if (inst->rd == 0) trax_keep_r0(tp->reg, RD);", "r0 keeps what is written to it"
    yield f"{statement} RD ^= 1;", "the lowest bit of the result is inverted"
    if re.search(r"RD = [^;]*( < |trax_f(eq|lt|le)\()", statement):
        yield f"{statement} RD = -RD;", "true is all ones"
    else:
        yield f"{statement} RD &= 0x7FFFFFFFu;", "bit 31 of the result is lost"
    if "TRAX_IS_BRANCH" not in flags:
        yield f"{statement} NEXT_PC = PC + 8;", "the next instruction is left out"


def stores(statement):
    match = re.fullmatch(r"STORE\d+(_NONTEMPORAL)?\(RA \+ IMM, RB\);", statement)
    if match:
        yield "(void)0;", "nothing is stored"
        yield f"{statement} NEXT_PC = PC + 8;", "the next instruction is left out"


def memory(statement):
    if re.search(r"\b(LOAD|STORE)\d+(_NONTEMPORAL)?\(", statement):
        yield f"struct trax_ref_tp *const own = tp; tp = &tm->tp[0]; {mine(statement)}", \
            "all threads have the first one's local memory"


def mine(statement):
    """With the registers of `own`, memory of `tp`."""
    for name, field in (("RD", "rd"), ("RA", "ra"), ("RB", "rb")):
        statement = re.sub(rf"\b{name}\b", f"own->reg[inst->{field}]", statement)
    return statement + " tp = own;"


def own_rules(statement):
    """Statements that are only a call."""
    if statement == "RD = SPECIAL_REGISTER(IMM);":
        for number, value, what in SPECIAL_REGISTERS:
            yield f"RD = IMM == {number} ? {value} : SPECIAL_REGISTER(IMM);", what
    elif statement == "TRAP(RA, IMM);":
        for code, instead, what in TRAPS:
            yield f"if (IMM == {code}) {{ {instead} }} else TRAP(RA, IMM);", what
        yield "TRAP(RA, IMM); if (IMM != 0 && !fault) NEXT_PC = PC + 8;", "the next instruction is left out"
    elif statement == "FENCE(IMM);":
        yield f"{statement} NEXT_PC = PC + 8;", "the next instruction is left out"
        yield f"{statement} reg[5] ^= 1;", "a register is changed"
    elif statement == "HALT();":
        yield "(void)0;", "the thread goes on"
        yield "HALT(); for (uint32_t i = 0; i < tm->tps; i++) if (!tm->tp[i].ended) end(tm, &tm->tp[i], 0);", \
            "all threads of the TM end"
    elif statement == "RD = ATOMIC_INC(RA + IMM);":
        yield f"{statement} NEXT_PC = PC + 8;", "the next instruction is left out"
    elif statement == "NEXT_PC = RA + IMM; RD = PC + 4;":
        yield "RD = PC + 4; NEXT_PC = RA + IMM;", "rd is written before ra is read"


def mutants(statement, flags):
    seen = {statement}
    for rule in (rewrite(statement, flags), conditions(statement), results(statement, flags), stores(statement),
                 memory(statement), own_rules(statement)):
        for changed, what in rule:
            if changed not in seen:
                seen.add(changed)
                yield changed, what


def main():
    semantics, instructions, out_semantics, out_list = sys.argv[1:]
    table = {}
    for line in open(instructions):
        match = re.match(r'TRAX_INSTRUCTION\((\w+), "([^"]*)", "[^"]*", \w+, \w+, \w+, \w+, ([^,]*),', line)
        if match:
            table[match[1]] = match[2], match[3]
    number = 0
    with open(out_semantics, "w") as out, open(out_list, "w") as listing:
        for line in open(semantics):
            match = re.match(r"TRAX_SEMANTICS\((\w+), \{ (.*) \}\)$", line)
            if not match:
                continue
            name, statement = match.groups()
            mnemonic, flags = table.pop(name)
            first = number
            print(f"TRAX_SEMANTICS({name}, {{ switch (trax_mutant) {{", file=out)
            for changed, what in mutants(statement, flags):
                number += 1
                print(f"case {number}: {{ {changed} }} break;", file=out)
                print(f'STATEMENT_MUTANT("{mnemonic}", "{what}")', file=listing)
            print(f"default: {{ {statement} }} break; }} }})", file=out)
            if number == first:
                sys.exit(f"{name}: no rule of {sys.argv[0]} applies to '{statement}'")
    if table:
        sys.exit(f"no semantics of {', '.join(sorted(table))}")


main()
