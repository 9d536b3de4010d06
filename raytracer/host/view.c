/* View files (libconfig), and a view for scenes that have none. */
#include "trax/view.h"
#include "internal.h"

#include <libconfig.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* False if the length is zero, or not finite. */
static bool normalise(float v[3]) {
  float largest = fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2])));
  if (!(largest > 0) || !isfinite(largest))
    return false;
  for (int axis = 0; axis < 3; axis++)
    v[axis] /= largest;
  float length = sqrtf(dot(v, v));
  for (int axis = 0; axis < 3; axis++)
    v[axis] /= length;
  return true;
}

/* Makes up perpendicular to the direction; false if they are parallel, both being of unit length. */
static bool make_perpendicular(float up[3], const float direction[3]) {
  float along = dot(up, direction);
  float rest[3];
  for (int axis = 0; axis < 3; axis++)
    rest[axis] = up[axis] - along * direction[axis];
  if (dot(rest, rest) < 1e-8f)
    return false;
  memcpy(up, rest, sizeof rest);
  return normalise(up);
}

/* --- files --- */

struct reader {
  const char *path;
  const config_setting_t *root;
  trax_error *error;
};

static trax_status fail_at(const struct reader *reader, const config_setting_t *setting, const char *key,
                           const char *reason) {
  const char *file = setting ? config_setting_source_file(setting) : NULL;
  return scene_fail(reader->error, "%s:%u: %s: %s", file ? file : reader->path,
                    setting ? config_setting_source_line(setting) : 1, key, reason);
}

static trax_status find(const struct reader *reader, const char *key, const config_setting_t **setting) {
  *setting = config_setting_get_member(reader->root, key);
  return *setting ? TRAX_OK : fail_at(reader, NULL, key, "missing");
}

static bool read_number(const config_setting_t *setting, float *number) {
  double value;
  switch (config_setting_type(setting)) {
  case CONFIG_TYPE_INT:
    value = config_setting_get_int(setting);
    break;
  case CONFIG_TYPE_INT64:
    value = (double)config_setting_get_int64(setting);
    break;
  case CONFIG_TYPE_FLOAT:
    value = config_setting_get_float(setting);
    break;
  default:
    return false;
  }
  *number = (float)value;
  return fabs(value) <= SCENE_MAX_COORDINATE;
}

static trax_status read_vector(const struct reader *reader, const char *key, float vector[3]) {
  const config_setting_t *setting;
  trax_status result = find(reader, key, &setting);
  if (result != TRAX_OK)
    return result;
  if (!config_setting_is_array(setting) && !config_setting_is_list(setting))
    return fail_at(reader, setting, key, "must be three numbers, as [0.0, 1.0, 0.0]");
  if (config_setting_length(setting) != 3)
    return fail_at(reader, setting, key, "must have exactly three numbers");
  for (unsigned axis = 0; axis < 3; axis++)
    if (!read_number(config_setting_get_elem(setting, axis), &vector[axis]))
      return fail_at(reader, setting, key, "must be three numbers of ordinary size");
  return TRAX_OK;
}

/* direction, or look_at relative to the eye. */
static trax_status read_direction(const struct reader *reader, struct trax_view *view) {
  const config_setting_t *direction = config_setting_get_member(reader->root, "direction");
  const config_setting_t *look_at = config_setting_get_member(reader->root, "look_at");
  if (direction && look_at)
    return fail_at(reader, look_at, "look_at", "direction is given as well; one of them is enough");
  const char *key = look_at ? "look_at" : "direction";
  if (!direction && !look_at)
    return fail_at(reader, NULL, "direction", "missing, and so is look_at");
  trax_status result = read_vector(reader, key, view->direction);
  if (result != TRAX_OK)
    return result;
  if (look_at)
    for (int axis = 0; axis < 3; axis++)
      view->direction[axis] -= view->eye[axis];
  if (!normalise(view->direction))
    return fail_at(reader, look_at ? look_at : direction, key, look_at ? "is the eye itself" : "has no length");
  return TRAX_OK;
}

static trax_status read_up(const struct reader *reader, struct trax_view *view) {
  trax_status result = read_vector(reader, "up", view->up);
  if (result != TRAX_OK)
    return result;
  const config_setting_t *setting = config_setting_get_member(reader->root, "up");
  if (!normalise(view->up))
    return fail_at(reader, setting, "up", "has no length");
  if (!make_perpendicular(view->up, view->direction))
    return fail_at(reader, setting, "up", "is parallel to the direction");
  return TRAX_OK;
}

static trax_status read_fov(const struct reader *reader, struct trax_view *view) {
  const config_setting_t *setting;
  trax_status result = find(reader, "fov", &setting);
  if (result != TRAX_OK)
    return result;
  if (!read_number(setting, &view->fov) || !(view->fov >= 0.01f && view->fov <= 179.9f))
    return fail_at(reader, setting, "fov", "must be a number of degrees from 0.01 to 179.9");
  return TRAX_OK;
}

static trax_status check_keys(const struct reader *reader) {
  static const char *const known[] = {"eye", "direction", "look_at", "up", "fov", "light"};
  for (int i = 0; i < config_setting_length(reader->root); i++) {
    const config_setting_t *setting = config_setting_get_elem(reader->root, (unsigned)i);
    bool found = false;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
      found = found || !strcmp(config_setting_name(setting), known[k]);
    if (!found)
      return fail_at(reader, setting, config_setting_name(setting),
                     "unknown; the keys are eye, direction or look_at, up, fov and light");
  }
  return TRAX_OK;
}

trax_status trax_view_read(struct trax_view *view, const char *path, trax_error *error) {
  struct scene_bytes file; /* libconfig aborts on what cannot be read as a file, as on a directory */
  trax_status result = scene_load_file(&file, path, error);
  if (result != TRAX_OK)
    return result;
  char *text = memchr(file.data, 0, file.size) ? NULL : realloc(file.data, file.size + 1);
  if (!text) {
    free(file.data);
    return scene_fail(error, "%s:1: not text", path);
  }
  text[file.size] = 0;
  config_t config;
  config_init(&config);
  struct trax_view read = {0};
  if (!config_read_string(&config, text)) {
    const char *included = config_error_file(&config);
    result = scene_fail(error, "%s:%d: %s", included ? included : path, config_error_line(&config),
                        config_error_text(&config));
  } else {
    const struct reader reader = {path, config_root_setting(&config), error};
    result = check_keys(&reader);
    if (result == TRAX_OK)
      result = read_vector(&reader, "eye", read.eye);
    if (result == TRAX_OK)
      result = read_direction(&reader, &read);
    if (result == TRAX_OK)
      result = read_up(&reader, &read);
    if (result == TRAX_OK)
      result = read_fov(&reader, &read);
    if (result == TRAX_OK)
      result = read_vector(&reader, "light", read.light);
  }
  config_destroy(&config);
  free(text);
  if (result == TRAX_OK)
    *view = read;
  return result;
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
  float radius = sqrtf(dot(half, half));
  if (!(radius > 0))
    radius = 1;

  *view = (struct trax_view){.up = {0, 1, 0}, .fov = fov};
  for (int axis = 0; axis < 3; axis++)
    view->direction[axis] = -toward_eye[axis];
  normalise(view->direction);
  make_perpendicular(view->up, view->direction);
  const float *d = view->direction, *u = view->up;
  const float right[3] = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]};

  /* The least distance at which all eight corners are inside of the picture's four edges. */
  float tangent = tanf(fov * pi / 360), distance = 0;
  for (int corner = 0; corner < 8; corner++) {
    float offset[3];
    for (int axis = 0; axis < 3; axis++)
      offset[axis] = corner >> axis & 1 ? half[axis] : -half[axis];
    float needed = fmaxf(fabsf(dot(offset, u)) / tangent, fabsf(dot(offset, right)) / (tangent * aspect));
    distance = fmaxf(distance, needed - dot(offset, d));
  }
  distance = fmaxf(distance, radius * 0.01f) * margin;
  float light[3] = {toward_light[0], toward_light[1], toward_light[2]};
  normalise(light);
  for (int axis = 0; axis < 3; axis++) {
    view->eye[axis] = centre[axis] - distance * d[axis];
    view->light[axis] = centre[axis] + 4 * radius * light[axis];
  }
}
