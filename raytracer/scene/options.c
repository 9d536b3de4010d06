#include "trax/scene_options.h"

#include "internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *member(void *target, const trax_option *option) {
  return (char *)target + option->offset;
}

static trax_status add_override(struct trax_import_options *import, const char *text, trax_error *error,
                                trax_status (*parse)(struct trax_material_override *, char *, trax_error *)) {
  const size_t count = import->override_count;
  struct trax_material_override *overrides =
      realloc((struct trax_material_override *)import->overrides, (count + 1) * sizeof *overrides);
  if (!overrides)
    return trax_fail(error, "out of memory");
  import->overrides = overrides;
  /* The text is in argv, whose strings may be changed: the name is cut off there. */
  trax_status status = parse(&overrides[count], (char *)text, error);
  import->override_count += status == TRAX_OK;
  return status;
}

trax_status trax_take_diffuse(void *target, const trax_option *option, const char *value, trax_error *error) {
  return add_override(member(target, option), value, error, trax_override_diffuse);
}

trax_status trax_take_material(void *target, const trax_option *option, const char *value, trax_error *error) {
  return add_override(member(target, option), value, error, trax_override_material);
}

trax_status trax_take_at(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_import_options *import = member(target, option);
  char *end;
  import->at = strtod(value, &end);
  import->moves = true;
  return end != value && !*end && isfinite(import->at)
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is neither a time in seconds nor the number of a frame");
}

const char *const trax_node_words[] = {
#define LAYOUT(number, NAME, name, general, planes, visit, option, ...) [1 + number] = option,
#include "layouts/table.def"
    [0] = "auto", [1 + TRAX_NODE_LAYOUTS] = NULL};
const char *const trax_normals_words[] = {"file", "smooth", "flat", NULL};

trax_status trax_take_texture_size(void *target, const trax_option *option, const char *value, trax_error *error) {
  const unsigned most = 1u << TRAX_TEXTURE_MAX_LOG2;
  uint64_t size;
  if (trax_option_number(option, value, 1, most, &size, error) != TRAX_OK || (size & (size - 1)))
    return trax_option_refuse(option, value, error, "is not a power of two up to %u", most);
  *(unsigned *)member(target, option) = (unsigned)size;
  return TRAX_OK;
}

trax_status trax_take_unpack_limit(void *target, const trax_option *option, const char *value, trax_error *error) {
  return trax_parse_size(value, member(target, option))
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is not a size from 1 byte to 4G");
}

trax_status trax_take_nodes(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_build_options build;
  char words[256];
  *(const char **)member(target, option) = value;
  if (trax_node_layout_choose(value, &build))
    return TRAX_OK;
  int length = snprintf(words, sizeof words, "%s", trax_node_words[0]);
  for (unsigned i = 1; i <= TRAX_NODE_LAYOUTS; i++)
    length += snprintf(words + length, sizeof words - (size_t)length, "%s%s", i < TRAX_NODE_LAYOUTS ? ", " : " and ",
                       trax_node_words[i]);
  return trax_option_refuse(option, value, error, "is none of %s", words);
}

trax_status trax_take_splits(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_build_options build;
  *(const char **)member(target, option) = value ? value : "1.5";
  return trax_splits_choose(value, &build)
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is neither auto nor a number from 1 to %g",
                                  (double)TRAX_SCENE_MAX_SPLITS);
}

trax_status trax_take_normals(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_build_options *build = member(target, option);
  build->smooth = strcmp(value, "flat") != 0;
  build->compute_normals = strcmp(value, "smooth") == 0;
  if (strcmp(value, "file") == 0 || build->compute_normals || !build->smooth)
    return TRAX_OK;
  return trax_option_refuse(option, value, error, "is none of file, smooth and flat");
}
