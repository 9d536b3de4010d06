#!/usr/bin/env python3
"""A page for man(1) of what a program says with --help: help_to_man.py PROGRAM NAME SUMMARY VERSION [SEE_ALSO]"""

import re
import subprocess
import sys


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def main():
    program, name, summary, version, *see_also = sys.argv[1:]
    text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    out = [f'.TH {roff(name.upper())} 1 "" "trax {version}"', ".SH NAME", f"{roff(name)} \\- {roff(summary)}",
           ".SH SYNOPSIS"]
    described = listed = in_usage = in_examples = False
    for line in text.splitlines():
        usage = re.match(r"(?:usage|USAGE): *(.*)", line)
        words = line.split()
        option = re.match(r"  +(-\S.*?|@FILE|=\S+)(?:  +- *|   *|  +)(\S.*)$| +(-\S+)$", line)
        if usage or (in_usage and line.startswith("    ")):
            call = usage[1] if usage else line.strip()
            out += [*([".br"] if in_usage else []),
                    f"\\fB{roff(call.split(' ')[0])}\\fR {roff(call.partition(' ')[2])}"]
            in_usage = True
            continue
        in_usage = False
        if line.startswith("OVERVIEW:") or line.strip() == "OPTIONS:":
            continue
        if not words:
            out.append(".PP")
            in_examples = False
        elif line == "Examples:":
            out.append(".SH EXAMPLES")
            in_examples = listed = True
        elif in_examples:
            command, _, meaning = line.partition("#")
            out += [".TP", f"\\fB{roff(command.strip())}\\fR", roff(meaning.strip())]
        elif re.fullmatch(r"\S[^:]*:", line):
            out += [] if listed else [".SH OPTIONS"]
            listed = True
            out.append(f".SS {roff(line[:-1])}")
        elif option:
            out += [] if listed else [".SH OPTIONS"]
            listed = True
            out += [".TP", f"\\fB{roff(option[1] or option[3])}\\fR", roff((option[2] or "").removeprefix("- "))]
        elif re.match(r"  \S+  +\S", line):  # a row of a table, as of the experiments
            what, _, meaning = line.strip().partition("  ")
            out += [".TP", f"\\fB{roff(what)}\\fR", roff(meaning.strip())]
        else:
            out += [] if described or listed else [".SH DESCRIPTION"]
            described = True
            out.append(roff(" ".join(words)))
    out += [".SH SEE ALSO", roff(see_also[0])] if see_also else []
    page = [
        line for number, line in enumerate(out)
        if line and not (line == ".PP" and
                         (number + 1 == len(out) or out[number + 1][:3] in (".PP", ".SH", ".SS", ".TP")))]
    print("\n".join(page))


main()
