#!/usr/bin/env python3
"""Makes other nodes of the binary ones that a specialised program reads: nodes.py
quantised8|wide|wide-quantised|wide-quantised8

Run in the folder that trax-render --prepare has written, on scene.trax. Scenes of `wide` must have binary nodes, those
of the others quantised ones.

Wide nodes have up to four children: two pairs of two boxes and two references, one pair behind the other. Children that
are not there have the reference 0 and stand behind the others; their boxes are turned inside out. Of the binary tree
the largest child gives way to its own two until there are four. Wide nodes stand in the order of the binary ones that
they begin with.

Nodes with frames (quantised8, wide-quantised8) begin with three words, an axis each. Planes are numbers of 8 bits in
this frame: 256 at equal distances, a power of two times the cells of the scene's grid. A word is the binary32 number
FRAME_BIAS + p, where p is the first plane's place in cells, with FRAME_EXPONENT + e in its last nine bits, if planes
are 2^e cells apart: p is what both together make it. So the traversal takes the word as a float as it is. The frame is
the one of least e, and of these of greatest p, that has room for all boxes."""

import array
import math
import pathlib
import struct
import sys

BINARY, QUANTISED = 0, 1
LAYOUTS = {"quantised8": 2, "wide": 3, "wide-quantised": 4, "wide-quantised8": 5}
ENTRIES = 32  # of the traversal's stack (WIDE_ENTRIES)
LINE, TRIANGLE, HEADER, SECTIONS = 64, 40, 192, 64  # bytes
GRID_LAST, FINEST_CELL = 65535, 2**-7
FRAME_EXPONENT, FRAME_LEAST, FRAME_BITS = 149, -7, 0x47800000  # the bits of 65536.0


def plain(reference):
    """Decodes a reference. A specialised program reads those that lead to leaves negated."""
    return -reference & 0xFFFFFFFF if reference >> 31 else reference


class Scene:
    """The device's scene (trax/scene_format.h), little endian as the host."""

    def __init__(self, path):
        self.data = path.read_bytes()
        self.words = array.array("I", self.data)
        self.root, self.base, self.layout = self.words[4], self.words[14], self.words[15]
        self.sections = [list(self.words[at : at + 4]) for at in range(16, 48, 4)]
        (self.nodes, _, self.count, self.node_bytes), (self.triangles, *_) = self.sections[:2]
        self.low, self.high = (struct.unpack_from("<3f", self.data, at) for at in (32, 44))
        if self.sections[6][2]:
            sys.exit("nodes.py: error: scenes with textures are not converted")

    def node_of(self, reference):
        return (reference - self.base - self.nodes) // self.node_bytes

    def node(self, number):
        """Two boxes of six planes, least ones first, and two references."""
        at = self.nodes + number * self.node_bytes
        values = struct.unpack_from("<12f2I" if self.layout == BINARY else "<12H2I", self.data, at)
        return values[:6], values[6:12], [plain(reference) for reference in values[12:]]

    def cells(self):
        """Origin and cell of the grid along each axis (trax_scene_grid_of)."""
        greatest = max(map(abs, self.low + self.high))
        cells = []
        for low, high in zip(self.low, self.high):
            least = max((high - low) / (GRID_LAST - 1), 2.0**-40 * greatest, 2.0**-149)
            exponent = max(math.frexp(least)[1] - 8, -149)
            cells.append((low, math.ldexp(math.ceil(math.ldexp(least, -exponent)), exponent)))
        return cells

    def fine_box(self, reference, coarse, cells):
        """A leaf's box in cells, rounded outwards to FINEST_CELL: of its triangles, as far as they are in the one that
        is stored."""
        first = reference - self.base - (reference & 7)
        corners = struct.unpack_from("<" + "9f4x" * (reference & 7), self.data, first)
        box = []
        for side, choose, round_off in ((0, min, math.floor), (3, max, math.ceil)):
            for axis, (origin, cell) in enumerate(cells):
                plane = round_off((choose(corners[axis::3]) - origin) / cell / FINEST_CELL) * FINEST_CELL
                box.append(max(plane, coarse[axis]) if side == 0 else min(plane, coarse[3 + axis]))
        return tuple(box)


def around(boxes):
    columns = list(zip(*boxes))
    return (*map(min, columns[:3]), *map(max, columns[3:]))


def half_area(box, units):
    x, y, z = ((box[3 + axis] - box[axis]) * units[axis] for axis in range(3))
    return x * y + y * z + z * x


class Tree:
    """The scene's nodes by number: children as (box, reference), boxes of whole nodes, and how many nodes are on the
    longest way down."""

    def __init__(self, scene, fine):
        self.scene, self.children, self.boxes, self.heights = scene, [None] * scene.count, [None] * scene.count, [
            0] * scene.count
        cells = scene.cells()
        self.units = [1] * 3 if scene.layout == BINARY else [cell for _, cell in cells]
        pending = [scene.root]
        while pending:  # children before their parents
            number = scene.node_of(pending[-1])
            *boxes, references = scene.node(number)
            below = [reference for reference in references if not reference & 7]
            if self.children[number] is None and below:
                self.children[number] = ()
                pending += below
                continue
            pending.pop()
            for side, reference in enumerate(references):
                if reference & 7 and fine:
                    boxes[side] = scene.fine_box(reference, boxes[side], cells)
                elif not reference & 7:
                    boxes[side] = self.boxes[scene.node_of(reference)]
            self.children[number] = tuple(zip(boxes, references))
            self.boxes[number] = around(boxes)
            self.heights[number] = 1 + max([self.heights[scene.node_of(reference)] for reference in below], default=0)

    def height(self, reference):
        return 0 if reference & 7 else self.heights[self.scene.node_of(reference)]

    def widen(self):
        """Children of the wide nodes, up to four, by the number of the binary one that each begins with."""
        wide, pending = {}, [(self.scene.root, ENTRIES)]
        while pending:
            reference, entries = pending.pop()
            number = self.scene.node_of(reference)
            children = list(self.children[number])
            while len(children) < 4:
                best = None
                for place, (box, child) in enumerate(children):
                    if child & 7:
                        continue
                    own = self.children[self.scene.node_of(child)]
                    others = [*children[:place], *children[place + 1 :], *own]
                    if any(len(children) + self.height(other) > entries for _, other in others):
                        continue  # below each there must be room for a tree as it is now
                    area = half_area(box, self.units)
                    if best is None or area > best[0]:
                        best = area, place, own
                if best is None:
                    break
                children[best[1] : best[1] + 1] = best[2]
            wide[number] = children
            pending += [(child, entries - (len(children) - 1)) for _, child in children if not child & 7]
        return wide


def frame(low, high):
    """(word, first plane, distance of planes) of the frame around an interval in cells."""
    exponent = max(FRAME_LEAST, math.frexp((high - low) / 255)[1] - 1 if high > low else FRAME_LEAST)
    while True:
        rest = exponent + FRAME_EXPONENT
        fours = min(math.floor((4 + low - rest / 128) / 4), 2**14 - 1)
        first = 4 * fours + rest / 128 - 4
        if high - first <= 255 * 2.0**exponent:
            return FRAME_BITS | fours << 9 | rest, first, 2.0**exponent
        exponent += 1


def record(name, children, box):
    """A node's bytes. children: (box, reference), as many as there are."""
    width = 2 if name == "quantised8" else 4
    children = [*children, *[((*box[3:], *box[:3]), 0)] * (width - len(children))]
    data, plane = b"", "f" if name == "wide" else "H"
    if name.endswith("8"):
        frames, plane = [frame(box[axis], box[3 + axis]) for axis in range(3)], "B"
        data = struct.pack("<3I", *(word for word, _, _ in frames))
        children = [([math.floor((child[axis] - first) / step) for axis, (_, first, step) in enumerate(frames)]
                     + [math.ceil((child[3 + axis] - first) / step) for axis, (_, first, step) in enumerate(frames)],
                     reference) for child, reference in children]
    for pair in range(0, width, 2):
        (first, left), (second, right) = children[pair : pair + 2]
        data += struct.pack(f"<12{plane}2I", *first, *second, left, right)
    return data + b"\0" * (-len(data) % (LINE if width == 4 else LINE // 2))


def convert(path, name):
    scene = Scene(path)
    if scene.layout != (BINARY if name == "wide" else QUANTISED):
        sys.exit(f"nodes.py: error: {name}: the scene needs {'binary' if name == 'wide' else 'quantised'} nodes")
    if not scene.root or scene.root >> 31:
        sys.exit("nodes.py: error: the scene has no nodes")
    if scene.words[5] > ENTRIES:
        sys.exit(
            f"nodes.py: error: the tree is {scene.words[5]} nodes deep; the stack has {ENTRIES} entries (trax-scene "
            f"--depth)"
        )
    tree = Tree(scene, name.endswith("8"))
    nodes = dict(enumerate(tree.children)) if name == "quantised8" else tree.widen()
    if name != "quantised8":
        nodes = {number: nodes[number] for number in sorted(nodes)}
    places = {number: place for place, number in enumerate(nodes)}
    size = len(record(name, tree.children[0], tree.boxes[0]))
    length = len(nodes) * size
    shift = -(-(scene.nodes + length) // LINE) * LINE - scene.triangles  # of what is behind the nodes
    start = scene.base + scene.nodes

    def moved(reference):
        if not reference:
            return 0
        return -(reference + shift) & 0xFFFFFFFF if reference & 7 else start + places[scene.node_of(reference)] * size

    data = bytearray(scene.data[:HEADER])
    for number, children in nodes.items():
        boxes = [box for box, _ in children]
        data += record(name, [(box, moved(reference)) for box, reference in children], around(boxes))
    data += b"\0" * (-len(data) % LINE) + scene.data[scene.triangles :]
    sections = [[offset + shift, *rest] if offset > scene.nodes else [offset, *rest] for offset,
                *rest in scene.sections]
    sections[0] = [scene.nodes, length, len(nodes), size]
    struct.pack_into("<I", data, 8, len(data))
    struct.pack_into("<I", data, 16, moved(scene.root))
    struct.pack_into("<I", data, 60, LAYOUTS[name])
    struct.pack_into("<32I", data, SECTIONS, *(word for section in sections for word in section))
    path.write_bytes(data)


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in LAYOUTS:
        sys.exit(f"nodes.py: error: usage: nodes.py {'|'.join(LAYOUTS)}")
    convert(pathlib.Path("scene.trax"), sys.argv[1])
