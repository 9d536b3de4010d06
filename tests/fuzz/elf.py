"""The parts of an object file that are loaded, to compare two objects that should be the same."""

import struct

SHT_SYMTAB, SHT_RELA, SHT_NOBITS = 2, 4, 8
SHF_ALLOC = 2


def read(path):
    """{section name: (flags, alignment, bytes or size of zeros, relocations)} of the allocated sections of a 32-bit
    little-endian object. Relocations are (offset, type, target, addend); a section symbol refers to its
    section. Sections of one name, as COMDAT groups have them, are told apart by their order."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:6] != b"\x7fELF\x01\x01":
        raise ValueError(f"{path}: not a 32-bit little-endian ELF file")
    (table,) = struct.unpack_from("<I", data, 32)
    size, count, names = struct.unpack_from("<HHH", data, 46)
    headers = [struct.unpack_from("<10I", data, table + i * size) for i in range(count)]

    def text(strings, offset):
        start = headers[strings][4] + offset
        return data[start:data.index(b"\0", start)].decode()

    def symbol(symbols, index):
        name, value, _, info, _, section = struct.unpack_from("<IIIBBH", data, headers[symbols][4] + 16 * index)
        if info & 15 == 3:  # STT_SECTION
            return f"{text(names, headers[section][0])}+{value}"
        return text(headers[symbols][6], name)

    relocations = {}
    for header in headers:
        if header[1] != SHT_RELA:
            continue
        entries = struct.iter_unpack("<IIi", data[header[4]:header[4] + header[5]])
        relocations[header[7]] = [(offset, info & 255, symbol(header[6], info >> 8), addend) for offset, info,
                                  addend in entries]
    sections = {}
    for index, (name, kind, flags, _, offset, length, _, _, alignment, _) in enumerate(headers):
        if not flags & SHF_ALLOC:
            continue
        key = base = text(names, name)
        while key in sections:
            key = f"{base} ({len(sections)})"
        content = length if kind == SHT_NOBITS else data[offset:offset + length]
        sections[key] = (flags, alignment, content, relocations.get(index, []))
    return sections


def difference(one, other):
    """None, or how the objects of two paths differ."""
    first, second = read(one), read(other)
    if list(first) != list(second):
        return f"different sections: {' '.join(sorted(set(first) ^ set(second))) or 'another order'}"
    for name, section in first.items():
        for what, mine, theirs in zip(("flags", "alignment", "bytes", "relocations"), section, second[name]):
            if mine != theirs:
                return f"different {what} of section {name}"
    return None
