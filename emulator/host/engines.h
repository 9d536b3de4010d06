/* The engines, by the names of --engine and trax_run_options.engine. */
#ifndef TRAX_HOST_ENGINES_H
#define TRAX_HOST_ENGINES_H

#include "engine/engine.h"

/* NULL is the default's name. The message, behind the name, says that there is no such
   engine or that this host cannot run it. */
trax_status trax_engine_find(const char *name, const struct trax_engine **engine, trax_error *error);

/* The names of the engines that can, as in "fast, reference or functional"; variants of one are not
   told. */
void trax_engine_names(bool (*can)(const struct trax_engine *engine), char *names, size_t size);

#endif
