#include "picture_error.h"

#include <stdlib.h>

/* --- both programs --- */

/* A machine that has rendered the frame, and the picture. */
static trax_status render(trax_machine **machine, struct trax_picture *picture, const struct trax_frame *frame,
                          bool record, const struct trax_error_run *run, trax_error *error) {
  struct trax_specialise_options specialise = run->specialise;
  struct trax_program program = {.specialised = false};
  char note[256];
  specialise.record = record;
  trax_status status = trax_program_specialise(&program, frame, &specialise, note, error);
  if (status == TRAX_OK && !program.specialised)
    status = trax_fail(error, "there is no program compiled for the picture: %s", note);
  if (status == TRAX_OK && !(*machine = trax_machine_create(run->config, error)))
    status = TRAX_ERROR;
  if (status == TRAX_OK)
    status = trax_simulated_load(*machine, frame, &program, error);
  const struct trax_simulated_options options = {
      .run = {.output = stderr,
              .total_items = (uint64_t)frame->params->width * frame->params->height,
              .progress = run->progress,
              .progress_context = run->progress_context,
              .interrupt = run->specialise.interrupt,
              .engine = "functional",
              .host_threads = run->host_threads}};
  return status == TRAX_OK ? trax_simulated_run(picture, frame, *machine, &options, error) : status;
}

/* --- figures --- */

static trax_status take_errors(double figures[TRAX_ERROR_FIGURE_COUNT], const struct trax_frame *frame,
                               const uint8_t *record, const struct trax_error_run *run, trax_error *error) {
  const uint32_t width = frame->params->width, height = frame->params->height;
  const size_t pixels = (size_t)width * height;
  const struct trax_pixel_record *recorded = (const struct trax_pixel_record *)(const void *)record;
  double *channels = malloc(3 * pixels * sizeof *channels);
  if (!channels)
    return trax_fail(error, "out of memory for a picture of %u x %u", width, height);
  for (size_t i = 0; i < 3 * pixels; i++)
    channels[i] = recorded[i / 3].channel[i % 3];

  struct trax_channel_errors numerical, sampling, total;
  trax_channel_errors(&numerical, channels, run->exact->channels, pixels);
  trax_channel_errors(&sampling, run->exact->channels, run->converged->channels, pixels);
  trax_channel_errors(&total, channels, run->converged->channels, pixels);
  struct trax_hit_errors hits;
  trax_hit_errors(&hits, run->exact, (const struct trax_sample_record *)(const void *)(recorded + pixels), frame);
  figures[TRAX_ERROR_RMSE] = numerical.rmse;
  figures[TRAX_ERROR_LARGEST] = numerical.largest;
  figures[TRAX_ERROR_SAMPLING_RMSE] = sampling.rmse;
  figures[TRAX_ERROR_TOTAL_RMSE] = total.rmse;
  figures[TRAX_ERROR_WRONG] = (double)hits.wrong_pixels;
  figures[TRAX_ERROR_MISSED] = (double)hits.missed;
  figures[TRAX_ERROR_GROWN] = (double)hits.grown;
  figures[TRAX_ERROR_OTHER] = (double)hits.other;
  figures[TRAX_ERROR_TIED] = (double)hits.tied;
  figures[TRAX_ERROR_SHADOW] = (double)hits.shadow;
  trax_status status = trax_flip(&figures[TRAX_ERROR_FLIP], channels, run->exact->channels, width, height, error);
  if (status == TRAX_OK)
    status = trax_flip(&figures[TRAX_ERROR_TOTAL_FLIP], channels, run->converged->channels, width, height, error);
  free(channels);
  return status;
}

/* The program that records is another one, so its picture must be shown to be the same; -ffast-math may compile it to
   other roundings. */
static trax_status check_recorded(double figures[TRAX_ERROR_FIGURE_COUNT], const struct trax_picture *picture,
                                  const struct trax_picture *recorded, const struct trax_method *method,
                                  trax_error *error) {
  struct trax_difference difference;
  trax_picture_compare(&difference, picture, recorded, 0);
  figures[TRAX_ERROR_CHANGED] = (double)difference.unequal;
  if (difference.unequal && !method->fast_math)
    return trax_fail(error, "the program that records renders %llu pixels otherwise than the program that is measured",
                     (unsigned long long)difference.unequal);
  return TRAX_OK;
}

trax_status trax_error_measure(double figures[TRAX_ERROR_FIGURE_COUNT], const struct trax_frame *frame,
                               const struct trax_error_run *run, trax_error *error) {
  struct trax_picture picture = {0}, recorded = {0};
  trax_machine *machine = NULL;
  const uint8_t *record;
  uint32_t record_bytes;
  trax_status status = render(&machine, &picture, frame, false, run, error);
  trax_machine_destroy(machine);
  machine = NULL;
  if (status == TRAX_OK)
    status = render(&machine, &recorded, frame, true, run, error);
  if (status == TRAX_OK)
    status = check_recorded(figures, &picture, &recorded, &frame->method, error);
  if (status == TRAX_OK)
    status = trax_machine_read_buffer(machine, "record", &record, &record_bytes, error);
  if (status == TRAX_OK)
    status = take_errors(figures, frame, record, run, error);
  trax_machine_destroy(machine);
  trax_picture_release(&picture);
  trax_picture_release(&recorded);
  return status;
}
