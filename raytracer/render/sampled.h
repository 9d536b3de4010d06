/* Sampled simulation of a picture. A prediction of costs chooses the slots that are simulated (sampling/slots.h). */
#ifndef TRAX_RENDER_SAMPLED_H
#define TRAX_RENDER_SAMPLED_H

#include "prediction.h"

struct trax_picture_sampling {
  trax_slot_sampling slots; /* fraction or error, and seed, are the caller's */
  struct trax_prediction prediction;
  uint64_t kinds[TRAX_RAY_KIND_COUNT]; /* of slots */
  const char *doubt;                   /* trax_prediction_doubt */
};

/* Fills in the rest, for a machine that `program` is loaded into; the picture is the native twin's. Errors: the
   program hands out its pixels neither as the device program does, by `next_slot`, nor row by row, by `next_pixel`. */
trax_status trax_picture_sampling_init(struct trax_picture_sampling *sampling, struct trax_picture *picture,
                                       const struct trax_frame *frame, const struct trax_program *program,
                                       trax_machine *machine, struct trax_render_run *run, trax_error *error);
void trax_picture_sampling_release(struct trax_picture_sampling *sampling);

#endif
