#!/usr/bin/env python3
"""Every kind of operand that the description's instructions have is tested with wrong operands: a file KIND-invalid.s
beside this one, with a comment line for each mistake that the kind can have, followed by cases. Prints what is missing.

  kinds.py DESCRIPTION MC    from llvm-tblgen --dump-json isa/Isa.td; the assembler

Then it does what every_instruction.py says.
"""

import json
import os
import re
import sys

import every_instruction

HERE = os.path.dirname(os.path.abspath(__file__))


def kinds_of(description):
    """The kinds by name: the message of each, and whether it is a register, has names, is a target."""
    kinds = {}
    classes = description["!instanceof"]
    for name in classes.get("TraxInst", []) + classes.get("TraxAsmPseudo", []):
        instruction = description[name]
        for operands in (instruction["OutOperandList"], instruction["InOperandList"]):
            for operand, _ in operands["args"]:
                kinds[operand["def"]] = description[operand["def"]]
        if re.search(r"\(\$\{", instruction["AsmString"]):
            kinds["memory"] = None  # spelt out in the instructions
    return kinds


def mistakes_of(description, kind):
    """The mistakes that an operand of the kind can have."""
    mistakes = ["wrong kind", "missing", "extra", "modifier"]
    if kind is None:
        return mistakes + ["misspelled"]
    if "RegisterClass" in kind["!superclasses"]:
        return mistakes + ["too large", "misspelled"]
    parser = description[kind["ParserMatchClass"]["def"]]
    if re.search("integer|range", parser["DiagnosticString"]):
        mistakes += ["too small", "too large", "symbol"]
    if parser["ParserMethod"]:
        mistakes += ["misspelled"]
    if kind["OperandType"] == "OPERAND_PCREL":
        mistakes += ["misaligned"]
    return mistakes


def message_of(description, kind):
    if kind is None:
        return "expected a register"
    if "RegisterClass" in kind["!superclasses"]:
        return kind["DiagnosticString"]
    return description[kind["ParserMatchClass"]["def"]]["DiagnosticString"]


def tested(path):
    """The headings of a file that cases follow."""
    headings, heading = set(), None
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("# CHECK:"):
                headings.add(heading)
            elif line.startswith("# "):
                heading = line[2:].strip()
    return headings


def missing_cases(description, kinds):
    missing = []
    for name, kind in sorted(kinds.items()):
        path = os.path.join(HERE, f"{name}-invalid.s")
        if not os.path.exists(path):
            missing.append(f"operand kind {name}: there is no {name}-invalid.s")
            continue
        headings = tested(path)
        missing += [f"{name}-invalid.s: no case of: {mistake}" for mistake in mistakes_of(description, kind)
                    if mistake not in headings]
        with open(path, encoding="ascii") as file:
            if f"error: {message_of(description, kind)}\n" not in file.read():
                missing.append(f"{name}-invalid.s: no case has the kind's own message")
    return missing


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        description = json.load(file)
    kinds = kinds_of(description)
    missing = missing_cases(description, kinds)
    print("\n".join(missing) or f"{len(kinds)} kinds of operands are tested: {', '.join(sorted(kinds))}")
    kinds["uimm9"] = kinds.pop("uimm5")
    print("with a new kind:", "; ".join(missing_cases(description, kinds)))
    return bool(missing) or every_instruction.different(description, sys.argv[2])


if __name__ == "__main__":
    sys.exit(main())
