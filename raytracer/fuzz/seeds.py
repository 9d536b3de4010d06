#!/usr/bin/env python3
"""Writes cases to begin with: usage seeds.py BUILD DIRECTORY

BUILD is a finished build. DIRECTORY gets a folder for each fuzzer, one file a case, in the form that fuzz_case.h
describes or, for scenes, views and pictures, the file itself.
"""

import glob
import gzip
import hashlib
import json
import lzma
import os
import struct
import subprocess
import sys
import tempfile
import zlib

if len(sys.argv) != 3:
    sys.exit(__doc__)
build, directory = sys.argv[1:]
here = os.path.dirname(os.path.abspath(__file__))


def add(fuzzer, data):
    folder = os.path.join(directory, fuzzer)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, hashlib.sha1(data).hexdigest()[:12]), "wb") as file:
        file.write(data)


def add_case(fuzzer, options, *files):
    """files: pairs of name and bytes."""
    add(fuzzer, options.encode() + b"\n" + b"".join(f"{name} {len(data)}\n".encode() + data for name, data in files))


def png(width, height, kind, pixel, interlaced=0):

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + pixel * width for _ in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, interlaced)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def render(*words):
    subprocess.run([os.path.join(build, "bin", "trax-render"), *words, "--engine", "native", "-q"], check=True)


def rays(count, exponent=0, exact=0):
    header = struct.pack("<8s4IiI", b"traxray1", 64, 8, 4, 1, exponent, exact)
    return header + b"".join(
        struct.pack("<8f3HBBI3f2I", i % 5, i % 3, -9, 0.5 - i % 2, i % 7 / 8, 1, 0, 2.0**127 if i % 3 else 4, i % 8,
                    i // 8, 0, i % 4, 1, i, 3, 0.25, 0.5, 4, 2) for i in range(count))


for words in ((1, ), (2, 0, 1), (7, ), (20, -3), (41, )):
    add("trax-rays", rays(*words))


# JPEG, 8 x 8, grey: as libjpeg writes it.
JPEG = bytes.fromhex(
    "ffd8ffe000104a46494600010100000100010000ffdb004300080606070605080707070909080a0c140d0c0b0b0c1912130f141d1a1f1e1d"
    "1a1c1c20242e2720222c231c1c2837292c30313434341f27393d38323c2e333432ffc0000b080008000801011100ffc4001f000001050101"
    "0101010100000000000000000102030405060708090a0bffc400b5100002010303020403050504040000017d010203000411051221314106"
    "13516107227114328191a1082342b1c11552d1f02433627282090a161718191a25262728292a3435363738393a434445464748494a535455"
    "565758595a636465666768696a737475767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9ba"
    "c2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffda0008010100003f00f7fa28a2bfffd9")

image = png(4, 2, 6, b"\x80\x40\xff\x20")
OBJ = (b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 1 1\nusemtl a\n"
       b"f 1/1/1 2/2/1 3/3/2 4/1/2\nusemtl b\nf -4//1 -3//2 -1//1\nf 1 2 4\n")
MTL = (b"newmtl a\nKd .5 .5 .5\nmap_Kd -clamp on a.png\nmap_d a.png\nKs .2 .2 .2\nNs 20\nillum 2\n"
       b"newmtl b\nKe 1 2 3\nNi 1.3\nillum 7\nd 0.5\nTr 0.5\n")
PLY = (
    b"ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 4\nproperty float x\nproperty float y\n"
    b"property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
    b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n"
    b"1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n4 0 1 2 3\n")
BINARY_PLY = (
    b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty double y\nproperty short z\n"
    b"element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
    b"".join(struct.pack("<fdh", *v) for v in ((0, 0, 0), (1, 0, 0), (0, 1, 2))) + struct.pack("<5i", 4, 0, 1, 2, -1))
add_case("trax-scene-mesh", "a=mirror emit:1,2,3", ("a.obj", OBJ), ("a.mtl", MTL), ("a.png", image))
add_case("trax-scene-mesh", "", ("a.obj", OBJ), ("a.mtl", MTL), ("a.png", JPEG))
add_case("trax-scene-mesh", "glass:2", ("a.ply", PLY), ("a.png", image))
add_case("trax-scene-mesh", "", ("a.ply", BINARY_PLY))
add_case("trax-scene-mesh", "", ("a.obj", gzip.compress(OBJ, mtime=0)), ("a.mtl", MTL), ("a.png", image))
add_case("trax-scene-mesh", "", ("a.ply", lzma.compress(PLY)), ("a.png", image))
INSTANCES = (b"mesh m a.obj\nmaterial red 0.8,0.1,0.1\ngroup g\nplace m\n"
             b"place m 0 -1 0 2 1 0 0 0 0 0 1 0 material red\nend\n"
             b"place g\nplace g -1 0 0 5  0 1 0 0  0 0 0.5 1e4\nplace m material red\n")
add_case("trax-scene-mesh", "", ("a.instances", INSTANCES), ("a.obj", OBJ.replace(b"usemtl b\n", b"")), ("a.mtl", MTL))
NESTED = (b"mesh a a.obj\nmesh b b.ply\ngroup c\nplace a\nplace b 1 0 0 3  0 -2 0 1  0 0 1 0\nend\n"
          b"place c\nplace c 1e-3 0 0 1e6  0 1e3 0 0  0 0 1 0\n")
add_case("trax-scene-mesh", "", ("a.instances", NESTED), ("a.obj", OBJ), ("b.ply", BINARY_PLY))
GLTF = json.dumps({
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0, 3]}],
    "extensionsRequired": ["KHR_texture_transform"],
    "nodes": [
        {"children": [1, 2], "rotation": [0, 0, 0.6, 0.8], "scale": [1, -2, 1]},
        {"camera": 0, "translation": [0, 0, 4]},
        {"mesh": 0},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
    ],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
    "meshes": [{"primitives": [
        {"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0, "mode": 5},
        {"attributes": {"POSITION": 0}, "mode": 2},
    ]}],
    "materials": [{
        "name": "a", "alphaMode": "MASK", "emissiveFactor": [1, 2, 3],
        "pbrMetallicRoughness": {
            "metallicFactor": 0.5, "roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 1},
            "baseColorTexture": {
                "index": 0,
                "extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 3]}},
            },
        },
    }],
    "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
    "samplers": [{"wrapS": 33071}],
    "images": [{"uri": "a.png"}, {"bufferView": 2}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5121, "count": 4, "type": "VEC2", "normalized": True},
        {"bufferView": 1, "byteOffset": 8, "componentType": 5123, "count": 4, "type": "SCALAR"},
    ],
    "bufferViews": [
        {"buffer": 0, "byteLength": 48},
        {"buffer": 0, "byteOffset": 48, "byteLength": 16},
        {"buffer": 0, "byteOffset": 64, "byteLength": len(image)},
    ],
    "buffers": [{"byteLength": 64 + len(image), "uri": "b.bin"}],
}).encode()
BUFFER = struct.pack("<12f8B4H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1, 0, 0, 255, 0, 0, 255, 255, 255, 0, 1, 2, 3) + image
add_case("trax-scene-mesh", "", ("a.gltf", GLTF), ("a.png", image), ("b.bin", BUFFER))
CHUNKS = GLTF.replace(b', "uri": "b.bin"', b"") + b" " * (-len(GLTF.replace(b', "uri": "b.bin"', b"")) % 4)
glb = b"glTF" + struct.pack("<4I", 2, 28 + len(CHUNKS) + len(BUFFER), len(CHUNKS), 0x4E4F534A) + CHUNKS
add_case("trax-scene-mesh", "", ("a.glb", glb + struct.pack("<2I", len(BUFFER), 0x004E4942) + BUFFER), ("a.png", image))
comb = b"".join(b"v %d %d 0\n" % (i, 5 * (i // 2 % 2)) for i in range(40)) + b"f " + b" ".join(b"%d" % (i + 1)
                                                                                               for i in range(40))
add_case("trax-scene-mesh", "", ("a.obj", comb))

for view in glob.glob(os.path.join(here, "..", "views", "*.view")):
    with open(view, "rb") as file:
        add("trax-view", file.read())
VIEW = b"eye = (0, 1.5, 4); look_at = [0.0, 0.0, 0.0]; up = [0, 1, 0]; fov = 45;\n"
add(
    "trax-view", VIEW +
    b'lights = ( { type = "point"; position = [1, 2, 3]; colour = (1, 0.5, 0); strength = 0.5; falloff = 4; } );\n')
add(
    "trax-view", VIEW + b'lights = ( { type = "directional"; direction = [1, 2, 3]; },\n'
    b'  { type = "rectangle"; corner = [1, 2, 3]; edges = ([1, 0, 0], [0, 0, 1]); strength = 8.0; } );\n')

for kind, pixel in ((0, b"\x40"), (2, b"\x10\x20\x30"), (4, b"\x40\x80"), (6, b"\x10\x20\x30\x40")):
    add("trax-picture", png(7, 5, kind, pixel))
add("trax-picture", JPEG)
HDR = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X %d\n"
add("trax-picture", HDR % 3 + 2 * b"\x80\x40\x20\x81\1\1\1\2")
add("trax-picture", HDR % 9 + 2 * (b"\2\2\0\x09" + 3 * b"\x89\x40" + b"\4\x80\x81\x82\x83\x85\x7f"))
add("trax-picture", b"Pf\n3 2\n1.0\n" + struct.pack(">6f", 0, 1, 2, 3, 4, 5))


def npy(kind, shape, data):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


# Over the fuzzer's mesh of nine triangles: a root and two leaves, and a deeper one; with boxes a triangle is in two
# leaves.
everything = struct.pack("<6f", -99, -99, -99, 99, 99, 99)
ORDER = npy("<i4", (9, ), struct.pack("<9i", *range(9)))
LEAVES = npy("<i4", (3, 3), struct.pack("<9i", 1, 2, 0, 0, 0, 5, 5, 0, 4))
add_case("trax-scene-tree", "", ("nodes.npy", LEAVES), ("order.npy", ORDER))
add_case("trax-scene-tree", "quantised twins smooth",
         ("nodes.npy", npy("<u8", (5, 3), struct.pack("<15Q", 1, 2, 0, 0, 0, 3, 3, 4, 0, 3, 0, 3, 6, 0, 3))),
         ("order.npy", ORDER))
add_case("trax-scene-tree", "deep", ("nodes.npy", LEAVES), ("order.npy", ORDER),
         ("boxes.npy", npy("<f4", (3, 2, 3), 3 * everything)))
add_case("trax-scene-tree", "lamps", ("nodes.npy", npy("<i4", (3, 3), struct.pack("<9i", 1, 2, 0, 0, 0, 5, 4, 0, 5))),
         ("order.npy", ORDER), ("boxes.npy", npy("<f4", (3, 6), 3 * everything)))
WIDE = struct.pack("<20i", 1, 2, 3, 0, 0, *(number for first in (0, 3, 6) for number in (first, 0, 0, 0, 3)))
add_case("trax-scene-tree", "", ("nodes.npy", npy("<i4", (4, 5), WIDE)), ("order.npy", ORDER))
add_case("trax-scene-tree", "quantised", ("nodes.npy", npy("<i4", (4, 5), WIDE)), ("order.npy", ORDER),
         ("boxes.npy", npy("<f4", (4, 6), 4 * everything)))

with tempfile.TemporaryDirectory() as work:

    def write(name, data):
        with open(os.path.join(work, name), "wb") as file:
            file.write(data)
        return os.path.join(work, name)

    mesh = write("a.obj", OBJ)
    write("a.mtl", MTL)
    write("a.png", image)
    for ending in ("pfm", "exr"):
        for size in ("5x3", "40x33"):
            picture = os.path.join(work, "a." + ending)
            render(mesh, "-o", picture, "--size", size)
            with open(picture, "rb") as file:
                add("trax-picture", file.read())
    box = os.path.join(here, "..", "..", "tests", "render", "box.obj")
    instances = write("a.instances", b"mesh m box.obj\nplace m\nplace m 0 -1 0 9 0.5 0 0 0 0 0 2 1\nplace m\n")
    with open(box, "rb") as file:
        write("box.obj", file.read())
    for number, words in enumerate(
        ([instances, "--smooth"], [mesh, "--smooth"], [mesh, "--material", "b=glass"], [mesh, "--no-textures"],
         [box, "--nodes", "binary"], [box, "--nodes", "quantised", "--leaf", "2"],
         [box, "--material", "red=mirror", "--material", "white=ggx:0.3"], [box, "--smooth", "--leaf", "1"])):
        scene = os.path.join(work, f"{number}.trax")
        subprocess.run([os.path.join(build, "bin", "trax-scene"), "-q", *words, "-o", scene], check=True)
        with open(scene, "rb") as file:
            add("trax-scene-file", file.read())
