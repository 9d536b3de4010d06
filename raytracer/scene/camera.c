/* Views that are not read: a scene framed as a whole, a camera aimed or turned. */
#include "internal.h"
#include "trax/view.h"

#include <math.h>
#include <string.h>

float scene_dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool scene_normalise(float v[3]) {
  float largest = fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2])));
  if (!(largest > 0) || !isfinite(largest))
    return false;
  for (int axis = 0; axis < 3; axis++)
    v[axis] /= largest;
  float length = sqrtf(scene_dot(v, v));
  for (int axis = 0; axis < 3; axis++)
    v[axis] /= length;
  return true;
}

bool scene_make_perpendicular(float up[3], const float direction[3]) {
  float along = scene_dot(up, direction);
  float rest[3];
  for (int axis = 0; axis < 3; axis++)
    rest[axis] = up[axis] - along * direction[axis];
  if (scene_dot(rest, rest) < 1e-8f)
    return false;
  memcpy(up, rest, sizeof rest);
  return scene_normalise(up);
}

/* --- automatic framing --- */

void trax_view_frame(struct trax_view *view, const float bounds_min[3], const float bounds_max[3], float aspect) {
  static const float toward_eye[3] = {0.25f, 0.25f, 1.0f}, toward_light[3] = {-1.0f, 1.6f, 1.2f};
  enum { fov = 40 };
  const float pi = 3.14159265f, margin = 1.06f;
  float centre[3], half[3];
  for (int axis = 0; axis < 3; axis++) {
    half[axis] = bounds_max[axis] * 0.5f - bounds_min[axis] * 0.5f;
    centre[axis] = bounds_min[axis] * 0.5f + bounds_max[axis] * 0.5f;
  }
  float radius = sqrtf(scene_dot(half, half));
  if (!(radius > 0))
    radius = 1;

  *view = (struct trax_view){.up = {0, 1, 0}, .fov = fov, .has_look_at = true};
  memcpy(view->look_at, centre, sizeof centre);
  for (int axis = 0; axis < 3; axis++)
    view->direction[axis] = -toward_eye[axis];
  scene_normalise(view->direction);
  scene_make_perpendicular(view->up, view->direction);
  const float *d = view->direction, *u = view->up;
  const float right[3] = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]};

  /* The least distance at which all eight corners are inside of the picture's four edges. */
  float tangent = tanf(fov * pi / 360), distance = 0;
  for (int corner = 0; corner < 8; corner++) {
    float offset[3];
    for (int axis = 0; axis < 3; axis++)
      offset[axis] = corner >> axis & 1 ? half[axis] : -half[axis];
    float needed = fmaxf(fabsf(scene_dot(offset, u)) / tangent, fabsf(scene_dot(offset, right)) / (tangent * aspect));
    distance = fmaxf(distance, needed - scene_dot(offset, d));
  }
  distance = fmaxf(distance, radius * 0.01f) * margin;
  float light[3] = {toward_light[0], toward_light[1], toward_light[2]};
  scene_normalise(light);
  for (int axis = 0; axis < 3; axis++) {
    view->eye[axis] = centre[axis] - distance * d[axis];
    view->light[axis] = centre[axis] + 4 * radius * light[axis];
  }
}

/* --- other views --- */

trax_status trax_view_aim(struct trax_view *view, const float look_at[3], trax_error *error) {
  float direction[3];
  for (int axis = 0; axis < 3; axis++)
    direction[axis] = look_at[axis] - view->eye[axis];
  if (!scene_normalise(direction))
    return trax_fail(error, "the point to look at is the eye itself");
  memcpy(view->direction, direction, sizeof direction);
  memcpy(view->look_at, look_at, sizeof view->look_at);
  view->has_look_at = true;
  return TRAX_OK;
}

trax_status trax_view_set_up(struct trax_view *view, const float up[3], trax_error *error) {
  float unit[3] = {up[0], up[1], up[2]};
  if (!scene_normalise(unit))
    return trax_fail(error, "the direction upwards has no length");
  if (!scene_make_perpendicular(unit, view->direction))
    return trax_fail(error, "the direction upwards is that in which the eye looks");
  memcpy(view->up, unit, sizeof unit);
  return TRAX_OK;
}

/* Rodrigues' formula, about an axis of unit length through the origin. */
static void rotate(float v[3], const double axis[3], double degrees) {
  const double radians = degrees * (3.14159265358979323846 / 180), c = cos(radians), s = sin(radians);
  const double along = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
  double turned[3];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    turned[i] = v[i] * c + (axis[j] * v[k] - axis[k] * v[j]) * s + axis[i] * along * (1 - c);
  }
  for (int i = 0; i < 3; i++)
    v[i] = (float)turned[i];
}

void trax_view_orbit(struct trax_view *view, const float centre[3], float angle, float elevation) {
  const float *d = view->direction, *u = view->up;
  const double left[3] = {(double)u[1] * d[2] - (double)u[2] * d[1], (double)u[2] * d[0] - (double)u[0] * d[2],
                          (double)u[0] * d[1] - (double)u[1] * d[0]};
  double axis[3] = {0};
  int most = 1;
  for (int i = 0; i < 3; i++)
    if (fabsf(u[i]) > fabsf(u[most]))
      most = i;
  axis[most] = u[most] < 0 ? -1 : 1;
  float place[3];
  for (int i = 0; i < 3; i++)
    place[i] = view->eye[i] - centre[i];
  float *const vectors[] = {place, view->direction, view->up};
  for (int i = 0; i < 3; i++) {
    rotate(vectors[i], left, elevation);
    rotate(vectors[i], axis, angle);
  }
  for (int i = 0; i < 3; i++)
    view->eye[i] = centre[i] + place[i];
  scene_normalise(view->direction);
  scene_make_perpendicular(view->up, view->direction);
  if (view->has_look_at) {
    for (int i = 0; i < 3; i++)
      place[i] = view->look_at[i] - centre[i];
    rotate(place, left, elevation);
    rotate(place, axis, angle);
    for (int i = 0; i < 3; i++)
      view->look_at[i] = centre[i] + place[i];
  }
}
