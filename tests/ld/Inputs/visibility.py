#!/usr/bin/env python3
"""Link every pair of mentions of a symbol, in both orders, with every pair of visibilities, and look at the
executable's.

    visibility.py TRAX-LD YAML2OBJ LLVM-READELF YAML SCRATCH
"""

import itertools
import subprocess
import sys

# The most constraining first.
ORDER = ["STV_INTERNAL", "STV_HIDDEN", "STV_PROTECTED", "STV_DEFAULT"]
KINDS = {"strong": 2, "weak": 3, "common": 4, "reference": 5}
# Linked by -u or --defsym, and by the layout, instead of a definition in an object.
OTHER = [("--defsym=f=0x333", "f"), (None, "__text_end")]


def symbols(readelf, wanted):
    """The binding and the visibility of a symbol of each file: a dictionary of paths; wanted has the names."""
    listed = subprocess.run([readelf, "-sW", *wanted], capture_output=True, text=True, check=True).stdout
    found, path = {}, None
    for line in listed.splitlines():
        fields = line.split()
        if fields[:1] == ["File:"]:
            path = fields[1]
        elif len(fields) == 8 and fields[7] == wanted[path]:
            found[path] = fields[4], "STV_" + fields[5]
    return found


def main():
    linker, yaml2obj, readelf, source, scratch = sys.argv[1:]

    def assemble(document, visibility="STV_DEFAULT", name="f"):
        path = f"{scratch}.{document}.{visibility}.{name}.o"
        subprocess.run([yaml2obj, f"--docnum={document}", source, f"-DVISIBILITY={visibility}", f"-DNAME={name}", "-o",
                        path],
                       check=True)
        return path

    start = assemble(1)
    objects = {(kind, visibility): assemble(document, visibility)
               for (kind, document), visibility in itertools.product(KINDS.items(), ORDER)}
    linked = []  # output, symbol, expected visibility and whether it is local, command

    def check(inputs, visibilities, name="f", option=None):
        output = f"{scratch}.{len(linked)}.out"
        command = [linker, *([option] if option else []), start, *inputs, "-o", output]
        subprocess.run(command, check=True)
        expected = min(visibilities, key=ORDER.index)
        linked.append((output, name, expected, expected in ORDER[:2], command))

    for (a, first), (b, second) in itertools.product(objects, repeat=2):
        if (a, b) not in {("strong", "strong"), ("reference", "reference")}:
            check([objects[a, first], objects[b, second]], [first, second])
    for option, name in OTHER:
        for first, second in itertools.product(ORDER, repeat=2):
            references = [assemble(KINDS["reference"], visibility, name) for visibility in (first, second)]
            check(references, [first, second], name, option)
    failed = 0
    found = symbols(readelf, {output: name for output, name, *_ in linked})
    for output, _, expected, is_local, command in linked:
        binding, visibility = found.get(output, (None, None))
        if visibility != expected or (binding == "LOCAL") != is_local:
            failed += 1
            print(f"{' '.join(command)}: {binding} {visibility}, but {expected} is asked for")
    if len(linked) != 14 * 16 + 2 * 16:
        print(f"{len(linked)} links")
        return 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
