#!/usr/bin/env python3
"""environment_test.py BIN: light from all directions by --environment, against closed forms."""
import functools
import math
import pathlib
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402
from png_files import SIGNATURE  # noqa: E402

BIN = pathlib.Path(sys.argv[1]).resolve()
call = functools.partial(checking.call, BIN)
ALBEDO = 0.75  # of triangles without a material

# --- pictures ---


def write_pfm(path, width, height, light):
    """light(column, row) from the top left."""
    rows = [struct.pack("<3f", *light(x, y)) for y in reversed(range(height)) for x in range(width)]
    pathlib.Path(path).write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + b"".join(rows))


def read_pfm(path):
    """Rows from the top of pixels."""
    data = pathlib.Path(path).read_bytes()
    _, size, _, *_ = data.split(b"\n", 3)
    width, height = map(int, size.split())
    values = struct.unpack(f"<{3 * width * height}f", data[-12 * width * height:])
    pixels = [values[i:i + 3] for i in range(0, len(values), 3)]
    return [pixels[y * width:(y + 1) * width] for y in reversed(range(height))]


def direction_of(column, row, width, height):
    """Returns a texel's direction by the definition of the map: the middle is -z, the right half +x, the top +y."""
    theta, phi = math.pi * (row + 0.5) / height, 2 * math.pi * ((column + 0.5) / width - 0.5)
    return math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi)


def write_map(path, light, width=256, height=128):
    """light(direction)"""
    write_pfm(path, width, height, lambda x, y: light(direction_of(x, y, width, height)))


def render(*words, size="32x32", engine="native"):
    call("trax-render", *words, "--size", size, "--engine", engine, "-q", "-o", "out.pfm")
    return read_pfm("out.pfm")


def mean(picture):
    pixels = [pixel for row in picture for pixel in row]
    return [sum(pixel[channel] for pixel in pixels) / len(pixels) for channel in range(3)]


def close(found, wanted, error, *what):
    check(all(abs(a - b) <= error for a, b in zip(found, wanted)), *what, "found", found, "wanted", wanted)


# --- what rays see ---


def test_directions():
    """Each pixel of a view has the light of its direction, within a texel's width."""
    write_map("axes.pfm", lambda d: [0.5 + 0.5 * part for part in d])
    far = "far.obj"
    pathlib.Path(far).write_text("v 0 500 0\nv 0.001 500 0\nv 0 500 0.001\nf 1 2 3\n")
    size, half = 16, math.tan(math.radians(30))
    for forward, up in (((0, 0, -1), (0, 1, 0)), ((1, 0, 0), (0, 1, 0)), ((0, -1, 0), (0, 0, 1)),
                        ((-0.6, 0, 0.8), (0, 1, 0))):
        picture = render(far, "--eye", "0,0,0", "--look-at", ",".join(map(str, forward)), "--up",
                         ",".join(map(str, up)), "--fov", "60", "--environment", "axes.pfm", size=f"{size}x{size}")
        right = [forward[1] * up[2] - forward[2] * up[1], forward[2] * up[0] - forward[0] * up[2],
                 forward[0] * up[1] - forward[1] * up[0]]
        for y in range(size):
            for x in range(size):
                a, b = (2 * (x + 0.5) / size - 1) * half, (1 - 2 * (y + 0.5) / size) * half
                d = [f + a * r + b * u for f, r, u in zip(forward, right, up)]
                length = math.hypot(*d)
                close(picture[y][x], [0.5 + 0.5 * part / length for part in d], 0.012, "direction", forward, x, y)
    turned = render(far, "--eye", "0,0,0", "--look-at", "0,0,-1", "--environment", "axes.pfm", "--environment-turn",
                    "90", "--environment-strength", "2", size="1x1")
    close(turned[0][0], [0, 1, 1], 0.03, "turned: the middle of the map is now at +x, and -x, seen before, is here")


# --- light on surfaces ---

FLOOR = "v -9 0 -9\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nf 1 2 3 4\n"
ABOVE = ("floor.obj", "--eye", "0,3,0", "--look-at", "0,0,0", "--up", "0,0,1", "--fov", "30", "--paths", "2",
         "--samples", "64")


def test_irradiance():
    """A floor that nothing blocks reflects its albedo times the integral of light times cosine over the upper half,
    over pi: of 1 it is 1, of y 2/3, of a cap of the half angle a around +y its light times sin^2 a."""
    pathlib.Path("floor.obj").write_text(FLOOR)
    write_map("white.pfm", lambda d: (1, 1, 1), 8, 4)
    write_map("slope.pfm", lambda d: (max(d[1], 0), 1, 1 + 0.5 * d[1]))
    cap = 3 * math.pi / 128  # rows of the map
    write_pfm("sun.pfm", 256, 128, lambda x, y: (300, 200, 100) if y < 3 else (0, 0, 0))
    for engine in ("native", "embree"):
        close(mean(render(*ABOVE, "--environment", "white.pfm", engine=engine)), [ALBEDO] * 3, 0.002, "furnace", engine)
        close(mean(render(*ABOVE, "--environment", "slope.pfm", engine=engine)),
              [ALBEDO * x for x in (2 / 3, 1, 4 / 3)], 0.006, "slope", engine)
        sun = ALBEDO * math.sin(cap)**2
        close([x / y for x, y in zip(mean(render(*ABOVE, "--environment", "sun.pfm", engine=engine)), (300, 200, 100))],
              [sun] * 3, 0.01 * sun, "sun", engine)
    below = [word.replace("0,3,0", "0,-3,0") for word in ABOVE]
    close(mean(render(*below, "--environment", "sun.pfm")), [0] * 3, 1e-6, "below the floor there is no sun")


def test_noise():
    """Shadow rays find the small sun: with them the pixels of the floor hardly differ."""
    picture = render(*ABOVE, "--environment", "sun.pfm")
    values = [pixel[0] for row in picture for pixel in row]
    average = sum(values) / len(values)
    deviation = math.sqrt(sum((value - average)**2 for value in values) / len(values))
    check(deviation < 0.05 * average, "noise", deviation, average)


def test_engines():
    """The device program, specialised and general, and the twin, with lights, emitters and mirrors beside the sky."""
    pathlib.Path("room.obj").write_text(FLOOR + "v -1 0 -1\nv 1 0 -1\nv 0 2 -1\nusemtl lamp\nf 5 6 7\n"
                                        "v 2 0 -2\nv 3 0 1\nv 3 2 0\nusemtl mirror\nf 8 9 10\n")
    words = ("room.obj", "--material", "lamp=emit:2,1,1", "--material", "mirror=mirror", "--eye", "0,3,6", "--look-at",
             "0,0.5,0", "--light", "2,5,2", "--light", "-2,5,2", "--environment", "axes.pfm", "--paths", "3",
             "--samples", "2", "--size", "16x12", "-q")
    outputs = []
    for name, more in (("twin", ("--engine", "native")), ("device", ()), ("general", ("--no-specialise", ))):
        call("trax-render", *words, *more, "-o", f"{name}.pfm")
        outputs.append(pathlib.Path(f"{name}.pfm").read_bytes())
    check(outputs[0] == outputs[1] == outputs[2], "twin, device and general program")
    call("trax-render", *words, "--engine", "native", "--samples", "64", "--compare", "-o", "compared.pfm")


# --- files ---


def hdr(rows, head=b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", size=None):
    width, height = size or (len(rows[0]), len(rows))
    return head + b"-Y %d +X %d\n" % (height, width)


def test_hdr():
    pixels = [[(128, 64, 32, 129), (200, 100, 50, 128)] * 5, [(16, 16, 16, 140)] * 10]
    plain = hdr(pixels) + b"".join(bytes(pixel) for row in pixels for pixel in row)
    runs = hdr(pixels)
    for row in pixels:
        runs += b"\2\2\0\x0a"
        for channel in range(4):
            values = bytes(pixel[channel] for pixel in row)
            runs += bytes([138, values[0]]) if len(set(values)) == 1 else b"\x03" + values[:3] + b"\x07" + values[3:]
    old = hdr(pixels) + b"".join(bytes(pixel) for pixel in pixels[0]) + bytes(pixels[1][0]) + b"\1\1\1\x09"
    for name, data in (("plain", plain), ("runs", runs), ("old", old)):
        pathlib.Path(f"{name}.hdr").write_bytes(data)
    write_pfm("same.pfm", 10, 2,
              lambda x, y: [math.ldexp(part + 0.5, pixels[y][x][3] - 136) for part in pixels[y][x][:3]])
    for name in ("plain", "runs", "old"):
        call("trax-compare", f"{name}.hdr", "same.pfm", "--within", "0")
    for name, data, said in (("cut", plain[:-1], "row 1 of an HDR picture"),
                             ("code", runs[:-9] + b"\0" * 9, "is cut off or damaged"),
                             ("first", hdr(pixels) + b"\1\1\1\x04" + plain[-76:], "is cut off or damaged"),
                             ("format", plain.replace(b"rgbe", b"xyze"), "of another format"),
                             ("turned", plain.replace(b"-Y 2 +X 10", b"+X 10 -Y 2"), "do not go down"),
                             ("huge", plain.replace(b"-Y 2 +X 10", b"-Y 2 +X 99999"), "must be 1 to"),
                             ("bomb", hdr([], size=(16384, 16384)) + 16384 * b"\x09\x09\x09\x82\1\1\1\xff\1\1\1\x3f",
                              "16384 x 16384 pixels in 196"), ("head", b"#?RADIANCE\nFORMAT=32-bit", "does not end")):
        pathlib.Path(f"{name}.hdr").write_bytes(data)
        done = call("trax-render", "floor.obj", "--environment", f"{name}.hdr", "-q", "-o", "x.pfm", status=1)
        check(said in done.stderr, name, done.stderr)


def blank_png(side, bits):
    """A PNG of one colour."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = zlib.compress(bytes((side * bits // 8 + 1) * side), 9)
    header = struct.pack(">IIBBBBB", side, side, bits, 0, 0, 0, 0)
    return SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def test_blank():
    """Few bytes may have many pixels, but not a gigabyte of them."""
    for side, bits, status in ((2048, 1, 0), (5000, 8, 0), (16384, 1, 1)):
        pathlib.Path("blank.png").write_bytes(blank_png(side, bits))
        done = call("trax-compare", "-q", "blank.png", "blank.png", status=status)
        check(not status or "blank.png: not a readable PNG: its few bytes have too many pixels" in done.stderr, done)


def test_refusals():
    write_pfm("nan.pfm", 4, 2, lambda x, y: (1, math.nan if (x, y) == (2, 1) else 1, 1))
    write_pfm("minus.pfm", 4, 2, lambda x, y: (1, 1, -1 if (x, y) == (3, 0) else 1))
    for said, words in (("the light of pixel (2, 1) is nan", "--environment nan.pfm"),
                        ("the light of pixel (3, 0) is -1", "--environment minus.pfm"),
                        ("not a readable PNG", "--environment floor.obj"),
                        ("No such file", "--environment nothing.exr"),
                        ("without --environment", "--environment-turn 9"),
                        ("is not a number from 0", "--environment white.pfm --environment-strength -1"),
                        ("for trax-render's own program", "--environment white.pfm --program x.elf")):
        done = call("trax-render", "floor.obj", *words.split(), "-q", "-o", "x.pfm", status=1)
        check(said in done.stderr, said, done.stderr)
    check(not pathlib.Path("x.pfm").exists(), "nothing is written")


if __name__ == "__main__":  # instances_light_test.py has parts of this file
    sys.exit(checking.run(test_directions, test_irradiance, test_noise, test_engines, test_hdr, test_blank,
                          test_refusals))
