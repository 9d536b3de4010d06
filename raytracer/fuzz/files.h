/* The file system of a case: only its files, found by the last part of their names. */
#ifndef TRAX_RAYTRACER_FUZZ_FILES_H
#define TRAX_RAYTRACER_FUZZ_FILES_H

#include "fuzz_case.h"
#include "internal.h"

extern const fuzz_case *fuzz_files; /* the case that runs */

/* --- built.c --- */

/* Checks that the scene passes every check, and releases it. */
void fuzz_check_built(struct trax_scene *scene);
/* An imported mesh makes a scene, which passes every check. */
void fuzz_build(const struct trax_mesh *mesh);

#endif
