/* The file system of a case: its files and nothing else, found by the last part of their names. */
#ifndef TRAX_RAYTRACER_FUZZ_FILES_H
#define TRAX_RAYTRACER_FUZZ_FILES_H

#include "fuzz_case.h"
#include "internal.h"

extern const fuzz_case *fuzz_files; /* the case that runs */

/* --- built.c --- */

/* The scene passes every check; it is released. */
void fuzz_check_built(struct trax_scene *scene);
/* An imported mesh makes a scene, which passes every check. */
void fuzz_build(const struct trax_mesh *mesh);

#endif
