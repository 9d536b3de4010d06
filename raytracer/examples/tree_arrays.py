"""The arrays of docs/own-tree.md, without numpy: for embree_tree.py and tinybvh_tree.py."""
import array
import pathlib
import struct


def read_triangles(path="triangles.npy"):
    """Nine coordinates each."""
    data = pathlib.Path(path).read_bytes()
    return list(struct.iter_unpack("<9f", data[10 + struct.unpack_from("<H", data, 8)[0]:]))


def read_boxes():
    """Six numbers each: the least and the greatest corner."""
    return [(*map(min, t[:3], t[3:6], t[6:]), *map(max, t[:3], t[3:6], t[6:])) for t in read_triangles()]


def write_array(path, kind, shape, values):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    values = array.array("f" if kind == "<f4" else "i", values)
    pathlib.Path(path).write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
                                   + values.tobytes())


def write_tree(rows, order, boxes=()):
    """rows: children, or the place in `order`, and behind them a count; boxes: of each row six numbers, or of none."""
    most = max(3, *map(len, rows))
    write_array("nodes.npy", "<i4", (len(rows), most),
                [value for *first, count in rows for value in (*first, *[0] * (most - 1 - len(first)), count)])
    write_array("order.npy", "<i4", (len(order),), order)
    if boxes:
        write_array("boxes.npy", "<f4", (len(boxes), 6), [value for box in boxes for value in box])
