/* The tables behind the parameters of a picture with one of TRAX_PATH_FEATURES. */
#ifndef TRAX_RENDER_LIGHTING_H
#define TRAX_RENDER_LIGHTING_H

#include "render.h"

/* Properties of the materials in use, for features.c. */
enum trax_scene_trait {
  HAS_TEXTURE = 1,
  HAS_HOLES = 2,
  HAS_MIRROR = 4,
  HAS_GLASS = 8,
  HAS_GGX = 16,
  HAS_EMISSION = 32,
};
uint32_t trax_scene_traits(const struct trax_scene *scene);

/* Bytes of struct trax_path_params and its tables. */
uint32_t trax_lighting_bytes(const struct trax_scene *scene, const struct trax_view *view,
                             const struct trax_frame_options *options);

/* Fills them, behind params, which are complete but for the light_strength of a view without `lights`. */
void trax_lighting_fill(struct trax_render_params *params, const struct trax_scene *scene, const struct trax_view *view,
                        const struct trax_frame_options *options);

#endif
