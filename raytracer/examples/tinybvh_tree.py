#!/usr/bin/env python3
"""tinybvh_tree.py NODES INDICES: a tree of tinybvh's class BVH as nodes.npy, order.npy and boxes.npy. A program has
written its arrays:

    fwrite(bvh.bvhNode, sizeof(BVH::BVHNode), bvh.usedNodes, nodes);
    fwrite(bvh.primIdx, sizeof(uint32_t), bvh.idxCount, indices);

A node has 32 bytes: aabbMin, leftFirst, aabbMax, triCount. An inner node has triCount 0 and the children leftFirst and
leftFirst + 1; a leaf has the triangles primIdx[leftFirst] and further. Node 1 is not used."""
import array
import pathlib
import struct
import sys

from tree_arrays import write_tree

records = list(struct.iter_unpack("<3fI3fI", pathlib.Path(sys.argv[1]).read_bytes()))
rows, boxes = [], []


def node(number):
    *low, left_first, x, y, z, count = records[number]
    row = len(rows)
    rows.append((left_first, 0, count))
    boxes.append((*low, x, y, z))
    if count == 0:
        rows[row] = node(left_first), node(left_first + 1), 0
    return row


node(0)
write_tree(rows, array.array("I", pathlib.Path(sys.argv[2]).read_bytes()), boxes)
