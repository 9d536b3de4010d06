"""operands.py DESCRIPTION TRAX_MC: every operand of every instruction, shorthand and pseudo-instruction is refused when
it is wrong, with the message of its kind at its place. Cases and messages follow from the description, which is the
output of llvm-tblgen --dump-json isa/Isa.td."""

import collections
import json
import re
import subprocess
import sys

FEW, MANY, END = "too few operands for instruction", "invalid operand for instruction", "unknown token in expression"
REGISTERS = ["r32", "r100", "r", "r05", "R6x", "a8", "s12", "sp2", "x6", "7", "1.5", "symbol"]


class Operand:
    def __init__(self, description, name, kind, is_base):
        self.name, self.is_base, self.is_register = name, is_base, "RegisterClass" in kind["!superclasses"]
        source = kind if self.is_register else description[kind["ParserMatchClass"]["def"]]
        self.message = "expected a register" if is_base else source["DiagnosticString"]
        self.is_symbol = self.message == "operand must be a symbol"
        self.is_target = kind.get("OperandType") == "OPERAND_PCREL"
        self.low = self.high = None
        limits = re.search(r"range \[(-?\d+), (-?\d+)\]", self.message)
        if limits:
            self.low, self.high = int(limits[1]), int(limits[2])
        elif "integer of 32 bits" in self.message:
            self.low, self.high = -1 << 31, (1 << 32) - 1  # of li, which is a shorthand of addi, too
        elif not self.is_register and not self.is_symbol:
            sys.exit(f"operand kind {kind['!name']}: '{self.message}' names no range")

    def good(self):
        return "r4" if self.is_register else "symbol" if self.is_symbol else str(min(4, self.high))

    def wrong(self, is_offset):
        """Texts that are not of this kind. An offset is followed by "(ra)"."""
        if self.is_register:
            return REGISTERS + ([] if self.is_base else ["-r5", '"r6"', "%lo(symbol)"])
        texts = ["4.5"] + ([] if is_offset else ["r5"])
        if self.is_symbol:
            texts.append("5")
        else:
            step = 4 if self.is_target else 1
            texts += map(str, (self.low - step, self.high + step, -1 << 40, 1 << 40, (1 << 32) + 4))
            texts += ["2", "-1", "4194306"] if self.is_target else ["symbol", "symbol+4"]
        taken = "%lo(symbol) %abs(symbol)" if self.high == (1 << 32) - 1 else self.message
        return texts + [text for text in ("%hi(symbol)", "%lo(symbol)", "%abs(symbol)") if text not in taken]


def kinds_of(instruction):
    """The kinds of an instruction's or of a shorthand's operands, by name."""
    keys = ("ResultInst", ) if "ResultInst" in instruction else ("OutOperandList", "InOperandList")
    return {name: kind["def"] for key in keys for kind, name in instruction[key]["args"] if name}


def operands_of(description, instruction):
    """Mnemonic, and texts and operands in turn as they are written."""
    kinds = kinds_of(instruction)
    mnemonic, _, text = instruction["AsmString"].partition("\t")
    parts = re.split(r"\$\{?(\w+)\}?", text)
    return mnemonic, [part if i % 2 == 0 else Operand(description, part, description[kinds[part]],
                                                      parts[i - 1].endswith("("))
                      for i, part in enumerate(parts)]


def write(mnemonic, parts, wrong=None, text=None):
    """The statement, and the column of the wrong operand."""
    result, column = mnemonic + (" " if len(parts) > 1 else ""), None
    for part in parts:
        if part is wrong:
            column = len(result) + 1
        result += part if isinstance(part, str) else text if part is wrong else part.good()
    return result, column


def cases_of(description, instruction, texts):
    """Statements with column and message. One of the texts may be the instruction with fewer operands."""
    legal = {re.sub(r"\$\{?\w+\}?", "r4", text).replace("\t", " ") for text in texts}
    mnemonic, parts = operands_of(description, instruction)
    operands = [part for part in parts if not isinstance(part, str)]
    shorter = f"{mnemonic}\t$offset" in texts and len(operands) > 1
    for operand in operands:
        is_offset = parts[min(parts.index(operand) + 1, len(parts) - 1)] == "("
        for text in operand.wrong(is_offset):
            statement, column = write(mnemonic, parts, operand, text)
            if shorter and operand is operands[0] and not re.match("[0-9%]", text):
                # A symbol is the whole operand of the shorter form (jal symbol), and the next one too many.
                yield statement, statement.index(",") + 3, MANY
            else:
                yield statement, column, operand.message
    for count in range(len(operands)):
        fewer = write(mnemonic, parts[:2 * count])[0].rstrip(" ,(") if count else mnemonic
        if fewer not in legal:
            yield fewer, 1, FEW
        if count and parts[2 * count] == ", ":
            yield fewer + ",", len(fewer) + 2, END
    statement, _ = write(mnemonic, parts)
    more = statement + (", r5" if operands else " r5")
    yield more, len(more) - 1, MANY


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        description = json.load(file)
    classes = description["!instanceof"]
    instructions = [description[name] for name in classes["TraxInst"] + classes["TraxAsmPseudo"]]
    mnemonics = {instruction["AsmString"].partition("\t")[0] for instruction in instructions}
    # A shorthand that shares its mnemonic with an instruction is judged with the latter.
    aliases = [description[name] for name in classes["InstAlias"]]
    aliases = [alias for alias in aliases if alias["AsmString"].partition("\t")[0] not in mnemonics]
    texts = {description[name]["AsmString"] for name in classes["InstAlias"]}
    cases = [case for instruction in instructions + aliases for case in cases_of(description, instruction, texts)]
    result = subprocess.run([sys.argv[2]], input="".join(f"{statement}\n" for statement, _, _ in cases),
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    errors = collections.defaultdict(list)
    for line in result.stderr.splitlines():
        if ": error: " in line:
            errors[line.split(":")[1]].append(line)
    wrong = 0
    for line, (statement, column, message) in enumerate(cases, 1):
        wanted, got = f"<stdin>:{line}:{column}: error: {message}", errors[str(line)]
        if got != [wanted]:
            wrong += 1
            print(f"{statement}\n  expected {wanted}\n  got      {'; '.join(got) or 'nothing'}")
    print(f"{len(cases)} wrong statements of {len(instructions)} instructions and {len(aliases)} shorthands, "
          f"{wrong} not refused as they should be")
    return wrong != 0 or result.returncode == 0


if __name__ == "__main__":
    sys.exit(main())
