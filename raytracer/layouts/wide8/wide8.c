/* Nodes of up to eight children in a frame of their own (struct trax_wide8_node). */
#include "../layouts.h"

#include <math.h>
#include <string.h>

enum { SCALE_BIAS = 149, LAST_PLANE = 255, MOST_TRIANGLES = 32 /* of a node's leaves: places have five bits */ };
#define NONE UINT32_MAX

/* A plane is the exact sum value + rest, so that comparisons with coordinates are exact. */
struct plane {
  double value, rest;
};

static struct plane plane_at(float origin, double distance) {
  const double value = (double)origin + distance, part = value - (double)origin;
  return (struct plane){value, ((double)origin - (value - part)) + (distance - part)};
}

static struct plane plane_of(float origin, uint32_t number, int scale) {
  return plane_at(origin, ldexp((double)number, scale - SCALE_BIAS));
}

static bool is_below(struct plane plane, float coordinate) {
  return plane.value < (double)coordinate || (plane.value == (double)coordinate && plane.rest < 0);
}

static bool is_above(struct plane plane, float coordinate) {
  return plane.value > (double)coordinate || (plane.value == (double)coordinate && plane.rest > 0);
}

/* Rounded into the box, so that the same box is written again. */
static float not_below(struct plane plane) {
  const float rounded = (float)plane.value;
  return is_above(plane, rounded) ? scene_next_float(rounded, true) : rounded;
}

static float not_above(struct plane plane) {
  const float rounded = (float)plane.value;
  return is_below(plane, rounded) ? scene_next_float(rounded, false) : rounded;
}

/* The last plane that is not above a coordinate. */
static uint8_t plane_below(float origin, int scale, float coordinate) {
  const double number = floor(ldexp((double)coordinate - (double)origin, SCALE_BIAS - scale));
  uint32_t q = (uint32_t)fmax(fmin(number + 1, LAST_PLANE), 0);
  while (q > 0 && is_above(plane_of(origin, q, scale), coordinate))
    q--;
  return (uint8_t)q;
}

/* The first plane that is not below it. */
static uint8_t plane_above(float origin, int scale, float coordinate) {
  const double number = ceil(ldexp((double)coordinate - (double)origin, SCALE_BIAS - scale));
  uint32_t q = (uint32_t)fmax(fmin(number - 1, LAST_PLANE), 0);
  while (q < LAST_PLANE && is_below(plane_of(origin, q, scale), coordinate))
    q++;
  return (uint8_t)q;
}

/* The least scale with which the last plane is not below a coordinate. */
static uint8_t scale_for(float origin, float coordinate) {
  const double extent = (double)coordinate - (double)origin;
  int scale = extent > 0 ? ilogb(extent) - 9 + SCALE_BIAS : 0;
  scale = scale < 0 ? 0 : scale;
  while (scale < 255 && is_below(plane_of(origin, LAST_PLANE, scale), coordinate))
    scale++;
  return (uint8_t)scale;
}

static void write_node(void *bytes, const struct trax_node_format *format, const struct scene_node *node) {
  struct trax_wide8_node *out = bytes;
  (void)format;
  const struct scene_box whole = scene_box_around(node); /* of exact boxes */
  *out = (struct trax_wide8_node){.reserved = 0};
  memset(out->min, LAST_PLANE, sizeof out->min);
  for (int axis = 0; axis < 3; axis++) {
    out->origin[axis] = whole.min[axis] + 0.0f; /* not -0 */
    out->scale[axis] = scale_for(whole.min[axis], whole.max[axis]);
  }
  uint32_t nodes = 0, triangles = 0;
  for (uint32_t i = 0; i < node->count; i++) {
    const trax_scene_ref child = node->child[i];
    const uint32_t slot = node->slot[i], count = TRAX_SCENE_REF_COUNT(child);
    if (count) {
      out->first_triangle = triangles ? out->first_triangle : TRAX_SCENE_REF_OFFSET(child);
      out->meta[slot] = (uint8_t)(count | triangles << 3);
      triangles += count;
    } else {
      out->first_node = nodes ? out->first_node : child;
      out->meta[slot] = (uint8_t)(++nodes << 3);
    }
    for (int axis = 0; axis < 3; axis++) {
      out->min[axis][slot] = plane_below(out->origin[axis], out->scale[axis], node->box[i].min[axis]);
      out->max[axis][slot] = plane_above(out->origin[axis], out->scale[axis], node->box[i].max[axis]);
    }
  }
}

static void read_node(struct scene_node *node, const struct trax_node_format *format, const void *bytes) {
  const struct trax_wide8_node *in = bytes;
  (void)format;
  node->count = 0;
  for (uint32_t slot = 0; slot < TRAX_NODE_MOST_CHILDREN; slot++) {
    const uint32_t meta = in->meta[slot], count = TRAX_SCENE_REF_COUNT(meta), place = meta >> 3;
    if (!meta)
      continue;
    const uint32_t i = node->count++;
    node->slot[i] = (uint8_t)slot;
    node->child[i] = count ? (in->first_triangle + place * (uint32_t)sizeof(struct trax_triangle)) | count
                           : in->first_node + (place - 1) * (uint32_t)sizeof(struct trax_wide8_node);
    for (int axis = 0; axis < 3; axis++) {
      node->box[i].min[axis] = not_below(plane_of(in->origin[axis], in->min[axis][slot], in->scale[axis]));
      node->box[i].max[axis] = not_above(plane_of(in->origin[axis], in->max[axis][slot], in->scale[axis]));
    }
  }
}

static struct scene_box box_in_frame(const void *bytes, const struct scene_box *box) {
  const struct trax_wide8_node *node = bytes;
  struct scene_box stored;
  for (int axis = 0; axis < 3; axis++) {
    const float origin = node->origin[axis];
    const int scale = node->scale[axis];
    const struct plane low = plane_of(origin, plane_below(origin, scale, box->min[axis]), scale);
    const struct plane high = plane_of(origin, plane_above(origin, scale, box->max[axis]), scale);
    /* There is no plane beyond the frame. */
    stored.min[axis] = is_above(low, box->min[axis]) ? box->min[axis] : not_below(low);
    stored.max[axis] = is_below(high, box->max[axis]) ? box->max[axis] : not_above(high);
  }
  return stored;
}

static double cell_of(const void *bytes, int axis) {
  return ldexp(1, ((const struct trax_wide8_node *)bytes)->scale[axis] - SCALE_BIAS);
}

/* Scales of frames that are out of range belong to nodes smaller than any margin. */
static void scale_frame(void *bytes, const struct trax_node_format *format, int exponent) {
  struct trax_wide8_node *node = bytes;
  (void)format;
  trax_scale_floats(node->origin, 3, exponent);
  for (int axis = 0; axis < 3; axis++) {
    const int scale = node->scale[axis] + exponent;
    node->scale[axis] = (uint8_t)(scale < 0 ? 0 : scale > 255 ? 255 : scale);
  }
}

/* A reference that no child uses moves, too; nothing reads it. */
static void relocate(void *bytes, const struct trax_node_format *format, uint32_t address) {
  struct trax_wide8_node *node = bytes;
  (void)format;
  node->first_node += address, node->first_triangle += address;
}

/* Slots in the order of rays: a child is in the slot along whose diagonal it lies farthest, the clearest cases first.
 */
static void choose_slots(struct scene_wide_node *node, const struct scene_box *boxes, const struct scene_box *whole) {
  const struct scene_wide_node old = *node;
  bool taken[TRAX_NODE_MOST_CHILDREN] = {false};
  uint32_t child_of[TRAX_NODE_MOST_CHILDREN];
  bool placed[TRAX_NODE_MOST_CHILDREN] = {false};
  for (uint32_t round = 0; round < old.count; round++) {
    uint32_t best_slot = NONE, best_child = 0;
    double best = 0;
    for (uint32_t i = 0; i < old.count; i++)
      for (uint32_t slot = 0; slot < TRAX_NODE_MOST_CHILDREN; slot++) {
        if (placed[i] || taken[slot])
          continue;
        const struct scene_box *box = &boxes[old.child[i]];
        double along = 0;
        for (int axis = 0; axis < 3; axis++) {
          const double away = (double)box->min[axis] - whole->min[axis] + ((double)box->max[axis] - whole->max[axis]);
          along += slot >> axis & 1 ? away : -away;
        }
        if (best_slot == NONE || along > best)
          best = along, best_slot = slot, best_child = i;
      }
    taken[best_slot] = placed[best_child] = true;
    child_of[best_slot] = old.child[best_child];
  }
  node->count = 0;
  for (uint32_t slot = 0; slot < TRAX_NODE_MOST_CHILDREN; slot++)
    if (taken[slot]) {
      node->slot[node->count] = (uint8_t)slot;
      node->child[node->count++] = child_of[slot];
    }
}

const struct node_code wide8_code = {write_node,   read_node, scale_frame,  relocate,
                                     box_in_frame, cell_of,   choose_slots, MOST_TRIANGLES};
