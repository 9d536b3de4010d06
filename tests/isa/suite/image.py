"""The little of ELF that the suite changes in an image of its own linker: the entry, and words of a segment."""

import struct


class Image:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.bytes = bytearray(file.read())
        self.segments = []
        offset, size, count = struct.unpack_from("<I", self.bytes, 28)[0], *struct.unpack_from("<HH", self.bytes, 42)
        for i in range(count):
            kind, file_offset, address, _, file_bytes = struct.unpack_from("<5I", self.bytes, offset + i * size)
            if kind == 1:
                self.segments.append((address, file_offset, file_bytes))
        self.symbols = {}
        sections = [struct.unpack_from("<10I", self.bytes, struct.unpack_from("<I", self.bytes, 32)[0] + 40 * i)
                    for i in range(struct.unpack_from("<H", self.bytes, 48)[0])]
        for section in sections:
            if section[1] == 2:  # SHT_SYMTAB
                names = sections[section[6]][4]
                for at in range(section[4], section[4] + section[5], 16):
                    name, value = struct.unpack_from("<II", self.bytes, at)
                    end = self.bytes.index(b"\0", names + name)
                    self.symbols[self.bytes[names + name:end].decode()] = value

    def set_entry(self, address):
        struct.pack_into("<I", self.bytes, 24, address)

    def set_words(self, address, words):
        for start, offset, size in self.segments:
            if start <= address and address + 4 * len(words) <= start + size:
                struct.pack_into(f"<{len(words)}I", self.bytes, offset + address - start, *words)
                return
        raise ValueError(f"no segment has the {4 * len(words)} bytes at {address:#x}")

    def save(self, path):
        with open(path, "wb") as file:
            file.write(self.bytes)
