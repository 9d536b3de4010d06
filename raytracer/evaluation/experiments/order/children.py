"""Sorts the children of a specialised program's nodes, in the folder of its inputs: children.py
axis|box|surface|likelier"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from device_scene import TRIANGLE, Scene, cross, minus  # noqa: E402


def box_area(box):
    x, y, z = minus(box[1], box[0])
    return x * y + y * z + z * x


class Below:
    """Returns the areas of a child's box and of its triangles, and the mean cost of a visit, where a node and a
    triangle cost 1."""

    def __init__(self, box, surface, cost):
        self.area, self.surface, self.cost = box_area(box) or 1e-30, surface, cost


def sort_children(scene, worth):
    """First the child that is worth more."""
    sums, total = [0.0], 0.0
    for number in range(scene.triangle_count):
        a, b, c = scene.floats(number)
        total += math.hypot(*cross(minus(b, a), minus(c, a))) / 2
        sums.append(total)
    start, children, nodes = scene.base + scene.triangles * 4, scene.numbers(), {}
    pending = [(scene.node_of(scene.words[4]), False)]

    def below(reference, box):
        first, count = (reference - start) // (TRIANGLE * 4), reference & 7
        if count:
            return Below(box, sums[first + count] - sums[first], count)
        pair = nodes[scene.node_of(reference)]
        child = Below(box, sum(grandchild.surface for grandchild in pair), 1)
        child.cost += sum(grandchild.area * grandchild.cost for grandchild in pair) / child.area
        return child

    while pending:
        node, done = pending.pop()
        pair = [references[node] for references in children]
        if done:
            nodes[node] = list(map(below, pair, scene.boxes(node)))
            if worth(nodes[node][0]) < worth(nodes[node][1]):
                scene.swap(node)
        else:
            pending += [(node, True), *[(scene.node_of(reference), False) for reference in pair if not reference & 7]]


def larger_box_first(scene):
    sort_children(scene, lambda child: child.area)


def larger_surface_first(scene):
    """Orders children after Nah and Manocha, "SATO: Surface Area Traversal Order for Shadow Ray Tracing" (Computer
    Graphics Forum 33(6), 2014)."""
    sort_children(scene, lambda child: child.surface)


def likelier_per_cost_first(scene):
    """A line through a box meets surface / area triangles that lie in it at random."""
    sort_children(scene, lambda child: (1 - math.exp(-child.surface / child.area)) / child.cost)


def axis_in_reference(scene):
    """The axis along which the children's middles are farthest apart in bits 3 and 4 of a node's reference, and the
    child first that is lower along it."""
    axes = []
    for node in range(scene.node_count):
        middles = [[low + high for low, high in zip(*box)] for box in scene.boxes(node)]
        apart = minus(middles[1], middles[0])
        axes.append(max(range(3), key=lambda axis: abs(apart[axis])))
        if apart[axes[-1]] < 0:
            scene.swap(node)

    def marked(references):
        return [
            reference if reference & 7 else reference | axes[scene.node_of(reference)] << 3 for reference in references]

    scene.references(marked)
    scene.words[4], = marked([scene.words[4]])


scene = Scene()
{"axis": axis_in_reference, "box": larger_box_first, "surface": larger_surface_first,
 "likelier": likelier_per_cost_first}[sys.argv[1]](scene)
scene.write()
