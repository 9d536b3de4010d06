#!/usr/bin/env python3
"""own_tree_test.py BIN: trees that are built here, by a median split in Python, given to trax-scene as arrays."""
import functools
import json
import math
import pathlib
import random
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN = pathlib.Path(sys.argv[1]).resolve()
INFINITE = float("inf")
call = functools.partial(checking.call, BIN)


# --- arrays ---


def npy(path, code, shape, values, version=1, header=None):
    header = header or f"{{'descr': '{code}', 'fortran_order': False, 'shape': {tuple(shape)}, }}"
    size = "<H" if version == 1 else "<I"
    pad = -(8 + struct.calcsize(size) + len(header) + 1) % 64
    text = header.encode() + b" " * pad + b"\n"
    letter = {"i4": "i", "u4": "I", "i8": "q", "u8": "Q", "f4": "f", "f8": "d"}[code[1:]]
    pathlib.Path(path).write_bytes(b"\x93NUMPY" + bytes([version, 0]) + struct.pack(size, len(text)) + text +
                                   struct.pack(f"<{len(values)}{letter}", *values))


def read_triangles(path):
    data = pathlib.Path(path).read_bytes()
    size, = struct.unpack_from("<H", data, 8)
    count = (len(data) - 10 - size) // 36
    check(f"'shape': ({count}, 3, 3, )" in data[10:10 + size].decode() and (10 + size) % 64 == 0, "header", data[:128])
    return [struct.unpack_from("<9f", data, 10 + size + 36 * i) for i in range(count)]


# --- a builder ---


def box_of(triangle):
    return [min(triangle[axis::3]) for axis in range(3)] + [max(triangle[axis::3]) for axis in range(3)]


def around(boxes):
    return [min(box[axis] for box in boxes)
            for axis in range(3)] + [max(box[axis] for box in boxes) for axis in range(3, 6)]


def median_split(triangles, most):
    """(nodes, order, boxes): halves at the median of the longest axis."""
    bounds = [box_of(triangle) for triangle in triangles]
    nodes, order, boxes = [], [], []

    def build(chosen):
        row = len(nodes)
        nodes.append(None)
        box = around([bounds[i] for i in chosen])
        boxes.append(box)
        if len(chosen) <= most:
            nodes[row] = (len(order), 0, len(chosen))
            order.extend(chosen)
            return row
        axis = max(range(3), key=lambda axis: box[axis + 3] - box[axis])
        chosen = sorted(chosen, key=lambda i: (bounds[i][axis] + bounds[i][axis + 3], i))
        half = len(chosen) // 2
        nodes[row] = (build(chosen[:half]), build(chosen[half:]), 0)
        return row

    build(list(range(len(triangles))))
    return nodes, order, boxes


def widen(nodes, boxes, most, children_of):
    """Rows of up to `most` children, for which children_of(number) chooses nodes below a node."""
    rows, kept = [], []

    def place(number):
        row = len(rows)
        rows.append(None)
        kept.append(boxes[number])
        if nodes[number][2]:
            rows[row] = (nodes[number][0], *[0] * (most - 1), nodes[number][2])
        else:
            children = [place(child) for child in children_of(number)]
            rows[row] = (*children, *[0] * (most - len(children)), 0)
        return row

    place(0)
    return rows, kept


def whole_levels(nodes, levels):
    """Joins so many levels of the tree into one node: halves of its children are the binary tree's again."""
    def children_of(number):
        children = [number]
        for _ in range(levels):
            if any(nodes[child][2] for child in children):
                break
            children = [below for child in children for below in nodes[child][:2]]
        return children
    return children_of


def any_children(nodes, most, chance):
    def children_of(number):
        children = list(nodes[number][:2])
        while len(children) < most and chance.random() < 0.9:
            which = chance.randrange(len(children))
            if not nodes[children[which]][2]:
                children[which:which + 1] = nodes[children[which]][:2]
        return children
    return children_of


def split_leaves(nodes, boxes):
    """The tree that docs/own-tree.md says larger leaves become: the fewest leaves of seven at most, halved in order."""
    rows, kept = [], []
    none = [0] * (len(nodes[0]) - 3)

    def place_leaf(number, first, count):
        row, leaves = len(rows), -(-count // 7)
        rows.append((first, 0, *none, count))
        kept.append(boxes[number])
        if leaves > 1:
            half = count * (leaves // 2) // leaves
            rows[row] = (place_leaf(number, first, half), place_leaf(number, first + half, count - half), *none, 0)
        return row

    def place(number):
        *children, count = nodes[number]
        if count:
            return place_leaf(number, children[0], count)
        row = len(rows)
        rows.append(None)
        kept.append(boxes[number])
        rows[row] = (*[place(child) if child else 0 for child in children], 0)
        return row

    place(0)
    return rows, kept


def write(nodes, order, boxes, code="<i4"):
    npy("nodes.npy", code, (len(nodes), len(nodes[0])), [value for row in nodes for value in row])
    npy("order.npy", code, (len(order),), order)
    npy("boxes.npy", "<f4", (len(nodes), 2, 3), [value for box in boxes for value in box])


TREE = ["--tree", "nodes.npy", "--tree-triangles", "order.npy"]
BOXES = ["--tree-boxes", "boxes.npy"]


# --- the picture is the same, the work is not ---


def write_mesh(path, triangles):
    pathlib.Path(path).write_text("".join("v %.9g %.9g %.9g\n" * 3 % triangle for triangle in triangles) +
                                  "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(len(triangles))))


def measure(*words):
    call("trax-scene", *words, "-q", "-o", "s.trax")
    call("trax-scene", "--check", "s.trax")
    call("trax-render", "s.trax", "--view", "forest", "--size", "32x18", "-q", "-o", "s.png", "--stats", "s.json")
    return pathlib.Path("s.png").read_bytes(), json.loads(pathlib.Path("s.json").read_text())["cycles"]


def pictures():
    call("trax-scene", "generate:forest", "-q", "--write-triangles", "t.npy")
    write_mesh("few.obj", read_triangles("t.npy")[::5])
    call("trax-scene", "few.obj", "-q", "--write-triangles", "t.npy")
    triangles = read_triangles("t.npy")
    check(len(triangles) > 30000, len(triangles))
    ours, our_cycles = measure("few.obj")
    nodes, order, boxes = median_split(triangles, 4)
    write(nodes, order, boxes)
    theirs, cycles = measure("few.obj", *TREE)
    check(ours == theirs, "another picture with a tree of medians")
    scene = pathlib.Path("s.trax").read_bytes()
    for most, levels in ((5, 2), (8, 3)):
        wide, wide_boxes = widen(nodes, boxes, most, whole_levels(nodes, levels))
        check(len(wide) < 0.9 * len(nodes), most, "children:", len(wide), "rows of", len(nodes))
        write(wide, order, wide_boxes)
        call("trax-scene", "few.obj", *TREE, *BOXES, "-q", "-o", "s.trax")
        check(pathlib.Path("s.trax").read_bytes() == scene, most, "children make another scene than two")
    write(nodes, order, boxes)
    check(cycles > 1.02 * our_cycles, "a tree of medians takes", cycles, "cycles, ours", our_cycles)
    print(f"cycles: ours {our_cycles}, medians {cycles}")
    with_boxes, again = measure("few.obj", *TREE, *BOXES)
    check(with_boxes == ours and again == cycles, "exact boxes change something")
    for kind in ("binary", "quantised"):
        check(measure("few.obj", *TREE, "--nodes", kind)[0] == ours, "another picture with nodes", kind)
    wide, wide_boxes = widen(nodes, boxes, 7, any_children(nodes, 7, random.Random(37)))
    check({sum(map(bool, row[:-1])) for row in wide if not row[-1]} == set(range(2, 8)), "numbers of children")
    write(wide, order, wide_boxes)
    check(measure("few.obj", *TREE, *BOXES)[0] == ours, "another picture with up to 7 children")


def large_leaves():
    """Leaves of any size: the file is that of the tree with split leaves, and the picture the same, in every layout."""
    call("trax-scene", "generate:fir", "-q", "--write-triangles", "t.npy")
    triangles = read_triangles("t.npy")
    nodes, order, boxes = median_split(triangles, 50)
    wide_rows, wide_boxes = widen(nodes, boxes, 4, whole_levels(nodes, 2))
    wide, whole = (wide_rows, order, wide_boxes), boxes[0]
    middle = (whole[0] + whole[3]) / 2
    left = [i for i in order if box_of(triangles[i])[0] <= middle]
    right = [i for i in order if box_of(triangles[i])[3] > middle]
    check(len(left) + len(right) > len(order), "no triangle is in two leaves")
    halves = [whole, [*whole[:3], middle, *whole[4:]], [middle, *whole[1:]]]
    native = "--size", "32x32", "--engine", "native", "-q"
    call("trax-render", "generate:fir", *native, "-o", "ours.png")
    for rows, elements, row_boxes in (
            (nodes, order, boxes), wide, ([(0, 0, len(order))], order, [whole]),
            ([(1, 2, 0), (0, 0, len(left)), (len(left), 0, len(right))], left + right, halves)):
        check(max(row[-1] for row in rows) > 25, "small leaves")
        split, split_boxes = split_leaves(rows, row_boxes)
        check(max(row[-1] for row in split) <= 7, "large leaves")
        for layout in "binary", "quantised", "wide4", "wide4-quantised", "wide8":
            for name, *arrays in ("large", rows, elements, row_boxes), ("split", split, elements, split_boxes):
                write(*arrays)
                call("trax-scene", "generate:fir", *TREE, *BOXES, "--nodes", layout, "-q", "-o", f"{name}.trax")
            check(pathlib.Path("large.trax").read_bytes() == pathlib.Path("split.trax").read_bytes(), layout,
                  "another file than with split leaves", len(rows), "rows")
            call("trax-render", "large.trax", *native, "-o", "s.png")
            check(pathlib.Path("s.png").read_bytes() == pathlib.Path("ours.png").read_bytes(), layout,
                  "another picture with large leaves", len(rows), "rows")


def forms():
    """Other types, versions, orders of keys, a tree of one leaf, and triangles in several leaves."""
    call("trax-scene", "big.obj", "-q", "--write-triangles", "t.npy")
    triangles = read_triangles("t.npy")
    nodes, order, boxes = median_split(triangles, 2)
    scenes = []
    for code in ("<i4", "<u4", "<i8", "<u8"):
        write(nodes, order, boxes, code)
        call("trax-scene", "big.obj", *TREE, "-q", "-o", "s.trax")
        scenes.append(pathlib.Path("s.trax").read_bytes())
    npy("order.npy",
        "<i4", (len(order), ),
        order,
        version=3,
        header=f'{{"shape": ({len(order)},), "fortran_order":True,"descr":"<i4"}}')
    call("trax-scene", "big.obj", *TREE, "-q", "-o", "s.trax")
    scenes.append(pathlib.Path("s.trax").read_bytes())
    check(len(set(scenes)) == 1, "types and versions make different scenes")
    call("trax-scene", "one.obj", "-q", "--write-triangles", "t.npy")
    triangles = read_triangles("t.npy")
    write([(0, 0, 1)], [0], [box_of(triangles[0])])
    call("trax-scene", "one.obj", *TREE, "-q", "-o", "s.trax")
    # Parts of triangles that are cut at a subnormal number are rounded outwards, but not beyond the triangles.
    corners = [(i, i * 7 % 5, i * 8 % 5) for i in range(11)]
    write_mesh("strip.obj", [corners[i] + corners[i + 1] + corners[i + 2] for i in range(9)])
    whole, cut = [-99] * 3 + [99] * 3, [-99, 2.5e-44, -99, 99, 2, 99]
    rows = [(1, 2, 3, 0, 0), (0, 0, 0, 0, 6), (0, 0, 0, 0, 3), (6, 0, 0, 0, 3)]
    write(rows, list(range(9)), [whole, whole, cut, whole])
    call("trax-scene", "strip.obj", *TREE, *BOXES, "--nodes", "quantised", "-q", "-o", "s.trax")
    call("trax-scene", "--check", "s.trax")
    # The large triangle in two leaves, each time with a half of its box.
    low, high = box_of(triangles[0])[:3], box_of(triangles[0])[3:]
    middle = (low[0] + high[0]) / 2
    write([(1, 2, 0), (0, 0, 1), (1, 0, 1)], [0, 0],
          [low + high, low + [middle, high[1], high[2]], [middle, low[1], low[2]] + high])
    done = call("trax-scene", "one.obj", *TREE, *BOXES, "-q", "-o", "s.trax", "--stats-json", "s.json")
    check(json.loads(pathlib.Path("s.json").read_text())["bvh.leaves_of_1"] == 2, done.stdout)


# --- what is refused ---


def refuse(message, *words, mesh="big.obj", place="nodes.npy"):
    pathlib.Path("old.trax").write_text("old")
    done = call("trax-scene", mesh, *(words or TREE), "-o", "old.trax", status=1)
    check(message in done.stderr and place in done.stderr, "expected", message, "but it says", done.stderr)
    check(pathlib.Path("old.trax").read_bytes() == b"old", "the file of before is gone")
    check(not [path for path in pathlib.Path().iterdir() if path.name.startswith("old.trax.")], "a file is left")


def write_chain(inner_nodes):
    """A tree for many.obj in which each left child is a leaf."""
    counts = [1] * (inner_nodes + 1)
    counts[-1] = min(7, 42 - len(counts))
    counts[0] += 41 - sum(counts)
    rows = [row for i in range(inner_nodes)
            for row in ((2 * i + 1, 2 * i + 2, 0),
                        (sum(counts[:i]), 0, counts[i]))] + [(41 - counts[-1], 0, counts[-1])]
    write(rows, list(range(41)), [[0] * 6] * len(rows))


def refusals():
    call("trax-scene", "big.obj", "-q", "--write-triangles", "t.npy")
    triangles = read_triangles("t.npy")
    good = median_split(triangles, 2)
    inner = next(i for i, row in enumerate(good[0]) if row[2] == 0 and i > 0)
    leaf = next(i for i, row in enumerate(good[0]) if row[2] == 2)

    def changed(row, value):
        nodes = list(good[0])
        nodes[row] = value
        write(nodes, *good[1:])

    count = len(good[0])
    for value, message in ((count, f"node {inner}: its left child is {count}, and the nodes are 0 to {count - 1}"),
                           (-1, "its left child is -1"), (0, "its child is node 0, the root"),
                           (good[0][inner][1], "is node"), (2**31 - 1, "2147483647")):
        changed(inner, (value, good[0][inner][1], 0))
        refuse(message)
    changed(inner, (inner, good[0][inner][1], 0))
    refuse(f"its child {inner} is node")
    changed(leaf, (len(good[1]) - 1, 0, 2))
    refuse("has no place in order.npy")
    changed(leaf, (0, 0, 11))
    refuse("a count of 11; a leaf has 1 to 10 triangles, those of order.npy, and an inner node 0")
    changed(leaf, (3, 0, 8))
    refuse("a leaf of 8 triangles has no place in order.npy, which has 10")
    write([(1, 2, 0), (0, 0, 9), (1, 0, 9)], good[1], [good[2][0]] * 3)
    refuse("node 2: with this one's 9, leaves of more than 7 have more triangles than the 10 of order.npy")
    write([(0, 0, 10)], good[1][1:2] + good[1][1:], good[2][:1])
    refuse("node 0: a leaf with triangle", *TREE, *BOXES)
    write([(0, 0, 10)], good[1], good[2][:1])
    call("trax-scene", "big.obj", *TREE, "--depth", "1", "-q", "-o", "s.trax")
    write([(0, 0, 15)], [*range(15)], good[2][:1])
    refuse("node 0: the tree is deeper than 1 inner nodes", *TREE, "--depth", "1", mesh="more.obj")
    changed(leaf, (0, 0, -2))
    refuse("a count of -2")
    changed(0, (0, 0, 2))
    refuse("is not below the root")
    nodes = [(1, 2, 0), (0, 0, 2), (2, 0, 2), (4, 3, 0), (3, 4, 0)]
    write(nodes, good[1], [good[2][0]] * 5)
    refuse("node 3 is not below the root")
    write(good[0], [len(triangles)] + good[1][1:], good[2])
    refuse(f"element 0 is triangle {len(triangles)}, and the mesh's are 0 to", place="order.npy")
    write(good[0], good[1][1:2] + good[1][1:], good[2])
    refuse("twice")
    other = next(i for i in range(2, len(good[1])) if good[1][i] != good[1][0])
    write(good[0], good[1][other:other + 1] + good[1][1:], good[2])
    refuse("needs --tree-boxes", place="order.npy")
    wide, wide_boxes = widen(good[0], good[2], 4, whole_levels(good[0], 2))
    for row, message in (((1, 0, 0, 0, 0), "node 0: an inner node with 1 children; it has 2 to 4"),
                         ((0, 0, 0, 0, 0), "node 0: an inner node with 0 children"),
                         ((1, 2, 2, 0, 0), "its child 2 is node 0's, too"), ((1, 2, -1, 0, 0), "its third child is -1"),
                         ((0, 0, 0, 0, 11), "a count of 11")):
        write([row, *wide[1:]], good[1], wide_boxes)
        refuse(message)
    write([(*row[:-1], *[0] * 5, row[-1]) for row in wide], good[1], wide_boxes)
    refuse("for k children, (N, k + 1)")
    for inner_nodes in (33, 40):
        write_chain(inner_nodes)
        refuse("the tree is deeper than 32 inner nodes; --depth 62", mesh="many.obj")
        call("trax-scene", "many.obj", *TREE, "--depth", "62", "-q", "-o", "s.trax")
    write_chain(32)
    call("trax-scene", "many.obj", *TREE, "-q", "-o", "s.trax")

    def boxed(row, box, message):
        boxes = list(good[2])
        boxes[row] = box
        write(*good[:2], boxes)
        refuse(message, *TREE, *BOXES, place="boxes.npy")

    lower = good[2][leaf]
    boxed(leaf, [value + 0.01 for value in lower[:3]] + lower[3:], "which no other leaf has, is not within its box")
    boxed(inner, [lower[0]] * 6, "its box does not contain that of its child")
    boxed(inner, [float("nan")] + lower[1:], "its box is from nan")
    boxed(0, [-INFINITE] + good[2][0][1:], "its box is from -inf")
    boxed(leaf, lower[3:] + lower[:3], "its box is from")
    write(*good)
    refuse("need each other", *TREE[:2], place="--tree")
    refuse("without --tree", *BOXES, place="--tree")
    for words in (["--leaf", "2"], ["--splits"], ["--passes", "0"]):
        refuse("is a tree that is built", *TREE, *words, place="--tree")
    refuse("cannot", "--tree", "none.npy", *TREE[2:], place="none.npy")
    # One triangle in two leaves that leave a part of it out.
    call("trax-scene", "one.obj", "-q", "--write-triangles", "one.npy")
    one = box_of(read_triangles("one.npy")[0])
    third, low, high = (one[3] - one[0]) / 3, one[:3], one[3:]
    write([(1, 2, 0), (0, 0, 1), (1, 0, 1)], [0, 0],
          [one, low + [low[0] + third, *high[1:]], [high[0] - third, *low[1:], *high]])
    refuse("triangle", *TREE, *BOXES, mesh="one.obj")
    write([(0, 0, 1)], [0], [one])
    refuse("no leaf has triangle 1", mesh="twins.obj", place="order.npy")
    beyond = [2 * value for value in high]
    write([(1, 2, 0), (0, 0, 1), (1, 0, 1)], [0, 0], [low + beyond, one, [value + 1 for value in high] + beyond])
    refuse("node 2: triangle 0 is not in its box", *TREE, *BOXES, mesh="one.obj", place="boxes.npy")
    write([(1, 2, 0), (0, 0, 1), (1, 0, 1)], [0, 0], [one, one, one])
    refuse("would be several lamps", *TREE, *BOXES, "--material", "emit:1,1,1", mesh="one.obj", place="order.npy")
    write([(1, 2, 0), (0, 0, 2), (2, 0, 2)], [0, 1, 0, 1], [one] * 3)
    refuse("are at one place", *TREE, *BOXES, mesh="twins.obj", place="order.npy")


def damaged():
    """Files that are no arrays are refused."""
    call("trax-scene", "big.obj", "-q", "--write-triangles", "t.npy")
    nodes, order, boxes = median_split(read_triangles("t.npy"), 2)
    write(nodes, order, boxes)
    whole, rows = pathlib.Path("nodes.npy").read_bytes(), [value for row in nodes for value in row]
    for end in (0, 5, 9, 40, 100, len(whole) - 1):
        pathlib.Path("nodes.npy").write_bytes(whole[:end])
        refuse("nodes.npy")
    pathlib.Path("nodes.npy").write_bytes(whole + b"x")
    refuse("but the file has")
    pathlib.Path("nodes.npy").write_bytes(whole[:6] + b"\x09" + whole[7:])
    refuse("version 9")
    for header, message in (
            ("{'descr': '>i4', 'fortran_order': False, 'shape': (%d, 3), }", "'>i4', not"),
            ("{'descr': '<i4', 'fortran_order': True, 'shape': (%d, 3), }", "Fortran"),
            ("{'descr': '<i4', 'fortran_order': False, 'shape': (3, %d), }", "(N, 3)"),
            ("{'descr': '<i4', 'fortran_order': 0, 'shape': (%d, 3), }", "True or False"),
            ("{'descr': '<i4', 'shape': (%d, 3), }", "lacks"),
            ("{'descr': '<i4', 'other': (%d, 3), }", "no key 'other'"),
            ("{'descr': '<i4', 'descr': '<i4', 'shape': (%d, 3), }", "no key 'descr', or it has it once"),
            ("{'descr': '<i4', 'fortran_order': False, 'shape': (%d, 3, 1, 1), }", "more than 3 dimensions"),
            ("{'descr': '<i4', 'fortran_order': False, 'shape': (%d, 99999999999999999, 9999999), }", "2^60"),
            ("[%d]", "a dictionary"),
            ("{'descr': [('left', '<i4')], 'shape': (%d, 3)}", "the type of the elements")):
        npy("nodes.npy", "<i4", (), rows, header=header % len(nodes))
        refuse(message)
    npy("nodes.npy", "<f4", (len(nodes), 3), rows)
    refuse("'<f4', not '<i4'")
    write(nodes, order, boxes)
    npy("order.npy", "<i4", (len(order), 1), order)
    refuse("the shape of the leaves' triangles is (M,)", place="order.npy")
    for few in ([], order[:len(nodes) // 2]):
        npy("order.npy", "<i4", (len(few),), few)
        refuse(f"{len(nodes)} nodes; a tree over the {len(few)} triangles of order.npy has fewer")
    write(nodes, order, boxes)
    npy("boxes.npy", "<f8", (len(nodes), 6), [value for box in boxes for value in box])
    refuse(".astype('<f4')", *TREE, *BOXES, place="boxes.npy")
    for shape in ((len(nodes), 3, 2), (len(nodes), 5), (6 * len(nodes),)):
        npy("boxes.npy", "<f4", shape, [0] * math.prod(shape))
        refuse("(N, 2, 3) or (N, 6)", *TREE, *BOXES, place="boxes.npy")
    npy("boxes.npy", "<f4", (len(nodes) - 1, 6), [value for box in boxes[1:] for value in box])
    refuse("(N, 2, 3) or (N, 6)", *TREE, *BOXES, place="boxes.npy")


def meshes():
    points = [(0.1 * i, (i * 7) % 5, (i * 3) % 4) for i in range(12)]
    text = "".join("v %g %g %g\n" % point for point in points)
    pathlib.Path("big.obj").write_text(text + "".join(f"f {i + 1} {i + 2} {i + 3}\n" for i in range(10)))
    pathlib.Path("more.obj").write_text(text * 2 + "".join(f"f {i + 1} {i + 2} {i + 3}\n" for i in range(10)) +
                                        "".join(f"f {i + 13} {i + 14} {i + 16}\n" for i in range(5)))
    pathlib.Path("one.obj").write_text("v 0 0 0\nv 4 1 0\nv 4 0 3\nf 1 2 3\n")
    pathlib.Path("twins.obj").write_text("v 0 0 0\nv 4 1 0\nv 4 0 3\nf 1 2 3\nf 1 2 3\n")
    pathlib.Path("many.obj").write_text("".join(
        f"v {i} 0 0\nv {i} 1 0\nv {i} 0 1\nf {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(41)))


sys.exit(checking.run(meshes, forms, large_leaves, refusals, damaged, pictures))
