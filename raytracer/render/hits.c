#include "hits.h"

#include "core/machine.h"
#include "double3.h"

#include "../device/camera.h"

#include <stdlib.h>
#include <string.h>

#define UNIT 0x1p-24 /* of binary32's rounding */

void trax_hits_release(struct trax_hits *hits) {
  free(hits->triangles);
  *hits = (struct trax_hits){0};
}

/* What the watertight test computes of one triangle, with bounds on the errors that it makes. */
struct bounds {
  double edge[3], edge_error[3];
  double determinant, determinant_error;
  double distance, distance_error; /* of the plane, in units of the direction */
};

static struct bounds bounds_of(const struct trax_triangle *triangle, struct double3 eye, struct double3 towards) {
  const float *const corners[3] = {triangle->v0, triangle->v1, triangle->v2};
  const double origin[3] = {eye.x, eye.y, eye.z}, direction[3] = {towards.x, towards.y, towards.z};
  int w = 0;
  for (int axis = 1; axis < 3; axis++)
    if (fabs(direction[axis]) > fabs(direction[w]))
      w = axis;
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  double vertex[3][3], error[3], size = 0;
  for (int i = 0; i < 3; i++) {
    double farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
      vertex[i][axis] = (double)corners[i][axis] - origin[axis];
      farthest = fmax(farthest, fabs(vertex[i][axis]));
    }
    vertex[i][u] -= direction[u] / direction[w] * vertex[i][w];
    vertex[i][v] -= direction[v] / direction[w] * vertex[i][w];
    error[i] = 14 * UNIT * farthest;
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
  bounds.distance_error =
      (fmin(certain > 0 ? spread / certain : INFINITY, widest) + 16 * UNIT * size) / fabs(direction[w]);
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

/* Could a test with such errors give this answer, where the other triangle is in the scene, too? */
static bool is_explained(const struct trax_scene *scene, uint32_t answer, uint32_t other, struct double3 eye,
                         struct double3 direction) {
  struct bounds own = {.distance = INFINITY};
  if (answer != TRAX_NO_TRIANGLE) {
    own = bounds_of(&scene->triangles[answer], eye, direction);
    if (!may_be_found(&own))
      return false;
  }
  if (other == TRAX_NO_TRIANGLE)
    return true;
  const struct bounds rival = bounds_of(&scene->triangles[other], eye, direction);
  return !must_be_found(&rival) || rival.distance + rival.distance_error >= own.distance - own.distance_error;
}

static uint32_t number_of(const struct trax_scene *scene, uint32_t triangle) {
  return triangle == TRAX_NO_TRIANGLE || !scene->source_ids ? triangle : scene->source_ids[triangle];
}

void trax_hits_compare(struct trax_hits_difference *difference, const struct trax_hits *a, const struct trax_hits *b,
                       const struct trax_frame *frame) {
  const struct trax_render_params *params = frame->params;
  const struct trax_scene *scene = frame->scene;
  *difference = (struct trax_hits_difference){.pixels = (uint64_t)a->width * a->height};
  for (uint32_t y = 0; y < a->height; y++)
    for (uint32_t x = 0; x < a->width; x++) {
      const size_t i = (size_t)y * a->width + x;
      const uint32_t left = a->triangles[i], right = b->triangles[i];
      if (number_of(scene, left) == number_of(scene, right)) {
        difference->same++;
        continue;
      }
      const struct vector camera = camera_direction(params, pixel_at(x, y), PIXEL_MIDDLE);
      const struct double3 direction = {camera.x, camera.y, camera.z}, eye = from(params->eye);
      if (is_explained(scene, left, right, eye, direction) && is_explained(scene, right, left, eye, direction))
        difference->tied++;
      else if (difference->unexplained++ == 0)
        difference->x = x, difference->y = y;
    }
}

trax_status trax_hits_picture(struct trax_picture *picture, const struct trax_hits *hits,
                              const struct trax_frame *frame, trax_error *error) {
  if (trax_picture_init(picture, hits->width, hits->height, error) != TRAX_OK)
    return TRAX_ERROR;
  for (size_t i = 0; i < (size_t)hits->width * hits->height; i++) {
    const uint32_t number = number_of(frame->scene, hits->triangles[i]) + 1; /* of none: 0 */
    if (number > 0xFFFFFF) {
      trax_picture_release(picture);
      return trax_fail(error, "a picture of triangles has room for 16,777,215, and number %u is seen", number - 1);
    }
    picture->pixels[i] = number | 0xFF000000u;
  }
  return TRAX_OK;
}
