/* trax-render: from meshes to a picture in one command. */
#include "bench_accuracy.h"
#include "emulated.h"
#include "files.h"
#include "hits.h"
#include "inputs.h"
#include "options.h"
#include "render.h"
#include "trax/output.h"
#include "trax/progress.h"
#include "trax/signals.h"

#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

static volatile sig_atomic_t reader_gone; /* nobody reads standard output any more: pictures are written all the same */

static void on_broken_pipe(int signal_number) {
  (void)signal_number;
  reader_gone = 1;
}

/* --- the other engines --- */

struct step {
  trax_progress_line *progress;
  const char *name;
};

static void show_step(void *context, uint64_t done, uint64_t total) {
  const struct step *step = context;
  trax_progress_line_show(step->progress, step->name, (double)done / (double)total, NULL);
}

static trax_status run_on_host(struct trax_picture *picture, bool reference, unsigned threads,
                               const struct trax_frame *frame, trax_progress_line *progress, bool quiet,
                               trax_error *error) {
  struct step step = {progress, reference ? "reference" : "native twin"};
  struct trax_render_run run = {.progress = show_step, .progress_context = &step, .interrupt = &trax_signal};
  double begun = trax_seconds();
  trax_status status = reference ? trax_render_embree(picture, frame, &run, error)
                                 : trax_render_twin(picture, frame, threads, &run, error);
  trax_progress_line_clear(progress);
  if (status == TRAX_OK && !quiet)
    printf("rays        %llu in %.3f s on this computer\n", (unsigned long long)run.rays, trax_seconds() - begun);
  return status;
}

enum finder { BY_TWIN, BY_EMBREE, WITHOUT_ERROR };

/* What the rays hit. */
static trax_status find_hits(struct trax_hits *hits, enum finder finder, bool holes, unsigned threads,
                             const struct trax_frame *frame, trax_progress_line *progress, trax_error *error) {
  static const char *const names[] = {"hits", "Embree's hits", "exact hits"};
  struct step step = {progress, names[finder]};
  struct trax_render_run run = {
      .progress = show_step, .progress_context = &step, .interrupt = &trax_signal, .holes = holes};
  trax_status status = finder == BY_TWIN     ? trax_hits_native(hits, frame, threads, &run, error)
                       : finder == BY_EMBREE ? trax_hits_embree(hits, frame, &run, error)
                                             : trax_hits_exact(hits, frame, &run, error);
  trax_progress_line_clear(progress);
  return status;
}

static trax_status compare_hits(const struct trax_frame *frame, trax_progress_line *progress, bool *agrees,
                                trax_error *error) {
  struct trax_hits hits[3] = {{0}};
  struct trax_hits_difference difference;
  trax_status status = TRAX_OK;
  for (int finder = BY_TWIN; finder <= WITHOUT_ERROR && status == TRAX_OK; finder++)
    status = find_hits(&hits[finder], finder, false, 0, frame, progress, error);
  if (status == TRAX_OK) {
    trax_hits_judge(&difference, &hits[BY_TWIN], &hits[WITHOUT_ERROR], frame);
    const uint64_t beyond = difference.holes + difference.wrong;
    printf("hits        %llu of %llu pixels hit the nearest triangle, %llu another within the error bound, %llu beyond "
           "it, of which %llu are holes",
           (unsigned long long)difference.same, (unsigned long long)difference.pixels,
           (unsigned long long)difference.tied, (unsigned long long)beyond, (unsigned long long)difference.holes);
    if (beyond)
      printf(": (%u, %u)", difference.x, difference.y);
    printf("\nEmbree      %llu pixels hit the triangle that Embree hits\n",
           (unsigned long long)trax_hits_same(&hits[BY_TWIN], &hits[BY_EMBREE], frame));
    *agrees = *agrees && beyond == 0;
  }
  for (int finder = BY_TWIN; finder <= WITHOUT_ERROR; finder++)
    trax_hits_release(&hits[finder]);
  return status;
}

static trax_status write_hits(const struct options *options, const struct trax_frame *frame,
                              trax_progress_line *progress, trax_error *error) {
  struct trax_hits hits = {0};
  struct trax_picture picture = {0};
  trax_status status = find_hits(&hits, options->engine == ENGINE_EMBREE ? BY_EMBREE : BY_TWIN, true, options->threads,
                                 frame, progress, error);
  if (status == TRAX_OK)
    status = trax_hits_picture(&picture, &hits, frame, error);
  if (status == TRAX_OK)
    status = trax_picture_write(&picture, options->id_picture, error);
  if (status == TRAX_OK && !options->quiet)
    printf("triangles   %s\n", options->id_picture);
  trax_picture_release(&picture);
  trax_hits_release(&hits);
  return status;
}

/* *agrees: all comparisons came out well. */
static trax_status compare(const struct trax_picture *picture, const struct trax_frame *frame,
                           trax_progress_line *progress, bool *agrees, trax_error *error) {
  struct trax_picture other = {0};
  struct trax_difference difference;
  trax_status status = run_on_host(&other, true, 0, frame, progress, true, error);
  if (status != TRAX_OK)
    return status;
  trax_picture_compare(&difference, picture, &other, 2);
  const double light = trax_picture_light(picture), other_light = trax_picture_light(&other);
  trax_picture_release(&other);
  double percent = trax_difference_percent(&difference);
  printf("reference   %.4f %% of the pixels within 2/255, largest difference %u at (%u, %u)\n", percent,
         difference.largest, difference.x, difference.y);
  *agrees = percent >= 99.9;
  if (frame->params->features & TRAX_FEATURE_BIT(PATHS)) { /* of which one in thousands takes another turn */
    const double deviation = other_light > 0 ? 100 * (light / other_light - 1) : 0;
    printf("            light of the whole picture %+.4f %%\n", deviation);
    *agrees = percent >= 99 && deviation > -0.2 && deviation < 0.2;
  }

  if (frame->method.fast_math) {
    printf("twin        not compared: it is strict, the program is not\n");
    return TRAX_OK;
  }
  status = run_on_host(&other, false, 0, frame, progress, true, error);
  if (status != TRAX_OK)
    return status;
  trax_picture_compare(&difference, picture, &other, 0);
  trax_picture_release(&other);
  if (difference.unequal == 0)
    printf("twin        identical in every bit\n");
  else
    printf("twin        %llu pixels differ, by %u at (%u, %u) and less elsewhere\n",
           (unsigned long long)difference.unequal, difference.largest, difference.x, difference.y);
  *agrees = *agrees && difference.unequal == 0;
  /* The error bounds are the watertight test's. */
  return frame->method.triangle == TRAX_TRIANGLE_WATERTIGHT ? compare_hits(frame, progress, agrees, error) : TRAX_OK;
}

static void print_outputs(const struct options *options, const char *picture) {
  if (picture)
    printf("picture     %s\n", picture);
  if (options->stats)
    printf("statistics  %s\n", options->stats);
  if (options->keep)
    printf("inputs      %s\n", options->keep);
}

/* One picture. *scaled: the power of two by which the scene was scaled so far. */
static trax_status render_view(const struct options *options, struct inputs *inputs, struct trax_view *view,
                               const char *output, int *scaled, trax_progress_line *progress, bool *agrees,
                               trax_error *error) {
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  int exponent;
  trax_scale_view(view, *scaled);
  trax_status status = trax_normalise(&inputs->scene, view, &exponent, error);
  if (status == TRAX_OK && options->bench_accuracy)
    return bench_accuracy(options, &inputs->scene, view, progress, &trax_signal, error);
  if (status == TRAX_OK) {
    *scaled += exponent;
    status = trax_frame_init(&frame, &inputs->scene, view, &options->frame, error);
  }
  if (status == TRAX_OK)
    status = options->engine <= ENGINE_REFERENCE
                 ? emulate(&picture, options, &frame, view, progress, &trax_signal, agrees, error)
                 : run_on_host(&picture, options->engine == ENGINE_EMBREE, options->threads, &frame, progress,
                               options->quiet, error);
  if (status == TRAX_OK && output)
    status = trax_picture_write(&picture, output, error);
  if (status == TRAX_OK && !options->quiet)
    print_outputs(options, output);
  if (status == TRAX_OK && options->id_picture)
    status = write_hits(options, &frame, progress, error);
  if (status == TRAX_OK && options->compare) {
    bool same = true;
    status = compare(&picture, &frame, progress, &same, error);
    *agrees = *agrees && same;
  }
  trax_picture_release(&picture);
  trax_frame_release(&frame);
  return status;
}

static trax_status render(const struct options *options, trax_progress_line *progress, bool *agrees,
                          trax_error *error) {
  struct inputs inputs = {0};
  struct trax_view view;
  int scaled = 0;
  trax_status status = inputs_load(&inputs, options, progress, &trax_signal, error);
  if (status == TRAX_OK && options->write_view) {
    inputs_view(&view, &inputs, options, 0);
    status = trax_view_write(&view, options->write_view, error);
  }
  for (unsigned i = 0; i < options->frames && status == TRAX_OK; i++) {
    char *output = options->frames > 1 ? numbered(options->output, i + 1) : NULL;
    if (options->frames > 1 && !output)
      status = trax_fail(error, "out of memory");
    inputs_view(&view, &inputs, options, i);
    if (status == TRAX_OK)
      status =
          render_view(options, &inputs, &view, output ? output : options->output, &scaled, progress, agrees, error);
    free(output);
  }
  inputs_release(&inputs);
  return status;
}

int main(int argc, char **argv) {
  struct options options;
  trax_error error = {""};
  trax_parsed parsed = options_parse(&options, argc, argv, &error);
  int exit_status = 0;
  if (parsed == TRAX_PARSED_WRONG) {
    fprintf(stderr, "trax-render: error: %s\n", error.message);
    exit_status = 1;
  } else if (parsed == TRAX_PARSED_RUN) {
    trax_progress_line progress;
    bool agrees = true;
    trax_progress_line_begin(&progress, "trax-render", options.quiet);
    trax_catch_signals();
    signal(SIGPIPE, on_broken_pipe);
    signal(SIGXFSZ, SIG_IGN); /* a file beyond the limit is one that cannot be written */
    trax_files files = {0};
    options.import.files = &files;
    trax_status status = check_files(&files, &options, &error);
    if (status == TRAX_OK)
      status = render(&options, &progress, &agrees, &error);
    trax_files_release(&files);
    trax_progress_line_clear(&progress);
    if (status != TRAX_OK && trax_signal) {
      options_release(&options);
      fprintf(stderr, "trax-render: interrupted\n");
      trax_end_by_signal();
    } else if (status != TRAX_OK) {
      fprintf(stderr, "trax-render: error: %s\n", error.message);
      exit_status = 1;
    } else if (!agrees) {
      exit_status = 1;
    }
  }
  options_release(&options);
  const bool unwritten = trax_output_flush(&error) != TRAX_OK;
  if (exit_status == 0 && reader_gone) {
    exit_status = 128 + SIGPIPE;
  } else if (exit_status == 0 && unwritten) {
    fprintf(stderr, "trax-render: error: %s\n", error.message);
    exit_status = 1;
  }
  return exit_status;
}
