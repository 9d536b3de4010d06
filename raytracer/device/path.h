/* Pictures with more than the paper's workload: several lights, mirrors, glass, rough layers, textures, alpha masks,
   and paths over many surfaces. There is one loop over rays again, so that there is one copy of the traversal. The
   state of a path lies in global memory, unless local memory has room for it beside the traversal's stack.

   Without TRAX_FEATURE_PATHS a ray from the eye is followed through mirrors and glass to the first surface that
   scatters. Each light sends it a shadow ray, and the ambient light is added: with TRAX_FEATURE_OCCLUSION the part
   whose cosine-distributed rays hit nothing within their reach. Glass reflects or refracts, whichever is more; with
   several samples, in proportion.

   With TRAX_FEATURE_PATHS, light arrives from lights, emitting triangles and the background over up to max_depth
   surfaces. At each surface that scatters, a shadow ray goes to one of the lights, to a point of an emitter or into the
   environment, and the path continues in a direction sampled from the BRDF. Light that both can find is weighted by the
   balance heuristic (Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997). Paths of low throughput
   end by Russian roulette. */
#ifndef TRAX_DEVICE_PATH_H
#define TRAX_DEVICE_PATH_H

#include "algebra.h"
#include "camera.h"
#include "environment.h"
#include "light.h"
#include "material.h"
#include "record.h"
#include "run.h"
#include "sampler.h"
#include "shade.h"
#include "texture.h"
#include "traverse.h"

#include <stdbool.h>

extern struct trax_buffer paths;

/* With few features a path has little state. It is then kept in the registers and on the stack of one function
   (TRAX_PATHS_LOCAL; render/program_compile.c tries that first), and leaves the caches to the scene. */
#ifdef TRAX_PATHS_LOCAL
#define PATH_STEP static inline __attribute__((always_inline))
#define LOAD_PATH_AGAIN(path) ((void)0)
#else
#define PATH_STEP static __attribute__((noinline))
#define LOAD_PATH_AGAIN(path) HIDE_ORIGIN(path)
#endif

struct path {
  struct vector sum;                         /* of the pixel's samples so far */
  struct vector light;                       /* of this sample so far */
  struct vector throughput;                  /* the part of the light along the ray that reaches the eye */
  struct vector pending;                     /* added to light if the shadow ray is not blocked */
  struct vector origin, direction;           /* of the current ray */
  struct vector next_origin, next_direction; /* of the one after the shadow rays, */
  struct vector next_throughput;             /* and its throughput */
  struct vector point, target;               /* where light arrives, and where it comes from */
  struct scatterer at;
  struct hit hit; /* of the ray */
  uint32_t layered;
  float pdf;             /* pi times that of the ray's direction in solid angle; 0: a mirror, glass or the eye */
  int32_t distance_bits; /* the length of a shadow ray */
  uint32_t pixel, sample, key;
  uint32_t depth;        /* surfaces so far */
  uint32_t lights_left;  /* shadow rays that the surface is still to send */
  uint32_t ambient_left; /* occlusion rays, too */
  uint32_t holes;        /* that the current ray went through, */
  float travelled;       /* and the distance to the last of them */
  uint32_t goes_on;      /* the ray after the shadow rays, as a term of trax_count_kinds; 0: none */
  struct vector start;   /* of the rays that leave the point; LIT_AT_POINT */
};
_Static_assert(sizeof(struct path) <= TRAX_PATH_BYTES, "render_params.h");

#define MOST_HOLES 1024 /* a ray ends at the next */

/* Whether the hit point and the start of the shadow ray must be told apart. One light that is far away (no
   TRAX_FEATURE_NEAR_LIGHT) needs only the start, which is then path->point. */
#define LIT_AT_POINT(run) (NEEDS(run, LIGHTS) || NEEDS(run, NEAR_LIGHT) || (NEEDS(run, PATHS) && NEEDS(run, EMISSION)))
#define PATH_START(run, path) (LIT_AT_POINT(run) ? (path)->start : (path)->point)
#define SURE_DEPTH 3 /* roulette begins at this depth */

static inline struct path *path_of_thread(void) {
  unsigned end = (trax_thread() + 1) * TRAX_PATH_BYTES;
  if (end > paths.size)
    trax_abort("the buffer `paths` has no room for this thread");
  return (struct path *)(void *)((char *)paths.data + (end - TRAX_PATH_BYTES));
}

static inline struct place path_point(const struct trax_render_params *run, const struct path *path,
                                      uint32_t dimension) {
  dimension += DIMENSIONS_OF_SURFACE * path->depth;
  if (NEEDS(run, PATHS))
    return random_point(path->sample, dimension, path->key);
  return NEEDS(run, SAMPLES) && path->sample ? even_point(path->sample, dimension) : PIXEL_MIDDLE;
}

PATH_STEP void begin_sample(struct path *path, const struct trax_render_params *run) {
  struct place place = PIXEL_MIDDLE;
  path->light = (struct vector){0, 0, 0};
  path->throughput = (struct vector){1, 1, 1};
  path->pdf = 0;
  path->depth = 0;
  path->holes = 0, path->travelled = 0;
  if (NEEDS(run, PATHS))
    place = random_point(path->sample, DIMENSION_PIXEL, path->key);
  else if (NEEDS(run, SAMPLES))
    place = sample_place(path->sample);
  path->origin = load_vector(run->eye);
  path->direction = camera_direction(run, (struct pixel){path->pixel}, place);
}

static inline const struct trax_device_material *hit_material(const struct trax_render_params *run,
                                                              const struct hit *hit) {
  const struct trax_device_material *materials = path_table(RUN_PATH(run)->materials);
  return NEEDS(run, MATERIALS) ? &materials[material_of_hit(hit)] : materials;
}

static inline void add_to(struct vector *sum, struct vector throughput, struct vector light) {
  *sum = plus(*sum, filtered(throughput, light));
}

#define MOST_CORRECTION 4.0f

/* The light of an emitter that a ray has hit, with its MIS weight; path->point and path->at are still those of the
   surface that scattered the ray. Both densities of the weight are of the direction from point to point, although the
   ray starts beside its point. On a Lambert surface the light is multiplied by the ratio of the form factors at the
   point and at the ray's start, so that near lamps are as bright as by shadow rays. */
static inline struct vector emission_found(const struct trax_render_params *run, const struct path *path,
                                           const struct surface *surface, const struct trax_device_material *material,
                                           const struct hit *hit) {
  struct vector light = load_vector(material->emission);
  if (!NEEDS(run, PATHS) || float_bits(path->pdf) == 0)
    return light;
  float distance = path->travelled + bits_float(hit->distance_bits), square = distance * distance;
  float cosine = bits_float(magnitude(dot(surface->normal, path->direction))) * surface->inverse_length;
  float own = path->pdf, share = 1;
  struct vector way = minus(surface->point, path->point);
  float way_square = dot(way, way);
  if (float_bits(way_square) >= float_bits(0x1p-80f)) {
    float inverse = trax_rsqrt(way_square);
    float facing = bits_float(magnitude(dot(surface->normal, way))) * surface->inverse_length * inverse;
    if (!(NEEDS(run, GLOSSY) && path->layered)) {
      float at_start = at_least(own * cosine * way_square, 0x1p-120f);
      own = at_least(dot(path->at.normal, way) * inverse, 0);
      share = at_most(own * facing * square / at_start, MOST_CORRECTION);
    }
    cosine = facing, square = way_square;
  }
  if (float_bits(material->emitter_pdf) != 0) {
    float other = emitter_pdf(material->emitter_pdf, square, cosine, (float)(int32_t)RUN_PATH(run)->choices);
    share *= own / at_least(own + other, 0x1p-120f);
  }
  return times(share, light);
}

/* Sets path->at; the normals' lengths become 1. */
static inline void describe_scatterer(const struct trax_render_params *run, struct path *path, struct surface *surface,
                                      const struct trax_device_material *material, const struct hit *hit,
                                      struct vector texel) {
  struct scatterer *at = &path->at;
  bool scatters = material->kind == TRAX_MATERIAL_LAMBERT || material->kind == TRAX_MATERIAL_GGX;
  at->view = unit(times(-1, path->direction));
  at->flat = times(surface->inverse_length, surface->normal);
  at->normal = at->flat;
  if (NEEDS(run, SMOOTH)) {
    smooth_surface(surface, hit, run->normals_distance);
    struct vector normal = times(surface->inverse_length, surface->normal);
    /* A mirror whose smooth normal faces away from the view uses its triangle's. */
    if (scatters || float_bits(dot(normal, at->view)) > 0)
      at->normal = normal;
  }
  at->diffuse = load_vector(material->diffuse);
  at->specular = load_vector(material->specular);
  at->roughness = material->roughness;
  path->layered = material->kind == TRAX_MATERIAL_GGX;
  if (NEEDS(run, TEXTURES)) { /* for a metal, which has no diffuse colour, of the specular one */
    bool metal = NEEDS(run, GLOSSY) && path->layered && greatest_bits(at->diffuse) == 0;
    if (metal)
      at->specular = filtered(texel, at->specular);
    else
      at->diffuse = filtered(texel, at->diffuse);
  }
}

/* Samples the next direction at a surface that scatters; the path may end. */
static inline void choose_direction(const struct trax_render_params *run, struct path *path) {
  struct place choice = path_point(run, path, DIMENSION_CHOICE);
  struct vector part = scatter(&path->at, NEEDS(run, GLOSSY) && path->layered, path_point(run, path, DIMENSION_SCATTER),
                               choice.x, &path->next_direction, &path->pdf);
  struct vector throughput = filtered(path->throughput, part);
  uint32_t rays = TRAX_RAYS(NEEDS(run, GLOSSY) && path->layered ? TRAX_RAY_GLOSSY : TRAX_RAY_DIFFUSE, 1);
  path->goes_on = greatest_bits(throughput) > 0 ? rays : 0;
  if (path->depth >= SURE_DEPTH) {
    float chance = at_most(at_least(bits_float(greatest_bits(throughput)), 0x1p-10f), 0.95f);
    if (!(choice.y < chance))
      path->goes_on = 0;
    throughput = times(1 / chance, throughput);
  }
  path->next_throughput = throughput;
  path->next_origin = PATH_START(run, path);
}

/* The ambient light that an unoccluded surface reflects. */
static inline struct vector ambient_of(const struct trax_render_params *run, const struct path *path) {
  float ambient = run->ambient + dot(path->at.normal, load_vector(run->fill));
  struct vector reflectance = path->at.diffuse;
  if (NEEDS(run, GLOSSY) && path->layered)
    reflectance = plus(reflectance, path->at.specular);
  return times(ambient, reflectance);
}

/* Shades a hit on an opaque surface: adds its emission, and prepares shadow rays and the next ray. */
static inline void meet_surface(const struct trax_render_params *run, struct path *path, struct surface *surface,
                                const struct trax_device_material *material, const struct hit *hit,
                                struct vector texel) {
  path->goes_on = 0;
  path->lights_left = 0;
  path->ambient_left = 0;
  bool turned = surface->turned;
  if (NEEDS(run, EMISSION))
    add_to(&path->light, path->throughput, emission_found(run, path, surface, material, hit));
  describe_scatterer(run, path, surface, material, hit, texel);
  if (path->depth >= RUN_PATH(run)->max_depth)
    return;
  path->point = surface->start;
  if (LIT_AT_POINT(run))
    path->point = surface->point, path->start = surface->start;
  path->next_throughput = path->throughput;
  if (NEEDS(run, REFLECTION) && material->kind == TRAX_MATERIAL_MIRROR) {
    path->next_throughput = filtered(path->throughput, path->at.specular);
    path->next_origin = surface->start;
    path->next_direction = mirror_direction(&path->at);
    path->pdf = 0;
    path->goes_on = TRAX_RAYS(TRAX_RAY_MIRROR, 1);
    return;
  }
  if (NEEDS(run, REFRACTION) && material->kind == TRAX_MATERIAL_GLASS) {
    bool through;
    float ratio = turned ? material->ior : 1 / material->ior;
    path->next_direction = glass_direction(&path->at, ratio, path_point(run, path, DIMENSION_CHOICE).x, &through);
    path->next_origin = through ? surface->behind : surface->start;
    if (through)
      path->next_throughput = filtered(path->throughput, path->at.specular);
    path->pdf = 0;
    path->goes_on = TRAX_RAYS(through ? TRAX_RAY_GLASS : TRAX_RAY_MIRROR, 1);
    return;
  }
  if (NEEDS(run, PATHS)) {
    path->lights_left = RUN_PATH(run)->choices > 0;
    choose_direction(run, path);
    return;
  }
  path->lights_left = RUN_PATH(run)->light_count;
  if (NEEDS(run, OCCLUSION))
    path->ambient_left = RUN_PATH(run)->occlusion_rays;
  else
    add_to(&path->light, path->throughput, ambient_of(run, path));
}

/* Prepares the next occlusion ray; false if there is none. A direction below the triangle counts as blocked. */
static inline bool next_occlusion(const struct trax_render_params *run, struct path *path) {
  const struct trax_path_params *more = RUN_PATH(run);
  while (path->ambient_left > 0) {
    uint32_t number = more->occlusion_rays * (NEEDS(run, SAMPLES) ? path->sample : 0) + --path->ambient_left;
    path->direction = cosine_direction(
        path->at.normal, random_point(number, DIMENSION_SCATTER + DIMENSIONS_OF_SURFACE * path->depth, path->key));
    if (float_bits(dot(path->at.flat, path->direction)) <= 0)
      continue;
    path->pending = filtered(path->throughput, times(more->occlusion_weight, ambient_of(run, path)));
    path->origin = PATH_START(run, path);
    path->target = plus(PATH_START(run, path), times(more->occlusion_reach, path->direction));
    path->distance_bits = float_bits(more->occlusion_reach);
    path->holes = 0, path->travelled = 0;
    return true;
  }
  return false;
}

/* Prepares the next shadow ray; false if there is none. Without shadows it adds the light of all instead. */
static inline bool next_light(const struct trax_render_params *run, struct path *path) {
  const struct trax_path_params *more = RUN_PATH(run);
  const struct trax_device_light *lights = path_table(more->lights);
  while (path->lights_left > 0) {
    struct arrival arrival;
    bool arrives;
    float choices = 1;
    uint32_t number = --path->lights_left;
    struct place place = path_point(run, path, DIMENSION_LIGHT);
    if (NEEDS(run, PATHS)) {
      struct words pick = random_words(path->sample, DIMENSION_PICK + DIMENSIONS_OF_SURFACE * path->depth, path->key);
      number = (uint32_t)((uint64_t)pick.x * more->choices >> 32);
      choices = (float)(int32_t)more->choices;
      if (NEEDS(run, ENVIRONMENT) && number == more->choices - 1)
        arrives = environment_arrives(&arrival, more, pick.y, place);
      else if (NEEDS(run, EMISSION) && number == more->light_count)
        arrives = emitter_arrives(&arrival, NEEDS(run, ONE_SIDED), more, pick.y, path->point, place);
      else
        arrives = light_arrives(&arrival, &lights[number], path->point, place);
    } else {
      arrives = light_arrives(&arrival, &lights[number], path->point, place);
    }
    float cosine = arrives ? dot(path->at.normal, arrival.direction) : 0;
    if (float_bits(cosine) <= 0 || float_bits(dot(path->at.flat, arrival.direction)) <= 0)
      continue;
    float pdf;
    struct vector part = reflectance(&path->at, NEEDS(run, GLOSSY) && path->layered, arrival.direction, cosine, &pdf);
    float scale = cosine * choices;
    if ((NEEDS(run, EMISSION) || NEEDS(run, ENVIRONMENT)) && float_bits(arrival.pdf) > 0)
      scale = cosine / (arrival.pdf + pdf);
    path->pending = filtered(path->throughput, filtered(times(scale, part), arrival.radiance));
    if (NEEDS(run, SHADOWS)) {
      path->origin = PATH_START(run, path);
      if (LIT_AT_POINT(run) && arrival.distance_bits != FARTHEST_BITS)
        aim_at(&arrival, path->origin, arrival.target);
      path->direction = arrival.direction;
      path->target = arrival.target;
      path->distance_bits = arrival.distance_bits;
      path->holes = 0, path->travelled = 0;
      return true;
    }
    path->light = plus(path->light, path->pending);
  }
  return false;
}

/* Whether a triangle can be a hole, by its alpha mask or its side. */
#define HAS_HOLES(run) (NEEDS(run, ALPHA) || NEEDS(run, ONE_SIDED))

/* If the hit is a hole, moves the start of the ray behind it. Returns whether it is. */
static inline bool pass_hole(const struct trax_render_params *run, struct path *path, bool shadow,
                             const struct surface *surface, const struct trax_device_material *material,
                             const struct hit *hit, float texel_alpha) {
  bool hole = NEEDS(run, ALPHA) && material->opacity * texel_alpha < material->alpha_cutoff;
  if (NEEDS(run, ONE_SIDED))
    hole |= surface->turned && material->kind != TRAX_MATERIAL_GLASS;
  if (!hole || path->holes >= MOST_HOLES)
    return false;
  path->origin = surface->behind;
  if (shadow && path->distance_bits != FARTHEST_BITS) { /* aimed at the light again, so that errors do not accumulate */
    struct arrival arrival = {.direction = path->direction, .distance_bits = 0};
    aim_at(&arrival, path->origin, path->target);
    path->direction = arrival.direction;
    path->distance_bits = arrival.distance_bits;
  }
  path->travelled += bits_float(hit->distance_bits);
  path->holes++;
  return true;
}

static inline void store_radiance(const struct trax_render_params *run, struct pixel pixel, struct vector light) {
  uint32_t *to = (uint32_t *)image.data;
  uint32_t number = pixel_y(pixel) * run->width + pixel_x(pixel);
  if (NEEDS(run, FLOATS)) {
    to += 3 * number;
    trax_store_nt(to, (uint32_t)float_bits(light.x));
    trax_store_nt(to + 1, (uint32_t)float_bits(light.y));
    trax_store_nt(to + 2, (uint32_t)float_bits(light.z));
    return;
  }
  float red = 255 * root_of_light(at_most(light.x, 1)), green = 255 * root_of_light(at_most(light.y, 1));
  trax_store_nt(to + number, pixel_of(red, green, 255 * root_of_light(at_most(light.z, 1))));
}

/* Rays are distinguished by their counter. Shadow and occlusion rays are any-hit rays. */
#define PRIMARY_RAY TRAX_RAYS(TRAX_RAY_PRIMARY, 1)
#define SHADOW_RAY TRAX_RAYS(TRAX_RAY_SHADOW, 1)
#define OCCLUSION_RAY TRAX_RAYS(TRAX_RAY_OCCLUSION, 1)
#define IS_SHADOW(run, rays) (((rays) & (SHADOW_RAY | (NEEDS(run, OCCLUSION) ? OCCLUSION_RAY : 0))) != 0)

/* Traces the current ray. This and after_ray are two functions, since local memory has no room for the frames of both.
 */
PATH_STEP bool follow_ray(const struct trax_render_params *run, struct path *path, uint32_t rays) {
  struct ray ray;
  bool shadow = IS_SHADOW(run, rays);
  trax_count_kinds(rays);
  struct hit hit = {shadow ? path->distance_bits : FARTHEST_BITS, NULL, 0, 0};
  prepare_ray(&ray, RUN_LAYOUT(run), path->origin, path->direction, run->box_margin, &run->grid);
  bool found = trace_ray(RUN_LAYOUT(run), scene.data, ((const struct trax_scene_header *)scene.data)->root, &ray,
                         shadow && !HAS_HOLES(run), &hit);
  ACCESS_RAY(path->pixel, path->sample, rays, path->origin, path->direction,
             shadow ? path->distance_bits : FARTHEST_BITS, found, &hit);
  LOAD_PATH_AGAIN(path);
  path->hit = hit;
  return found;
}

/* Shades the result of the ray. Returns the next ray as its term of trax_count_kinds, 0 if there is none. */
PATH_STEP uint32_t after_ray(const struct trax_render_params *run, struct path *path, uint32_t rays, bool found) {
  bool shadow = IS_SHADOW(run, rays);
  if (found && (!shadow || HAS_HOLES(run))) {
    const struct hit hit = path->hit;
    const struct trax_device_material *material = hit_material(run, &hit);
    struct surface surface;
    struct texel texel = {{1, 1, 1}, 1};
    find_surface(&surface, &hit, path->origin, path->direction);
    if (NEEDS(run, TEXTURES) && material->texture)
      texel = texture_of_hit(scene.data, material->texture, &hit);
    if (pass_hole(run, path, shadow, &surface, material, &hit, texel.alpha))
      return rays;
    RECORD_SEEN(run, path, shadow, &hit);
    if (!shadow)
      meet_surface(run, path, &surface, material, &hit, texel.colour);
  } else if (!found && shadow) {
    path->light = plus(path->light, path->pending);
  } else if (!found) {
    struct vector far = load_vector(RUN_PATH(run)->background);
    if (NEEDS(run, ENVIRONMENT))
      far = environment_found(run, path->direction, path->pdf);
    add_to(&path->light, path->throughput, far);
    return 0;
  }
  if (next_light(run, path))
    return SHADOW_RAY;
  if (NEEDS(run, OCCLUSION) && next_occlusion(run, path))
    return OCCLUSION_RAY;
  uint32_t next = path->goes_on;
  if (!next)
    return 0;
  path->origin = path->next_origin;
  path->direction = path->next_direction;
  path->throughput = path->next_throughput;
  path->depth++;
  path->holes = 0, path->travelled = 0;
  return next;
}

/* Adds the sample to the pixel. Returns whether another sample follows. */
PATH_STEP bool end_sample(const struct trax_render_params *run, struct path *path) {
  path->sum = plus(path->sum, bounded_colour(path->light));
  if (NEEDS(run, SAMPLES) && ++path->sample < run->samples)
    return true;
  store_radiance(run, (struct pixel){path->pixel},
                 NEEDS(run, SAMPLES) ? times(run->sample_weight, path->sum) : path->sum);
  return false;
}

/* Keeps few values across the calls: the stack holds this frame and the largest of the callees'. */
static inline void render_path_pixel(const struct trax_render_params *run, struct path *path, struct pixel pixel) {
  path->pixel = pixel.packed;
  path->key = hash_word(pixel.packed ^ hash_word(RUN_PATH(run)->seed));
  path->sum = (struct vector){0, 0, 0};
  path->sample = 0;
  do {
    begin_sample(path, run);
    for (uint32_t rays = PRIMARY_RAY; rays != 0;)
      rays = after_ray(run, path, rays, follow_ray(run, path, rays));
  } while (end_sample(run, path));
}

#endif
