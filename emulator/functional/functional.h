/* The functional engine: a program's results, without time (functional.c). */
#ifndef TRAX_FUNCTIONAL_FUNCTIONAL_H
#define TRAX_FUNCTIONAL_FUNCTIONAL_H

#include "engine/engine.h"

extern const struct trax_engine trax_functional_engine;

#endif
