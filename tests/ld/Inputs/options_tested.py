"""options_tested.py HELP DIRECTORY...: every option in the help text stands in a RUN, DEFINE or REDEFINE line of a
test."""

import pathlib
import re
import sys

help_text, *directories = sys.argv[1:]
lines = []
for directory in directories:
    for path in pathlib.Path(directory).iterdir():
        if path.is_file() and path.name != "help.test":
            continued = False
            for line in path.read_text(errors="replace").splitlines():
                if continued or re.search(r"\b(RUN|DEFINE):", line):
                    lines.append(line)
                    continued = line.rstrip().endswith("\\")
used = "\n".join(lines)

options = re.findall(r"^  (-{1,2}[\w-]+|@)", pathlib.Path(help_text).read_text(), re.MULTILINE)
assert len(options) > 30, options
# As -Wl, passes it, too; a value may be joined to an option of one letter.
missing = [option for option in options
           if not re.search(rf"(?<![\w-]){re.escape(option)}" + ("" if len(option.strip('-')) == 1 else r"(?![\w-])"),
                            used)]
sys.exit(f"no test uses {', '.join(missing)}" if missing else 0)
