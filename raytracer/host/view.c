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
  trax_error *error;
};

static trax_status fail_at(const struct reader *reader, const config_setting_t *setting, const char *key,
                           const char *reason) {
  return scene_fail(reader->error, "%s:%u: %s: %s", reader->path, setting ? config_setting_source_line(setting) : 1,
                    key, reason);
}

/* A key of the file, or of one of its lights: what = "" or "lights[2]." */
struct group {
  const struct reader *reader;
  const config_setting_t *setting;
  const char *prefix;
};

static trax_status fail_in(const struct group *group, const config_setting_t *setting, const char *key,
                           const char *reason) {
  char name[64];
  snprintf(name, sizeof name, "%s%.30s", group->prefix, key);
  return fail_at(group->reader, setting ? setting : *group->prefix ? group->setting : NULL, name, reason);
}

static trax_status find(const struct group *group, const char *key, const config_setting_t **setting) {
  *setting = config_setting_get_member(group->setting, key);
  return *setting ? TRAX_OK : fail_in(group, NULL, key, "missing");
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

static trax_status read_three(const struct group *group, const config_setting_t *setting, const char *key,
                              float vector[3]) {
  if (!config_setting_is_array(setting) && !config_setting_is_list(setting))
    return fail_in(group, setting, key, "must be three numbers, as [0.0, 1.0, 0.0]");
  if (config_setting_length(setting) != 3)
    return fail_in(group, setting, key, "must have exactly three numbers");
  for (unsigned axis = 0; axis < 3; axis++)
    if (!read_number(config_setting_get_elem(setting, axis), &vector[axis]))
      return fail_in(group, setting, key, "must be three numbers of ordinary size");
  return TRAX_OK;
}

static trax_status read_vector(const struct group *group, const char *key, float vector[3]) {
  const config_setting_t *setting;
  trax_status result = find(group, key, &setting);
  return result == TRAX_OK ? read_three(group, setting, key, vector) : result;
}

/* What may be left out; *value is then as it was. */
static trax_status read_optional(const struct group *group, const char *key, float least, float most, float *value) {
  const config_setting_t *setting = config_setting_get_member(group->setting, key);
  if (!setting || (read_number(setting, value) && *value >= least && *value <= most))
    return TRAX_OK;
  char reason[64];
  snprintf(reason, sizeof reason, "must be a number from %g to %g", (double)least, (double)most);
  return fail_in(group, setting, key, reason);
}

static trax_status check_keys(const struct group *group, const char *const *known, const char *listed) {
  for (int i = 0; i < config_setting_length(group->setting); i++) {
    const config_setting_t *setting = config_setting_get_elem(group->setting, (unsigned)i);
    bool found = false;
    for (size_t k = 0; known[k] && !found; k++)
      found = !strcmp(config_setting_name(setting), known[k]);
    if (!found) {
      char reason[160];
      snprintf(reason, sizeof reason, "unknown; the keys are %s", listed);
      return fail_in(group, setting, config_setting_name(setting), reason);
    }
  }
  return TRAX_OK;
}

/* direction, or look_at relative to the eye. */
static trax_status read_direction(const struct group *file, struct trax_view *view) {
  const config_setting_t *direction = config_setting_get_member(file->setting, "direction");
  const config_setting_t *look_at = config_setting_get_member(file->setting, "look_at");
  if (direction && look_at)
    return fail_in(file, look_at, "look_at", "direction is given as well; one of them is enough");
  const char *key = look_at ? "look_at" : "direction";
  if (!direction && !look_at)
    return fail_in(file, NULL, "direction", "missing, and so is look_at");
  trax_status result = read_vector(file, key, view->direction);
  if (result != TRAX_OK)
    return result;
  if (look_at) {
    view->has_look_at = true;
    memcpy(view->look_at, view->direction, sizeof view->look_at);
    for (int axis = 0; axis < 3; axis++)
      view->direction[axis] -= view->eye[axis];
  }
  if (!normalise(view->direction))
    return fail_in(file, look_at ? look_at : direction, key, look_at ? "is the eye itself" : "has no length");
  return TRAX_OK;
}

static trax_status read_up(const struct group *file, struct trax_view *view) {
  trax_status result = read_vector(file, "up", view->up);
  if (result != TRAX_OK)
    return result;
  const config_setting_t *setting = config_setting_get_member(file->setting, "up");
  if (!normalise(view->up))
    return fail_in(file, setting, "up", "has no length");
  if (!make_perpendicular(view->up, view->direction))
    return fail_in(file, setting, "up", "is parallel to the direction");
  return TRAX_OK;
}

static trax_status read_fov(const struct group *file, struct trax_view *view) {
  const config_setting_t *setting;
  trax_status result = find(file, "fov", &setting);
  if (result != TRAX_OK)
    return result;
  if (!read_number(setting, &view->fov) || !(view->fov >= 0.01f && view->fov <= 179.9f))
    return fail_in(file, setting, "fov", "must be a number of degrees from 0.01 to 179.9");
  return TRAX_OK;
}

/* --- lights --- */

static trax_status read_point(const struct group *group, struct trax_light *light) {
  static const char *const keys[] = {"type", "position", "colour", "strength", "falloff", NULL};
  trax_status result = check_keys(group, keys, "type, position, colour, strength and falloff");
  if (result == TRAX_OK)
    result = read_vector(group, "position", light->position);
  return result == TRAX_OK ? read_optional(group, "falloff", 0, SCENE_MAX_COORDINATE, &light->falloff) : result;
}

static trax_status read_directional(const struct group *group, struct trax_light *light) {
  static const char *const keys[] = {"type", "direction", "colour", "strength", NULL};
  trax_status result = check_keys(group, keys, "type, direction, colour and strength");
  if (result == TRAX_OK)
    result = read_vector(group, "direction", light->direction);
  if (result == TRAX_OK && !normalise(light->direction))
    return fail_in(group, config_setting_get_member(group->setting, "direction"), "direction", "has no length");
  return result;
}

static trax_status read_rectangle(const struct group *group, struct trax_light *light) {
  static const char *const keys[] = {"type", "corner", "edges", "colour", "strength", NULL};
  const config_setting_t *edges;
  trax_status result = check_keys(group, keys, "type, corner, edges, colour and strength");
  if (result == TRAX_OK)
    result = read_vector(group, "corner", light->position);
  if (result == TRAX_OK)
    result = find(group, "edges", &edges);
  if (result != TRAX_OK)
    return result;
  if (!config_setting_is_list(edges) || config_setting_length(edges) != 2)
    return fail_in(group, edges, "edges", "must be two vectors, as ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])");
  float unit[2][3];
  for (unsigned i = 0; i < 2; i++) {
    result = read_three(group, config_setting_get_elem(edges, i), "edges", light->edges[i]);
    if (result != TRAX_OK)
      return result;
    memcpy(unit[i], light->edges[i], sizeof unit[i]);
    if (!normalise(unit[i]))
      return fail_in(group, edges, "edges", "an edge has no length");
  }
  if (fabsf(dot(unit[0], unit[1])) > 1e-3f)
    return fail_in(group, edges, "edges", "are not perpendicular to each other");
  for (int axis = 0; axis < 3; axis++)
    light->direction[axis] =
        unit[0][(axis + 1) % 3] * unit[1][(axis + 2) % 3] - unit[0][(axis + 2) % 3] * unit[1][(axis + 1) % 3];
  normalise(light->direction);
  return TRAX_OK;
}

static trax_status read_light(const struct group *group, struct trax_light *light) {
  static const struct {
    const char *name;
    enum trax_light_kind kind;
    trax_status (*read)(const struct group *, struct trax_light *);
  } kinds[] = {{"point", TRAX_LIGHT_POINT, read_point},
               {"directional", TRAX_LIGHT_DIRECTIONAL, read_directional},
               {"rectangle", TRAX_LIGHT_RECTANGLE, read_rectangle}};
  *light = (struct trax_light){.colour = {1, 1, 1}, .strength = 1};
  const config_setting_t *type;
  trax_status result = find(group, "type", &type);
  if (result != TRAX_OK)
    return result;
  const char *name = config_setting_get_string(type);
  size_t kind = 0;
  while (kind < sizeof kinds / sizeof *kinds && !(name && !strcmp(name, kinds[kind].name)))
    kind++;
  if (kind == sizeof kinds / sizeof *kinds)
    return fail_in(group, type, "type", "must be \"point\", \"directional\" or \"rectangle\"");
  light->kind = kinds[kind].kind;
  result = kinds[kind].read(group, light);
  const config_setting_t *colour = config_setting_get_member(group->setting, "colour");
  if (result == TRAX_OK && colour)
    result = read_three(group, colour, "colour", light->colour);
  for (int channel = 0; result == TRAX_OK && channel < 3; channel++)
    if (!(light->colour[channel] >= 0 && light->colour[channel] <= 1))
      return fail_in(group, colour, "colour", "must be three numbers from 0 to 1");
  return result == TRAX_OK ? read_optional(group, "strength", 0, TRAX_VIEW_MAX_STRENGTH, &light->strength) : result;
}

static trax_status read_lights(const struct group *file, struct trax_view *view) {
  const config_setting_t *lights = config_setting_get_member(file->setting, "lights");
  if (!lights)
    return read_vector(file, "light", view->light);
  if (config_setting_get_member(file->setting, "light"))
    return fail_in(file, lights, "lights", "light is given as well; one of them is enough");
  int count = config_setting_is_list(lights) ? config_setting_length(lights) : 0;
  if (count == 0)
    return fail_in(file, lights, "lights", "must be a list of lights, as ( { type = \"point\"; ... } )");
  if (count > TRAX_VIEW_MAX_LIGHTS) {
    char reason[64];
    snprintf(reason, sizeof reason, "there may be at most %d lights", TRAX_VIEW_MAX_LIGHTS);
    return fail_in(file, lights, "lights", reason);
  }
  for (int i = 0; i < count; i++) {
    char prefix[32];
    snprintf(prefix, sizeof prefix, "lights[%d].", i);
    const struct group group = {file->reader, config_setting_get_elem(lights, (unsigned)i), prefix};
    if (!config_setting_is_group(group.setting)) {
      snprintf(prefix, sizeof prefix, "lights[%d]", i);
      return fail_at(file->reader, group.setting, prefix, "must be a light, as { type = \"point\"; ... }");
    }
    trax_status result = read_light(&group, &view->lights[i]);
    if (result != TRAX_OK)
      return result;
    view->light_count++;
  }
  return TRAX_OK;
}

/* The line of an @include, from 1; 0: there is none. What it names may be any file of this computer, or a device that
   never ends, so a view is one file. */
static unsigned find_include(const char *text) {
  unsigned line = 1;
  for (const char *at = text; at; at = strchr(at, '\n'), at = at ? at + 1 : NULL, line++)
    if (!strncmp(at + strspn(at, " \t"), "@include", 8))
      return line;
  return 0;
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
  const unsigned include = find_include(text);
  if (include) {
    free(text);
    return scene_fail(error, "%s:%u: @include: a view is one file", path, include);
  }
  config_t config;
  config_init(&config);
  struct trax_view read = {0};
  if (!config_read_string(&config, text)) {
    result = scene_fail(error, "%s:%d: %s", path, config_error_line(&config), config_error_text(&config));
  } else {
    static const char *const keys[] = {"eye", "direction", "look_at", "up", "fov", "light", "lights", NULL};
    const struct reader reader = {path, error};
    const struct group file = {&reader, config_root_setting(&config), ""};
    result = check_keys(&file, keys, "eye, direction or look_at, up, fov and light or lights");
    if (result == TRAX_OK)
      result = read_vector(&file, "eye", read.eye);
    if (result == TRAX_OK)
      result = read_direction(&file, &read);
    if (result == TRAX_OK)
      result = read_up(&file, &read);
    if (result == TRAX_OK)
      result = read_fov(&file, &read);
    if (result == TRAX_OK)
      result = read_lights(&file, &read);
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

  *view = (struct trax_view){.up = {0, 1, 0}, .fov = fov, .has_look_at = true};
  memcpy(view->look_at, centre, sizeof centre);
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

/* --- other views --- */

trax_status trax_view_aim(struct trax_view *view, const float look_at[3], trax_error *error) {
  float direction[3];
  for (int axis = 0; axis < 3; axis++)
    direction[axis] = look_at[axis] - view->eye[axis];
  if (!normalise(direction))
    return scene_fail(error, "the point to look at is the eye itself");
  memcpy(view->direction, direction, sizeof direction);
  memcpy(view->look_at, look_at, sizeof view->look_at);
  view->has_look_at = true;
  return TRAX_OK;
}

trax_status trax_view_set_up(struct trax_view *view, const float up[3], trax_error *error) {
  float unit[3] = {up[0], up[1], up[2]};
  if (!normalise(unit))
    return scene_fail(error, "the direction upwards has no length");
  if (!make_perpendicular(unit, view->direction))
    return scene_fail(error, "the direction upwards is that in which the eye looks");
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
  normalise(view->direction);
  make_perpendicular(view->up, view->direction);
  if (view->has_look_at) {
    for (int i = 0; i < 3; i++)
      place[i] = view->look_at[i] - centre[i];
    rotate(place, left, elevation);
    rotate(place, axis, angle);
    for (int i = 0; i < 3; i++)
      view->look_at[i] = centre[i] + place[i];
  }
}

/* --- writing: text that libconfig reads, with every bit of a float --- */

static void put_number(FILE *out, float value) {
  char text[32];
  snprintf(text, sizeof text, "%.9g", (double)value);
  fprintf(out, "%s%s", text, strpbrk(text, ".e") ? "" : ".0"); /* or it would be an integer */
}

static void put_key(FILE *out, const char *key, float value) {
  fprintf(out, "%s = ", key);
  put_number(out, value);
  fputs("; ", out);
}

static void put_vector(FILE *out, const float value[3]) {
  for (int axis = 0; axis < 3; axis++) {
    fputs(axis ? ", " : "[", out);
    put_number(out, value[axis]);
  }
  fputc(']', out);
}

static void put_vector_key(FILE *out, const char *key, const float value[3]) {
  fprintf(out, "%s = ", key);
  put_vector(out, value);
  fputs("; ", out);
}

static void put_light(FILE *out, const struct trax_light *light) {
  static const char *const names[] = {"point", "directional", "rectangle"};
  fprintf(out, "  { type = \"%s\"; ", names[light->kind]);
  if (light->kind == TRAX_LIGHT_POINT) {
    put_vector_key(out, "position", light->position);
    put_key(out, "falloff", light->falloff);
  } else if (light->kind == TRAX_LIGHT_DIRECTIONAL)
    put_vector_key(out, "direction", light->direction);
  else {
    put_vector_key(out, "corner", light->position);
    fputs("edges = ( ", out);
    put_vector(out, light->edges[0]);
    fputs(", ", out);
    put_vector(out, light->edges[1]);
    fputs(" ); ", out);
  }
  put_vector_key(out, "colour", light->colour);
  put_key(out, "strength", light->strength);
  fputc('}', out);
}

trax_status trax_view_write(const struct trax_view *view, const char *path, trax_error *error) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return scene_out_of_memory(error, path);
  put_vector_key(out, "eye", view->eye);
  fputc('\n', out);
  put_vector_key(out, view->has_look_at ? "look_at" : "direction", view->has_look_at ? view->look_at : view->direction);
  fputc('\n', out);
  put_vector_key(out, "up", view->up);
  fputc('\n', out);
  put_key(out, "fov", view->fov);
  fputc('\n', out);
  if (view->light_count == 0)
    put_vector_key(out, "light", view->light);
  else
    fputs("lights = (\n", out);
  for (uint32_t i = 0; i < view->light_count; i++) {
    put_light(out, &view->lights[i]);
    fputs(i + 1 < view->light_count ? ",\n" : "\n);", out);
  }
  fputc('\n', out);
  trax_status result = fclose(out) == 0 ? trax_write_file(path, text, size, error) : scene_out_of_memory(error, path);
  free(text);
  return result;
}
