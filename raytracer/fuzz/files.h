/* The file system of a case: its files and nothing else, found by the last part of their names. */
#ifndef TRAX_RAYTRACER_FUZZ_FILES_H
#define TRAX_RAYTRACER_FUZZ_FILES_H

#include "fuzz_case.h"
#include "internal.h"

extern const fuzz_case *fuzz_files; /* the case that runs */

#endif
