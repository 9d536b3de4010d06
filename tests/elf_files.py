"""ELF files of 32 bits, little-endian, as tests in Python read them."""

import collections
import struct

LOAD = 1  # a segment
SYMTAB, RELA, NOBITS, REL = 2, 4, 8, 9
ALLOC, EXECINSTR = 2, 4

Segment = collections.namedtuple("Segment", "kind offset address physical size memory_size flags alignment")
Section = collections.namedtuple("Section", "name kind flags address offset size link info alignment entry_size")
Symbol = collections.namedtuple("Symbol", "name value size info other section")


class ElfFile:
    def __init__(self, data):
        if data[:6] != b"\x7fELF\x01\x01":
            raise ValueError("not a 32-bit little-endian ELF file")
        self.data = data
        programs, sections, _, _, _, program_count, _, count, names = struct.unpack_from("<IIIHHHHHH", data, 28)
        self.segments = [Segment(*struct.unpack_from("<8I", data, programs + 32 * i)) for i in range(program_count)]
        headers = [struct.unpack_from("<10I", data, sections + 40 * i) for i in range(count)]
        self.sections = [Section(self._text(headers[names][4] + name), *rest) for name, *rest in headers]
        self.symbols, self._relocations = [], collections.defaultdict(list)
        for table in self.sections:
            if table.kind == RELA:
                self._relocations[table.info] += struct.iter_unpack("<IIi", self.contents(table))
            if table.kind == SYMTAB:
                strings = self.sections[table.link].offset
                self.symbols = [Symbol(self._text(strings + name), *rest) for name, *rest in
                                struct.iter_unpack("<IIIBBH", data[table.offset:table.offset + table.size])]

    def _text(self, at):
        return bytes(self.data[at:self.data.index(b"\0", at)]).decode()

    def section(self, name):
        """The first one of this name."""
        return next(section for section in self.sections if section.name == name)

    def contents(self, section):
        return b"" if section.kind == NOBITS else bytes(self.data[section.offset:section.offset + section.size])

    def relocations(self, number):
        """(offset, type, target, addend) of each relocation of a section: a section symbol's target is its section."""
        for offset, info, addend in self._relocations[number]:
            symbol = self.symbols[info >> 8]
            yield offset, info & 255, symbol.name or self.sections[symbol.section].name, addend
