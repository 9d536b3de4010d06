/* The emulated machines of the extreme suite. */
#ifndef TRAX_EXTREME_MACHINES_H
#define TRAX_EXTREME_MACHINES_H

#include "query.h"
#include "render.h"

/* All rays through a query program on the chip 1x32; without `cycles`, in the functional engine. */
trax_status machine_trace(const char *program, const struct trax_scene *scene, const struct query_params *params,
                          const struct query_ray *rays, struct query_answer *answers, uint64_t *cycles,
                          trax_error *error);

/* The frame's picture by the ray tracer, natively on one and on many threads, on the chip 4x32, and, if asked for, on
   machines at the ends of what a configuration allows: an error unless all are the same and of opaque pixels. */
trax_status machine_pictures(const char *directory, const struct trax_frame *frame, bool all_machines,
                             trax_error *error);

#endif
