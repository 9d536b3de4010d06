/* A room with everything that the ray tracer shades: a lamp that emits, a textured floor, a mirror, a glass, a gold and
   a lacquered ball, and leaves that are holes in quads. */
#ifndef TRAX_TEST_GALLERY_H
#define TRAX_TEST_GALLERY_H

#include "meshes.h"

/* Parts of it, which may be left out or be something else. */
enum {
  GALLERY_TEXTURES = 1,
  GALLERY_HOLES = 2,
  GALLERY_MIRROR = 4,
  GALLERY_GLASS = 8,
  GALLERY_GGX = 16,
  GALLERY_LAMP = 32,
  GALLERY_ALL = 63,
};

void gallery_mesh(struct trax_mesh *mesh, unsigned parts);
struct trax_scene gallery_scene(unsigned parts);
/* The view from its open side. lights: how many of a point, a directional light and a rectangle the view has; 0: the
   paper's one point light. */
struct trax_view gallery_view(unsigned lights);

#endif
