"""The little of ELF that the suite changes in an image of its own linker: the entry, and words of a segment."""

import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from elf_files import LOAD, ElfFile  # noqa: E402


class Image:
    def __init__(self, path):
        self.bytes = bytearray(pathlib.Path(path).read_bytes())
        elf = ElfFile(self.bytes)
        self.segments = [segment for segment in elf.segments if segment.kind == LOAD]
        self.symbols = {symbol.name: symbol.value for symbol in elf.symbols}

    def set_entry(self, address):
        struct.pack_into("<I", self.bytes, 24, address)

    def set_words(self, address, words):
        for segment in self.segments:
            at = address - segment.address
            if 0 <= at <= segment.size - 4 * len(words):
                struct.pack_into(f"<{len(words)}I", self.bytes, segment.offset + at, *words)
                return
        raise ValueError(f"no segment has the {4 * len(words)} bytes at {address:#x}")

    def save(self, path):
        with open(path, "wb") as file:
            file.write(self.bytes)
