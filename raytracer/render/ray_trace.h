/* The trace of rays (docs/traces.md): each ray of a picture and its result, by the native twin. */
#ifndef TRAX_RENDER_RAY_TRACE_H
#define TRAX_RENDER_RAY_TRACE_H

#include "render.h"

/* Writes it to path: CSV if that ends in .csv, else binary (ray_file.h). exponent: the scene was scaled by 2^exponent.
   picture: the same of another engine, NULL: none. It fails if that differs from the twin's picture, because then the
   program traced other rays. */
trax_status trax_ray_trace_write(const char *path, const struct trax_frame *frame, int exponent,
                                 const struct trax_picture *picture, struct trax_render_run *run, trax_error *error);

/* The number in the meshes of the triangle at an offset in the scene; in scenes
   without these numbers its place in the file. TRAX_NO_TRIANGLE of offset 0. */
uint32_t trax_ray_triangle(const struct trax_scene *scene, uint32_t offset, uint32_t instance);

#endif
