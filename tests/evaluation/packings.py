"""A small mesh in many packings, its hash by another program than trax-eval's, and an entry of a list of sources."""

import fractions
import hashlib
import io
import itertools
import json
import random
import struct
import subprocess
import tarfile
import zipfile


def single(value):
    """The nearest number of binary32."""
    return struct.unpack("<f", struct.pack("<f", float(value)))[0]


def make_mesh(seed=34, count=40):
    """Triangles as three corners of three numbers of binary32, two of them at one place."""
    numbers = random.Random(seed)
    corners = [tuple(single(numbers.uniform(-3, 3)) for _ in range(3)) for _ in range(count)]
    corners[0] = (0.0, 0.0, single(1.1))
    triangles = [tuple(numbers.sample(corners, 3)) for _ in range(2 * count)]
    return [*triangles, (corners[0], corners[1], corners[2]), triangles[5]]


def oracle(triangles):
    """The hash of docs/scenes.md, from its words."""
    listed = []
    for triangle in triangles:
        a, b, c = ([fractions.Fraction(value) for value in corner] for corner in triangle)
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        if any(u[i] * v[j] != u[j] * v[i] for i, j in ((0, 1), (1, 2), (2, 0))):
            turns = [triangle[turn:] + triangle[:turn] for turn in range(3)]
            listed.append(min(struct.pack("<9f", *(value + 0.0 for corner in turn for value in corner))
                              for turn in turns))
    return hashlib.sha256(b"".join(sorted(listed))).hexdigest()


def indexed(triangles):
    corners = sorted(set(itertools.chain(*triangles)))
    return corners, [[corners.index(corner) for corner in triangle] for triangle in triangles]


def header(form, kind, corners, faces):
    axes = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    return (f"ply\nformat {form} 1.0\nelement vertex {corners}\n{axes}element face {faces}\n"
            f"property list uchar int vertex_indices\nend_header\n")


def ply(triangles):
    corners, faces = indexed(triangles)
    lines = [*("%.9g %.9g %.9g\n" % corner for corner in corners), *("3 %d %d %d\n" % tuple(face) for face in faces)]
    return (header("ascii", "float", len(corners), len(faces)) + "".join(lines)).encode()


def binary_ply(triangles, order=">"):
    corners = list(itertools.chain(*triangles))  # none is shared
    form = "binary_big_endian" if order == ">" else "binary_little_endian"
    faces = (struct.pack(order + "B3i", 3, 3 * place, 3 * place + 1, 3 * place + 2) for place in range(len(triangles)))
    return b"".join([header(form, "double", len(corners), len(triangles)).encode(),
                     *(struct.pack(order + "3d", *corner) for corner in corners), *faces])


def obj(triangles, digits="%.17g"):
    corners, faces = indexed(triangles)
    return "".join(["# a mesh\n", *(f"v {' '.join(digits % value for value in corner)}\n" for corner in corners),
                    "g part\n", *(f"f {' '.join(str(at + 1) for at in face)}\n" for face in faces)]).encode()


def glb(document, binary):
    text = json.dumps(document | {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(binary)}]}).encode()
    text, binary = text + b" " * (-len(text) % 4), binary + bytes(-len(binary) % 4)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(binary)) + b"BIN\0" + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def plain_glb(triangles):
    data = struct.pack(f"<{9 * len(triangles)}f", *itertools.chain(*itertools.chain(*triangles)))
    axes = list(zip(*itertools.chain(*triangles)))
    return glb({
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}], "scene": 0, "scenes": [{"nodes": [0]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3 * len(triangles), "type": "VEC3",
                       "min": list(map(min, axes)), "max": list(map(max, axes))}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]
    }, data)


def six_digits(triangles):
    return [tuple(tuple(single(f"{value:.6f}") for value in corner) for corner in triangle) for triangle in triangles]


def draco_glb(triangles, scratch):
    """Two parts, each packed by Draco without a loss. What unpacks them writes six digits."""
    views, data = [], b""
    for part in (triangles[:30], triangles[30:]):
        (scratch / "part.obj").write_bytes(obj(part))
        subprocess.run(["draco_encoder", "-i", "part.obj", "-o", "part.drc", "-qp", "0"], cwd=scratch, check=True,
                       stdout=subprocess.DEVNULL)
        packed = (scratch / "part.drc").read_bytes()
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data += packed
    meshes = [{"primitives": [{"extensions": {"KHR_draco_mesh_compression": {"bufferView": view}}}]} for view in (0, 1)]
    return glb({"bufferViews": views, "meshes": meshes, "nodes": [{"mesh": 0, "scale": [0.5, 0.5, 0.5]}]}, data)


def tar(members):
    """members: (name, data), or (name, None) for a symbolic link out of the folder."""
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w:gz") as archive:
        for name, data in members:
            one = tarfile.TarInfo(name)
            one.size = len(data or b"")
            if data is None:
                one.type, one.linkname = tarfile.SYMTYPE, "/etc/passwd"
            archive.addfile(one, io.BytesIO(data or b""))
    return file.getvalue()


def zipped(members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members:
            archive.writestr(name, data)
    return file.getvalue()


MESH = make_mesh()
HASH = oracle(MESH)
AXES = list(zip(*itertools.chain(*MESH)))


def area(triangle):
    a, b, c = triangle
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    return sum((u[i] * v[j] - u[j] * v[i])**2 for i, j in ((0, 1), (1, 2), (2, 0)))**0.5 / 2


def described(file, *sources, **more):
    return {
        "file": file, "geometry": HASH, "triangles": len(MESH), "low": list(map(min, AXES)),
        "high": list(map(max, AXES)), "area": sum(map(area, MESH)), "sources": list(sources)
    } | more
