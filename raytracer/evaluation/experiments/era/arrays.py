"""The plain arrays (trax/plain_scene.h) otherwise, in the folder of a program's inputs. Words are little endian, as is
the host (x86-64)."""

import array
import json
import pathlib
import sys

NODE_WORDS, TRIANGLE_WORDS = 8, 10
COUNT, FIRST = 6, 7


def words(path):
    values = array.array("I")
    values.frombytes(pathlib.Path(path).read_bytes())
    return values


def siblings_apart():
    """The root, and behind it the pairs: every pair is in two lines of 64 bytes."""
    nodes = words("nodes.bin")
    for place in range(0, len(nodes), NODE_WORDS):
        if nodes[place + COUNT] == 0xFFFFFFFF:
            nodes[place + FIRST] -= 1
    pathlib.Path("nodes.bin").write_bytes((nodes[:NODE_WORDS] + nodes[2 * NODE_WORDS:]).tobytes())


def long_record():
    triangles, padding = words("triangles.bin"), array.array("I", (0, 0))
    record = array.array("I")
    for place in range(0, len(triangles), TRIANGLE_WORDS):
        record += triangles[place:place + TRIANGLE_WORDS] + padding
    pathlib.Path("triangles.bin").write_bytes(record.tobytes())


def short_record():
    """Materials are a buffer of their own."""
    triangles = words("triangles.bin")
    pathlib.Path("materials.bin").write_bytes(triangles[TRIANGLE_WORDS - 1::TRIANGLE_WORDS].tobytes())
    vertices = array.array("I")
    for place in range(0, len(triangles), TRIANGLE_WORDS):
        vertices += triangles[place:place + TRIANGLE_WORDS - 1]
    pathlib.Path("triangles.bin").write_bytes(vertices.tobytes())
    manifest = json.loads(pathlib.Path("manifest.json").read_text())
    manifest["buffers"].append({"symbol": "materials", "file": "materials.bin"})
    pathlib.Path("manifest.json").write_text(json.dumps(manifest))


{"siblings": siblings_apart, "long-record": long_record, "short-record": short_record}[sys.argv[1]]()
