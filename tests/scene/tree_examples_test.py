#!/usr/bin/env python3
"""tree_examples_test.py BIN EXAMPLES: raytracer/examples/embree_tree.py with Embree's library, and
tinybvh_tree.py with arrays of the form that tinybvh's class BVH has in memory, made here. Trees are accepted, have the
leaves that were given, and show the same picture."""
import functools
import pathlib
import struct
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402

BIN, EXAMPLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
call = functools.partial(checking.call, BIN)
sys.path.append(str(EXAMPLES))
from tree_arrays import read_triangles  # noqa: E402

TREE = ["--tree", "nodes.npy", "--tree-triangles", "order.npy", "--depth", "62"]
BOXES = ["--tree-boxes", "boxes.npy"]


def run_example(name, *words):
    for path in "nodes.npy", "order.npy", "boxes.npy":
        pathlib.Path(path).unlink(missing_ok=True)
    done = subprocess.run([sys.executable, "-B", EXAMPLES / name, *map(str, words)], capture_output=True, text=True,
                          timeout=100, check=False)
    equal(done.returncode, 0, name, *words, done.stderr)


def read_rows():
    data = pathlib.Path("nodes.npy").read_bytes()
    columns = int(data[:128].decode("latin-1").split("'shape': (")[1].split(",")[1].rstrip("), }"))
    return list(struct.iter_unpack(f"<{columns}i", data[128:]))


def picture(*words):
    call("trax-scene", "generate:fir", *words, "-q", "-o", "s.trax")
    call("trax-scene", "--check", "s.trax")
    call("trax-render", "s.trax", "--size", "32x32", "--engine", "native", "-q", "-o", "s.png")
    return pathlib.Path("s.png").read_bytes()


def embree(ours):
    for most in 2, 4, 8:
        run_example("embree_tree.py", most)
        rows = read_rows()
        equal(max(sum(map(bool, row[:-1])) for row in rows if row[-1] == 0), most, "the most children")
        check(picture(*TREE) == ours, "another picture with a tree of Embree's of", most, "children")


def tinybvh_arrays(triangles, most):
    """Halves along the longest axis. Children are side by side, and node 1 is free."""
    bounds = [[*map(min, t[:3], t[3:6], t[6:]), *map(max, t[:3], t[3:6], t[6:])] for t in triangles]
    nodes, order = [None, (0,) * 8], []

    def build(number, chosen):
        columns = list(zip(*(bounds[i] for i in chosen)))
        low, high = list(map(min, columns[:3])), list(map(max, columns[3:]))
        if len(chosen) <= most:
            nodes[number] = (*low, len(order), *high, len(chosen))
            order.extend(chosen)
            return
        axis = max(range(3), key=lambda axis: high[axis] - low[axis])
        chosen = sorted(chosen, key=lambda i: bounds[i][axis] + bounds[i][axis + 3])
        first = len(nodes)
        nodes.extend([None, None])
        nodes[number] = (*low, first, *high, 0)
        build(first, chosen[:len(chosen) // 2])
        build(first + 1, chosen[len(chosen) // 2:])

    build(0, list(range(len(triangles))))
    return nodes, order


def tinybvh(ours):
    triangles = read_triangles()
    for most in 1, 7, 30:
        nodes, order = tinybvh_arrays(triangles, most)
        pathlib.Path("nodes.bin").write_bytes(b"".join(struct.pack("<3fI3fI", *node) for node in nodes))
        pathlib.Path("indices.bin").write_bytes(struct.pack(f"<{len(order)}I", *order))
        run_example("tinybvh_tree.py", "nodes.bin", "indices.bin")
        rows = read_rows()
        equal(len(rows), len(nodes) - 1, "nodes")
        equal(sorted(row[::2] for row in rows if row[-1]), sorted(n[3::4] for n in nodes if n[7]), "leaves")
        check(picture(*TREE, *BOXES) == ours, "another picture with a tree of tinybvh's form, leaves of", most)


def trees():
    call("trax-scene", "generate:fir", "-q", "--write-triangles", "triangles.npy")
    ours = picture()
    embree(ours)
    tinybvh(ours)


sys.exit(checking.run(trees))
