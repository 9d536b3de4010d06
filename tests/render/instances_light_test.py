#!/usr/bin/env python3
"""instances_light_test.py BIN: light on instances against closed forms: furnaces, a mirror, a plate of glass, each
turned, stretched and mirrored by its transform, by the twin and with Embree's instances."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from environment_test import close, mean, render, write_map  # noqa: E402

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
OUTWARDS = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
ENGINES = "native", "embree"
INDEX = 1.5


def write(name, *lines):
    pathlib.Path(name).write_text("\n".join(lines) + "\n")


def write_box(name, size=1, inwards=False, material=None):
    faces = [face[::-1] if inwards else face for face in OUTWARDS]
    write(name, *("v %r %r %r" % tuple(size * x for x in corner) for corner in CORNERS),
          *([f"usemtl {material}"] if material else []), *("f %d %d %d %d" % face for face in faces))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def turned(axis, angle):
    """The matrix of a rotation about an axis of unit length."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = axis
    across = (0, -z, y), (z, 0, -x), (-y, x, 0)
    return [[c * (i == k) + (1 - c) * axis[i] * axis[k] + s * across[i][k] for k in range(3)] for i in range(3)]


TURN = turned((2 / 3, -1 / 3, 2 / 3), 0.8)


def place(name, stretch, at=(0, 0, 0), material=None, turn=None):
    """A line: what is stretched along its own axes, then turned, then moved."""
    rows = [[value * factor for value, factor in zip(row, stretch)] + [x] for row, x in zip(turn or TURN, at)]
    return " ".join(["place", name, *(repr(value) for row in rows for value in row)]
                    + ([f"material {material}"] if material else []))


BODIES = (place("box", (0.5, 0.7, 0.4), (-1.3, 0, 0), "white"),
          place("box", (-0.5, 0.5, 0.6), (0, 0.2, 0.3), "mirror"),
          place("box", (0.6, -0.4, 0.5), (1.3, -0.1, 0), "glass"),
          place("box", (-0.3, -0.5, -0.4), (0.4, -1.1, 0.2), "glass", turned((0, 0.6, 0.8), 2)))
MATERIALS = ("mesh box box.obj", "material white 1,1,1", "material mirror mirror", f"material glass glass:{INDEX}")
LOOK = ("--eye", "0,0.3,5", "--look-at", "0,0,0", "--fov", "45")


def test_furnaces():
    """Bodies that lose no light are not seen before an even sky, nor in a room whose walls shine e and reflect r, where
    light is e / (1 - r)."""
    write("bodies.instances", *MATERIALS, *BODIES)
    write("room.instances", *MATERIALS, "mesh room room.obj", "place room", *BODIES)
    write_box("room.obj", 7, inwards=True, material="lamp")
    write_map("white.pfm", lambda d: (1, 1, 1), 8, 4)
    for engine in ENGINES:
        picture = render("bodies.instances", *LOOK, "--environment", "white.pfm", "--paths", "32", "--samples", "16",
                         engine=engine)
        close(mean(picture), [1] * 3, 0.001, "sky", engine)
        found = mean(render("room.instances", *LOOK, "--diffuse", "lamp=0.5,0.8,0", "--material", "lamp=emit:1,0.5,2",
                            "--paths", "32", "--samples", "64", engine=engine))
        close([x / y for x, y in zip(found, (2, 2.5 * (1 - 0.8**33), 2))], [1] * 3, 0.006, "room", engine)


def pixels(size, eye, look_at, degrees):
    """The directions of the middles of pixels, row by row."""
    ahead = [b - a for a, b in zip(eye, look_at)]
    ahead = [x / math.hypot(*ahead) for x in ahead]
    right = [-ahead[2], 0, ahead[0]]  # up is +y
    right = [x / math.hypot(*right) for x in right]
    up = [right[1] * ahead[2] - right[2] * ahead[1], right[2] * ahead[0] - right[0] * ahead[2],
          right[0] * ahead[1] - right[1] * ahead[0]]
    half = math.tan(math.radians(degrees / 2))
    for y in range(size):
        for x in range(size):
            a, b = (2 * (x + 0.5) / size - 1) * half, (1 - 2 * (y + 0.5) / size) * half
            d = [f + a * r + b * u for f, r, u in zip(ahead, right, up)]
            yield x, y, [part / math.hypot(*d) for part in d]


def reflected(d, normal):
    return [a - 2 * dot(d, normal) * b for a, b in zip(d, normal)]


def sky(d):
    return [0.5 + 0.5 * x for x in d]


def reflectance(cosine):
    """Fresnel's, of unpolarised light from outside."""
    inside = math.sqrt(1 - (1 - cosine**2) / INDEX**2)
    across = (cosine - INDEX * inside) / (cosine + INDEX * inside)
    along = (INDEX * cosine - inside) / (INDEX * cosine + inside)
    return (across**2 + along**2) / 2


NORMAL = [row[2] for row in TURN]
EYE = [3 * (0.8 * n + 0.6 * row[0]) for n, row in zip(NORMAL, TURN)]
AT_PLATE = ("--eye", ",".join(map(repr, EYE)), "--look-at", "0,0,0", "--fov", "40", "--environment", "axes.pfm",
            "--paths", "32")


def test_plates():
    """A sky with the light 1/2 + d/2 from the direction d. A mirror shows that of the reflected direction. A plate of
    glass, with the reflectance R of a face, reflects 2R / (1 + R) in all orders, and the rest goes on as it came."""
    write_map("axes.pfm", sky)
    for stretch in (30, 20, 0.1), (30, -20, 0.1), (-30, -20, -0.1):
        write("plate.instances", *MATERIALS, place("box", stretch, material="mirror"))
        for engine in ENGINES:
            picture = render("plate.instances", *AT_PLATE, engine=engine)
            difference = [0, 0, 0]
            for x, y, d in pixels(32, EYE, (0, 0, 0), 40):
                light = sky(reflected(d, NORMAL))
                close(picture[y][x], light, 0.02, "mirror", engine, stretch, x, y)  # of a texel of the sky
                difference = [a + b - c for a, b, c in zip(difference, picture[y][x], light)]
            close([x / 32**2 for x in difference], [0] * 3, 0.001, "mirror, the mean", engine, stretch)
        write("plate.instances", *MATERIALS, place("box", stretch, material="glass"))
        wanted = [0, 0, 0]
        for _, _, d in pixels(32, EYE, (0, 0, 0), 40):
            share = reflectance(-dot(d, NORMAL))
            share = 2 * share / (1 + share)
            for i, (back, on) in enumerate(zip(sky(reflected(d, NORMAL)), sky(d))):
                wanted[i] += (share * back + (1 - share) * on) / 32**2
        for engine in ENGINES:
            close(mean(render("plate.instances", *AT_PLATE, "--samples", "16", engine=engine)), wanted, 0.002, "glass",
                  engine, stretch)


sys.exit(checking.run(lambda: write_box("box.obj"), test_furnaces, test_plates))
