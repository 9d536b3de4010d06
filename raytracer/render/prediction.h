/* A fast estimate of the cycles that ranges of a picture's slots will take: a coarse model of the chip runs the twin's
   accesses to the scene. Sampled simulation (sampling/slots.h) compares the estimate of the simulated slots with their
   cycles, and corrects that of the others accordingly. */
#ifndef TRAX_RENDER_PREDICTION_H
#define TRAX_RENDER_PREDICTION_H

#include "render.h"

#include <stdint.h>

#define TRAX_PREDICTION_BLOCK 32u /* slots */

struct trax_prediction {
  uint32_t blocks;
  double *cycles;       /* [blocks + 1]: cycles[n]: when n blocks have been handed out; the last one: the end */
  uint32_t *handed_out; /* [blocks + 1][queues]: the slots of each queue (device/slots.h) by then */
};

/* scene_address: where the device has the scene. The picture is the twin's, run->rays the rays traced. */
trax_status trax_predict(struct trax_prediction *prediction, struct trax_picture *picture,
                         const struct trax_frame *frame, uint32_t queues, const struct trax_config *config,
                         uint32_t scene_address, struct trax_render_run *run, trax_error *error);
/* Why the model may be off by more than usual: the configuration key, or other property, that differs from those of the
   device program, workload and chips that its constants were fitted to. NULL: none. */
const char *trax_prediction_doubt(const struct trax_frame *frame, bool other_program, const struct trax_config *config);
void trax_prediction_release(struct trax_prediction *prediction);

#endif
