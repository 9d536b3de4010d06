/* Lights and emitting triangles in binary64, for Embree's pictures: from the view and the scene, not from the
   tables that lighting.c prepares for the device program. */
#include "embree.h"
#include "environment.h"

#include <stdlib.h>

#define PI 3.14159265358979323846

/* Rec. 709. */
static double luminance(const float colour[3]) {
  return 0.2126 * (double)colour[0] + 0.7152 * (double)colour[1] + 0.0722 * (double)colour[2];
}

struct double3 embree_winding_normal(const struct trax_triangle *triangle) {
  const struct double3 a = from(triangle->v0);
  return embree_unit(cross(minus(from(triangle->v1), a), minus(from(triangle->v2), a)));
}

double embree_towards(struct double3 point, struct double3 target, struct double3 *direction) {
  const struct double3 way = minus(target, point);
  const double distance = sqrt(dot(way, way));
  if (!(distance >= 0x1p-40))
    return 0;
  *direction = (struct double3){way.x / distance, way.y / distance, way.z / distance};
  return distance;
}

/* --- lights of the view --- */

static bool shines(const struct trax_light *light) {
  return (double)light->strength * luminance(light->colour) > 0;
}

bool embree_light_at(const struct embree *embree, uint32_t number, struct double3 point, double x, double y,
                     struct embree_arrival *arrival) {
  const struct trax_light *light = &embree->lights[number];
  double scale = PI * (double)light->strength;
  *arrival = (struct embree_arrival){.distance = INFINITY};
  if (light->kind == TRAX_LIGHT_DIRECTIONAL) {
    arrival->direction = embree_unit(minus((struct double3){0, 0, 0}, from(light->direction)));
  } else {
    const struct double3 edge = from(light->edges[0]), other = from(light->edges[1]), across = cross(edge, other);
    const bool rectangle = light->kind == TRAX_LIGHT_RECTANGLE;
    arrival->target = from(light->position);
    if (rectangle)
      arrival->target = plus_scaled(plus_scaled(arrival->target, x, edge), y, other);
    arrival->distance = embree_towards(point, arrival->target, &arrival->direction);
    if (!(arrival->distance > 0))
      return false;
    const double square = arrival->distance * arrival->distance;
    if (rectangle) /* its area times the cosine */
      scale *= -dot(across, arrival->direction) / PI / square;
    else if (light->falloff > 0)
      scale *= (double)light->falloff * (double)light->falloff / square;
  }
  const struct double3 colour = from(light->colour);
  arrival->irradiance = (struct double3){scale * colour.x, scale * colour.y, scale * colour.z};
  return scale > 0;
}

/* --- emitting triangles --- */

/* Emitters with an alpha mask are not sampled. Scattered rays find them. */
static double power_per_area(const struct trax_material *material) {
  return material->alpha_cutoff > 0 ? 0 : luminance(material->emission);
}

static double power(const struct trax_scene *scene, uint32_t number) {
  const struct trax_triangle *triangle = &scene->triangles[number];
  const struct double3 a = from(triangle->v0), n = cross(minus(from(triangle->v1), a), minus(from(triangle->v2), a));
  return 0.5 * sqrt(dot(n, n)) * power_per_area(&scene->materials[triangle->material]);
}

double embree_emitter_density(const struct embree *embree, const struct trax_triangle *triangle, double distance,
                              struct double3 direction) {
  const double cosine = fabs(dot(embree_winding_normal(triangle), direction));
  const double per_area = power_per_area(&embree->frame->scene->materials[triangle->material]);
  return per_area > 0 ? per_area / embree->power * distance * distance / (cosine * embree->choices) : 0;
}

const struct trax_triangle *embree_pick_emitter(const struct embree *embree, double part) {
  uint32_t chosen = embree->emitter_count - 1;
  while (chosen > 0 && embree->emitters[chosen].before > part * embree->power)
    chosen--;
  return embree->emitters[chosen].triangle;
}

/* --- the environment: texels on the octahedron, of unit sum of coordinates --- */

static double side_of(double value) {
  return value < 0 ? -1 : 1;
}

/* Folds the lower half out, or in. */
static void fold(double *u, double *v) {
  const double across = (1 - fabs(*v)) * side_of(*u), along = (1 - fabs(*u)) * side_of(*v);
  *u = across, *v = along;
}

struct double3 embree_environment(const struct embree *embree, struct double3 direction, double *density) {
  const struct trax_environment *environment = embree->frame->options.environment;
  const int side = 1 << TRAX_ENVIRONMENT_LOG2;
  const double size = fabs(direction.x) + fabs(direction.y) + fabs(direction.z);
  double u = direction.x / size, v = direction.z / size;
  if (direction.y < 0)
    fold(&u, &v);
  const int column = (int)fmin(floor((u + 1) / 2 * side), side - 1),
            row = (int)fmin(floor((v + 1) / 2 * side), side - 1);
  const int texel = row * side + column;
  /* A texel has a probability and the area (2 / side)^2 in u and v, which is size^3 as large in solid angle. */
  *density = environment->probability[texel] * side * side / 4 / (size * size * size) / embree->choices;
  return from(environment->radiance[texel]);
}

struct double3 embree_pick_environment(const struct embree *embree, uint32_t pick, double x, double y) {
  const struct trax_environment *environment = embree->frame->options.environment;
  const double side = 1 << TRAX_ENVIRONMENT_LOG2, place = pick * 0x1p-32 * side * side;
  uint32_t texel = (uint32_t)place;
  if ((place - texel) * 0x1p32 >= environment->aliases[texel].threshold)
    texel = environment->aliases[texel].other;
  double u = (texel % (uint32_t)side + x) / side * 2 - 1, v = (texel / (uint32_t)side + y) / side * 2 - 1;
  const double up = 1 - fabs(u) - fabs(v);
  if (up < 0)
    fold(&u, &v);
  return embree_unit((struct double3){u, up, v});
}

/* Linear; pixels have gamma 2. */
static struct double3 background_of(const struct trax_render_params *params) {
  const double r = (params->background & 255) / 255.0, g = (params->background >> 8 & 255) / 255.0,
               b = (params->background >> 16 & 255) / 255.0;
  return (struct double3){r * r, g * g, b * b};
}

struct double3 embree_far_light(const struct embree *embree, struct double3 direction, double density) {
  double chosen;
  if (!embree_needs(embree, TRAX_FEATURE_ENVIRONMENT))
    return background_of(embree->frame->params);
  const struct double3 light = embree_environment(embree, direction, &chosen);
  const double share = density > 0 ? density / (density + chosen) : 1;
  return (struct double3){share * light.x, share * light.y, share * light.z};
}

bool embree_prepare_lights(struct embree *embree) {
  const struct trax_scene *scene = embree->frame->scene;
  const struct trax_view *view = &embree->frame->view;
  const struct trax_light plain = {.colour = {1, 1, 1},
                                   .strength = embree->frame->params->light_strength,
                                   .position = {view->light[0], view->light[1], view->light[2]}};
  const bool environment = embree_needs(embree, TRAX_FEATURE_ENVIRONMENT);
  if (view->light_count == 0 && !(environment && embree_needs(embree, TRAX_FEATURE_PATHS)))
    embree->lights[embree->light_count++] = plain;
  for (uint32_t i = 0; i < view->light_count; i++)
    if (shines(&view->lights[i]))
      embree->lights[embree->light_count++] = view->lights[i];
  const bool wanted = embree_needs(embree, TRAX_FEATURE_PATHS);
  for (uint32_t i = 0; wanted && i < scene->triangle_count; i++)
    embree->emitter_count += power(scene, i) > 0;
  embree->choices = embree->light_count + (embree->emitter_count > 0) + environment;
  if (embree->emitter_count == 0)
    return true;
  struct embree_emitter *emitter = embree->emitters = malloc(embree->emitter_count * sizeof *embree->emitters);
  for (uint32_t i = 0; emitter && i < scene->triangle_count; i++) {
    const double own = power(scene, i);
    if (own > 0)
      *emitter++ = (struct embree_emitter){&scene->triangles[i], embree->power};
    embree->power += own;
  }
  return emitter;
}
