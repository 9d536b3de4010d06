"""Pictures: written as PNG, and compared (RFC 2083)."""

import struct
import zlib

from .util import Problem

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def png(picture, pixels):
    """Writes a manifest's picture, R, G, B, A bytes, row by row, as a PNG."""
    width, height = picture["width"], picture["height"]
    if picture["layout"] != "rgba uint8":
        raise Problem(f"the picture is of {picture['layout']}, not of bytes")

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + pixels[4 * width * row:4 * width * (row + 1)] for row in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")


def rows_of(data):
    """Size and rows of a picture that png() wrote."""
    width, height = struct.unpack(">II", data[16:24])
    place, packed = len(SIGNATURE), b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        packed += data[place + 8:place + 8 + size] if kind == b"IDAT" else b""
        place += 12 + size
    rows = zlib.decompress(packed)
    return (width,
            height), [memoryview(rows)[row * (4 * width + 1) + 1:(row + 1) * (4 * width + 1)] for row in range(height)]


def pixels_that_differ(one, other):
    """Counts the pixels that differ between two of our pictures (paths); None for pictures of two sizes."""
    if one == other:
        return 0
    (size, rows), (other_size, other_rows) = rows_of(one.read_bytes()), rows_of(other.read_bytes())
    if size != other_size:
        return None
    return sum(a != b for row, beside in zip(rows, other_rows) if row != beside
               for a, b in zip(pixels_of(row), pixels_of(beside)))


def pixels_of(row):
    return memoryview(bytes(row)).cast("I")
