#!/usr/bin/env python3
"""embree_tree.py CHILDREN: a tree of Embree's builder (rtcBuildBVH) over triangles.npy, of nodes of so many children at
most, as nodes.npy and order.npy. What Embree takes for the address of a node is the number of its row, from 1."""
import ctypes.util
import struct
import sys

from tree_arrays import read_boxes, write_tree

POINTER, UINT, SIZE = ctypes.c_void_p, ctypes.c_uint, ctypes.c_size_t
embree = ctypes.CDLL(ctypes.util.find_library("embree4") or "libembree3.so.3")
embree.rtcNewDevice.restype = embree.rtcNewBVH.restype = embree.rtcBuildBVH.restype = POINTER
rows, order = [], []


def add_row(*row):
    rows.append(row)
    return len(rows)


def set_children(node, children, count, user):
    rows[node - 1] = *(child - 1 for child in children[:count]), 0


def create_leaf(memory, words, count, user):
    order.extend(words[7:8 * count:8])
    return add_row(len(order) - count, count)


boxes = [struct.pack("3fI3fI", *box[:3], 0, *box[3:], i) for i, box in enumerate(read_boxes())]  # RTCBuildPrimitive
primitives = ctypes.create_string_buffer(b"".join(boxes))
callbacks = [ctypes.CFUNCTYPE(POINTER, POINTER, UINT, POINTER)(lambda *node: add_row()),
             ctypes.CFUNCTYPE(None, SIZE, ctypes.POINTER(SIZE), UINT, POINTER)(set_children),
             ctypes.CFUNCTYPE(None, SIZE, POINTER, UINT, POINTER)(lambda *bounds: None),
             ctypes.CFUNCTYPE(POINTER, POINTER, ctypes.POINTER(UINT), SIZE, POINTER)(create_leaf)]
assert embree.rtcBuildBVH(struct.pack(  # RTCBuildArguments, 136 bytes
    "N7I2fPPNN7P", 136, 1, 0, int(sys.argv[1]), 32, 1, 1, 7, 1, 1,
    embree.rtcNewBVH(POINTER(embree.rtcNewDevice(b"threads=1"))), ctypes.addressof(primitives), len(boxes), len(boxes),
    *(ctypes.cast(callback, POINTER).value for callback in callbacks), 0, 0, 0)) == 1  # the root is created first
write_tree(rows, order)
