/* Lights, materials and emitting triangles, as the device program reads them. */
#include "lighting.h"
#include "environment.h"

#include <math.h>
#include <string.h>

static bool emits(const struct trax_material *material) {
  return material->emission[0] > 0 || material->emission[1] > 0 || material->emission[2] > 0;
}

uint32_t trax_scene_traits(const struct trax_scene *scene) {
  uint32_t traits = 0;
  for (uint32_t i = 0; i < scene->material_count; i++) {
    const struct trax_material *material = &scene->materials[i];
    const bool textured = material->texture && scene->uvs;
    const bool colour_matters = material->kind == TRAX_MATERIAL_LAMBERT || material->kind == TRAX_MATERIAL_GGX;
    const bool alpha = textured && scene->textures[material->texture - 1].flags & TRAX_TEXTURE_ALPHA;
    if (material->alpha_cutoff > 0 && (alpha || material->opacity < material->alpha_cutoff))
      traits |= HAS_HOLES | (alpha ? HAS_TEXTURE : 0);
    traits |= textured && colour_matters ? HAS_TEXTURE : 0;
    traits |= material->kind == TRAX_MATERIAL_MIRROR ? HAS_MIRROR : 0;
    traits |= material->kind == TRAX_MATERIAL_GLASS ? HAS_GLASS : 0;
    traits |= material->kind == TRAX_MATERIAL_GGX ? HAS_GGX : 0;
    traits |= emits(material) ? HAS_EMISSION : 0;
  }
  return traits;
}

/* --- emitters --- */

/* Rec. 709's luminance, in proportion to which emitters are chosen. */
static double luminance(const float colour[3]) {
  return 0.2126 * (double)colour[0] + 0.7152 * (double)colour[1] + 0.0722 * (double)colour[2];
}

/* A triangle's weight in the choice of shadow rays; 0: no emitter. Emitters with holes are found by scattered rays. */
static double emitter_weight(const struct trax_scene *scene, uint32_t number) {
  const struct trax_triangle *triangle = &scene->triangles[number];
  const struct trax_material *material = &scene->materials[triangle->material];
  if (!emits(material) || material->alpha_cutoff > 0)
    return 0;
  double e[3], f[3], n[3];
  for (int i = 0; i < 3; i++) {
    e[i] = (double)triangle->v1[i] - (double)triangle->v0[i];
    f[i] = (double)triangle->v2[i] - (double)triangle->v0[i];
  }
  for (int i = 0; i < 3; i++)
    n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
  return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) * luminance(material->emission);
}

static bool wants_emitters(const struct trax_scene *scene, const struct trax_frame_options *options) {
  return options->paths > 0 && trax_scene_traits(scene) & HAS_EMISSION;
}

static uint32_t count_emitters(const struct trax_scene *scene, const struct trax_frame_options *options) {
  uint32_t count = 0;
  for (uint32_t i = 0; wants_emitters(scene, options) && i < scene->triangle_count; i++)
    count += emitter_weight(scene, i) > 0;
  return count;
}

static void fill_emitters(struct trax_emitter *emitters, struct trax_device_material *materials,
                          const struct trax_scene *scene) {
  const uint32_t first = scene->header->sections[TRAX_SCENE_TRIANGLES].offset;
  double total = 0, before = 0;
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    total += emitter_weight(scene, i);
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    const double weight = emitter_weight(scene, i);
    if (!(weight > 0))
      continue;
    const double part = before / total * 0x1p32;
    *emitters++ = (struct trax_emitter){first + i * (uint32_t)sizeof(struct trax_triangle),
                                        part < UINT32_MAX ? (uint32_t)part : UINT32_MAX};
    before += weight;
  }
  for (uint32_t i = 0; i < scene->material_count; i++)
    if (emits(&scene->materials[i]) && !(scene->materials[i].alpha_cutoff > 0))
      materials[i].emitter_pdf = (float)(luminance(scene->materials[i].emission) / total);
}

/* --- lights --- */

static bool shines(const struct trax_light *light) {
  return light->strength > 0 && (light->colour[0] > 0 || light->colour[1] > 0 || light->colour[2] > 0);
}

/* The plain light of a view without `lights` does not shine where an environment does. */
static bool has_plain_light(const struct trax_view *view, const struct trax_frame_options *options) {
  return view->light_count == 0 && !(options->environment && options->paths);
}

static uint32_t count_lights(const struct trax_view *view, const struct trax_frame_options *options) {
  uint32_t count = has_plain_light(view, options);
  for (uint32_t i = 0; i < view->light_count; i++)
    count += shines(&view->lights[i]);
  return count;
}

static struct trax_device_light device_light(const struct trax_light *light) {
  struct trax_device_light out = {.kind = TRAX_FROM_POINT};
  double scale = light->strength;
  memcpy(out.place, light->position, sizeof out.place);
  if (light->kind == TRAX_LIGHT_DIRECTIONAL) {
    out.kind = TRAX_FROM_DIRECTION;
    for (int i = 0; i < 3; i++)
      out.place[i] = -light->direction[i];
  } else if (light->kind == TRAX_LIGHT_RECTANGLE) {
    double area = 1;
    out.kind = TRAX_FROM_RECTANGLE;
    memcpy(out.edge, light->edges, sizeof out.edge);
    memcpy(out.normal, light->direction, sizeof out.normal);
    for (int k = 0; k < 2; k++) {
      const float *edge = light->edges[k];
      area *= sqrt((double)edge[0] * (double)edge[0] + (double)edge[1] * (double)edge[1] +
                   (double)edge[2] * (double)edge[2]);
    }
    scale *= area / 3.14159265358979323846;
  } else if (light->falloff > 0) {
    out.kind = TRAX_FROM_FADING_POINT;
    scale *= (double)light->falloff * (double)light->falloff;
  }
  for (int i = 0; i < 3; i++)
    out.radiance[i] = (float)(scale * (double)light->colour[i]);
  return out;
}

static void fill_lights(struct trax_device_light *lights, const struct trax_view *view,
                        const struct trax_frame_options *options, float strength) {
  if (has_plain_light(view, options))
    *lights = (struct trax_device_light){.kind = TRAX_FROM_POINT,
                                         .place = {view->light[0], view->light[1], view->light[2]},
                                         .radiance = {strength, strength, strength}};
  for (uint32_t i = 0; i < view->light_count; i++)
    if (shines(&view->lights[i]))
      *lights++ = device_light(&view->lights[i]);
}

/* --- materials --- */

static struct trax_device_material device_material(const struct trax_material *material) {
  struct trax_device_material out = {.kind = material->kind,
                                     .roughness = fmaxf(material->roughness, TRAX_LEAST_ROUGHNESS),
                                     .ior = material->ior,
                                     .opacity = material->opacity,
                                     .alpha_cutoff = material->alpha_cutoff,
                                     .texture = material->texture};
  memcpy(out.diffuse, material->diffuse, sizeof out.diffuse);
  memcpy(out.specular, material->specular, sizeof out.specular);
  memcpy(out.emission, material->emission, sizeof out.emission);
  return out;
}

/* --- the environment --- */

static void fill_environment(struct trax_environment_texel *texels, const struct trax_environment *environment) {
  const uint32_t count = 1u << 2 * TRAX_ENVIRONMENT_LOG2;
  for (uint32_t i = 0; i < count; i++) {
    memcpy(texels[i].radiance, environment->radiance[i], sizeof texels[i].radiance);
    texels[i].pdf = (float)(3.14159265358979323846 / 4 * count * environment->probability[i]);
  }
  memcpy(texels + count, environment->aliases, count * sizeof *environment->aliases);
}

/* --- all of it --- */

static uint32_t round_up(uint32_t bytes) {
  return (bytes + 63) & ~63u;
}

/* Offsets of the tables, lines like the records: where the parameters begin, a line begins. Returns their end. */
static uint32_t lay_out(struct trax_path_params *path, uint32_t materials, bool environment) {
  const uint32_t start = sizeof(struct trax_render_params);
  path->materials = round_up(start + sizeof *path) - start;
  path->lights = path->materials + materials * (uint32_t)sizeof(struct trax_device_material);
  path->emitters = path->lights + path->light_count * (uint32_t)sizeof(struct trax_device_light);
  const uint32_t end = path->emitters + path->emitter_count * (uint32_t)sizeof(struct trax_emitter);
  if (!environment)
    return end;
  path->environment = round_up(start + end) - start;
  path->environment_log2 = TRAX_ENVIRONMENT_LOG2;
  return path->environment + (uint32_t)((sizeof(struct trax_environment_texel) + sizeof(struct trax_environment_alias))
                                        << 2 * TRAX_ENVIRONMENT_LOG2);
}

uint32_t trax_lighting_bytes(const struct trax_scene *scene, const struct trax_view *view,
                             const struct trax_frame_options *options) {
  struct trax_path_params path = {.light_count = count_lights(view, options),
                                  .emitter_count = count_emitters(scene, options)};
  return lay_out(&path, scene->material_count, options->environment);
}

static float occlusion_reach(const struct trax_scene_header *header, double part) {
  double square = 0;
  for (int i = 0; i < 3; i++) {
    const double side = (double)header->bounds_max[i] - (double)header->bounds_min[i];
    square += side > 0 ? side * side : 0;
  }
  return (float)((part > 0 ? part : TRAX_DEFAULT_REACH) * sqrt(square));
}

void trax_lighting_fill(struct trax_render_params *params, const struct trax_scene *scene, const struct trax_view *view,
                        const struct trax_frame_options *options) {
  struct trax_path_params *path = (struct trax_path_params *)(params + 1);
  path->max_depth = options->paths ? options->paths : TRAX_DIRECT_DEPTH + 1;
  path->seed = options->seed;
  if (options->occlusion) {
    path->occlusion_rays = options->occlusion;
    path->occlusion_weight = 1 / (float)options->occlusion;
    path->occlusion_reach = occlusion_reach(scene->header, options->occlusion_reach);
  }
  path->light_count = count_lights(view, options);
  path->emitter_count = count_emitters(scene, options);
  path->choices = path->light_count + (path->emitter_count > 0) + (options->environment != NULL);
  for (int i = 0; i < 3; i++) {
    const double part = (params->background >> 8 * i & 255) / 255.0;
    path->background[i] = (float)(part * part);
  }
  lay_out(path, scene->material_count, options->environment);
  struct trax_device_material *materials = (struct trax_device_material *)((char *)path + path->materials);
  for (uint32_t i = 0; i < scene->material_count; i++)
    materials[i] = device_material(&scene->materials[i]);
  fill_lights((struct trax_device_light *)((char *)path + path->lights), view, options, params->light_strength);
  if (path->emitter_count)
    fill_emitters((struct trax_emitter *)((char *)path + path->emitters), materials, scene);
  if (options->environment)
    fill_environment((struct trax_environment_texel *)((char *)path + path->environment), options->environment);
}
