/* Layouts of pairs: each is two boxes of six planes, the three least ones first, and two references. */
#include "layouts.h"

#include <string.h>

/* The offsets in a node of pairs of a child's box, and of its reference. */
static uint32_t pair_of(const struct trax_node_format *format, uint32_t child) {
  return child / 2 * (12 * format->plane_bytes + 2 * (uint32_t)sizeof(trax_scene_ref));
}
static uint32_t box_of(const struct trax_node_format *format, uint32_t child) {
  return pair_of(format, child) + child % 2 * 6 * format->plane_bytes;
}
static uint32_t reference_of(const struct trax_node_format *format, uint32_t child) {
  return pair_of(format, child) + 12 * format->plane_bytes + child % 2 * (uint32_t)sizeof(trax_scene_ref);
}

static void write_plane(unsigned char *to, uint32_t bytes, float plane) {
  if (bytes == sizeof plane) {
    memcpy(to, &plane, sizeof plane);
    return;
  }
  const uint16_t number = (uint16_t)plane;
  memcpy(to, &number, sizeof number);
}

static float read_plane(const unsigned char *from, uint32_t bytes) {
  uint16_t number;
  float plane;
  if (bytes == sizeof plane) {
    memcpy(&plane, from, sizeof plane);
    return plane;
  }
  memcpy(&number, from, sizeof number);
  return number;
}

static void write_pairs(void *bytes, const struct trax_node_format *format, const struct scene_node *node) {
  const struct scene_box whole = scene_box_around(node);
  const struct scene_box inside_out = {{whole.max[0], whole.max[1], whole.max[2]},
                                       {whole.min[0], whole.min[1], whole.min[2]}};
  memset(bytes, 0, format->bytes);
  for (uint32_t i = 0; i < format->children; i++) {
    const struct scene_box *box = i < node->count ? &node->box[i] : &inside_out;
    unsigned char *plane = (unsigned char *)bytes + box_of(format, i);
    for (int axis = 0; axis < 3; axis++, plane += format->plane_bytes) {
      write_plane(plane, format->plane_bytes, box->min[axis]);
      write_plane(plane + 3 * format->plane_bytes, format->plane_bytes, box->max[axis]);
    }
    if (i < node->count)
      memcpy((unsigned char *)bytes + reference_of(format, i), &node->child[i], sizeof *node->child);
  }
}

static void read_pairs(struct scene_node *node, const struct trax_node_format *format, const void *bytes) {
  node->count = 0;
  for (uint32_t i = 0; i < format->children; i++) {
    const unsigned char *plane = (const unsigned char *)bytes + box_of(format, i);
    for (int axis = 0; axis < 3; axis++, plane += format->plane_bytes) {
      node->box[i].min[axis] = read_plane(plane, format->plane_bytes);
      node->box[i].max[axis] = read_plane(plane + 3 * format->plane_bytes, format->plane_bytes);
    }
    memcpy(&node->child[i], (const unsigned char *)bytes + reference_of(format, i), sizeof *node->child);
    if (!node->child[i])
      break;
    node->count++;
  }
}

/* Boxes on the grid scale with the grid. */
static void scale_pairs(void *bytes, const struct trax_node_format *format, int exponent) {
  for (uint32_t child = 0; child < format->children && !format->quantised; child++)
    trax_scale_floats((float *)(void *)((unsigned char *)bytes + box_of(format, child)), 6, exponent);
}

static void relocate_pairs(void *bytes, const struct trax_node_format *format, uint32_t address) {
  for (uint32_t i = 0; i < format->children; i++) {
    trax_scene_ref *child = (trax_scene_ref *)(void *)((unsigned char *)bytes + reference_of(format, i));
    *child = *child ? trax_ref_at(*child, address) : 0;
  }
}

const struct node_code pairs_code = {
    .write = write_pairs, .read = read_pairs, .scale = scale_pairs, .relocate = relocate_pairs};
