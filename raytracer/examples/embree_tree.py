#!/usr/bin/env python3
"""embree_tree.py CHILDREN [LIBRARY]: a tree of Embree's builder (rtcBuildBVH) over triangles.npy, of nodes of so many
children at most, as nodes.npy, order.npy and boxes.npy. What Embree takes for pointers to nodes are rows, + 1."""
import ctypes
import ctypes.util
import struct
import sys

from tree_arrays import read_triangles, write_tree

POINTER, UINT, BOX = ctypes.c_void_p, ctypes.c_uint, ctypes.c_float * 8  # RTCBounds
most = int(sys.argv[1])
embree = ctypes.CDLL(sys.argv[2] if len(sys.argv) > 2 else ctypes.util.find_library("embree4") or "libembree3.so.3")
embree.rtcNewDevice.restype = embree.rtcNewBVH.restype = embree.rtcBuildBVH.restype = POINTER
rows, boxes, order, boxes_below = [], [], [], {}


def create_node(memory, count, user):
    rows.append([0] * (most + 1))
    boxes.append(whole)
    return len(rows)


def set_bounds(node, bounds, count, user):
    boxes_below[node] = [(*box[0][:3], *box[0][4:7]) for box in bounds[:count]]


def set_children(node, children, count, user):
    for i, box in enumerate(boxes_below[node]):
        rows[node - 1][i], boxes[children[i] - 1] = children[i] - 1, box


def create_leaf(memory, primitives, count, user):
    rows.append([len(order), *[0] * (most - 1), count])
    boxes.append(whole)
    order.extend(fields[7] for fields in struct.iter_unpack("3fI3fI", ctypes.string_at(primitives, 32 * count)))
    return len(rows)


bounds = [(*map(min, t[:3], t[3:6], t[6:]), *map(max, t[:3], t[3:6], t[6:])) for t in read_triangles()]
whole = [*map(min, *[box[:3] for box in bounds]), *map(max, *[box[3:] for box in bounds])]
primitives = ctypes.create_string_buffer(
    b"".join(struct.pack("3fI3fI", *box[:3], 0, *box[3:], i) for i, box in enumerate(bounds)))
callbacks = [ctypes.CFUNCTYPE(POINTER, POINTER, UINT, POINTER)(create_node),
             ctypes.CFUNCTYPE(None, ctypes.c_size_t, ctypes.POINTER(ctypes.c_size_t), UINT, POINTER)(set_children),
             ctypes.CFUNCTYPE(None, ctypes.c_size_t, ctypes.POINTER(ctypes.POINTER(BOX)), UINT, POINTER)(set_bounds),
             ctypes.CFUNCTYPE(POINTER, POINTER, POINTER, ctypes.c_size_t, POINTER)(create_leaf)]
form = "N7I2fPPNN7P"  # RTCBuildArguments
arguments = struct.pack(form, struct.calcsize(form), 1, 0, most, 32, 1, 1, 7, 1, 1,
                        embree.rtcNewBVH(POINTER(embree.rtcNewDevice(b"threads=1"))), ctypes.addressof(primitives),
                        len(bounds), len(bounds), *(ctypes.cast(callback, POINTER).value for callback in callbacks),
                        0, 0, 0)
assert embree.rtcBuildBVH(arguments) == 1  # the root is created first
write_tree(rows, boxes, order)
