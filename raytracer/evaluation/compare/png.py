"""Reads PNGs of 8 bits a channel, as trax writes them (RFC 2083)."""

import struct
import zlib

from trax_eval.pictures import SIGNATURE
from trax_eval.util import FILE_LIMIT, Problem, read_bytes

CHANNELS = {0: 1, 2: 3, 6: 4}  # of the colour types grey, RGB, RGBA


def read_png(path):
    """(width, height, bytes of R, G, B)."""
    data = read_bytes(path)
    try:
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
        rows = zlib.decompressobj().decompress(b"".join(packed), (width * step + 1) * height)
        if len(rows) != (width * step + 1) * height:
            raise ValueError("it ends early")
        return width, height, rgb(unfilter(rows, width * step, step), step)
    except (ValueError, struct.error, zlib.error) as error:
        raise Problem(f"{path}: is no PNG that can be read: {error}") from error


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


def rgb(pixels, step):
    if step == 3:
        return bytes(pixels)
    out = bytearray(len(pixels) // step * 3)
    for channel in range(3):
        out[channel::3] = pixels[channel if step == 4 else 0::step]
    return bytes(out)
