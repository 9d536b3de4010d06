/* The engines by name, for --engine and trax_run_options.engine. */
#ifndef TRAX_CONTROL_ENGINES_H
#define TRAX_CONTROL_ENGINES_H

#include "engine/engine.h"

/* Finds an engine; a NULL name is the default. Errors: there is no such engine, or this host cannot run it. The message
   is a predicate: the caller puts the name before it. */
trax_status trax_engine_find(const char *name, const struct trax_engine **engine, trax_error *error);

/* The engine that runs a machine if none is named. */
const struct trax_engine *trax_engine_for(const struct trax_config *config);
/* Error: the engine cannot run the machine. */
trax_status trax_engine_check(const struct trax_engine *engine, const struct trax_config *config, trax_error *error);

/* Lists the names of the engines for which can() is true, as in "fast, reference, functional or simt", without variants
   of the fast engine. */
void trax_engine_names(bool (*can)(const struct trax_engine *engine), char *names, size_t size);
/* The name of one of these, by its number; NULL: there are fewer. */
const char *trax_engine_name(unsigned number);

#endif
