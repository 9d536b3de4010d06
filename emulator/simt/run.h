/* The engine of docs/simt.md, to be read beside that page. */
#ifndef TRAX_SIMT_RUN_H
#define TRAX_SIMT_RUN_H

#include "engine/engine.h"

extern const struct trax_engine trax_simt_engine;

#endif
