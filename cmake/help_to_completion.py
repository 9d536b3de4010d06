#!/usr/bin/env python3
"""The completion in bash of what a program says with --help: help_to_completion.py PROGRAM NAME

Options, else files. For the programs of help_to_man.py."""

import re
import subprocess
import sys

SCRIPT = """\
# Completes the options of %(name)s in bash.
_%(function)s() {
  local word=${COMP_WORDS[COMP_CWORD]}
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W '%(options)s' -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "${word//\\\\/}")
  fi
}
complete -o filenames -F _%(function)s %(name)s"""


def main():
    program, name = sys.argv[1:3]
    text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^  +(-\S.*?)(?:  | - |$)", text, re.MULTILINE)
    options = dict.fromkeys(option for row in rows for option in re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", row))
    print(SCRIPT % {"name": name, "function": name.replace("-", "_"), "options": " ".join(options)})


main()
