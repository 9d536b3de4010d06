#!/usr/bin/env python3
"""embree_tree.py CHILDREN [LIBRARY]: a tree of Embree's builder (rtcBuildBVH) over triangles.npy, of nodes of so many
children at most, as nodes.npy, order.npy and boxes.npy. The form of its nodes is the caller's. Here what Embree takes
for pointers are places in a list."""
import ctypes
import ctypes.util
import sys

from tree_arrays import read_triangles, write_tree

POINTER, SIZE, UINT, FLOAT = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_uint, ctypes.c_float
most = int(sys.argv[1])
library = sys.argv[2] if len(sys.argv) > 2 else ctypes.util.find_library("embree4") or "libembree3.so.3"
embree = ctypes.CDLL(library)
embree.rtcNewDevice.restype = embree.rtcNewBVH.restype = embree.rtcBuildBVH.restype = POINTER


class Box(ctypes.Structure):  # RTCBounds and RTCBuildPrimitive
    _fields_ = [("low", FLOAT * 3), ("mesh", UINT), ("high", FLOAT * 3), ("triangle", UINT)]


class Arguments(ctypes.Structure):  # RTCBuildArguments
    _fields_ = [("bytes", SIZE), *((name, UINT) for name in ("quality", "flags", "children", "depth", "block", "least",
                                                             "most_in_leaf")),
                ("traversal_cost", FLOAT), ("intersection_cost", FLOAT), ("bvh", POINTER), ("primitives", POINTER),
                ("count", SIZE), ("capacity", SIZE), *((f"callback{i}", POINTER) for i in range(6)), ("user", POINTER)]


nodes = [None]  # of each: triangles, children, their boxes


def create_node(memory, count, user, triangles=()):
    nodes.append([triangles, (), ()])
    return len(nodes) - 1


def set_children(node, children, count, user):
    nodes[node][1] = children[:count]


def set_bounds(node, bounds, count, user):
    nodes[node][2] = [(*bounds[i][0].low, *bounds[i][0].high) for i in range(count)]


def create_leaf(memory, primitives, count, user):
    return create_node(memory, 0, user, [primitives[i].triangle for i in range(count)])


CALLBACKS = [ctypes.CFUNCTYPE(POINTER, POINTER, UINT, POINTER)(create_node),
             ctypes.CFUNCTYPE(None, SIZE, ctypes.POINTER(SIZE), UINT, POINTER)(set_children),
             ctypes.CFUNCTYPE(None, SIZE, ctypes.POINTER(ctypes.POINTER(Box)), UINT, POINTER)(set_bounds),
             ctypes.CFUNCTYPE(POINTER, POINTER, ctypes.POINTER(Box), SIZE, POINTER)(create_leaf)]
bounds = [(*map(min, t[:3], t[3:6], t[6:]), *map(max, t[:3], t[3:6], t[6:])) for t in read_triangles()]
primitives = (Box * len(bounds))(*(Box(box[:3], 0, box[3:], i) for i, box in enumerate(bounds)))
arguments = Arguments(ctypes.sizeof(Arguments), 1, 0, most, 32, 1, 1, 7, 1, 1,
                      embree.rtcNewBVH(POINTER(embree.rtcNewDevice(b"threads=1"))), ctypes.addressof(primitives),
                      len(bounds), len(bounds), *(ctypes.cast(callback, POINTER) for callback in CALLBACKS))
root = embree.rtcBuildBVH(ctypes.byref(arguments))
rows, boxes, order = [], [], []


def place(number, box):
    triangles, children, child_boxes = nodes[number]
    row = len(rows)
    rows.append((len(order), *[0] * (most - 1), len(triangles)))
    boxes.append(box)
    order.extend(triangles)
    if children:
        rows[row] = *map(place, children, child_boxes), *[0] * (most - len(children)), 0
    return row


columns = list(zip(*bounds))
place(root, (*map(min, columns[:3]), *map(max, columns[3:])))
write_tree(rows, boxes, order)
