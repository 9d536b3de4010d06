/* The functional engine: a program's results, without time (functional.c). */
#ifndef TRAX_FUNCTIONAL_FUNCTIONAL_H
#define TRAX_FUNCTIONAL_FUNCTIONAL_H

#include "engine/engine.h"

/* The engine, and two variants for tests: without translation, and with all of it at once. */
extern const struct trax_engine trax_functional_engine, trax_functional_interpreted_engine,
    trax_functional_translated_engine;

#endif
