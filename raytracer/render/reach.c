#include "reach.h"

#include "placed.h"

/* The squared distance between the origin and a triangle: C. Ericson, "Real-Time Collision Detection" (2005), section
   5.1.5. */
static double square_of_nearest(struct double3 a, struct double3 b, struct double3 c) {
  const struct double3 ab = minus(b, a), ac = minus(c, a);
  const double a_b = -dot(ab, a), a_c = -dot(ac, a), b_b = -dot(ab, b), b_c = -dot(ac, b), c_b = -dot(ab, c),
               c_c = -dot(ac, c);
  if (a_b <= 0 && a_c <= 0)
    return dot(a, a);
  if (b_b >= 0 && b_c <= b_b)
    return dot(b, b);
  if (c_c >= 0 && c_b <= c_c)
    return dot(c, c);
  struct double3 nearest;
  const double at_c = a_b * b_c - b_b * a_c, at_b = c_b * a_c - a_b * c_c, at_a = b_b * c_c - c_b * b_c;
  if (at_c <= 0 && a_b >= 0 && b_b <= 0)
    nearest = plus_scaled(a, a_b / (a_b - b_b), ab);
  else if (at_b <= 0 && a_c >= 0 && c_c <= 0)
    nearest = plus_scaled(a, a_c / (a_c - c_c), ac);
  else if (at_a <= 0 && b_c - b_b >= 0 && c_b - c_c >= 0)
    nearest = plus_scaled(b, (b_c - b_b) / ((b_c - b_b) + (c_b - c_c)), minus(c, b));
  else
    nearest = plus_scaled(plus_scaled(a, at_b / (at_a + at_b + at_c), ab), at_c / (at_a + at_b + at_c), ac);
  return dot(nearest, nearest);
}

/* Whether the triangle is too large or too small as seen from the origin. */
static bool needs_exact(const struct trax_triangle *triangle, struct double3 origin) {
  const struct double3 a = minus(from(triangle->v0), origin), b = minus(from(triangle->v1), origin),
                       c = minus(from(triangle->v2), origin);
  const struct double3 normal = cross(minus(b, a), minus(c, a));
  if (greatest(normal) == 0)
    return false; /* without area, which no ray hits */
  const double size = fmax(greatest(minus(b, a)), greatest(minus(c, a)));
  const double farthest = fmax(greatest(a), fmax(greatest(b), greatest(c)));
  /* Most are smaller than they are far away. */
  return size < TRAX_LEAST_SIZE ||
         (farthest < 4 * size && !(square_of_nearest(a, b, c) * (TRAX_REACH * TRAX_REACH) >= farthest * farthest));
}

/* The nearest and the farthest distance between a point and a box, at most and at least. */
static void distances(double *nearest, double *farthest, struct double3 point, const float min[3], const float max[3]) {
  const double at[3] = {point.x, point.y, point.z};
  *nearest = *farthest = 0;
  for (int axis = 0; axis < 3; axis++) {
    const double low = (double)min[axis] - at[axis], high = at[axis] - (double)max[axis];
    *nearest = fmax(*nearest, fmax(low, high));
    *farthest = fmax(*farthest, fmax(fabs(low), fabs(high)));
  }
}

/* Rays are tested in the instances' meshes, so that is where they must be accurate enough. */
static bool instances_need_exact(const struct trax_scene *scene, const float eye[3]) {
  for (uint32_t m = 0; m < scene->mesh_count; m++)
    for (uint32_t i = 0; i < scene->meshes[m].triangle_count; i++) {
      const struct trax_triangle *triangle = &scene->triangles[scene->meshes[m].first_triangle + i];
      const struct double3 a = from(triangle->v0), e = minus(from(triangle->v1), a), f = minus(from(triangle->v2), a);
      if (greatest(cross(e, f)) > 0 && fmax(greatest(e), greatest(f)) < TRAX_LEAST_SIZE)
        return true;
    }
  for (uint32_t i = 0; i < scene->instance_count; i++) {
    const struct trax_instance *instance = &scene->instances[i];
    const struct trax_scene_mesh *mesh = &scene->meshes[instance->mesh];
    const struct double3 at = trax_to_object(instance, minus(from(eye), from(instance->origin)));
    double nearest, farthest;
    distances(&nearest, &farthest, at, mesh->bounds_min, mesh->bounds_max);
    for (uint32_t k = 0; nearest * TRAX_REACH < farthest * 2 && k < mesh->triangle_count; k++)
      if (needs_exact(&scene->triangles[mesh->first_triangle + k], at))
        return true;
  }
  return false;
}

bool trax_needs_exact(const struct trax_scene *scene, const float eye[3]) {
  if (scene->instances)
    return instances_need_exact(scene, eye);
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    if (needs_exact(&scene->triangles[i], from(eye)))
      return true;
  return false;
}

/* Whether the light is within TRAX_NEAR_LIGHT of the triangle, in units of the bound. further: the instance's bound. */
static bool is_near(const struct trax_triangle *triangle, const float eye[3], const float light[3], bool exact,
                    double further) {
  const struct double3 v0 = from(triangle->v0), a = minus(v0, from(light)), b = minus(from(triangle->v1), from(light)),
                       c = minus(from(triangle->v2), from(light));
  const double size = fmax(greatest(minus(b, a)), greatest(minus(c, a)));
  double bound = trax_start_bound(greatest(v0), size) + further;
  if (greatest(a) > size + TRAX_NEAR_LIGHT * bound)
    return false; /* as most are */
  if (exact)
    bound = trax_exact_start_bound(greatest(v0), size, greatest(from(eye)), greatest(minus(v0, from(eye))) + size);
  return square_of_nearest(a, b, c) < TRAX_NEAR_LIGHT * TRAX_NEAR_LIGHT * bound * bound;
}

/* The greatest such bound of an instance, and how far its mesh reaches from its origin. */
static double most_further(const struct trax_instance *instance, const struct trax_scene_mesh *mesh, double *reach) {
  double in_mesh = 0, out = 0;
  for (int row = 0; row < 3; row++) {
    in_mesh = fmax(in_mesh, fmax(fabs((double)mesh->bounds_min[row]), fabs((double)mesh->bounds_max[row])));
    out = fmax(out, fabs((double)instance->to_world[row][0]) + fabs((double)instance->to_world[row][1]) +
                        fabs((double)instance->to_world[row][2]));
  }
  *reach = out * in_mesh;
  return (double)instance->spread * 3 * *reach; /* the distance of a vertex, and an edge */
}

static bool light_is_near_instance(const struct trax_scene *scene, const struct trax_instance *instance,
                                   const float eye[3], const float light[3]) {
  const struct trax_scene_mesh *mesh = &scene->meshes[instance->mesh];
  double reach, nearest, farthest;
  const double further = most_further(instance, mesh, &reach);
  const double bound = trax_start_bound(greatest(from(instance->origin)) + reach, 2 * reach) + further;
  const struct double3 way = minus(from(light), from(instance->origin)), at = trax_to_object(instance, way);
  const double stretch = (double)instance->stretch;
  distances(&nearest, &farthest, at, mesh->bounds_min, mesh->bounds_max);
  if (nearest > TRAX_NEAR_LIGHT * bound * stretch)
    return false;
  for (uint32_t k = 0; k < mesh->triangle_count; k++) {
    struct placed_triangle placed;
    trax_place(&placed, scene, instance->first_number + k);
    if (is_near(&placed.triangle, eye, light, false, further))
      return true;
  }
  return false;
}

bool trax_light_is_near(const struct trax_scene *scene, const float eye[3], const float light[3]) {
  const bool exact = trax_needs_exact(scene, eye);
  for (uint32_t i = 0; i < scene->instance_count; i++)
    if (light_is_near_instance(scene, &scene->instances[i], eye, light))
      return true;
  for (uint32_t i = 0; i < scene->triangle_count && !scene->instances; i++)
    if (is_near(&scene->triangles[i], eye, light, exact, 0))
      return true;
  return false;
}
