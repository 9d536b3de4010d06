/* The picture as the emulated machine renders it. */
#include "core/machine.h"
#include "explain/explain.h"
#include "render.h"

#include <string.h>

static trax_status run(trax_machine *machine, const struct trax_simulated_options *options, trax_error *error) {
  struct trax_explain_options wanted = options->explain ? *options->explain : (struct trax_explain_options){0};
  struct trax_explain *explain;
  if (options->costs) {
    wanted.item_buffer = "image";
    wanted.item_bytes = 4;
  }
  if (trax_explain_begin(&explain, machine, &wanted, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->costs)
    trax_explain_items(explain, trax_costs_add, options->costs);
  const trax_status status = trax_machine_run(machine, &options->run, error);
  if (status == TRAX_OK)
    return trax_explain_end(explain, error);
  trax_explain_discard(explain);
  return status;
}

trax_status trax_render_simulated(struct trax_picture *picture, const struct trax_frame *frame, trax_machine *machine,
                                  const struct trax_simulated_options *options, trax_error *error) {
  uint32_t width = frame->params->width, height = frame->params->height, size = 4 * width * height;
  if (frame->scene->size > UINT32_MAX)
    return trax_fail(error, "the scene of %zu bytes exceeds the machine's address space", frame->scene->size);
  trax_status status = trax_machine_load_elf(machine, options->program, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "scene", frame->scene->bytes, (uint32_t)frame->scene->size, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "params", frame->params, frame->params_size, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "image", NULL, size, error);
  if (status == TRAX_OK)
    status = run(machine, options, error);
  if (status != TRAX_OK)
    return status;
  int exit_status = trax_machine_exit_status(machine);
  if (exit_status != 0)
    return trax_fail(error, "%s ended with status %d", options->program, exit_status);
  const uint8_t *bytes;
  uint32_t bytes_size;
  status = trax_machine_read_buffer(machine, "image", &bytes, &bytes_size, error);
  if (status == TRAX_OK)
    status = trax_picture_init(picture, width, height, error);
  if (status == TRAX_OK)
    memcpy(picture->pixels, bytes, size);
  return status;
}
