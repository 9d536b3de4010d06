/* Computed views: a scene framed as a whole, a camera aimed or turned. */
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

/* Turns v by the smallest rotation that takes the y axis to `up`, of unit length. */
static void turn_up(float v[3], const float up[3]) {
  if (up[1] < -0.9999f) { /* half a turn, around the z axis of all */
    v[0] = -v[0], v[1] = -v[1];
    return;
  }
  const float axis[3] = {up[2], 0, -up[0]}, along = (axis[0] * v[0] + axis[2] * v[2]) / (1 + up[1]);
  const float turned[3] = {up[1] * v[0] + axis[1] * v[2] - axis[2] * v[1] + along * axis[0],
                           up[1] * v[1] + axis[2] * v[0] - axis[0] * v[2],
                           up[1] * v[2] + axis[0] * v[1] - axis[1] * v[0] + along * axis[2]};
  memcpy(v, turned, sizeof turned);
}

/* The extent of the scene beyond the planes through its middle that bound a view of a direction: to the right, left,
   top and bottom, with slopes[0] and slopes[1] for each unit of depth; and the least depth. */
struct extent {
  double right, left, top, bottom, nearest;
};

static double along(const float axis[3], const double v[3]) {
  return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
}

static int triangle_corners(float corners[8][3], const struct trax_triangle *triangle) {
  memcpy(corners, triangle, 9 * sizeof(float));
  return 3;
}

/* The corners of the mesh's box where it is placed: all triangles of millions of instances would take too long. */
static int box_corners(float corners[8][3], const struct trax_scene *scene, const struct trax_instance *instance) {
  const struct trax_scene_mesh *mesh = &scene->meshes[instance->mesh];
  for (int c = 0; c < 8; c++)
    for (int row = 0; row < 3; row++) {
      double sum = instance->origin[row];
      for (int column = 0; column < 3; column++)
        sum +=
            (double)instance->to_world[row][column] * (c >> column & 1 ? mesh->bounds_max : mesh->bounds_min)[column];
      corners[c][row] = (float)sum;
    }
  return 8;
}

static struct extent measure(const struct trax_scene *scene, const double middle[3], const float *direction,
                             const float *up, const float *right, const double slopes[2]) {
  struct extent extent = {0, 0, 0, 0, 0};
  const uint32_t shapes = scene->instances ? scene->instance_count : scene->triangle_count;
  bool is_first = true;
  for (uint32_t i = 0; i < shapes; i++) {
    float corners[8][3];
    const int count = scene->instances ? box_corners(corners, scene, &scene->instances[i])
                                       : triangle_corners(corners, &scene->triangles[i]);
    for (int c = 0; c < count; c++) {
      const double place[3] = {corners[c][0] - middle[0], corners[c][1] - middle[1], corners[c][2] - middle[2]};
      const double x = along(right, place), y = along(up, place), z = along(direction, place);
      const struct extent one = {x - slopes[0] * z, -x - slopes[0] * z, y - slopes[1] * z, -y - slopes[1] * z, z};
      extent.right = is_first || one.right > extent.right ? one.right : extent.right;
      extent.left = is_first || one.left > extent.left ? one.left : extent.left;
      extent.top = is_first || one.top > extent.top ? one.top : extent.top;
      extent.bottom = is_first || one.bottom > extent.bottom ? one.bottom : extent.bottom;
      extent.nearest = is_first || one.nearest < extent.nearest ? one.nearest : extent.nearest;
      is_first = false;
    }
  }
  return extent;
}

void trax_view_frame(struct trax_view *view, const struct trax_scene *scene, const float up[3], float fov,
                     float aspect) {
  static const float toward_eye[3] = {0.25f, 0.25f, 1.0f}, toward_light[3] = {-1.0f, 1.6f, 1.2f};
  const double filled = 0.8, pi = 3.14159265358979323846;
  const float *low = scene->header->bounds_min, *high = scene->header->bounds_max;
  double middle[3];
  float half[3], centre[3], light[3] = {toward_light[0], toward_light[1], toward_light[2]};
  for (int axis = 0; axis < 3; axis++) {
    half[axis] = high[axis] * 0.5f - low[axis] * 0.5f;
    centre[axis] = low[axis] * 0.5f + high[axis] * 0.5f;
    middle[axis] = (double)centre[axis];
  }
  const float square = scene_dot(half, half);
  float radius = sqrtf(square);
  if (square < 0x1p-100f) { /* too short to be accurate */
    double exact = 0;
    for (int axis = 0; axis < 3; axis++)
      exact += ((double)high[axis] - (double)low[axis]) * ((double)high[axis] - (double)low[axis]);
    radius = (float)(sqrt(exact) / 2);
  }
  if (!(radius > 0))
    radius = 1;

  *view = (struct trax_view){.up = {up[0], up[1], up[2]}, .fov = fov > 0 ? fov : 40, .has_look_at = true};
  if (!scene_normalise(view->up))
    memcpy(view->up, (const float[]){0, 1, 0}, sizeof view->up);
  for (int axis = 0; axis < 3; axis++)
    view->direction[axis] = -toward_eye[axis];
  scene_normalise(view->direction);
  scene_normalise(light);
  turn_up(view->direction, view->up);
  turn_up(light, view->up);
  scene_make_perpendicular(view->up, view->direction);
  const float *d = view->direction, *u = view->up;
  const float right[3] = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]};

  /* The planes that bound the filled part of the picture go through the eye. Each touches the scene; in the direction
     in which the scene is smaller, both are equally far from it. */
  const double tangent = filled * tan((double)view->fov * pi / 360);
  const double slopes[2] = {tangent * (double)aspect, tangent};
  const struct extent extent = measure(scene, middle, d, u, right, slopes);
  double depth = -(extent.right + extent.left) / (2 * slopes[0]);
  depth = fmin(depth, -(extent.top + extent.bottom) / (2 * slopes[1]));
  depth = fmin(depth, extent.nearest - 0.01 * (double)radius);
  const double x = (extent.right - extent.left) / 2, y = (extent.top - extent.bottom) / 2;
  for (int axis = 0; axis < 3; axis++) {
    const double aside = middle[axis] + x * (double)right[axis] + y * (double)u[axis];
    view->look_at[axis] = (float)aside;
    view->eye[axis] = (float)(aside + depth * (double)d[axis]);
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
