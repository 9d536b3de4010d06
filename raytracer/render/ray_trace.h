/* The trace of rays (docs/traces.md): each ray of a picture and its result, by the native twin. */
#ifndef TRAX_RENDER_RAY_TRACE_H
#define TRAX_RENDER_RAY_TRACE_H

#include "render.h"

enum { TRAX_RAY_TRACE_HEADER = 32, TRAX_RAY_TRACE_RECORD = 64 }; /* bytes of the binary trace */

/* Writes it to path: CSV if that ends in .csv, else binary. picture: the same of another engine, NULL: none. It fails
   if that differs from the twin's picture, because then the program traced other rays. */
trax_status trax_ray_trace_write(const char *path, const struct trax_frame *frame, const struct trax_picture *picture,
                                 struct trax_render_run *run, trax_error *error);

#endif
