#!/usr/bin/env python3
"""What would identical code folding save, and what does garbage collection save? Bytes of code in objects.

    llvm-target/bench/folding.py ARCHIVE-OR-OBJECT...

Sections of code are equal if their bytes and their relocations are, the latter by kind, place, addend and the symbol's
name, or the contents of the section that it stands for. That is what linkers fold without further rounds. Each file is
counted by itself."""

import subprocess
import struct
import sys
import tempfile
from collections import defaultdict
from pathlib import Path


def sections_of(data):
    """Of an ELF32 object: (name, flags, type, bytes, link, info) of its sections."""
    at, = struct.unpack_from("<I", data, 0x20)
    size, count, names = struct.unpack_from("<HHH", data, 0x2E)
    headers = [struct.unpack_from("<10I", data, at + i * size) for i in range(count)]
    strings = data[headers[names][4]:]

    def text(offset):
        return strings[offset:strings.index(b"\0", offset)].decode()

    return [(text(h[0]), h[2], h[1], data[h[4]:h[4] + h[5]] if h[1] != 8 else b"", h[6], h[7]) for h in headers]


def code_of(data):
    """(contents that decide, bytes) of each section of code."""
    sections = sections_of(data)
    found = {i: [s[3], []] for i, s in enumerate(sections) if s[1] & 4 and s[3]}
    for section in sections:
        if section[2] != 4 or section[5] not in found:
            continue
        symbols, strings = sections[section[4]][3], sections[sections[section[4]][4]][3]
        for at in range(0, len(section[3]), 12):
            offset, info, addend = struct.unpack_from("<IIi", section[3], at)
            name, value, _, kind, _, index = struct.unpack_from("<IIIBBH", symbols, 16 * (info >> 8))
            place = sections[index][3] + bytes([
                value & 255]) if kind & 15 == 3 and index < len(sections) else strings[name:strings.index(b"\0", name)]
            found[section[5]][1].append((offset, info & 255, addend, place))
    return [((contents, tuple(sorted(places))), len(contents)) for contents, places in found.values()]


def members(path):
    """The objects of an archive, or the file."""
    if path.read_bytes()[:7] != b"!<arch>":
        return [path.read_bytes()]
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run(["ar", "x", str(path.resolve())], cwd=scratch, check=True)
        return [member.read_bytes() for member in sorted(Path(scratch).iterdir())]


def main():
    print(f"{'bytes of code':40} {'sections':>8} {'bytes':>9} {'folded':>7} {'share':>6}")
    for name in sys.argv[1:]:
        groups = defaultdict(list)
        for data in members(Path(name)):
            for key, size in code_of(data):
                groups[key].append(size)
        total = sum(sum(sizes) for sizes in groups.values())
        folded = sum(sum(sizes[1:]) for sizes in groups.values())
        print(
            f"{Path(name).name:40} {sum(map(len, groups.values())):8} {total:9} {folded:7} "
            f"{100 * folded / max(total, 1):5.2f}%"
        )


if __name__ == "__main__":
    main()
