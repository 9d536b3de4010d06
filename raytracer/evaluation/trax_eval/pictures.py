"""Pictures: written as PNG, and compared (RFC 2083)."""

import struct
import zlib

from .util import FILE_LIMIT, Problem, read_bytes

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 6: 4}  # of the colour types grey, RGB, RGBA


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


def read_png(data):
    """(width, height, channels, bytes of the pixels) of a PNG of 8 bits a channel, not interlaced, as trax writes them.
    Raises ValueError, struct.error or zlib.error."""
    if data[:8] != SIGNATURE:
        raise ValueError("it has another beginning")
    width, height, depth, kind, _, _, interlaced = struct.unpack(">IIBBBBB", data[16:29])
    if depth != 8 or kind not in CHANNELS or interlaced or width * height * 4 > FILE_LIMIT:
        raise ValueError("only pictures of 8 bits a channel, not interlaced, are read")
    if not width * height:
        raise ValueError("it has no pixels")
    place, packed = len(SIGNATURE), []
    while place < len(data):
        size, name = struct.unpack(">I4s", data[place:place + 8])
        packed += [data[place + 8:place + 8 + size]] if name == b"IDAT" else []
        place += 12 + size
    step = CHANNELS[kind]
    unpacking = zlib.decompressobj()
    rows = unpacking.decompress(b"".join(packed), (width * step + 1) * height)
    if len(rows) != (width * step + 1) * height:
        raise ValueError("it ends early")
    return width, height, step, bytes(unfilter(rows, width * step, step))


def unfilter(rows, size, step):
    out, above = bytearray(), bytes(size)
    for begin in range(0, len(rows), size + 1):
        kind, row = rows[begin], bytearray(rows[begin + 1:begin + 1 + size])
        if kind > 4:
            raise ValueError(f"a row has the filter {kind}")
        for place in range(size if kind else 0):
            left, corner = (row[place - step], above[place - step]) if place >= step else (0, 0)
            guess = (left, above[place], (left + above[place]) // 2, nearest(left, above[place], corner))[kind - 1]
            row[place] = (row[place] + guess) & 255
        out += row
        above = row
    return out


def nearest(left, above, corner):
    """Paeth's predictor."""
    guess = left + above - corner
    return min((left, above, corner), key=lambda value: abs(value - guess))


def pixels_that_differ(one, other):
    """Counts the pixels that differ between two of our pictures (paths); None for pictures of two sizes."""
    if one == other:
        return 0
    (*size, pixels), (*other_size, other_pixels) = read_png(one.read_bytes()), read_png(other.read_bytes())
    if size != other_size:
        return None
    if pixels == other_pixels:
        return 0
    return sum(a != b for a, b in zip(memoryview(pixels).cast("I"), memoryview(other_pixels).cast("I")))


def read_rgb(path):
    """(width, height, bytes of R, G, B) of a picture."""
    try:
        width, height, step, pixels = read_png(read_bytes(path))
    except (ValueError, struct.error, zlib.error) as error:
        raise Problem(f"{path}: is no PNG that can be read: {error}") from error
    if step == 3:
        return width, height, pixels
    out = bytearray(3 * width * height)
    for channel in range(3):
        out[channel::3] = pixels[channel if step == 4 else 0::step]
    return width, height, bytes(out)
