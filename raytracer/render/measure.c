#include "measure.h"

#include "emulated.h"
#include "picture_error.h"
#include "steps.h"
#include "trax/output.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STACK_BYTES (64u << 10) /* of a thread of the program that records */

static void show_run(void *context, const trax_progress *status) {
  show_step(context, status->items, status->total_items ? status->total_items : 1);
}

/* As many samples as there are in the picture, or in one that has converged. */
static trax_status frame_of(struct trax_frame *frame, const struct options *options, const struct trax_scene *scene,
                            const struct trax_view *view, uint32_t samples, trax_error *error) {
  struct trax_frame_options changed = options->frame;
  changed.samples = samples;
  return trax_frame_init(frame, scene, view, &changed, error);
}

/* What is known to be right is the picture that trax_render_exact renders. */
static trax_status check_workload(const struct trax_frame *frame, trax_error *error) {
  const uint32_t others = frame->params->features & TRAX_PATH_FEATURES;
  unsigned feature = 0;
  while (feature < TRAX_FEATURE_COUNT && !(others >> feature & 1))
    feature++;
  return others ? trax_fail(error,
                            "--error measures the paper's workload, one point light and Lambert surfaces; this picture "
                            "needs %s",
                            trax_feature_name(feature))
                : TRAX_OK;
}

/* The chip, with memory for what is recorded and for the stacks of the threads that record. */
static trax_status measure(double figures[TRAX_ERROR_FIGURE_COUNT], const struct options *options,
                           const struct trax_frame *frame, const struct trax_exact *exact,
                           const struct trax_exact *converged, struct step *step, const volatile int *interrupt,
                           trax_error *error) {
  const struct trax_render_params *params = frame->params;
  const uint64_t recorded = (uint64_t)params->width * params->height *
                            (sizeof(struct trax_pixel_record) + params->samples * sizeof(struct trax_sample_record));
  char root[TRAX_PATH_SIZE];
  if (!installation(root))
    return trax_fail(error, "the place of trax-render itself is not known: %s", strerror(errno));
  trax_config *config = trax_config_create();
  trax_status status = config ? emulated_config(config, options, frame, recorded + 4096ull * STACK_BYTES, error)
                              : trax_fail(error, "out of memory");
  if (status == TRAX_OK) {
    step->name = "measuring";
    const struct trax_error_run run = {
        .specialise = {.root = root,
                       .source = options->source,
                       .cache = options->cache,
                       .icache_bytes = (uint32_t)trax_config_get(config, "icache.bytes"),
                       .queues = options->queues ? options->queues : (unsigned)trax_config_get(config, "chip.tms"),
                       .interrupt = interrupt},
        .config = config,
        .exact = exact,
        .converged = converged,
        .host_threads = options->threads,
        .progress = show_run,
        .progress_context = step};
    status = trax_error_measure(figures, frame, &run, error);
  }
  trax_config_destroy(config);
  return status;
}

trax_status write_figures(const char *path, const struct figure *figures, size_t count, trax_error *error) {
  json_t *object = json_object();
  for (size_t i = 0; i < count; i++)
    json_object_set_new(object, figures[i].key,
                        figures[i].value == floor(figures[i].value) && fabs(figures[i].value) < 0x1p53
                            ? json_integer((json_int_t)figures[i].value)
                            : json_real(figures[i].value));
  trax_output output;
  char *text = json_dumps(object, JSON_INDENT(2));
  json_decref(object);
  trax_status status = text ? trax_output_open(&output, path, error) : trax_fail(error, "out of memory");
  if (status == TRAX_OK) {
    fputs(text, output.file);
    fputc('\n', output.file);
    status = trax_output_commit(&output, error); /* which notices what could not be written */
  }
  free(text);
  return status;
}

trax_status measure_error(const struct options *options, const struct trax_scene *scene, const struct trax_view *view,
                          trax_progress_line *progress, const volatile int *interrupt, trax_error *error) {
  static const char *const keys[TRAX_ERROR_FIGURE_COUNT] = {
#define FIGURE(NAME, key, meaning) key,
      TRAX_ERROR_FIGURES(FIGURE)
#undef FIGURE
  };
  double figures[TRAX_ERROR_FIGURE_COUNT] = {0};
  struct trax_frame frames[3] = {{0}}; /* the picture's, converged, rough */
  const uint32_t samples[3] = {options->frame.samples, TRAX_CONVERGED_SAMPLES, TRAX_ROUGH_SAMPLES};
  struct trax_exact exact = {0};
  struct trax_converged converged = {.rough_rmse = 0};
  struct step step = {.line = progress, .name = "the converged picture"};
  struct trax_render_run run = {.progress = show_step, .progress_context = &step, .interrupt = interrupt};
  trax_status status = TRAX_OK;
  for (int i = 0; i < 3 && status == TRAX_OK; i++)
    status = frame_of(&frames[i], options, scene, view, samples[i], error);
  if (status == TRAX_OK)
    status = check_workload(&frames[0], error);
  if (status == TRAX_OK)
    status = trax_converge(&converged, &frames[1], &frames[2], options->converged, &run, error);
  step.name = "the exact picture";
  if (status == TRAX_OK)
    status = trax_render_exact(&exact, &frames[0], true, &run, error);
  if (status == TRAX_OK)
    status = measure(figures, options, &frames[0], &exact, &converged.picture, &step, interrupt, error);
  trax_progress_line_clear(progress);
  if (status == TRAX_OK) {
    struct figure named[TRAX_ERROR_FIGURE_COUNT + 2];
    for (int i = 0; i < TRAX_ERROR_FIGURE_COUNT; i++)
      named[i] = (struct figure){keys[i], figures[i]};
    named[TRAX_ERROR_FIGURE_COUNT] = (struct figure){"converged_samples", TRAX_CONVERGED_SAMPLES};
    named[TRAX_ERROR_FIGURE_COUNT + 1] = (struct figure){"rough_rmse", converged.rough_rmse};
    status = write_figures(options->error, named, sizeof named / sizeof *named, error);
  }
  for (int i = 0; i < 3; i++)
    trax_frame_release(&frames[i]);
  trax_exact_release(&exact);
  trax_exact_release(&converged.picture);
  return status;
}
