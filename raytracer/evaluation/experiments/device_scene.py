"""Reads and changes scene.trax (trax/scene_format.h), for converters of experiments, which run in the folder of
prepared inputs."""

import array
import pathlib
import struct

LINE, TRIANGLE = 16, 10  # words


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def negated_if(is_leaf):
    """Negates the references that lead to leaves: those that a specialised program reads are, here they are not."""
    return lambda references: [-reference & 0xFFFFFFFF if is_leaf(reference) else reference for reference in references]


class Scene:
    """The device's scene (trax/scene_format.h) as words, little endian as the host (x86-64), and the places of its
    parts."""

    def __init__(self, path="scene.trax"):
        self.path, self.words = pathlib.Path(path), array.array("I")
        self.words.frombytes(self.path.read_bytes())
        words = self.words
        self.base, layout = words[14:16]
        self.nodes, node_bytes, self.node_count, self.node_size = words[16] // 4, *words[17:19], words[19] // 4
        self.triangles, self.triangle_count = words[20] // 4, words[22]
        self.plane_format = {0: "f", 1: "H"}[layout]  # the default's layouts
        self.children = 2 * 6 * (4 if layout == 0 else 2) // 4
        self.end = self.nodes + node_bytes // 4
        lows, highs = (struct.unpack("<3f", words[at:at + 3].tobytes()) for at in (8, 11))
        self.units = [1.0] * 3 if layout == 0 else [high - low for low, high in zip(lows, highs)]
        self.references(negated_if(lambda reference: reference >> 31))

    def write(self):
        self.references(negated_if(lambda reference: reference & 7))
        self.path.write_bytes(self.words.tobytes())

    def references(self, change):
        """change(list of references) for each node's first children, and their second ones."""
        for child in range(2):
            place = slice(self.nodes + self.children + child, self.end, self.node_size)
            self.words[place] = array.array("I", change(self.words[place]))

    def numbers(self):
        """Pairs of lists: the references of each node's children."""
        return [list(self.words[self.nodes + self.children + child:self.end:self.node_size]) for child in range(2)]

    def node_of(self, reference):
        return (reference - self.base - self.nodes * 4) // (self.node_size * 4)

    def boxes(self, node):
        """Returns the lows and highs of a node's children along each axis. Planes on a grid are in proportion to
        lengths."""
        at = self.nodes + node * self.node_size
        planes = memoryview(self.words)[at:at + self.children].cast("B").cast(self.plane_format)
        return [[[plane * unit for plane,
                  unit in zip(planes[first:first + 3], self.units)] for first in (box, box + 3)] for box in (0, 6)]

    def swap(self, node):
        at, half = self.nodes + node * self.node_size, self.children // 2
        last = at + self.children
        words = self.words
        words[at:at + half], words[at + half:last] = words[at + half:last], words[at:at + half]
        words[last], words[last + 1] = words[last + 1], words[last]

    def floats(self, number):
        """A triangle's corners."""
        at = self.triangles + number * TRIANGLE
        values = struct.unpack("<9f", self.words[at:at + 9].tobytes())
        return values[:3], values[3:6], values[6:]

    def replace_triangles(self, place, words, behind=()):
        """place: maps a leaf's first triangle to a place in `words`, in words; `behind` becomes the section of
        materials."""
        start = self.base + self.triangles * 4

        def moved(references):
            return [
                start + 4 * place(
                    (reference - start) // (TRIANGLE * 4)) + (reference & 7) if reference & 7 else reference
                for reference in references]

        self.references(moved)
        del self.words[self.triangles:]
        self.words[21] = 4 * len(words)
        self.words += words + array.array("I", [0] * (-len(words) % LINE))
        self.words[24] = 4 * len(self.words)
        self.words += array.array("I", behind) + array.array("I", [0] * (-len(behind) % LINE))
        self.words[2] = 4 * len(self.words)

    def leaves(self):
        """First triangle and number of triangles of each leaf, in order."""
        start = self.base + self.triangles * 4
        return sorted(((reference - start) // (TRIANGLE * 4),
                       reference & 7) for references in self.numbers() for reference in references if reference & 7)
