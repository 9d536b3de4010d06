/* The picture as the emulated machine renders it. */
#include "core/machine.h"
#include "render.h"

#include <string.h>

trax_status trax_render_simulated(struct trax_picture *picture, const struct trax_frame *frame, trax_machine *machine,
                                  const char *program, const trax_run_options *options, trax_error *error) {
  uint32_t width = frame->params->width, height = frame->params->height, size = 4 * width * height;
  if (frame->scene->size > UINT32_MAX)
    return trax_fail(error, "the scene of %zu bytes exceeds the machine's address space", frame->scene->size);
  trax_status status = trax_machine_load_elf(machine, program, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "scene", frame->scene->bytes, (uint32_t)frame->scene->size, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "params", frame->params, frame->params_size, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "image", NULL, size, error);
  if (status == TRAX_OK)
    status = trax_machine_run(machine, options, error);
  if (status != TRAX_OK)
    return status;
  int exit_status = trax_machine_exit_status(machine);
  if (exit_status != 0)
    return trax_fail(error, "%s ended with status %d", program, exit_status);
  const uint8_t *bytes;
  uint32_t bytes_size;
  status = trax_machine_read_buffer(machine, "image", &bytes, &bytes_size, error);
  if (status == TRAX_OK)
    status = trax_picture_init(picture, width, height, error);
  if (status == TRAX_OK)
    memcpy(picture->pixels, bytes, size);
  return status;
}
