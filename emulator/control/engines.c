#include "control/engines.h"
#include "engine/run.h"
#include "fast/chip.h"
#include "functional/functional.h"
#include "reference/run.h"
#include "simt/run.h"

#include <stdio.h>
#include <string.h>

/* The first engine is the default. After the first four come variants of them. */
static const struct trax_engine *const engines[] = {
    &trax_fast_engine,
    &trax_reference_engine,
    &trax_functional_engine,
    &trax_simt_engine,
    &trax_fast_any_engine,
    &trax_fast_interpreted_engine,
    &trax_fast_translated_engine,
    &trax_functional_interpreted_engine,
    &trax_functional_translated_engine,
};
enum { ENGINES = sizeof engines / sizeof *engines, MAIN_ENGINES = 4 };

static bool every_engine(const struct trax_engine *engine) {
  (void)engine;
  return true;
}

void trax_engine_names(bool (*can)(const struct trax_engine *engine), char *names, size_t size) {
  unsigned left = 0;
  size_t length = 0;
  for (unsigned i = 0; i < MAIN_ENGINES; i++)
    left += can(engines[i]);
  *names = '\0';
  for (unsigned i = 0; i < MAIN_ENGINES && length < size; i++)
    if (can(engines[i]))
      length += (size_t)snprintf(names + length, size - length, "%s%s", engines[i]->name,
                                 --left > 1 ? ", "
                                 : left     ? " or "
                                            : "");
}

const char *trax_engine_name(unsigned number) {
  return number < MAIN_ENGINES ? engines[number]->name : NULL;
}

trax_status trax_engine_find(const char *name, const struct trax_engine **engine, trax_error *error) {
  char names[128];
  *engine = engines[0];
  if (!name)
    return TRAX_OK;
  for (unsigned i = 0; i < ENGINES; i++)
    if (strcmp(engines[i]->name, name) == 0) {
      *engine = engines[i];
      return TRAX_OK;
    }
  trax_engine_names(every_engine, names, sizeof names);
  return trax_fail(error, "is not %s", names);
}

const struct trax_engine *trax_engine_for(const struct trax_config *config) {
  return config->simt.width > 1 ? &trax_simt_engine : engines[0];
}

static bool has_warps(const struct trax_engine *engine) {
  return engine->has_warps;
}

trax_status trax_engine_check(const struct trax_engine *engine, const struct trax_config *config, trax_error *error) {
  char names[128];
  if (config->simt.width == 1 || engine->has_warps)
    return TRAX_OK;
  trax_engine_names(has_warps, names, sizeof names);
  return trax_fail(error, "simt.width = %u needs the engine %s, not %s", config->simt.width, names, engine->name);
}
