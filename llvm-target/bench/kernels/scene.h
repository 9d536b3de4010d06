/* A scene for the ray tracer's own sources: hills of 32 x 32 squares, two triangles each, seen from one side. */
#ifndef TRAX_BENCH_SCENE_H
#define TRAX_BENCH_SCENE_H

#include "../bench.h"
#include "layouts/records.h"
#include "trax/render_params.h"

/* The parameters of raytracer/device/run.h for this scene: twelve levels, binary nodes, a whole stack. */
#define TRAX_TREE_DEPTH 12
#define TRAX_STACK_ENTRIES 12
#define TRAX_NODE_LAYOUT TRAX_NODES_BINARY

#include <stddef.h>

enum { SIDE = 32, SQUARES = SIDE * SIDE, TRIANGLES = 2 * SQUARES, WIDTH = 64, HEIGHT = 48 };

static struct {
  struct trax_scene_header header;
  struct trax_bvh_node nodes[SQUARES - 1];
  struct trax_triangle triangles[TRIANGLES];
} hills __attribute__((aligned(64)));

static struct {
  struct trax_render_params params;
  struct trax_palette_entry palette[4];
} frame;

/* Every other bit of a number in Morton order. */
static inline unsigned even_bits(unsigned code) {
  unsigned value = 0;
  for (int bit = 0; bit < 5; bit++)
    value |= (code >> (2 * bit) & 1) << bit;
  return value;
}

static float heights[SIDE + 1][SIDE + 1];

static void make_heights(void) {
  uint32_t random = 1;
  for (int y = 0; y <= SIDE; y++)
    for (int x = 0; x <= SIDE; x++)
      heights[y][x] = 2 * next_float(&random);
  for (int pass = 0; pass < 2; pass++)
    for (int y = 1; y < SIDE; y++)
      for (int x = 1; x < SIDE; x++)
        heights[y][x] = (heights[y - 1][x] + heights[y + 1][x] + heights[y][x - 1] + heights[y][x + 1]) * 0.25f;
}

static void make_triangle(struct trax_triangle *triangle, unsigned x, unsigned y, unsigned half) {
  /* The square's corners go round; the triangles share 0 and 2. */
  for (unsigned corner = 0; corner < 3; corner++) {
    unsigned at = corner == 0 ? 0 : corner + half;
    unsigned cx = x + (at == 1 || at == 2), cy = y + (at >= 2);
    float *vertex = corner == 0 ? triangle->v0 : corner == 1 ? triangle->v1 : triangle->v2;
    vertex[0] = (float)(int)cx;
    vertex[1] = heights[cy][cx];
    vertex[2] = -(float)(int)cy;
  }
  triangle->material = (x + y) & 3;
}

static void grow_box(float *min, float *max, const float *point) {
  for (int axis = 0; axis < 3; axis++) {
    if (point[axis] < min[axis])
      min[axis] = point[axis];
    if (point[axis] > max[axis])
      max[axis] = point[axis];
  }
}

/* A complete binary tree over the squares in Morton order: node i of a level has the children 2i and 2i + 1. */
static void make_tree(void) {
  for (unsigned i = SQUARES - 1; i-- > 0;) {
    struct trax_bvh_node *node = &hills.nodes[i];
    for (unsigned side = 0; side < 2; side++) {
      unsigned child = 2 * i + 1 + side;
      float *min = node->box[side].min, *max = node->box[side].max;
      for (int axis = 0; axis < 3; axis++)
        min[axis] = 1e30f, max[axis] = -1e30f;
      if (child < SQUARES - 1) {
        node->child[side] = offsetof(__typeof__(hills), nodes) + child * sizeof(struct trax_bvh_node);
        for (int grandchild = 0; grandchild < 2; grandchild++) {
          grow_box(min, max, hills.nodes[child].box[grandchild].min);
          grow_box(min, max, hills.nodes[child].box[grandchild].max);
        }
        continue;
      }
      unsigned first = 2 * (child - (SQUARES - 1));
      node->child[side] = (offsetof(__typeof__(hills), triangles) + first * sizeof(struct trax_triangle)) | 2;
      for (unsigned triangle = first; triangle < first + 2; triangle++) {
        grow_box(min, max, hills.triangles[triangle].v0);
        grow_box(min, max, hills.triangles[triangle].v1);
        grow_box(min, max, hills.triangles[triangle].v2);
      }
    }
  }
}

static void make_frame(void) {
  static const struct trax_render_params params = {.width = WIDTH,
                                                   .height = HEIGHT,
                                                   .slot_count = WIDTH * HEIGHT,
                                                   .tile_log2_side = 3,
                                                   .tiles_across = WIDTH / 8,
                                                   .row_multiplier = 0x80000001u,
                                                   .row_shift = 3,
                                                   .eye = {16.3f, 9.7f, 8.1f},
                                                   .corner = {-0.8f, 0.15f, -1.0f},
                                                   .step_x = {1.6f / WIDTH, 0, 0},
                                                   .step_y = {0, -1.1f / HEIGHT, -0.35f / HEIGHT},
                                                   .light = {-5.0f, 14.0f, -3.0f},
                                                   .light_strength = 0.7f,
                                                   .ambient = 0.2f,
                                                   .fill = {0.05f, 0.08f, 0.02f},
                                                   .box_margin = 0x1p-12f,
                                                   .features = TRAX_FEATURE_BIT(SHADOWS) | TRAX_FEATURE_BIT(MATERIALS),
                                                   .samples = 1,
                                                   .background = 0xFF804020u};
  frame.params = params;
  for (int i = 0; i < 4; i++)
    for (int part = 0; part < 3; part++)
      frame.palette[i].colour[part] = (float)(100 + 30 * i + 10 * part);
}

static void make_scene(void) {
  make_heights();
  for (unsigned i = 0; i < TRIANGLES; i++)
    make_triangle(&hills.triangles[i], even_bits(i / 2), even_bits(i / 4), i & 1);
  make_tree();
  hills.header.root = offsetof(__typeof__(hills), nodes);
  make_frame();
}

#endif
