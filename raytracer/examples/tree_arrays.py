"""The arrays of docs/own-tree.md, without numpy: for embree_tree.py and tinybvh_tree.py."""
import array
import pathlib
import struct


def read_triangles(path="triangles.npy"):
    """Nine coordinates each."""
    data = pathlib.Path(path).read_bytes()
    return list(struct.iter_unpack("<9f", data[10 + struct.unpack_from("<H", data, 8)[0]:]))


def write_array(path, kind, shape, values):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    values = array.array("f" if kind == "<f4" else "i", values)
    pathlib.Path(path).write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
                                   + values.tobytes())


def write_tree(rows, boxes, order):
    """rows: of children, of which 0 is none, or the place in `order`, and a count; boxes: six numbers each."""
    write_array("nodes.npy", "<i4", (len(rows), len(rows[0])), [value for row in rows for value in row])
    write_array("boxes.npy", "<f4", (len(boxes), 6), [value for box in boxes for value in box])
    write_array("order.npy", "<i4", (len(order),), order)
