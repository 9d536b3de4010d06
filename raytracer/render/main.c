/* trax-render: from meshes to a picture in one command. */
#include "compare.h"
#include "emulated.h"
#include "files.h"
#include "inputs.h"
#include "layers.h"
#include "options.h"
#include "rays_run.h"
#include "render.h"
#include "trax/compare.h"
#include "trax/message.h"
#include "trax/output.h"
#include "trax/progress.h"
#include "trax/reads.h"
#include "trax/signals.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t reader_gone; /* standard output was closed; pictures are still written */

static void on_broken_pipe(int signal_number) {
  (void)signal_number;
  reader_gone = 1;
}

static void print_outputs(const struct options *options, const struct inputs *inputs) {
  if (*inputs->choice)
    printf("view        %s\n", inputs->choice);
  if (options->output)
    printf("picture     %s\n", options->output);
  if (options->stats)
    printf("statistics  %s\n", options->stats);
  if (options->hits)
    printf("hits        %s\n", options->hits);
  if (options->ray_trace)
    printf("rays        %s\n", options->ray_trace);
  if (options->keep)
    printf("inputs      %s\n", options->keep);
}

/* Layers need the program's floats only if path.h renders the picture: in the paper's workload they are recorded. */
static trax_status init_frame(struct trax_frame *frame, const struct options *options, const struct inputs *inputs,
                              const struct trax_view *view, trax_error *error) {
  const struct trax_scene *scene = &inputs->scene;
  struct trax_frame_options chosen = options->frame;
  chosen.environment = options->environment ? &inputs->environment : NULL;
  trax_status status = trax_frame_init(frame, scene, view, &chosen, error);
  if (status != TRAX_OK || !options->layers || !(frame->params->features & TRAX_PATH_FEATURES))
    return status;
  chosen.floats = true;
  trax_frame_release(frame);
  return trax_frame_init(frame, scene, view, &chosen, error);
}

static trax_status render_view(const struct options *options, struct inputs *inputs, struct trax_view *view,
                               trax_progress_line *progress, bool *agrees, trax_error *error) {
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  int scaled;
  trax_status status = trax_normalise(&inputs->scene, view, &scaled, error);
  if (status == TRAX_OK)
    status = init_frame(&frame, options, inputs, view, error);
  const struct job job = {.options = options, .frame = &frame, .progress = progress};
  if (status == TRAX_OK && options->hits)
    status = measure_hits(&job, error);
  if (status == TRAX_OK && options_rendered(options))
    status = options->engine <= ENGINE_REFERENCE ? emulate(&picture, &job, error)
                                                 : run_on_host(&picture, &job, options->engine, error);
  if (status == TRAX_OK && picture.layers)
    trax_layers_finish(&picture, &frame, scaled);
  if (status == TRAX_OK && options->ray_trace)
    status = trace_rays(&job, scaled, picture.pixels ? &picture : NULL, error);
  if (status == TRAX_OK && options->output)
    status = trax_picture_write(&picture, options->output, error);
  if (status == TRAX_OK && !options->quiet)
    print_outputs(options, inputs);
  if (status == TRAX_OK && options->compare)
    status = compare(&picture, &job, agrees, error);
  trax_picture_release(&picture);
  trax_frame_release(&frame);
  return status;
}

static trax_status render(const struct options *options, trax_progress_line *progress, bool *agrees,
                          trax_error *error) {
  struct inputs inputs = {0};
  struct trax_view view;
  trax_status status = inputs_load(&inputs, options, progress, error);
  if (options->rays) {
    if (status == TRAX_OK)
      status = run_rays(options, &inputs.scene, progress, agrees, error);
    inputs_release(&inputs);
    return status;
  }
  if (status == TRAX_OK)
    inputs_view(&view, &inputs, options);
  if (status == TRAX_OK && options->write_view)
    status = trax_view_write(&view, options->write_view, error);
  if (status == TRAX_OK)
    status = render_view(options, &inputs, &view, progress, agrees, error);
  inputs_release(&inputs);
  return status;
}

/* Becomes trax-eval frames with the command line, which makes a sequence by sweeps. */
static trax_status become_sequence(int argc, char *const *words, trax_error *error) {
  char *arguments[argc + 2];
  arguments[0] = "trax-eval", arguments[1] = "frames";
  memcpy(arguments + 2, words + 1, (size_t)argc * sizeof *arguments); /* with the NULL behind the last */
  return trax_become_eval(arguments, error);
}

int main(int argc, char **argv) {
  char *words[argc + 1]; /* parsing changes argv */
  memcpy(words, argv, sizeof words);
  struct options options;
  trax_error error = {""};
  trax_reads_begin();
  trax_parsed parsed = options_parse(&options, argc, argv, &error);
  if (parsed == TRAX_PARSED_RUN && options.sequence && become_sequence(argc, words, &error) != TRAX_OK)
    parsed = TRAX_PARSED_WRONG;
  int exit_status = 0;
  if (parsed == TRAX_PARSED_WRONG) {
    trax_message("trax-render", TRAX_MESSAGE_ERROR, "%s", error.message);
    exit_status = 1;
  } else if (parsed == TRAX_PARSED_RUN) {
    trax_progress_line progress;
    bool agrees = true;
    trax_progress_line_begin(&progress, "trax-render", options.quiet);
    trax_catch_signals();
    signal(SIGPIPE, on_broken_pipe);
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
      trax_message("trax-render", TRAX_MESSAGE_ERROR, "%s", error.message);
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
    trax_message("trax-render", TRAX_MESSAGE_ERROR, "%s", error.message);
    exit_status = 1;
  }
  return exit_status;
}
