/* What ranges of a picture's slots will cost the chip, roughly and soon: the twin's accesses to the scene, passed
   through a coarse model of the chip. Sampled simulation (sampling/slots.h) takes it as a guess: what it says of the
   slots that are simulated is compared with the truth, and what it says of the others is corrected by as much. */
#ifndef TRAX_RENDER_PREDICTION_H
#define TRAX_RENDER_PREDICTION_H

#include "render.h"

#include <stdint.h>

#define TRAX_PREDICTION_BLOCK 32u /* slots */

struct trax_prediction {
  uint32_t blocks;
  double *cycles;       /* [blocks + 1]: when so many blocks have been handed out, and at the end */
  uint32_t *handed_out; /* [blocks + 1][queues]: how many slots of each queue (device/slots.h) then */
};

/* scene_address: where the device has the scene. The picture is the twin's, run->rays the rays traced. */
trax_status trax_predict(struct trax_prediction *prediction, struct trax_picture *picture,
                         const struct trax_frame *frame, uint32_t queues, const struct trax_config *config,
                         uint32_t scene_address, struct trax_render_run *run, trax_error *error);
/* Why the model, whose constants were fitted to the device program for the paper's workload on the paper's chips, may
   be off by more than there: the name of a configuration key or of what else is different; NULL: it fits. */
const char *trax_prediction_doubt(const struct trax_frame *frame, bool other_program, const struct trax_config *config);
void trax_prediction_release(struct trax_prediction *prediction);

#endif
