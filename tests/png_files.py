"""PNG files of 8 bits a channel, as tests in Python read and write them."""

import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def chunks(data):
    """(kind, content) of each chunk."""
    at = len(SIGNATURE)
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        yield kind, data[at + 8:at + 8 + size]
        at += 12 + size


def unfilter(method, line, above, step):
    """A row of pixels from its filtered bytes and the row above."""
    if method == 0:
        return line
    if method == 2:
        return bytes((value + up) & 255 for value, up in zip(line, above))
    row = bytearray(line)
    for i in range(len(row)):
        left, up, corner = row[i - step] if i >= step else 0, above[i], above[i - step] if i >= step else 0
        if method == 4:
            left = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
        row[i] = (row[i] + ((left + up) // 2 if method == 3 else left)) & 255
    return bytes(row)


def read_png(data):
    """Width, height, and rows of RGB or RGBA bytes."""
    found = list(chunks(data))
    width, height, depth, kind = struct.unpack_from(">IIBB", dict(found)[b"IHDR"])
    assert depth == 8 and kind in (2, 6), f"a PNG of {depth} bits a channel and colour type {kind}"
    step = 3 if kind == 2 else 4
    raw, rows, length = zlib.decompress(b"".join(part for name, part in found if name == b"IDAT")), [], step * width + 1
    for at in range(0, height * length, length):
        rows.append(unfilter(raw[at], raw[at + 1:at + length], rows[-1] if rows else bytes(step * width), step))
    return width, height, rows


def filtered(row, above):
    """The row by the filter with the smallest sum, as encoders choose."""
    ways = (row, bytes((value - (row[i - 3] if i >= 3 else 0)) & 255 for i, value in enumerate(row)),
            bytes((a - b) & 255 for a, b in zip(row, above)))
    method = min(range(3), key=lambda way: sum(min(value, 256 - value) for value in ways[way]))
    return bytes([method]) + ways[method]


def png_of(rows, best=False, channels=3):
    """A PNG of rows of RGB or RGBA bytes; best: RGB, filtered, as small as it gets."""
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", len(rows[0]) // channels, len(rows), 8, 2 if channels == 3 else 6, 0, 0, 0)
    above = [bytes(len(rows[0])), *rows]
    lines = b"".join(filtered(row, before) if best else b"\0" + row for row, before in zip(rows, above))
    packed = zlib.compress(lines, 9 if best else -1)
    return SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")
