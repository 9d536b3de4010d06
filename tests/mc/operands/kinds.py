#!/usr/bin/env python3
"""Every kind of operand that the description's instructions have is tested with wrong operands: wrong.txt has a section
for each, with cases of each mistake that the kind can have. Prints what is missing there, and what is not refused.

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


def read_cases():
    """{kind: [(mistake, column, statement, message, None for the kind's own)]}"""
    sections, mistake = {}, None
    with open(os.path.join(HERE, "wrong.txt"), encoding="ascii") as file:
        for line in file.read().split("\n\n", 1)[1].splitlines():
            if line.startswith("["):
                cases = sections.setdefault(line[1:line.index("]")], [])
            elif line.startswith("# "):
                mistake = line[2:]
            elif line:
                column, text = line.split(" ", 1)
                statement, _, message = text.partition(" !! ")
                cases.append((mistake, int(column), statement, message or None))
    return sections


def missing_cases(description, kinds, sections):
    missing = []
    for name, kind in sorted(kinds.items()):
        if name not in sections:
            missing.append(f"operand kind {name}: wrong.txt has no section of it")
            continue
        tested = {mistake for mistake, *_ in sections[name]}
        missing += [f"{name}: no case of: {mistake}" for mistake in mistakes_of(description, kind)
                    if mistake not in tested]
        if all(message for *_, message in sections[name]):
            missing.append(f"{name}: no case has the kind's own message")
    return missing


def different(description, kinds, sections, assembler):
    """Whether a case is not refused as wrong.txt says."""
    cases = [(column, statement, message or message_of(description, kinds[name]))
             for name, section in sections.items() for _, column, statement, message in section]
    return every_instruction.refused(assembler, cases, f"of {len(sections)} kinds")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        description = json.load(file)
    kinds = kinds_of(description)
    sections = read_cases()
    missing = missing_cases(description, kinds, sections)
    print("\n".join(missing) or f"{len(kinds)} kinds of operands are tested: {', '.join(sorted(kinds))}")
    wrong = different(description, kinds, sections, sys.argv[2])
    kinds["uimm9"] = kinds.pop("uimm5")
    print("with a new kind:", "; ".join(missing_cases(description, kinds, sections)))
    return bool(missing) or every_instruction.different(description, sys.argv[2]) or wrong


if __name__ == "__main__":
    sys.exit(main())
