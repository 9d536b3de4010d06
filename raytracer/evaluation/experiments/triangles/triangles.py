"""Other triangles for a specialised program, in the folder of its inputs: triangles.py
apart|few-lines|48|64|shared|edges|transforms"""

import array
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from device_scene import LINE, TRIANGLE, Scene, cross, minus  # noqa: E402


def dense(size):
    return lambda number: number * size


def padded(size):
    def change(scene):
        old, new = scene.words[scene.triangles:scene.triangles +
                               scene.triangle_count * TRIANGLE], array.array("I", [0]) * (scene.triangle_count * size)
        for word in range(TRIANGLE):
            new[word::size] = old[word::TRIANGLE]
        scene.replace_triangles(dense(size), new)

    return change


def at_even_words(scene, size, word_of):
    """Leaves of triangles of `size` words, each from an even word on; materials apart, found by the triangle's place in
    steps of a power of two."""
    step = 1 << size.bit_length() - 1
    words, places, materials = array.array("I"), {}, {}
    for first, count in scene.leaves():
        words += array.array("I", [0] * (len(words) % 2))
        places[first] = len(words)
        for number in range(first, first + count):
            materials[len(words) // step] = scene.words[scene.triangles + number * TRIANGLE + 9]
            words += word_of(number)
    behind = array.array("I", [0]) * (len(words) // step + 1)
    for place, material in materials.items():
        behind[place] = material
    scene.replace_triangles(places.get, words, behind)


def materials_apart(scene):
    old = scene.words[scene.triangles:]
    at_even_words(scene, 9, lambda number: old[number * TRIANGLE:number * TRIANGLE + 9])


def in_few_lines(scene):
    """A leaf begins with a new line where it is in fewer lines that way."""
    words, places, old = array.array("I"), {}, scene.words[scene.triangles:]
    for first, count in scene.leaves():
        size, over = count * TRIANGLE, len(words) % LINE
        if (over + size - 1) // LINE > (size - 1) // LINE:
            words += array.array("I", [0] * (LINE - over))
        places[first] = len(words)
        words += old[first * TRIANGLE:first * TRIANGLE + size]
    scene.replace_triangles(places.get, words)


def shared_vertices(scene):
    """Corners' addresses of each triangle, and the vertices, in the order in which triangles meet them."""
    vertices, corners = {}, []
    for number in range(scene.triangle_count):
        at = scene.triangles + number * TRIANGLE
        for corner in range(at, at + 9, 3):
            corners.append(vertices.setdefault(scene.words[corner:corner + 3].tobytes(), len(vertices)))
    words = array.array("I")
    words.frombytes(b"".join(vertices))
    return corners, words


def indexed(scene):
    """Three addresses and the material. Vertices are before the triangles, so that their addresses are known."""
    corners, vertices = shared_vertices(scene)
    vertices += array.array("I", [0] * (-len(vertices) % LINE))
    start = scene.base + scene.triangles * 4
    words = array.array("I", [0]) * (scene.triangle_count * 4)
    for corner in range(3):
        words[corner::4] = array.array("I", [start + 12 * vertex for vertex in corners[corner::3]])
    words[3::4] = scene.words[scene.triangles + 9:scene.triangles + scene.triangle_count * TRIANGLE:TRIANGLE]
    scene.replace_triangles(lambda number: len(vertices) + number * 4, vertices + words)


def edges(scene):
    words = array.array("I")
    for number in range(scene.triangle_count):
        a, b, c = scene.floats(number)
        words.frombytes(struct.pack("<9f", *a, *minus(b, a), *minus(c, a)))
        words.append(scene.words[scene.triangles + number * TRIANGLE + 9])
    scene.replace_triangles(dense(TRIANGLE), words)


def unit_transforms(scene):
    """Rows of the affine transform that brings the corners to (0, 0, 0), (1, 0, 0) and (0, 1, 0): that of the height
    first. Zeros if it is none in binary32. Then the triangles as they were, at the same distances."""
    transforms, records, none = array.array("f"), array.array("I", [0]) * (scene.triangle_count * 12), [0.0] * 12
    for word in range(TRIANGLE):
        records[word::12] = scene.words[scene.triangles + word:scene.triangles +
                                        scene.triangle_count * TRIANGLE:TRIANGLE]
    for number in range(scene.triangle_count):
        a, b, c = scene.floats(number)
        e, f = minus(b, a), minus(c, a)
        n = cross(e, f)
        square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2]
        values = []
        for row in (n, cross(f, n), cross(n, e)) if square else ():
            row = [value / square for value in row]
            values += [*row, -(row[0] * a[0] + row[1] * a[1] + row[2] * a[2])]
        transforms.extend(values if values and max(map(abs, values)) < 3e38 else none)
    words = array.array("I", transforms.tobytes())
    words += array.array("I", [0] * (-len(words) % LINE))
    scene.replace_triangles(dense(12), words + records)
    scene.words[24] = scene.words[20] + 4 * len(words)  # where the records are


scene = Scene()
{"apart": materials_apart, "few-lines": in_few_lines, "48": padded(12), "64": padded(16), "shared": indexed,
 "edges": edges, "transforms": unit_transforms}[sys.argv[1]](scene)
scene.write()
