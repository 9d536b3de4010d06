"""Every operand of every instruction is refused when it is wrong, with the message of its kind at its place: the cases
and the messages follow from the description."""

import collections
import re
import subprocess

FEW, MANY = "too few operands for instruction", "invalid operand for instruction"
NO_BASE = "expected a register"


class Operand:
    def __init__(self, description, name, kind, is_base):
        self.name, self.is_base, self.is_register = name, is_base, "RegisterClass" in kind["!superclasses"]
        source = kind if self.is_register else description[kind["ParserMatchClass"]["def"]]
        self.message = NO_BASE if is_base else source["DiagnosticString"]
        self.is_target = kind.get("OperandType") == "OPERAND_PCREL"
        limits = re.search(r"range \[(-?\d+), (-?\d+)\]", self.message)
        self.low, self.high = (int(limits[1]), int(limits[2])) if limits else (None, None)

    def good(self):
        return "r4" if self.is_register else str(4 if self.high is None or self.high >= 4 else self.high)

    def wrong(self, is_offset):
        """Texts that are none of this kind. An offset stands before "(ra)"."""
        if self.is_register:
            return ["r32", "r", "sp2", "7", "symbol"] + ([] if self.is_base else ["-r5", "%lo(symbol)"])
        step = 4 if self.is_target else 1
        texts = [str(self.low - step), str(self.high + step), str(-1 << 40), str(1 << 40), "4.5"]
        texts += [] if is_offset else ["r5"]
        texts += ["2", "-1", "4194306"] if self.is_target else ["symbol"]
        for modifier in ("hi", "lo", "abs"):
            texts += [] if f"%{modifier}(symbol)" in self.message else [f"%{modifier}(symbol)"]
        return texts


def operands_of(description, instruction):
    """Mnemonic, and texts and operands in turn as they are written."""
    kinds = {}
    for operands in (instruction["OutOperandList"], instruction["InOperandList"]):
        kinds.update({name: description[kind["def"]] for kind, name in operands["args"]})
    mnemonic, _, text = instruction["AsmString"].partition("\t")
    parts = re.split(r"\$\{?(\w+)\}?", text)
    return mnemonic, [part if i % 2 == 0 else Operand(description, part, kinds[part], parts[i - 1].endswith("("))
                      for i, part in enumerate(parts)]


def write(mnemonic, parts, wrong=None, text=None):
    """The statement, and the column of the wrong operand."""
    result, column = mnemonic + (" " if len(parts) > 1 else ""), None
    for part in parts:
        if part is wrong:
            column = len(result) + 1
        result += part if isinstance(part, str) else text if part is wrong else part.good()
    return result, column


def cases_of(description, instruction, aliases):
    """Statements with column and message. aliases may be the instruction with fewer operands."""
    legal = {re.sub(r"\$\{?\w+\}?", "r4", alias).replace("\t", " ") for alias in aliases}
    mnemonic, parts = operands_of(description, instruction)
    operands = [part for part in parts if not isinstance(part, str)]
    shorter = f"{mnemonic}\t$offset" in aliases
    for operand in operands:
        is_offset = parts[min(parts.index(operand) + 1, len(parts) - 1)] == "("
        for text in operand.wrong(is_offset):
            statement, column = write(mnemonic, parts, operand, text)
            if shorter and operand is operands[0] and text != "7" and not text.startswith("%"):
                # A symbol is the whole operand of the shorter form (jal symbol), and the next one too many.
                yield statement, statement.index(",") + 3, MANY
            else:
                yield statement, column, operand.message
    for count in range(len(operands)):
        fewer = write(mnemonic, parts[:2 * count])[0].rstrip(" ,(") if count else mnemonic
        if fewer not in legal:
            yield fewer, 1, FEW
    statement, _ = write(mnemonic, parts)
    more = statement + (", r5" if operands else " r5")
    yield more, len(more) - 1, MANY


def different(description, assembler):
    """Whether a wrong statement is not refused as it should be."""
    aliases = {description[name]["AsmString"] for name in description["!instanceof"]["InstAlias"]}
    names = description["!instanceof"]["TraxInst"]
    cases = [(column, statement, message) for name in names
             for statement, column, message in cases_of(description, description[name], aliases)]
    return refused(assembler, cases, f"of {len(names)} instructions")


def refused(assembler, cases, what):
    """Whether one of the cases, (column, statement, message), has not this error alone."""
    result = subprocess.run([assembler], input="".join(f"{statement}\n" for _, statement, _ in cases),
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    errors = collections.defaultdict(list)
    for line in result.stderr.splitlines():
        if ": error: " in line:
            errors[line.split(":")[1]].append(line)
    wrong = 0
    for line, (column, statement, message) in enumerate(cases, 1):
        wanted, got = f"<stdin>:{line}:{column}: error: {message}", errors[str(line)]
        if got != [wanted]:
            wrong += 1
            print(f"{statement}\n  expected {wanted}\n  got      {'; '.join(got) or 'nothing'}")
    print(f"{len(cases)} wrong statements {what}, {wrong} not refused as they should be")
    return wrong != 0 or result.returncode == 0
