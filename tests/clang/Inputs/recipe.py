"""Runs a recipe of docs/compiler.md as it stands there: recipe.py PAGE DIR HEADING...

Under each `### HEADING`, in their order: a block `sh recipe` is run by a shell that stops at the first error; of any
other block the first line, `# NAME`, says which file it is. DIR in both is the installation."""

import re
import subprocess
import sys

page, directory, *headings = sys.argv[1:]
with open(page, encoding="utf-8") as file:
    text = file.read()
for heading in headings:
    section = re.search(rf"^### {re.escape(heading)}\n(.*?)(?=^##|\Z)", text, re.M | re.S)
    blocks = re.findall(r"^```(\w+)(?: recipe)?\n(.*?)^```", section[1] if section else "", re.M | re.S)
    if not blocks:
        sys.exit(f"recipe.py: {page} has no recipe '{heading}'")
    for kind, block in blocks:
        block = re.sub(r"\bDIR\b", directory, block)
        if kind == "sh":
            subprocess.run(["sh", "-ec", block], check=True)
        else:
            with open(re.match(r"# (\S+)\n", block)[1], "w", encoding="utf-8") as file:
                file.write(block)
