/* The reference engine: docs/timing.md as a program, to be read beside that page. */
#ifndef TRAX_REFERENCE_RUN_H
#define TRAX_REFERENCE_RUN_H

#include "engine/engine.h"

extern const struct trax_engine trax_reference_engine;

#endif
