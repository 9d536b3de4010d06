/* A scene as plain arrays, for programs that bring their own ray tracer and want nothing of the scene file's layout. A
   program for trax-render --program gets those of these buffers that it defines:

     plain_nodes      struct trax_plain_node[], the root first
     plain_triangles  struct trax_plain_triangle[]

   beside `scene`, `params` and `image` (render_params.h), which it need not define either. Little endian, 32-bit
   fields. raytracer/render/plain_scene.c makes them of the scene: the same tree and the same triangles. */
#ifndef TRAX_PLAIN_SCENE_H
#define TRAX_PLAIN_SCENE_H

#include <stdint.h>

#define TRAX_PLAIN_MAX_DEPTH 40 /* inner nodes from the root to a leaf, at most */

/* Two siblings stand one behind the other, in one line of 64 bytes; pairs follow in the order of a depth-first
   traversal. The root is number 0, and number 1 is none. A scene without triangles has one leaf of none. */
struct trax_plain_node {
  float min[3], max[3]; /* bounds of every triangle below, exactly */
  int32_t count;        /* triangles of a leaf; -1: an inner node */
  uint32_t first;       /* the number of its first triangle, or of its first child: the second is the next one */
};

/* In the order in which a depth-first traversal meets the leaves. */
struct trax_plain_triangle {
  float v0[3], v1[3], v2[3];
  uint32_t material; /* number of the entry of the palette */
};

_Static_assert(sizeof(struct trax_plain_node) == 32, "no padding");
_Static_assert(sizeof(struct trax_plain_triangle) == 40, "no padding");

#endif
