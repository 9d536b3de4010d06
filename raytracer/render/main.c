/* trax-render: from meshes to a picture in one command. */
#include "core/machine.h"
#include "emulated.h"
#include "host/util.h"
#include "options.h"
#include "progress.h"
#include "render.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
  interrupted = 1;
  signal(signal_number, SIG_DFL); /* a second one ends the program at once */
}

static bool has_suffix(const char *text, const char *suffix) {
  size_t length = strlen(text), suffix_length = strlen(suffix);
  return length > suffix_length && strcmp(text + length - suffix_length, suffix) == 0;
}

/* --- the scene --- */

static void show_scene_step(void *context, const char *step, double fraction) {
  progress_show(context, step, fraction, NULL);
}

static trax_status import_scene(struct trax_scene *scene, const struct options *options, struct progress *progress,
                                trax_error *error) {
  struct trax_import_options import = options->import;
  import.progress = show_scene_step;
  import.progress_context = progress;
  import.interrupt = (const volatile int *)&interrupted;
  struct trax_build_options build = {.progress = show_scene_step,
                                     .progress_context = progress,
                                     .interrupt = (const volatile int *)&interrupted,
                                     .smooth = options->frame.smooth,
                                     .compute_normals = options->compute_normals};
  struct trax_mesh mesh = {0};
  struct trax_import_report report;
  trax_status status = trax_mesh_import(&mesh, options->meshes, options->mesh_count, &import, &report, error);
  if (status == TRAX_OK && !options->quiet) {
    progress_clear(progress);
    trax_import_print_notes(&report, "trax-render", stderr);
  }
  if (status == TRAX_OK)
    status = trax_scene_build(scene, &mesh, &build, error);
  trax_mesh_release(&mesh);
  return status;
}

static trax_status load_scene(struct trax_scene *scene, const struct options *options, struct progress *progress,
                              trax_error *error) {
  for (size_t i = 0; i < options->mesh_count; i++)
    if (has_suffix(options->meshes[i], ".trax")) {
      if (options->mesh_count > 1)
        return trax_fail(error, "%s: a scene file stands alone, it cannot be merged with other meshes",
                         options->meshes[i]);
      if (options->import.override_count || options->import.no_textures || options->import.texture_size ||
          options->compute_normals)
        return trax_fail(error,
                         "%s: a scene file is as trax-scene made it: --material, --diffuse, --no-textures, "
                         "--texture-size and --normals smooth are for meshes",
                         options->meshes[0]);
      trax_status status = trax_scene_read(scene, options->meshes[0], error);
      if (status == TRAX_OK && options->frame.smooth && !scene->normals && scene->triangle_count)
        status = trax_fail(error, "%s: --smooth: the scene has no normals; trax-scene --smooth makes them",
                           options->meshes[0]);
      return status;
    }
  return import_scene(scene, options, progress, error);
}

static trax_status load_view(struct trax_view *view, const struct options *options, const struct trax_scene *scene,
                             trax_error *error) {
  if (!options->view) {
    trax_view_frame(view, scene->header->bounds_min, scene->header->bounds_max,
                    (float)options->frame.width / (float)options->frame.height);
    return TRAX_OK;
  }
  char path[TRAX_PATH_SIZE];
  if (access(options->view, F_OK) != 0 && !strchr(options->view, '/') &&
      installed_file(path, "share/trax/views", options->view, ".view"))
    return trax_view_read(view, path, error);
  return trax_view_read(view, options->view, error);
}

/* --- the other engines --- */

struct step {
  struct progress *progress;
  const char *name;
};

static void show_step(void *context, uint64_t done, uint64_t total) {
  const struct step *step = context;
  progress_show(step->progress, step->name, (double)done / (double)total, NULL);
}

static trax_status run_on_host(struct trax_picture *picture, bool reference, unsigned threads,
                               const struct trax_frame *frame, struct progress *progress, bool quiet,
                               trax_error *error) {
  struct step step = {progress, reference ? "reference" : "native twin"};
  struct trax_render_run run = {
      .progress = show_step, .progress_context = &step, .interrupt = (const volatile int *)&interrupted};
  double begun = seconds_now();
  trax_status status = reference ? trax_render_reference(picture, frame, &run, error)
                                 : trax_render_twin(picture, frame, threads, &run, error);
  progress_clear(progress);
  if (status == TRAX_OK && !quiet)
    printf("rays        %llu in %.3f s on this computer\n", (unsigned long long)run.rays, seconds_now() - begun);
  return status;
}

/* *agrees: both comparisons came out well. */
static trax_status compare(const struct trax_picture *picture, const struct trax_frame *frame,
                           struct progress *progress, bool *agrees, trax_error *error) {
  struct trax_picture other = {0};
  struct trax_difference difference;
  trax_status status = run_on_host(&other, true, 0, frame, progress, true, error);
  if (status != TRAX_OK)
    return status;
  trax_picture_compare(&difference, picture, &other, 2);
  trax_picture_release(&other);
  double percent = trax_difference_percent(&difference);
  printf("reference   %.4f %% of the pixels within 2/255, largest difference %u at (%u, %u)\n", percent,
         difference.largest, difference.x, difference.y);
  *agrees = percent >= 99.9;

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
  return TRAX_OK;
}

static trax_status render(const struct options *options, struct progress *progress, bool *agrees, trax_error *error) {
  struct trax_scene scene = {0};
  struct trax_view view;
  struct trax_frame frame = {0};
  struct trax_picture picture = {0};
  int exponent;
  trax_status status = options->output ? trax_output_check(options->output, error) : TRAX_OK;
  if (status == TRAX_OK && options->stats)
    status = trax_output_check(options->stats, error);
  if (status == TRAX_OK && options->cost_picture)
    status = trax_output_check(options->cost_picture, error);
  if (status == TRAX_OK && options->cost_values)
    status = trax_output_check(options->cost_values, error);
  if (status == TRAX_OK)
    status = trax_explain_check(&options->explain, error);
  if (status == TRAX_OK)
    status = load_scene(&scene, options, progress, error);
  if (status == TRAX_OK)
    status = load_view(&view, options, &scene, error);
  if (status == TRAX_OK)
    status = trax_normalise(&scene, &view, &exponent, error);
  if (status == TRAX_OK)
    status = trax_frame_init(&frame, &scene, &view, &options->frame, error);
  if (status == TRAX_OK)
    status = options->engine <= ENGINE_REFERENCE
                 ? emulate(&picture, options, &frame, progress, (const volatile int *)&interrupted, agrees, error)
                 : run_on_host(&picture, options->engine == ENGINE_EMBREE, options->threads, &frame, progress,
                               options->quiet, error);
  if (status == TRAX_OK && options->output)
    status = trax_picture_write(&picture, options->output, error);
  if (status == TRAX_OK && !options->quiet) {
    if (options->output)
      printf("picture     %s\n", options->output);
    if (options->stats)
      printf("statistics  %s\n", options->stats);
    if (options->keep)
      printf("inputs      %s\n", options->keep);
  }
  if (status == TRAX_OK && options->compare) {
    bool same = true;
    status = compare(&picture, &frame, progress, &same, error);
    *agrees = *agrees && same;
  }
  trax_picture_release(&picture);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  return status;
}

int main(int argc, char **argv) {
  struct options options;
  trax_error error = {""};
  enum options_result parsed = options_parse(&options, argc, argv, &error);
  int exit_status = 0;
  if (parsed == OPTIONS_WRONG) {
    fprintf(stderr, "trax-render: error: %s\n", error.message);
    exit_status = 1;
  } else if (parsed == OPTIONS_RUN) {
    struct progress progress;
    bool agrees = true;
    progress_init(&progress, "trax-render", options.quiet);
    signal(SIGINT, on_interrupt);
    signal(SIGTERM, on_interrupt);
    trax_status status = render(&options, &progress, &agrees, &error);
    progress_clear(&progress);
    if (status == TRAX_INTERRUPTED) {
      fprintf(stderr, "trax-render: interrupted\n");
      exit_status = 130;
    } else if (status != TRAX_OK) {
      fprintf(stderr, "trax-render: error: %s\n", error.message);
      exit_status = 1;
    } else if (!agrees) {
      exit_status = 1;
    }
  }
  options_release(&options);
  if (fflush(stdout) != 0 && exit_status == 0) {
    fprintf(stderr, "trax-render: error: standard output: %s\n", strerror(errno));
    exit_status = 1;
  }
  return exit_status;
}
