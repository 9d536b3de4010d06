#include "sampled.h"

#include <stdlib.h>
#include <string.h>

/* The twin's accesses in the order of the program's slots. */
static trax_status predict(struct trax_picture_sampling *sampling, struct trax_picture *picture,
                           const struct trax_frame *frame, trax_machine *machine, bool by_rows, uint32_t queues,
                           struct trax_render_run *run, trax_error *error) {
  uint8_t *scene;
  uint32_t scene_address = 0, scene_bytes;
  /* A program with the scene as plain arrays has it at another address, in about the same size. */
  if (trax_program_has(machine, "scene") &&
      trax_machine_buffer(machine, "scene", &scene_address, &scene, &scene_bytes, error) != TRAX_OK)
    return TRAX_ERROR;
  struct trax_frame ordered = *frame;
  struct trax_render_params *params = malloc(frame->params_size);
  if (!params)
    return trax_fail(error, "out of memory for the prediction");
  memcpy(params, frame->params, frame->params_size);
  if (by_rows)
    trax_frame_set_tiles(params, 0);
  ordered.params = params;
  const trax_status status = trax_predict(&sampling->prediction, picture, &ordered, queues,
                                          trax_machine_config(machine), scene_address, run, error);
  sampling->slots.slots = params->slot_count;
  sampling->slots.tile = 1u << 2 * params->tile_log2_side;
  free(params);
  return status;
}

trax_status trax_picture_sampling_init(struct trax_picture_sampling *sampling, struct trax_picture *picture,
                                       const struct trax_frame *frame, const struct trax_program *program,
                                       trax_machine *machine, struct trax_render_run *run, trax_error *error) {
  uint32_t counter, counter_bytes;
  const bool by_tiles = trax_machine_find_symbol(machine, "next_slot", &counter, &counter_bytes);
  if (!by_tiles && !trax_machine_find_symbol(machine, "next_pixel", &counter, &counter_bytes))
    return trax_fail(error,
                     "%s: the program has neither next_slot nor next_pixel, which count the pixels handed out: "
                     "it cannot be sampled",
                     program->path);
  const uint32_t queues = by_tiles && counter_bytes > 4 ? counter_bytes / 4 : 1; /* device/slots.h */
  if (queues > TRAX_MAX_QUEUES)
    return trax_fail(error, "%s: next_slot has %u queues; allowed are %u at most", program->path, queues,
                     TRAX_MAX_QUEUES);
  const trax_status status = predict(sampling, picture, frame, machine, !by_tiles, queues, run, error);
  if (status != TRAX_OK)
    return status;
  sampling->doubt = trax_prediction_doubt(frame, !by_tiles, trax_machine_config(machine));
  sampling->slots.counter = counter;
  sampling->slots.costs = sampling->prediction.cycles;
  sampling->slots.queues = queues;
  sampling->slots.handed_out = sampling->prediction.handed_out;
  sampling->slots.block = TRAX_PREDICTION_BLOCK;
  /* Another program may trace other rays than the twin, unless its symbol says that it does not. */
  sampling->slots.rays = by_tiles || trax_program_has(machine, "workload_rays") ? run->rays : 0;
  if (sampling->slots.rays) {
    memcpy(sampling->kinds, run->kinds, sizeof sampling->kinds);
    sampling->slots.kinds = sampling->kinds;
  }
  sampling->slots.items = (uint64_t)frame->params->width * frame->params->height;
  return TRAX_OK;
}

void trax_picture_sampling_release(struct trax_picture_sampling *sampling) {
  trax_prediction_release(&sampling->prediction);
}
