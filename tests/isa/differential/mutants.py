#!/usr/bin/env python3
"""Do the random programs notice a mistake? Each instruction's statement in the manual, and what it says of the
immediate, is changed in turn, and the model made from that manual must differ from the emulator. Prints the changes
that were not noticed and how many were; exit status 1 if one was not.

  mutants.py --bin build/bin --jobs 2
  mutants.py --bin build/bin --first               one change of each instruction
  mutants.py --bin build/bin --first --every 3     of every third instruction
"""

import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
import interrupts  # noqa: E402
from progress import Progress  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
SECTION = re.compile(r"^### (?P<name>\S+)$(?:(?!^#).)*?(?:^IMM is bits (?P<immediate>.*?)$(?:(?!^#).)*?)?"
                     r"^Semantics: `(?P<statement>.*?)`$", re.MULTILINE | re.DOTALL)

# Each rule makes changes of a statement, one for each place where it applies.
RULES = [
    ("another operator", r"(?<= )(\+|-|\*|&|\||\^|<<|>>)(?= )",
     {"+": "-", "-": "+", "*": "+", "&": "|", "|": "&", "^": "|", "<<": ">>", ">>": "<<"}),
    ("the limit of a comparison", r"(?<= )(<|>=)(?= )", {"<": "<=", ">=": ">"}),
    ("the opposite", r"(?<= )(==|!=|<|>=)(?= )", {"==": "!=", "!=": "==", "<": ">=", ">=": "<"}),
    ("RB for RA", r"\b(RA)\b", {"RA": "RB"}),
    ("RA for RB", r"\b(RB)\b", {"RB": "RA"}),
    ("another mask", r"& (31)", {"31": "15"}),
    ("another distance", r"(?:<<|PC \+|>>) (16|4|32)\b", {"16": "15", "4": "8", "32": "31"}),
    ("without its sign", r"(trax_signed|trax_sext8|trax_sext16)\(",
     {"trax_signed": "", "trax_sext8": "", "trax_sext16": ""}),
    ("another shift or product", r"(trax_sra|trax_mulh)\(", {"trax_sra": "trax_mulh", "trax_mulh": "trax_fmul"}),
    ("another sign", r"(trax_sext8|trax_sext16)\(", {"trax_sext8": "trax_sext16", "trax_sext16": "trax_sext8"}),
    ("another width", r"((?:LOAD|STORE)(?:8|16|32)(?:_NONTEMPORAL)?)\(",
     {"LOAD8": "LOAD16", "LOAD16": "LOAD8", "LOAD32": "LOAD16", "STORE8": "STORE16", "STORE16": "STORE32",
      "STORE32": "STORE16", "LOAD32_NONTEMPORAL": "LOAD16", "STORE32_NONTEMPORAL": "STORE16"}),
    ("no increment", r"(ATOMIC_INC)\(", {"ATOMIC_INC": "LOAD32"}),
    ("another function", r"(trax_f\w+|FPDIV|ISQRT)\(",
     {"trax_fadd": "trax_fsub", "trax_fsub": "trax_fadd", "trax_fmul": "trax_fadd", "trax_fmin": "trax_fmax",
      "trax_fmax": "trax_fmin", "trax_feq": "trax_fle", "trax_flt": "trax_fle", "trax_fle": "trax_flt",
      "trax_fcvt_w_s": "trax_fcvt_wu_s", "trax_fcvt_wu_s": "trax_fcvt_w_s", "trax_fcvt_s_w": "trax_fcvt_s_wu",
      "trax_fcvt_s_wu": "trax_fcvt_s_w", "FPDIV": "trax_fmul", "ISQRT": "trax_fcvt_s_wu"}),
    ("another immediate", r"\b(IMM)\b", {"IMM": "(IMM + 1)"}),
    ("a bit more", r"= ([^=;]+);", None),
    ("nothing", r"^(.*)$", {None: "{ }"}),
]


def changes_of(statement):
    for name, pattern, replacements in RULES:
        for match in re.finditer(pattern, statement):
            found = match[1]
            if replacements is None:
                new = f"{found} + 1" if "NEXT_PC" not in statement[:match.start()] else f"{found} + 4"
            elif None in replacements:
                new = replacements[None]
            elif found in replacements:
                new = replacements[found]
            else:
                continue
            yield name, statement[:match.start(1)] + new + statement[match.end(1):]


# Changes without an effect, by instruction and changed part.
EQUIVALENT = {
    ("lui", "its sign"): "the bits that differ are shifted out",
    ("rdsr", "its sign"): "negative numbers are beyond the limit",
    ("trap", "its sign"): "negative numbers are beyond the limit",
    ("fence", "its sign"): "negative numbers are beyond the limit",
    ("fence", "nothing"): "the engines' memory is one, and always up to date",
    **{(name, "the limit of a comparison"): "equal operands are one number" for name in ("min", "max", "minu", "maxu")},
}


def changes_of_immediate(text):
    """Changes of the text after "IMM is bits "."""
    yield "its sign", re.sub("sign|zero", lambda match: {"sign": "zero", "zero": "sign"}[match[0]], text)
    for pattern, new in ((", times 4", ""), (", times 4", ", times 2"), ("Values of 6", "Values of 3"),
                         ("Values of 4", "Values of 3"), ("below 1", "below 2")):
        if re.search(pattern, text):
            yield "its values", re.sub(pattern, new, text)


def is_noticed(options, manual, begin, end, statement):
    """True, or why not; a statement that has no meaning is no change."""
    with tempfile.NamedTemporaryFile("w", suffix=".md", encoding="utf-8") as file:
        file.write(manual[:begin] + statement + manual[end:])
        file.flush()
        result = subprocess.run([os.path.join(options.bin, "../tests/bin/isa-differential"), "--manual", file.name,
                                 "--stop",
                                 "--seed", str(options.seed), "--count", str(options.count)],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=600, check=False)
    if result.returncode == 1 and "isa-differential:" in result.stderr:
        return None
    return result.returncode == 1 and ": engine " in result.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--bin", required=True, help="directory of the project's programs")
    parser.add_argument("--count", type=int, default=1000, help="random programs for each change")
    parser.add_argument("--seed", type=int, default=1, help="of the first program")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--every", type=int, default=1, help="of the changes every so many (default: all)")
    parser.add_argument("--first", action="store_true", help="one change of each instruction")
    options = parser.parse_args()
    interrupts.end_by_signals()
    with open(os.path.join(HERE, "..", "..", "..", "docs", "isa.md"), encoding="utf-8") as file:
        manual = file.read()
    cases = []
    for section in SECTION.finditer(manual):
        for part, changes in (("statement", changes_of), ("immediate", changes_of_immediate)):
            if section[part] is None:
                continue
            changed = list(dict.fromkeys((text, name) for name, text in changes(section[part])))
            cases += [(section["name"], name, section.start(part), section.end(part), text)
                      for text, name in changed[:1 if options.first else None]
                      if (section["name"], name) not in EQUIVALENT]
    cases = cases[::options.every]
    noticed, unnoticed, progress = 0, [], Progress(len(cases))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = pool.map(lambda case: is_noticed(options, manual, *case[2:]), cases)
        for case, result in zip(cases, results):
            if result is None:
                continue
            noticed += result
            if not result:
                unnoticed.append(f"{case[0]}: {case[1]}: {case[4]}")
            progress.show(noticed + len(unnoticed), f"changes, {len(unnoticed)} not noticed")
    progress.clear()
    for line in unnoticed:
        print(f"not noticed: {line}")
    print(f"{noticed} of {noticed + len(unnoticed)} changes of {len({case[0] for case in cases})} instructions noticed")
    return bool(unnoticed)


if __name__ == "__main__":
    sys.exit(main())
