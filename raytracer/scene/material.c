/* Materials that the command line gives. */
#include "placing.h"
#include "trax/names.h"
#include "trax/scene_options.h"

#include <math.h>
#include <string.h>

/* The specular colour at normal incidence of a dielectric of index 1.5. */
#define DIELECTRIC 0.04f

/* Cuts the name off and returns the rest. */
static char *cut_name(struct trax_material_override *override, char *text) {
  char *equals = strrchr(text, '=');
  override->name = equals ? text : NULL;
  if (!equals)
    return text;
  *equals = 0;
  return equals + 1;
}

static bool parse_colour(const char *text, float colour[3], float most) {
  int end = -1;
  if (sscanf(text, "%f,%f,%f%n", &colour[0], &colour[1], &colour[2], &end) != 3 || end < 0 || text[end])
    return false;
  for (int channel = 0; channel < 3; channel++)
    if (!(colour[channel] >= 0 && colour[channel] <= most))
      return false;
  return true;
}

/* Parses a number and, after another colon, an optional colour. */
static bool parse_value(const char *text, float least, float most, float *value, float colour[3]) {
  char number[32];
  const size_t length = strcspn(text, ":");
  if (length == 0 || length >= sizeof number)
    return false;
  memcpy(number, text, length);
  number[length] = 0;
  int end = -1;
  if (sscanf(number, "%f%n", value, &end) != 1 || end < 0 || number[end] || !(*value >= least && *value <= most))
    return false;
  return !text[length] || (colour && parse_colour(text + length + 1, colour, 1));
}

trax_status trax_override_diffuse(struct trax_material_override *override, char *text, trax_error *error) {
  char whole[128];
  snprintf(whole, sizeof whole, "%s", text);
  *override = (struct trax_material_override){.kind = TRAX_OVERRIDE_DIFFUSE};
  return parse_colour(cut_name(override, text), override->colour, 1)
             ? TRAX_OK
             : trax_fail(error, "--diffuse: '%s' is not [NAME=]R,G,B with R, G and B from 0 to 1", whole);
}

static const struct {
  const char *name;
  enum trax_override_kind kind;
  float colour, value;
  bool needs_value;
} kinds[] = {{"lambert", TRAX_OVERRIDE_LAMBERT, 0, 0, false},
             {"mirror", TRAX_OVERRIDE_MIRROR, 1, 0, false},
             {"glass", TRAX_OVERRIDE_GLASS, 1, 1.5f, false},
             {"ggx", TRAX_OVERRIDE_GGX, DIELECTRIC, 0, true},
             {"emit", TRAX_OVERRIDE_EMISSION, 0, 0, true}};
enum { KINDS = sizeof kinds / sizeof *kinds };

static const char *kind_name(const void *context, size_t i) {
  (void)context;
  return kinds[i].name;
}

void trax_put_material_kinds(FILE *out) {
  for (size_t i = 0; i < KINDS; i++)
    fprintf(out, "%s%s ", kinds[i].name, kinds[i].needs_value ? ":" : "");
}

static bool parse_kind(struct trax_material_override *override, const char *kind) {
  const char *colon = strchr(kind, ':'), *value = colon ? colon + 1 : NULL;
  const size_t length = colon ? (size_t)(colon - kind) : strlen(kind);
  for (size_t i = 0; i < KINDS; i++) {
    if (strlen(kinds[i].name) != length || strncmp(kind, kinds[i].name, length) != 0)
      continue;
    override->kind = kinds[i].kind;
    override->value = kinds[i].value;
    for (int channel = 0; channel < 3; channel++)
      override->colour[channel] = kinds[i].colour;
    if (!value)
      return !kinds[i].needs_value;
    switch (override->kind) {
    case TRAX_OVERRIDE_MIRROR:
      return parse_colour(value, override->colour, 1);
    case TRAX_OVERRIDE_GLASS:
      return parse_value(value, 1, TRAX_SCENE_MAX_IOR, &override->value, NULL);
    case TRAX_OVERRIDE_GGX:
      return parse_value(value, 0, 1, &override->value, override->colour);
    case TRAX_OVERRIDE_EMISSION:
      return parse_colour(value, override->colour, TRAX_SCENE_MAX_EMISSION);
    default:
      return false;
    }
  }
  return false;
}

trax_status trax_override_material(struct trax_material_override *override, char *text, trax_error *error) {
  char whole[128];
  snprintf(whole, sizeof whole, "%s", text);
  *override = (struct trax_material_override){0};
  char *kind = cut_name(override, text);
  if (parse_kind(override, kind))
    return TRAX_OK;
  kind[strcspn(kind, ":")] = 0;
  const char *nearest = trax_nearest_name(kind, KINDS, kind_name, NULL);
  const bool mistyped = nearest && strcmp(nearest, kind) != 0;
  return trax_fail(error,
                   "--material: '%s' is not [NAME=]lambert, mirror[:R,G,B], glass[:IOR], ggx:ROUGHNESS[:R,G,B] or "
                   "emit:R,G,B%s%s%s",
                   whole, mistyped ? "; did you mean " : "", mistyped ? nearest : "", mistyped ? "?" : "");
}

static void apply(struct trax_material *surface, const struct trax_material_override *override) {
  switch (override->kind) {
  case TRAX_OVERRIDE_DIFFUSE:
    memcpy(surface->diffuse, override->colour, sizeof surface->diffuse);
    return;
  case TRAX_OVERRIDE_EMISSION:
    memcpy(surface->emission, override->colour, sizeof surface->emission);
    return;
  case TRAX_OVERRIDE_LAMBERT:
    surface->kind = TRAX_MATERIAL_LAMBERT;
    return;
  case TRAX_OVERRIDE_MIRROR:
    surface->kind = TRAX_MATERIAL_MIRROR;
    break;
  case TRAX_OVERRIDE_GLASS:
    surface->kind = TRAX_MATERIAL_GLASS;
    surface->ior = override->value;
    break;
  case TRAX_OVERRIDE_GGX:
    surface->kind = TRAX_MATERIAL_GGX;
    surface->roughness = override->value;
    break;
  }
  memcpy(surface->specular, override->colour, sizeof surface->specular);
}

bool scene_set_material(struct trax_material *surface, const char *what) {
  struct trax_material_override override = {.kind = TRAX_OVERRIDE_DIFFUSE};
  if (!parse_colour(what, override.colour, 1) && !parse_kind(&override, what))
    return false;
  apply(surface, &override);
  return true;
}

static const char *material_name(const void *mesh, size_t i) {
  return ((const struct trax_mesh *)mesh)->materials[i].name;
}

/* Names the nearest material, or else the first ones. */
static trax_status no_material(const struct trax_mesh *mesh, const char *name, trax_error *error) {
  char names[300] = "";
  size_t used = 0;
  const char *nearest = trax_nearest_name(name, mesh->material_count, material_name, mesh);
  if (nearest || mesh->material_count == 0)
    return trax_fail(error, "no material is named '%s'%s%s%s", name, nearest ? "; did you mean " : "",
                     nearest ? nearest : "", nearest ? "?" : "");
  for (uint32_t m = 0; m < mesh->material_count && used < sizeof names; m++)
    used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", m ? ", " : "", mesh->materials[m].name);
  return trax_fail(error, "no material is named '%s'; there %s %s%s", name, mesh->material_count == 1 ? "is" : "are",
                   names, used < sizeof names ? "" : "...");
}

trax_status scene_override_materials(struct trax_mesh *mesh, const struct trax_import_options *options,
                                     trax_error *error) {
  for (size_t i = 0; i < options->override_count; i++) {
    const struct trax_material_override *override = &options->overrides[i];
    bool found = false;
    char name[TRAX_MESH_NAME];
    trax_mesh_name(name, override->name ? override->name : "");
    for (uint32_t m = 0; m < mesh->material_count; m++) {
      if (override->name && strcmp(name, mesh->materials[m].name) != 0)
        continue;
      apply(&mesh->materials[m].surface, override);
      found = true;
    }
    if (!found && override->name)
      return no_material(mesh, override->name, error);
    if (!found)
      return trax_fail(error, "the meshes have no material");
  }
  return TRAX_OK;
}
