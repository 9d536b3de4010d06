/* The parameters that the host gives to the ray tracer on the TPs: the bytes of the program's buffer `params`. Little
   endian, 32-bit fields. raytracer/render/frame.c fills it; raytracer/device reads it.

   Buffers of the program (docs/abi.md, "Buffers"):
     scene   the scene file (scene_format.h)
     params  struct trax_render_params and behind it the palette, one struct trax_palette_entry per material; or, of a
             picture with one of TRAX_PATH_FEATURES, struct trax_path_params and its tables
     image   width * height words, row by row from the top left, each R, G, B, A in its bytes from the lowest; with
             TRAX_FEATURE_FLOATS width * height times three floats, R, G and B, linear
     paths   of such a picture: TRAX_PATH_BYTES for each thread of the chip, zero */
#ifndef TRAX_RENDER_PARAMS_H
#define TRAX_RENDER_PARAMS_H

#include <stdint.h>

#define TRAX_RENDER_MAX_SIDE 16384u /* pixels */
#define TRAX_RENDER_MAX_SAMPLES 4096u

/* Bits of trax_render_params.features; features.def describes them. */
enum trax_feature {
#define TRAX_FEATURE(NAME, TEXT, SECTIONS) TRAX_FEATURE_##NAME,
#include "trax/features.def"
#undef TRAX_FEATURE
  TRAX_FEATURE_COUNT
};

/* A picture with none of these is the paper's workload: Lambert's law and one point light. */
#define TRAX_FEATURE_BIT(NAME) (1u << TRAX_FEATURE_##NAME)
#define TRAX_PATH_FEATURES                                                                                             \
  (TRAX_FEATURE_BIT(LIGHTS) | TRAX_FEATURE_BIT(TEXTURES) | TRAX_FEATURE_BIT(ALPHA) | TRAX_FEATURE_BIT(ONE_SIDED) |     \
   TRAX_FEATURE_BIT(REFLECTION) | TRAX_FEATURE_BIT(REFRACTION) | TRAX_FEATURE_BIT(GLOSSY) |                            \
   TRAX_FEATURE_BIT(EMISSION) | TRAX_FEATURE_BIT(PATHS) | TRAX_FEATURE_BIT(FLOATS) | TRAX_FEATURE_BIT(OCCLUSION) |     \
   TRAX_FEATURE_BIT(ENVIRONMENT) | TRAX_FEATURE_BIT(NEAR_LIGHT))

/* The grid of quantised nodes (struct trax_scene_grid), for rays. */
struct trax_ray_grid {
  float origin[3], cell[3];
};

#define TRAX_TILE_LOG2_SIDE 5u

/* Pixels are handed out in tiles, so that the threads that share a data cache see neighbouring parts of the scene. Slot
   s is pixel s % 2^(2 * tile_log2_side), along Hilbert's curve, of tile s / 2^(...), row by row. Slots past the
   picture's right or lower edge are not pixels. A tile's row is its number divided by tiles_across. It is computed
   without a division: the upper word of (2 * tile) * row_multiplier, shifted right by row_shift. */
struct trax_render_params {
  uint32_t width, height; /* pixels, 1 to TRAX_RENDER_MAX_SIDE */
  uint32_t slot_count;
  uint32_t tile_log2_side; /* at most TRAX_TILE_LOG2_SIDE */
  uint32_t tiles_across;
  uint32_t row_multiplier, row_shift;

  /* The ray through the point (x, y) of the picture, in pixels from the top left, has the direction
     corner + x * step_x + y * step_y: not of unit length, but 1 along the view's direction. */
  float eye[3], corner[3], step_x[3], step_y[3];

  /* A surface with the unit normal n, turned towards the viewer, reflects light_strength * cosine (0 in shadow) +
     ambient + n . fill of its colour. */
  float light[3];
  float light_strength;
  float ambient, fill[3];

  float box_margin;    /* the traversal widens boxes by this, scene units; see frame.c */
  uint32_t background; /* a pixel as in `image` */
  uint32_t features;   /* those that the picture needs: 1 << enum trax_feature each */

  uint32_t samples;    /* rays from the eye through a pixel */
  float sample_weight; /* 1 / samples */

  uint32_t normals_distance; /* bytes from a triangle to its normals, if the scene has them */

  uint32_t node_layout; /* enum trax_node_layout */
  struct trax_ray_grid grid;
};

/* A material's colour as it is stored in the picture: 255 * sqrt(diffuse), since the picture has gamma 2. */
struct trax_palette_entry {
  float colour[3];
  uint32_t reserved; /* zero */
};

/* --- more than one light, other materials than Lambert's, paths --- */

#define TRAX_RENDER_MAX_DEPTH 64u /* surfaces on a path */
#define TRAX_RENDER_MAX_OCCLUSION 64u
#define TRAX_DIRECT_DEPTH 8u      /* mirrors and glass one behind the other, without TRAX_FEATURE_PATHS */
#define TRAX_MAX_RADIANCE 0x1p40f /* of a light or a path; higher values are clamped */
#define TRAX_LEAST_ROUGHNESS 0x1p-7f

/* Light is radiance, linear RGB: 1 is white in the picture. Tables are found by their offset from this struct. */
struct trax_path_params {
  uint32_t max_depth; /* surfaces that scatter the light of one path, 1 to TRAX_RENDER_MAX_DEPTH */
  uint32_t seed;
  float background[3];
  uint32_t light_count;
  uint32_t emitter_count;
  uint32_t choices;        /* what a path chooses from for its shadow ray: the lights, all emitters, the environment */
  uint32_t materials;      /* struct trax_device_material, as the scene numbers them */
  uint32_t lights;         /* struct trax_device_light */
  uint32_t emitters;       /* struct trax_emitter */
  uint32_t occlusion_rays; /* of a sample, for the ambient light; up to TRAX_RENDER_MAX_OCCLUSION */
  float occlusion_weight;  /* 1 / occlusion_rays */
  float occlusion_reach;   /* how far they go */
  uint32_t environment;    /* struct trax_environment_texel, and behind all of them as many trax_environment_alias */
  uint32_t environment_log2; /* of the texels along a side */
};

/* struct trax_material (scene_format.h), prepared: numbers within the range in which the program computes. */
struct trax_device_material {
  float diffuse[3];
  uint32_t kind;
  float specular[3];
  float roughness; /* at least TRAX_LEAST_ROUGHNESS */
  float emission[3];
  float ior;
  float opacity, alpha_cutoff;
  uint32_t texture;
  float emitter_pdf; /* probability per area that a path's shadow ray goes to a point of this material; 0: never */
};

enum trax_device_light_kind { TRAX_FROM_POINT, TRAX_FROM_DIRECTION, TRAX_FROM_FADING_POINT, TRAX_FROM_RECTANGLE };

/* A light of trax/view.h, prepared. Its radiance is the light that a white surface facing it reflects; for a fading
   point light, at distance 1; for a rectangle, which is itself invisible, its radiance times its area / pi. */
struct trax_device_light {
  uint32_t kind;
  float place[3];   /* a point light's; towards a directional one, of unit length; a corner of a rectangle */
  float edge[2][3]; /* of a rectangle, from that corner */
  float normal[3];  /* of a rectangle, unit length */
  float radiance[3];
};

/* One triangle whose material emits. */
struct trax_emitter {
  uint32_t triangle;   /* bytes from the start of the scene */
  uint32_t cumulative; /* the probability of the emitters before it, in units of 2^-32 */
};

/* The light of a part of all directions (device/environment.h). */
struct trax_environment_texel {
  float radiance[3];
  float pdf; /* pi times the density in solid angle with which shadow rays to the environment go to a direction, divided
                by the cube of |x| + |y| + |z| of the direction of unit length, inverted; 0: never */
};
/* Draws of a texel above the threshold, in units of 2^-32, go to another texel (alias method). */
struct trax_environment_alias {
  uint32_t threshold, other;
};

#define TRAX_PATH_BYTES 320u

_Static_assert(sizeof(struct trax_path_params) == 64, "no padding");
_Static_assert(sizeof(struct trax_device_material) == 64, "one line");
_Static_assert(sizeof(struct trax_device_light) == 64, "one line");
_Static_assert(sizeof(struct trax_render_params) == 40 * 4, "no padding");
_Static_assert(sizeof(struct trax_palette_entry) == 16, "no padding");

#endif
