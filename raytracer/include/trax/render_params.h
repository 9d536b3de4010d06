/* What the host tells the ray tracer on the TPs besides the scene: the bytes of the program's buffer `params`. Little
   endian, 32-bit fields. raytracer/render/frame.c fills it; raytracer/device reads it.

   Buffers of the program (docs/abi.md, "Buffers"):
     scene   the scene file (scene_format.h)
     params  struct trax_render_params and behind it the palette, one struct trax_palette_entry per material
     image   width * height words, row by row from the top left, each R, G, B, A in its bytes from the lowest */
#ifndef TRAX_RENDER_PARAMS_H
#define TRAX_RENDER_PARAMS_H

#include <stdint.h>

#define TRAX_RENDER_MAX_SIDE 16384u /* pixels */
#define TRAX_RENDER_MAX_SAMPLES 4096u

/* Bits of trax_render_params.features; features.def says what they are. */
enum trax_feature {
#define TRAX_FEATURE(NAME, TEXT, QUESTION, SECTIONS) TRAX_FEATURE_##NAME,
#include "trax/features.def"
#undef TRAX_FEATURE
  TRAX_FEATURE_COUNT
};

/* Pixels are handed out in tiles, so that the threads that share a data cache look at neighbouring parts of the scene.
   Slot s is pixel s % 2^(tile_log2_width + tile_log2_height), row by row, of tile s / 2^(...), row by row. Slots past
   the picture's right or lower edge are no pixels. A tile's row is its number divided by tiles_across, which takes no
   division: the upper word of (2 * tile) * row_multiplier, shifted right by row_shift. */
struct trax_render_params {
  uint32_t width, height; /* pixels, 1 to TRAX_RENDER_MAX_SIDE */
  uint32_t slot_count;
  uint32_t tile_log2_width, tile_log2_height;
  uint32_t tiles_across;
  uint32_t row_multiplier, row_shift;

  /* The ray through the point (x, y) of the picture, in pixels from the top left, has the direction
     corner + x * step_x + y * step_y: not of unit length, but 1 along the view's direction. */
  float eye[3], corner[3], step_x[3], step_y[3];

  /* A surface with the unit normal n, turned towards the viewer, sends back light_strength * cosine (0 in shadow)
     + ambient + n . fill of its colour. */
  float light[3];
  float light_strength;
  float ambient, fill[3];

  float box_margin;    /* how far the traversal widens boxes, scene units; see frame.c */
  uint32_t background; /* a pixel as in `image` */
  uint32_t features;   /* what the picture needs: 1 << enum trax_feature each */

  uint32_t samples;    /* rays from the eye through a pixel */
  float sample_weight; /* 1 / samples */

  uint32_t normals_distance; /* bytes from a triangle to its normals, if the scene has them */
};

/* A material's colour as it is stored in the picture: 255 * sqrt(diffuse), since the picture has gamma 2. */
struct trax_palette_entry {
  float colour[3];
  uint32_t reserved; /* zero */
};

_Static_assert(sizeof(struct trax_render_params) == 34 * 4, "no padding");
_Static_assert(sizeof(struct trax_palette_entry) == 16, "no padding");

#endif
