#!/usr/bin/env python3
"""Link every pair of mentions of a symbol, in both orders, with every pair of visibilities, and look at the executable's.

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


def symbol(readelf, path, name):
    """The binding and the visibility of a symbol."""
    listed = subprocess.run([readelf, "-sW", path], capture_output=True, text=True, check=True).stdout
    for line in listed.splitlines():
        fields = line.split()
        if len(fields) == 8 and fields[7] == name:
            return fields[4], "STV_" + fields[5]
    return None


def main():
    linker, yaml2obj, readelf, source, scratch = sys.argv[1:]

    def assemble(document, visibility="STV_DEFAULT", name="f"):
        path = f"{scratch}.{document}.{visibility}.{name}.o"
        subprocess.run([yaml2obj, f"--docnum={document}", source, f"-DVISIBILITY={visibility}", f"-DNAME={name}", "-o", path],
                       check=True)
        return path

    start = assemble(1)
    objects = {(kind, visibility): assemble(document, visibility)
               for (kind, document), visibility in itertools.product(KINDS.items(), ORDER)}
    failed = linked = 0

    def check(inputs, visibilities, name="f", option=None):
        nonlocal failed, linked
        for relocatable in [False, True] if name == "f" and not option else [False]:
            output = f"{scratch}.out"
            command = [linker, *(["-r"] if relocatable else []), *([option] if option else []), start, *inputs, "-o", output]
            subprocess.run(command, check=True)
            linked += 1
            expected = min(visibilities, key=ORDER.index)
            found = symbol(readelf, output, name)
            is_local = expected in ORDER[:2] and not relocatable
            if not found or found[1] != expected or (found[0] == "LOCAL") != is_local:
                failed += 1
                print(f"{' '.join(command)}: {found}, but {expected} is asked for")

    for (a, first), (b, second) in itertools.product(objects, repeat=2):
        if (a, b) not in {("strong", "strong"), ("reference", "reference")}:
            check([objects[a, first], objects[b, second]], [first, second])
    for option, name in OTHER:
        for first, second in itertools.product(ORDER, repeat=2):
            references = [assemble(KINDS["reference"], visibility, name) for visibility in (first, second)]
            check(references, [first, second], name, option)
    if linked != 2 * 14 * 16 + 2 * 16:
        print(f"{linked} links")
        return 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
