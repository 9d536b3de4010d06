/* Small files, meshes and scenes made on the spot. What fails here ends the test. */
#ifndef TRAX_TEST_SCENE_SUPPORT_H
#define TRAX_TEST_SCENE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "layouts/layouts.h"
#include "temporary.h"

/* Writes a file into the test's directory and returns its path. */
const char *test_file(const char *name, const void *bytes, size_t size);
const char *test_text(const char *name, const char *text);
/* Appends bytes that a file is made of. */
void append(unsigned char *bytes, size_t *size, const void *more, size_t count);

/* Uniform in [0, 1). */
float random_unit(uint32_t *state);

/* Meshes; release with trax_mesh_release. */
void mesh_triangle(struct trax_mesh *mesh, const float a[3], const float b[3], const float c[3], uint32_t material);
void mesh_soup(struct trax_mesh *mesh, unsigned count, float size, uint32_t seed);

/* Imports one file in this process, which must succeed. */
void import_good(struct trax_mesh *mesh, const char *path, struct trax_import_report *report);
/* Imports one file, which must be refused by a message with this part. */
void import_bad(const char *path, const struct trax_import_options *options, const char *part);
void build_good(struct trax_scene *scene, const struct trax_mesh *mesh, const struct trax_build_options *options);

/* Makes the checksum right again after a change to the bytes. */
void seal(void *bytes, size_t size);

/* Fails the test if text does not contain part. */
#define assert_contains(text, part) assert_contains_at(text, part, __FILE__, __LINE__)
void assert_contains_at(const char *text, const char *part, const char *file, int line);

#endif
