/* The features of features.def: which ones a picture needs, their names, and the sections of the scene that they read.
 */
#include "lighting.h"
#include "reach.h"
#include "render.h"

uint32_t trax_features_of(const struct trax_frame_options *options, const struct trax_view *view,
                          const struct trax_scene *scene) {
  const uint32_t traits = trax_scene_traits(scene);
  const bool needed[TRAX_FEATURE_COUNT] = {
      [TRAX_FEATURE_SHADOWS] = options->shadows,
      [TRAX_FEATURE_MATERIALS] = scene->material_count > 1,
      [TRAX_FEATURE_SAMPLES] = options->samples > 1,
      [TRAX_FEATURE_SMOOTH] = options->smooth && scene->normals,
      [TRAX_FEATURE_LIGHTS] = view->light_count > 0,
      [TRAX_FEATURE_TEXTURES] = (traits & HAS_TEXTURE) != 0,
      [TRAX_FEATURE_ALPHA] = (traits & HAS_HOLES) != 0,
      [TRAX_FEATURE_ONE_SIDED] = options->one_sided,
      [TRAX_FEATURE_REFLECTION] = (traits & HAS_MIRROR) != 0,
      [TRAX_FEATURE_REFRACTION] = (traits & HAS_GLASS) != 0,
      [TRAX_FEATURE_GLOSSY] = (traits & HAS_GGX) != 0,
      [TRAX_FEATURE_EMISSION] = (traits & HAS_EMISSION) != 0,
      [TRAX_FEATURE_PATHS] = options->paths > 0,
      [TRAX_FEATURE_FLOATS] = options->floats,
      [TRAX_FEATURE_OCCLUSION] = options->occlusion > 0,
      [TRAX_FEATURE_ENVIRONMENT] = options->environment != NULL,
      [TRAX_FEATURE_NEAR_LIGHT] = view->light_count == 0 && !(options->environment && options->paths) &&
                                  trax_light_is_near(scene, view->eye, view->light),
      [TRAX_FEATURE_RAY_KINDS] = options->mark_rays,
      [TRAX_FEATURE_EXACT] = trax_needs_exact(scene, view->eye),
      [TRAX_FEATURE_INSTANCES] = scene->instances != NULL,
  };
  uint32_t features = 0;
  for (unsigned feature = 0; feature < TRAX_FEATURE_COUNT; feature++)
    features |= (uint32_t)needed[feature] << feature;
  return features;
}

const char *trax_feature_name(enum trax_feature feature) {
  static const char *const names[] = {
#define TRAX_FEATURE(NAME, TEXT, SECTIONS) TEXT,
#include "trax/features.def"
#undef TRAX_FEATURE
  };
  return names[feature];
}

uint32_t trax_feature_sections(uint32_t features) {
#define SECTION(KIND) (1u << TRAX_SCENE_##KIND)
  uint32_t sections = SECTION(NODES) | SECTION(TRIANGLES);
#define TRAX_FEATURE(NAME, TEXT, SECTIONS)                                                                             \
  if (features >> TRAX_FEATURE_##NAME & 1)                                                                             \
    sections |= (SECTIONS);
#include "trax/features.def"
#undef TRAX_FEATURE
#undef SECTION
  return sections;
}
