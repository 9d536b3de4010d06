/* View files (libconfig): reading and writing. */
#include "trax/view.h"
#include "internal.h"
#include "trax/output.h"

#include <libconfig.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- files --- */

struct reader {
  const char *path;
  trax_error *error;
};

static trax_status fail_at(const struct reader *reader, const config_setting_t *setting, const char *key,
                           const char *reason) {
  return trax_fail(reader->error, "%s:%u: %s: %s", reader->path, setting ? config_setting_source_line(setting) : 1, key,
                   reason);
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

/* Reads an optional value; *value stays if there is none. */
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
  if (!scene_normalise(view->direction))
    return fail_in(file, look_at ? look_at : direction, key, look_at ? "is the eye itself" : "has no length");
  return TRAX_OK;
}

static trax_status read_up(const struct group *file, struct trax_view *view) {
  trax_status result = read_vector(file, "up", view->up);
  if (result != TRAX_OK)
    return result;
  const config_setting_t *setting = config_setting_get_member(file->setting, "up");
  if (!scene_normalise(view->up))
    return fail_in(file, setting, "up", "has no length");
  if (!scene_make_perpendicular(view->up, view->direction))
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
  if (result == TRAX_OK && !scene_normalise(light->direction))
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
    if (!scene_normalise(unit[i]))
      return fail_in(group, edges, "edges", "an edge has no length");
  }
  if (fabsf(scene_dot(unit[0], unit[1])) > 1e-3f)
    return fail_in(group, edges, "edges", "are not perpendicular to each other");
  for (int axis = 0; axis < 3; axis++)
    light->direction[axis] =
        unit[0][(axis + 1) % 3] * unit[1][(axis + 2) % 3] - unit[0][(axis + 2) % 3] * unit[1][(axis + 1) % 3];
  scene_normalise(light->direction);
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

/* The line of an @include, from 1; 0: there is none. A view is one file, because @include may name any file of this
   computer, or a device that never ends. */
static unsigned find_include(const char *text) {
  unsigned line = 1;
  for (const char *at = text; at; at = strchr(at, '\n'), at = at ? at + 1 : NULL, line++)
    if (!strncmp(at + strspn(at, " \t"), "@include", 8))
      return line;
  return 0;
}

trax_status trax_view_read(struct trax_view *view, const char *path, trax_error *error) {
  struct scene_bytes file; /* libconfig aborts if it cannot read a file, such as a directory */
  trax_status result = scene_load_file(&file, path, SCENE_TEXT_LIMITS, error);
  if (result != TRAX_OK)
    return result;
  char *text = memchr(file.data, 0, file.size) ? NULL : realloc(file.data, file.size + 1);
  if (!text) {
    free(file.data);
    return trax_fail(error, "%s:1: not text", path);
  }
  text[file.size] = 0;
  const unsigned include = find_include(text);
  if (include) {
    free(text);
    return trax_fail(error, "%s:%u: @include: a view is one file", path, include);
  }
  config_t config;
  config_init(&config);
  struct trax_view read = {0};
  if (!config_read_string(&config, text)) {
    result = trax_fail(error, "%s:%d: %s", path, config_error_line(&config), config_error_text(&config));
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

/* --- writing: text that libconfig reads, with every bit of a float --- */

static void put_number(FILE *out, float value) {
  char text[32];
  snprintf(text, sizeof text, "%.9g", (double)value);
  fprintf(out, "%s%s", text, strpbrk(text, ".e") ? "" : ".0"); /* else it would be an integer */
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
