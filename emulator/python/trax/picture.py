"""Pictures."""

import dataclasses
import os
import struct
import threading
import zlib

import numpy


@dataclasses.dataclass(frozen=True)
class Picture:
    """pixels: an array [height, width, 4] of bytes for a display, R, G, B, A, or [height, width, 3] of linear floats.
    In a notebook it shows itself."""
    pixels: numpy.ndarray = dataclasses.field(repr=False)

    @property
    def size(self):
        """(width, height) in pixels."""
        return self.pixels.shape[1], self.pixels.shape[0]

    def bytes(self):
        """[height, width, 3]: linear floats become bytes by the sRGB curve (IEC 61966-2-1)."""
        colours = self.pixels[:, :, :3]
        if colours.dtype == numpy.uint8:
            return colours
        linear = numpy.clip(numpy.nan_to_num(colours), 0, 1)
        curve = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear**(1 / 2.4) - 0.055)
        return (curve * 255 + 0.5).astype(numpy.uint8)

    def png(self):
        """The bytes of a PNG file."""
        width, height = self.size

        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        rows = numpy.zeros((height, 1 + 3 * width), numpy.uint8)  # each begins with its filter, which is none
        rows[:, 1:] = self.bytes().reshape(height, 3 * width)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))

    def save(self, path):
        """Writes a PNG file, whole or not at all."""
        data, target = self.png(), os.path.realpath(path)
        if os.path.exists(target) and not os.path.isfile(target):  # a device or a pipe
            with open(target, "wb") as file:
                file.write(data)
            return
        beside = f"{target}.{os.getpid()}.{threading.get_native_id()}"
        try:
            with open(beside, "wb") as file:
                file.write(data)
            os.replace(beside, target)
        except BaseException:
            if os.path.exists(beside):
                os.unlink(beside)
            raise

    def _repr_png_(self):
        return self.png()
