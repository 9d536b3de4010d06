"""Which child of a node is visited first."""

import math
import re

from device_scene import TRIANGLE, Variant, cross, minus

# --- what is done to the scene


def box_area(box):
    x, y, z = minus(box[1], box[0])
    return x * y + y * z + z * x


class Below:
    """What is below a child: its box's and its triangles' areas, and what a visit costs on the average, where a node and a triangle cost 1."""

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
    """In the manner of Nah and Manocha, "SATO: Surface Area Traversal Order for Shadow Ray Tracing" (Computer Graphics Forum 33(6), 2014)."""
    sort_children(scene, lambda child: child.surface)


def likelier_per_cost_first(scene):
    """A line through a box meets surface / area triangles that lie in it at random."""
    sort_children(scene, lambda child: (1 - math.exp(-child.surface / child.area)) / child.cost)


def axis_in_reference(scene):
    """The axis along which the children's middles are farthest apart in bits 3 and 4 of a node's reference, and the child first that is lower along it."""
    axes = []
    for node in range(scene.node_count):
        middles = [[low + high for low, high in zip(*box)] for box in scene.boxes(node)]
        apart = minus(middles[1], middles[0])
        axes.append(max(range(3), key=lambda axis: abs(apart[axis])))
        if apart[axes[-1]] < 0:
            scene.swap(node)

    def marked(references):
        return [reference if reference & 7 else reference | axes[scene.node_of(reference)] << 3 for reference in references]

    scene.references(marked)
    scene.words[4], = marked([scene.words[4]])


# --- and to the source: file, what is there, what takes its place

KIND_OF_RAY = [("traverse.h", "struct stack_entry **top) {", "struct stack_entry **top, bool any) {"),
               ("traverse.h", "reference, top)", "reference, top, any)"),
               ("traverse.h", "&reference, &top)", "&reference, &top, any)")]
AXIS = [*KIND_OF_RAY,
        ("traverse.h", "scene_at(scene, *reference);", "scene_at(scene, *reference & ~31u);"),
        ("ray.h", "  struct triangle_ray triangle;\n", "  struct triangle_ray triangle;\n  uint32_t signs; /* bit 31: of x, bit 23: of y, bit 15: of z */\n"),
        ("ray.h", "  ray->near_offset_x = ", """  ray->signs = ((uint32_t)float_bits(way.x) & 0x80000000u) | ((uint32_t)float_bits(way.y) >> 31 << 23) |
               ((uint32_t)float_bits(way.z) >> 31 << 15);
  HIDE_ORIGIN(ray->signs);
  ray->near_offset_x = """)]
BY_SIGN = "(int32_t)(ray->signs << (*reference & 31)) >= 0"


def first_if(condition):
    return [("traverse.h", "if (enter0 <= enter1) {", f"if ({condition}) {{")]


# After a shadow ray that was stopped the next one of the thread first tries what stopped it.
REMEMBERED = [("path.h", re.compile(r"(trace_ray\([^;]*)\);"), r"\1, NULL);"),
              ("main.c", "shadow, &hit);", "shadow, &hit, last);"),
              ("main.c", "uint32_t layout, struct pixel pixel) {\n  struct vector sum", "uint32_t layout, struct pixel pixel, trax_scene_ref *last) {\n  struct vector sum"),
              ("main.c", "render_pixel(run, layout, pixel)", "render_pixel(run, layout, pixel, &last)"),
              ("main.c", "uint32_t layout) {\n  uint32_t slot", "uint32_t layout) {\n  trax_scene_ref last = 0;\n  uint32_t slot"),
              ("traverse.h", "bool any, struct hit *hit) {\n  struct stack_entry stack", "bool any, struct hit *hit, trax_scene_ref *last) {\n  struct stack_entry stack"),
              ("traverse.h", "  if (root == 0)\n    return false;\n", """  if (root == 0)
    return false;
  if (any && last && *last) {
    *top++ = (struct stack_entry){root, INT32_MIN};
    reference = *last;
  }
"""),
              ("traverse.h", "        return hit->triangle != NULL;", "        return last && any ? (*last = 0, false) : hit->triangle != NULL;")]


def remember(what):
    return [("traverse.h", "any, hit) && any)\n          return true;", f"any, hit) && any) {{\n        if (last)\n          *last = {what};\n        return true;\n      }}")]


ORDERS = [
    Variant("by distance"),
    Variant("fixed", first_if("true")),
    Variant("fixed, shadow rays", KIND_OF_RAY + first_if("any || enter0 <= enter1")),
    Variant("fixed, primary rays", KIND_OF_RAY + first_if("!any || enter0 <= enter1")),
    Variant("by the direction's sign", AXIS + first_if(BY_SIGN), axis_in_reference),
    Variant("by sign, shadow rays", AXIS + first_if(f"any ? {BY_SIGN} : enter0 <= enter1"), axis_in_reference),
    Variant("by sign, primary rays", AXIS + first_if(f"any ? enter0 <= enter1 : {BY_SIGN}"), axis_in_reference),
    Variant("farther first, shadow rays", KIND_OF_RAY + first_if("any ? enter0 > enter1 : enter0 <= enter1")),
    Variant("larger box first, shadow rays", KIND_OF_RAY + first_if("any || enter0 <= enter1"), larger_box_first),
    Variant("larger surface first, shadow rays", KIND_OF_RAY + first_if("any || enter0 <= enter1"), larger_surface_first),
    Variant("likelier per cost first, shadow rays", KIND_OF_RAY + first_if("any || enter0 <= enter1"), likelier_per_cost_first),
    Variant("what was in the last one's way first, triangle", REMEMBERED + remember("(uint32_t)triangle | 1")),
    Variant("what was in the last one's way first, leaf", REMEMBERED + remember("reference")),
]
