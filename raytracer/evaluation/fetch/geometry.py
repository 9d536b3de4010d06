"""The geometry of a mesh: its triangles, their hash, their measures (docs/scenes.md, "The hash")."""

import array
import ast
import hashlib
import math
import struct

from trax_eval.tools import run_tool

from .problems import Failed

TRIANGLE = 36  # bytes: nine floats, little endian
MINUS_ZERO = 0x80000000


def import_triangles(tools, meshes, scratch):
    """The triangles of mesh files as trax-scene imports them, in their order, TRIANGLE bytes each."""
    path = scratch / "triangles.npy"
    run = run_tool([tools.path("trax-scene"), "--quiet", "--no-textures", "--write-triangles", path, *meshes])
    if run.returncode != 0:
        said = run.stderr.strip().removeprefix("trax-scene: error: ")
        raise Failed(said.replace(f"{scratch}/", "") or f"trax-scene ended with status {run.returncode}")
    data = path.read_bytes()
    path.unlink()
    begin = 10 + struct.unpack_from("<H", data, 8)[0]  # numpy's format, version 1.0
    shape = ast.literal_eval(data[10:begin].decode())["shape"]
    triangles = data[begin:]
    assert shape == (len(triangles) // TRIANGLE, 3, 3)
    return triangles


def without_minus_zero(triangles):
    words = array.array("I", triangles)
    if MINUS_ZERO not in words:
        return triangles
    return array.array("I", [0 if word == MINUS_ZERO else word for word in words]).tobytes()


def geometry_hash(triangles):
    """SHA-256 of the triangles in a normal form: each begins with the corner whose bytes are least and keeps its
    winding, -0 is 0, and all are in ascending order of their bytes."""
    normal = []
    for first, second, third in struct.iter_unpack("12s12s12s", without_minus_zero(triangles)):
        if first <= second and first <= third:
            normal.append(first + second + third)
        elif second <= third:
            normal.append(second + third + first)
        else:
            normal.append(third + first + second)
    normal.sort()
    return hashlib.sha256(b"".join(normal)).hexdigest()


def measures(triangles):
    """Number, bounds and area of the triangles."""
    values = array.array("f", triangles)
    area = 0.0
    for ax, ay, az, bx, by, bz, cx, cy, cz in struct.iter_unpack("<9f", triangles):
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        area += math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
    axes = [values[axis::3] for axis in range(3)]
    return {
        "triangles": len(triangles) // TRIANGLE, "low": [min(axis, default=0.0) for axis in axes],
        "high": [max(axis, default=0.0) for axis in axes], "area": area / 2
    }


def differences(found, wanted):
    """Returns how measures differ from those of the wanted mesh, as texts. Other digits of the coordinates and other
    diagonals of polygons make no difference."""
    said = []
    if abs(found["triangles"] - wanted["triangles"]) > wanted["triangles"] / 1000:
        said.append(f"{found['triangles']:,} triangles instead of {wanted['triangles']:,}")
    size = math.dist(wanted["low"], wanted["high"])
    if any(abs(a - b) > size * 1e-4 for end in ("low", "high") for a, b in zip(found[end], wanted[end])):
        said.append("other bounds")
    if abs(found["area"] - wanted["area"]) > wanted["area"] / 1000:
        said.append("another area")
    return said


def ply_of(triangles):
    """A binary PLY file of the triangles, in their order. Corners at one place are one vertex."""
    numbers = {}
    corners = [numbers.setdefault(corner, len(numbers)) for corner, in struct.iter_unpack("12s", triangles)]
    count = len(corners) // 3
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(numbers)}\nproperty float x\n"
              f"property float y\nproperty float z\nelement face {count}\n"
              f"property list uchar int vertex_indices\nend_header\n")
    faces = bytearray(13 * count)
    for place in range(count):
        struct.pack_into("<B3i", faces, 13 * place, 3, *corners[3 * place:3 * place + 3])
    return b"".join([header.encode(), *numbers, faces])
