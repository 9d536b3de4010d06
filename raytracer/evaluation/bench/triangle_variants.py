"""What a triangle is in memory, and which test it is for."""

import array
import re
import struct

from device_scene import LINE, TRIANGLE, Variant, cross, minus

# --- what is done to the scene


def dense(size):
    return lambda number: number * size


def padded(size):
    def change(scene):
        old, new = scene.words[scene.triangles:scene.triangles + scene.triangle_count * TRIANGLE], array.array("I", [0]) * (scene.triangle_count * size)
        for word in range(TRIANGLE):
            new[word::size] = old[word::TRIANGLE]
        scene.replace_triangles(dense(size), new)

    return change


def at_even_words(scene, size, word_of):
    """Leaves of triangles of `size` words, each from an even word on; materials apart, found by the triangle's place in steps of a power of two."""
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
    """Rows of the affine transform that brings the corners to (0, 0, 0), (1, 0, 0) and (0, 1, 0): that of the height first. Zeros if it is none in binary32. Then
    the triangles as they were, at the same distances."""
    transforms, records, none = array.array("f"), array.array("I", [0]) * (scene.triangle_count * 12), [0.0] * 12
    for word in range(TRIANGLE):
        records[word::12] = scene.words[scene.triangles + word:scene.triangles + scene.triangle_count * TRIANGLE:TRIANGLE]
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


# --- and to the source: file, what is there, what takes its place


def stride(size):
    return [("traverse.h", "sizeof(struct trax_triangle)", f"{size}u")]


def material(address):
    return [("shade.h", "load_word(triangle + 36)", f"load_word({address})")]


HEADER = "((const struct trax_scene_header *)scene.data)"
APART = material(f"(const char *)scene.data + {HEADER}->sections[TRAX_SCENE_MATERIALS].offset + "
                 f"(((uint32_t)triangle - {HEADER}->base - {HEADER}->sections[TRAX_SCENE_TRIANGLES].offset) >> 5 << 2)")
INDEXED = [("triangle.h", "int corner) {\n", "int corner) {\n  const char *at = ((const char *const *)(const void *)triangle)[corner];\n"),
           ("triangle.h", re.compile(r"triangle \+ ray->offset_([uvw]) \+ 12 \* corner"), r"at + ray->offset_\1"),
           ("triangle.h", "*words = (const uint32_t *)(const void *)triangle, *others = (const uint32_t *)(const void *)other;",
            "*const *words = (const uint32_t *const *)(const void *)triangle, *const *others = (const uint32_t *const *)(const void *)other;"),
           ("triangle.h", "word = words[i], other_word = others[i];", "word = words[i / 3][i % 3], other_word = others[i / 3][i % 3];"),
           ("shade.h", "*v0 = (const float *)(const void *)hit->triangle, *v1 = v0 + 3, *v2 = v0 + 6;",
            "*const *corner = (const float *const *)(const void *)hit->triangle, *v0 = corner[0], *v1 = corner[1], *v2 = corner[2];")]
MOLLER_TRUMBORE = [("triangle.h", "#define TRAX_TRIANGLE TRAX_WATERTIGHT", "#define TRAX_TRIANGLE TRAX_MOLLER_TRUMBORE")]
EDGES = [*MOLLER_TRUMBORE,
         ("triangle.h", "f = minus(load_vector(v2), a)", "f = load_vector(v2)"),
         ("triangle.h", "e = minus(load_vector(v1), a)", "e = load_vector(v1)"),
         ("shade.h", re.compile(r"e = minus\(load_vector\(v1\), a\), f = minus\(load_vector\(v2\), a\)"), "e = load_vector(v1), f = load_vector(v2)")]
TRANSFORM_TEST = """  const float *row0 = (const float *)(const void *)triangle;
  float height = dot(load_vector(row0), ray->origin) + row0[3];
  float determinant = dot(load_vector(row0), ray->direction);
  int32_t size_bits = magnitude(determinant), sign = float_bits(determinant) & SIGN_BIT;
  if (size_bits < LEAST_DETERMINANT_BITS)
    return false;
  int32_t scaled_bits = float_bits(-height) ^ sign;
  if (scaled_bits <= 0 ||
      scaled_bits > float_bits(bits_float(hit->distance_bits) * bits_float(size_bits)) + UNITS_OF_DOUBT)
    return false;
  float weight[2];
  for (int row = 0; row < 2; row++) {
    const float *at = row0 + 4 + 4 * row;
    float start = dot(load_vector(at), ray->origin) + at[3];
    float step = dot(load_vector(at), ray->direction);
    weight[row] = bits_float(float_bits(start * determinant - height * step) ^ sign);
    if ((uint32_t)float_bits(weight[row]) > (uint32_t)SIGN_BIT || float_bits(weight[row]) > size_bits)
      return false;
  }
  if (float_bits(weight[0] + weight[1]) > size_bits)
    return false;
  return accept_hit(triangle, any, -height, determinant, bits_float(float_bits(weight[0]) ^ sign),
                    bits_float(float_bits(weight[1]) ^ sign), hit);
}
"""
RECORD = f"{HEADER}->sections[TRAX_SCENE_MATERIALS].offset - {HEADER}->sections[TRAX_SCENE_TRIANGLES].offset"
TRANSFORMS = [*MOLLER_TRUMBORE, *stride(48), *material(f"triangle + 36 + {RECORD}"),
              ("triangle.h", re.compile(r"  const float \*v0 = \(const float \*\)\(const void \*\)triangle, \*v1.*?\n}\n", re.S), TRANSFORM_TEST),
              ("shade.h", "(const void *)hit->triangle, *v1", f"(const void *)(hit->triangle + {RECORD}), *v1")]


TRIANGLES = [
    Variant("40 bytes"),
    Variant("36 bytes, materials apart", stride(36) + APART, materials_apart),
    Variant("40 bytes, leaves in few lines", (), in_few_lines),
    Variant("48 bytes", stride(48), padded(12)),
    Variant("64 bytes", stride(64), padded(16)),
    Variant("16 bytes, shared vertices", stride(16) + INDEXED + material("triangle + 12"), indexed),
    Variant("40 bytes, Möller and Trumbore", MOLLER_TRUMBORE, None, True),
    Variant("the same, vertex and edges", EDGES, edges, True),
    Variant("48 bytes, unit transform", TRANSFORMS, unit_transforms, True),
]
