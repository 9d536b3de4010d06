#include "hits.h"

#include "double3.h"
#include "exact.h"
#include "placed.h"
#include "reach.h"

#include "../device/camera.h"

#include <stdlib.h>
#include <string.h>

#define UNIT 0x1p-24 /* of binary32's rounding */

void trax_hits_release(struct trax_hits *hits) {
  free(hits->triangles);
  *hits = (struct trax_hits){0};
}

/* The results of the watertight test for one triangle, with bounds on their errors. */
struct bounds {
  double edge[3], edge_error[3];
  double determinant, determinant_error;
  double distance, distance_error; /* of the plane, in units of the direction */
};

/* Bounds on the errors of a ray's components in an instance's mesh: each is a sum of three products, of an inverse that
   was rounded, and of a difference from the instance's origin. 0 without an instance. */
struct transformed {
  struct double3 eye, towards;
  double eye_error, towards_error;
};

static double most_of_products(const float m[3][3], struct double3 v) {
  double most = 0;
  for (int row = 0; row < 3; row++)
    most = fmax(most, fabs((double)m[row][0] * v.x) + fabs((double)m[row][1] * v.y) + fabs((double)m[row][2] * v.z));
  return most;
}

static struct transformed transform(const struct trax_instance *instance, struct double3 eye, struct double3 towards) {
  if (!instance)
    return (struct transformed){eye, towards, 0, 0};
  const struct double3 way = minus(eye, from(instance->origin));
  return (struct transformed){trax_to_object(instance, way), trax_to_object(instance, towards),
                              5 * UNIT * most_of_products(instance->to_object, way),
                              4 * UNIT * most_of_products(instance->to_object, towards)};
}

/* hit: the distance of the hit that is judged, in units of the direction. */
static struct bounds bounds_of(const struct trax_scene *scene, uint32_t number, struct double3 world_eye,
                               struct double3 world_towards, double hit) {
  struct placed_triangle placed;
  trax_place(&placed, scene, number);
  const struct trax_triangle *triangle = &scene->triangles[placed.stored];
  const struct transformed ray = transform(placed.instance, world_eye, world_towards);
  const struct double3 eye = ray.eye, towards = ray.towards;
  const float *const corners[3] = {triangle->v0, triangle->v1, triangle->v2};
  const double origin[3] = {eye.x, eye.y, eye.z}, direction[3] = {towards.x, towards.y, towards.z};
  int w = 0;
  for (int axis = 1; axis < 3; axis++)
    if (fabs(direction[axis]) > fabs(direction[w]))
      w = axis;
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  double vertex[3][3], error[3], size = 0;
  const double reach = TRAX_REACH * hit * fabs(direction[w]);
  for (int i = 0; i < 3; i++) {
    double farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
      vertex[i][axis] = (double)corners[i][axis] - origin[axis];
      farthest = fmax(farthest, fabs(vertex[i][axis]));
    }
    farthest = fmin(farthest, reach);
    vertex[i][u] -= direction[u] / direction[w] * vertex[i][w];
    vertex[i][v] -= direction[v] / direction[w] * vertex[i][w];
    error[i] =
        14 * UNIT * farthest + 2 * ray.eye_error + 2 * fabs(vertex[i][w]) * ray.towards_error / fabs(direction[w]);
    size = fmax(size, farthest);
  }
  struct bounds bounds = {0};
  double mean = 0, spread = 0, widest = 0;
  for (int i = 0; i < 3; i++) {
    const int a = (i + 2) % 3, b = (i + 1) % 3;
    bounds.edge[i] = vertex[a][u] * vertex[b][v] - vertex[a][v] * vertex[b][u];
    bounds.edge_error[i] = error[b] * (fabs(vertex[a][u]) + fabs(vertex[a][v])) +
                           error[a] * (fabs(vertex[b][u]) + fabs(vertex[b][v])) + 2 * error[a] * error[b];
    bounds.determinant += bounds.edge[i];
    bounds.determinant_error += bounds.edge_error[i];
    mean += bounds.edge[i] * vertex[i][w];
  }
  const double certain = fabs(bounds.determinant) - bounds.determinant_error;
  mean = bounds.determinant == 0 ? (vertex[0][w] + vertex[1][w] + vertex[2][w]) / 3 : mean / bounds.determinant;
  for (int i = 0; i < 3; i++) {
    widest = fmax(widest, fabs(vertex[i][w] - mean));
    spread += bounds.edge_error[i] * fabs(vertex[i][w] - mean);
  }
  /* The hit is a mean of the vertices, so it is no farther off than they are. */
  bounds.distance = mean / direction[w];
  bounds.distance_error = (fmin(certain > 0 ? spread / certain : INFINITY, widest) + 16 * UNIT * size +
                           2 * ray.eye_error + 2 * fabs(mean) * ray.towards_error / fabs(direction[w])) /
                          fabs(direction[w]);
  return bounds;
}

static bool may_be_found(const struct bounds *bounds) {
  bool above = true, below = true;
  for (int i = 0; i < 3; i++) {
    above = above && bounds->edge[i] >= -bounds->edge_error[i];
    below = below && bounds->edge[i] <= bounds->edge_error[i];
  }
  return above || below;
}

static bool must_be_found(const struct bounds *bounds) {
  if (fabs(bounds->determinant) <= bounds->determinant_error || bounds->distance <= bounds->distance_error)
    return false;
  for (int i = 0; i < 3; i++)
    if (copysign(1, bounds->determinant) * bounds->edge[i] <= bounds->edge_error[i])
      return false;
  return true;
}

struct ray {
  struct double3 eye, direction;
};

/* Whether equal distances explain another answer of exact hits. */
static bool exact_is_explained(const struct trax_scene *scene, uint32_t answer, uint32_t right, struct ray ray) {
  struct exact_hit own, nearest;
  return answer != TRAX_NO_TRIANGLE && right != TRAX_NO_TRIANGLE &&
         exact_placed(scene, answer, ray.eye, ray.direction, &own) &&
         exact_placed(scene, right, ray.eye, ray.direction, &nearest) &&
         own.distance <= nearest.distance * (1 + 0x1p-21);
}

/* Whether a test with the errors of binary32 can give this answer. */
static bool is_explained(const struct trax_scene *scene, uint32_t answer, uint32_t right, struct ray ray) {
  struct bounds own = {.distance = INFINITY};
  struct exact_hit nearest = {.distance = INFINITY};
  if (right != TRAX_NO_TRIANGLE)
    exact_placed(scene, right, ray.eye, ray.direction, &nearest);
  if (answer != TRAX_NO_TRIANGLE) {
    own = bounds_of(scene, answer, ray.eye, ray.direction, nearest.distance);
    if (!may_be_found(&own))
      return false;
  }
  if (right == TRAX_NO_TRIANGLE)
    return true;
  const struct bounds rival = bounds_of(scene, right, ray.eye, ray.direction, nearest.distance);
  return !must_be_found(&rival) || rival.distance + rival.distance_error >= own.distance - own.distance_error;
}

static uint32_t number_of(const struct trax_scene *scene, uint32_t triangle) {
  return triangle == TRAX_NO_TRIANGLE ? triangle : trax_source_of(scene, triangle);
}

uint64_t trax_hits_same(const struct trax_hits *a, const struct trax_hits *b, const struct trax_frame *frame) {
  uint64_t same = 0;
  for (size_t i = 0; i < (size_t)a->width * a->height; i++)
    same += number_of(frame->scene, a->triangles[i]) == number_of(frame->scene, b->triangles[i]);
  return same;
}

void trax_hits_judge(struct trax_hits_difference *difference, const struct trax_hits *answers,
                     const struct trax_hits *exact, const struct trax_frame *frame) {
  const struct trax_render_params *params = frame->params;
  const struct trax_scene *scene = frame->scene;
  *difference = (struct trax_hits_difference){.pixels = (uint64_t)answers->width * answers->height};
  for (uint32_t y = 0; y < answers->height; y++)
    for (uint32_t x = 0; x < answers->width; x++) {
      const size_t i = (size_t)y * answers->width + x;
      const uint32_t answer = answers->triangles[i], right = exact->triangles[i];
      if (number_of(scene, answer) == number_of(scene, right)) {
        difference->same++;
        continue;
      }
      const struct vector camera = camera_direction(params, pixel_at(x, y), PIXEL_MIDDLE);
      const struct ray ray = {from(params->eye), {camera.x, camera.y, camera.z}};
      if (params->features & TRAX_FEATURE_BIT(EXACT) ? exact_is_explained(scene, answer, right, ray)
                                                     : is_explained(scene, answer, right, ray)) {
        difference->tied++;
        continue;
      }
      if (difference->holes + difference->wrong == 0)
        difference->x = x, difference->y = y;
      difference->holes += answer == TRAX_NO_TRIANGLE;
      difference->wrong += answer != TRAX_NO_TRIANGLE;
    }
}
