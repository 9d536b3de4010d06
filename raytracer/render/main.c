/* trax-render: from meshes to a picture in one command. */
#include "core/machine.h"
#include "host/util.h"
#include "options.h"
#include "progress.h"
#include "render.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
  interrupted = 1;
  signal(signal_number, SIG_DFL); /* a second one ends the program at once */
}

/* What the installation has, next to this program: ../lib/trax/NAME or ../share/trax/NAME. */
static bool installed_file(char path[PATH_MAX], const char *folder, const char *name, const char *suffix) {
  char self[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
  if (length <= 0)
    return false;
  self[length] = '\0';
  *strrchr(self, '/') = '\0';
  int written = snprintf(path, PATH_MAX, "%s/../%s/%s%s", self, folder, name, suffix);
  return written > 0 && written < PATH_MAX && access(path, R_OK) == 0;
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
  struct trax_import_options import = {
      .progress = show_scene_step, .progress_context = progress, .interrupt = (const volatile int *)&interrupted};
  struct trax_build_options build = {
      .progress = show_scene_step, .progress_context = progress, .interrupt = (const volatile int *)&interrupted};
  struct trax_mesh mesh = {0};
  trax_status status = trax_mesh_import(&mesh, options->meshes, options->mesh_count, &import, NULL, error);
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
      return trax_scene_read(scene, options->meshes[0], error);
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
  char path[PATH_MAX];
  if (access(options->view, F_OK) != 0 && !strchr(options->view, '/') &&
      installed_file(path, "share/trax/views", options->view, ".view"))
    return trax_view_read(view, path, error);
  return trax_view_read(view, options->view, error);
}

/* --- the machine --- */

static trax_status make_config(trax_config *config, const struct options *options, const struct trax_frame *frame,
                               trax_error *error) {
  trax_status status = trax_config_load(config, options->config ? options->config : "4x32", error);
  if (status != TRAX_OK)
    return status;
  /* The machine's memory grows with what is rendered, unless it is set. */
  uint64_t bytes = frame->scene->size + frame->params_size + 4ull * frame->params->width * frame->params->height;
  uint64_t mib = (bytes >> 20) + 2;
  if (mib > 1024) {
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)mib);
    status = trax_config_set(config, "memory.size_mib", text, error);
  }
  for (size_t i = 0; i < options->setting_count && status == TRAX_OK; i++)
    status = trax_config_set(config, options->settings[i].key, options->settings[i].value, error);
  return status == TRAX_OK ? trax_config_check(config, error) : status;
}

static trax_status find_program(char path[PATH_MAX], const struct options *options, trax_error *error) {
  if (options->program) {
    if (snprintf(path, PATH_MAX, "%s", options->program) >= PATH_MAX)
      return trax_fail(error, "the path of the program is too long");
    return TRAX_OK;
  }
  if (!installed_file(path, "lib/trax", "trax-raytracer", ".elf"))
    return trax_fail(error, "%s is missing; --program names another one", path);
  return TRAX_OK;
}

static void show_run(void *context, const trax_progress *status) {
  char detail[96];
  double seconds = status->host_seconds > 0 ? status->host_seconds : 1;
  snprintf(detail, sizeof detail, "%.1f M cycles, %.1f M instructions/s", 1e-6 * (double)status->cycle,
           1e-6 * (double)status->instructions / seconds);
  double fraction = status->total_items ? (double)status->items / (double)status->total_items : -1;
  progress_show(context, "rendering", fraction, detail);
}

static trax_status write_bytes(const char *directory, const char *name, const void *bytes, size_t size,
                               trax_error *error) {
  char path[PATH_MAX];
  if (snprintf(path, sizeof path, "%s/%s", directory, name) >= (int)sizeof path)
    return trax_fail(error, "%s: the path is too long", directory);
  trax_output output;
  trax_status status = trax_output_open(&output, path, error);
  if (status != TRAX_OK)
    return status;
  if (fwrite(bytes, 1, size, output.file) != size) {
    trax_output_discard(&output);
    return trax_fail(error, "%s: %s", path, strerror(errno));
  }
  return trax_output_commit(&output, error);
}

/* A word for the shell, in quotes. */
static void quote(FILE *out, const char *word) {
  fputc('\'', out);
  for (; *word; word++)
    if (*word == '\'')
      fputs("'\\''", out);
    else
      fputc(*word, out);
  fputc('\'', out);
}

/* The files that the program reads, and the command that runs it on them. */
static trax_status keep_inputs(const struct options *options, const struct trax_frame *frame, const char *program,
                               trax_error *error) {
  if (mkdir(options->keep, 0777) != 0 && errno != EEXIST)
    return trax_fail(error, "%s: %s", options->keep, strerror(errno));
  char *text = NULL;
  size_t size = 0;
  FILE *command = open_memstream(&text, &size);
  if (!command)
    return trax_fail(error, "out of memory");
  fputs("#!/bin/sh\n# Renders into image.raw: R, G, B, A bytes, row by row.\ncd \"$(dirname \"$0\")\" || exit 1\n"
        "exec \"${TRAX_SIM:-trax-sim}\" --config ",
        command);
  quote(command, options->config ? options->config : "4x32");
  for (size_t i = 0; i < options->setting_count; i++) {
    fprintf(command, " --set %s=", options->settings[i].key);
    quote(command, options->settings[i].value);
  }
  fprintf(command,
          " --bind scene=scene.trax --bind params=params.bin --alloc image=%u --dump image=image.raw "
          "--progress-total %u \"$@\" ",
          4 * frame->params->width * frame->params->height, frame->params->width * frame->params->height);
  char resolved[PATH_MAX];
  quote(command, realpath(program, resolved) ? resolved : program);
  fputc('\n', command);
  fclose(command);
  trax_status status = write_bytes(options->keep, "scene.trax", frame->scene->bytes, frame->scene->size, error);
  if (status == TRAX_OK)
    status = write_bytes(options->keep, "params.bin", frame->params, frame->params_size, error);
  if (status == TRAX_OK)
    status = write_bytes(options->keep, "run.sh", text, size, error);
  free(text);
  return status;
}

static double statistic(const trax_machine *machine, const char *name) {
  double value = 0;
  trax_stats_get(machine, name, &value);
  return value;
}

static void print_machine(const trax_machine *machine) {
  printf("cycles      %.0f (%.3f ms)\n", statistic(machine, "cycles"), 1e3 * statistic(machine, "seconds"));
  printf("rays        %.0f, %.2f million per second\n", statistic(machine, "rays"), statistic(machine, "mrps"));
}

static trax_status write_costs(const struct trax_costs *costs, const struct options *options, trax_error *error) {
  struct trax_cost_summary summary;
  trax_status status = trax_costs_summarise(costs, &summary, error);
  if (status == TRAX_OK && options->cost_picture)
    status = trax_costs_write_picture(costs, &summary, options->cost_picture, error);
  if (status == TRAX_OK && options->cost_values)
    status = trax_costs_write(costs, options->cost_values, error);
  if (status == TRAX_OK && !options->quiet)
    trax_costs_print(costs, &summary, stdout);
  return status;
}

static trax_status run_emulator(struct trax_picture *picture, const struct options *options,
                                const struct trax_frame *frame, struct progress *progress, trax_error *error) {
  char program[PATH_MAX];
  trax_status status = find_program(program, options, error);
  trax_config *config = status == TRAX_OK ? trax_config_create() : NULL;
  if (status == TRAX_OK)
    status = config ? make_config(config, options, frame, error) : trax_fail(error, "out of memory");
  if (status == TRAX_OK && options->keep)
    status = keep_inputs(options, frame, program, error);
  trax_machine *machine = status == TRAX_OK ? trax_machine_create(config, error) : NULL;
  if (status == TRAX_OK && !machine)
    status = TRAX_ERROR;
  if (status == TRAX_OK) {
    struct trax_costs costs = {0};
    struct trax_simulated_options run = {
        .program = program,
        .explain = &options->explain,
        .run = {.output = stderr,
                .total_items = (uint64_t)frame->params->width * frame->params->height,
                .progress = show_run,
                .progress_context = progress,
                .interrupt = (const volatile int *)&interrupted,
                .engine = options->engine == ENGINE_REFERENCE ? TRAX_ENGINE_REFERENCE : TRAX_ENGINE_FAST,
                .host_threads = options->threads}};
    if (options->cost_picture || options->cost_values) {
      run.costs = &costs;
      status = trax_costs_init(&costs, frame->params->width, frame->params->height,
                               options->cost ? options->cost : "cycles", error);
    }
    if (status == TRAX_OK)
      status = trax_render_simulated(picture, frame, machine, &run, error);
    progress_clear(progress);
    if (status == TRAX_FAULT)
      trax_machine_print_fault(machine, stderr);
    if (status == TRAX_OK && !options->quiet)
      print_machine(machine);
    if (status == TRAX_OK && options->stats)
      status = trax_stats_write_json(machine, options->stats, error);
    if (status == TRAX_OK && run.costs)
      status = write_costs(&costs, options, error);
    trax_costs_release(&costs);
  }
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return status;
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
  trax_status status = trax_output_check(options->output, error);
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
                 ? run_emulator(&picture, options, &frame, progress, error)
                 : run_on_host(&picture, options->engine == ENGINE_EMBREE, options->threads, &frame, progress,
                               options->quiet, error);
  if (status == TRAX_OK)
    status = trax_picture_write(&picture, options->output, error);
  if (status == TRAX_OK && !options->quiet) {
    printf("picture     %s\n", options->output);
    if (options->stats)
      printf("statistics  %s\n", options->stats);
    if (options->keep)
      printf("inputs      %s\n", options->keep);
  }
  if (status == TRAX_OK && options->compare)
    status = compare(&picture, &frame, progress, agrees, error);
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
