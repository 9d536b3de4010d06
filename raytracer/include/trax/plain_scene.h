/* A scene as plain arrays, for programs with their own ray tracer that do not use the scene file's layout. A program
   for trax-render --program gets these buffers if it defines them:

     plain_nodes      struct trax_plain_node[], the root first
     plain_triangles  struct trax_plain_triangle[]

   and also `scene`, `params` and `image` (render_params.h) if it defines them. Little endian, 32-bit fields.
   raytracer/render/plain_scene.c converts the scene: the same tree and the same triangles. */
#ifndef TRAX_PLAIN_SCENE_H
#define TRAX_PLAIN_SCENE_H

#include <stdint.h>

#define TRAX_PLAIN_MAX_DEPTH 40 /* limit of the inner nodes from the root to a leaf */

/* Two siblings are adjacent, in one line of 64 bytes; pairs follow in the order of a depth-first traversal. The root is
   number 0, and number 1 is unused. A scene without triangles has one leaf with no triangle. */
struct trax_plain_node {
  float min[3], max[3]; /* bounds of every triangle below, exactly */
  int32_t count;        /* triangles of a leaf; -1: an inner node */
  uint32_t first;       /* the number of its first triangle, or of its first child; the second child follows it */
};

/* Triangles stand in the order of the leaves in a depth-first traversal. */
struct trax_plain_triangle {
  float v0[3], v1[3], v2[3];
  uint32_t material; /* number of the entry of the palette */
};

_Static_assert(sizeof(struct trax_plain_node) == 32, "no padding");
_Static_assert(sizeof(struct trax_plain_triangle) == 40, "no padding");

#endif
