#include "emulated.h"

#include "installation.h"
#include "layers.h"
#include "prepare.h"
#include "rays.h"
#include "sampled.h"
#include "steps.h"
#include "trax/message.h"
#include "trax/run_progress.h"
#include "trax/signals.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_FRACTION 0.05 /* of the work, with --sampled */

static trax_status general_program(struct trax_program *program, const struct options *options,
                                   const struct trax_frame *frame, trax_error *error) {
  const bool deep = frame->scene->header->max_depth > TRAX_SCENE_DEFAULT_DEPTH;
  program->specialised = false;
  if (options->program) {
    if (snprintf(program->path, sizeof program->path, "%s", options->program) >= (int)sizeof program->path)
      return trax_fail(error, "the path of the program is too long");
    return TRAX_OK;
  }
  const struct trax_node_format *format = &trax_node_formats[frame->params->node_layout];
  if (!format->general)
    return trax_fail(error, "%s nodes: the general program knows binary and quantised ones only", format->name);
  const char *name = frame->params->features & TRAX_FEATURE_BIT(EXACT) ? "trax-raytracer-exact"
                     : deep                                            ? "trax-raytracer-deep"
                                                                       : "trax-raytracer";
  if (!installed_file(program->path, "lib/trax", name, ".elf"))
    return trax_fail(error, "%s is missing; --program names another one", program->path);
  return TRAX_OK;
}

/* The properties of the chip that a program is compiled for. */
struct chosen {
  unsigned queues;
  uint32_t icache_bytes;
};

/* The specialised program, or, with a note, the general one. */
static trax_status find_program(struct trax_program *program, const struct job *job, const struct chosen *chosen,
                                trax_error *error) {
  const struct options *options = job->options;
  if (options->program || options->no_specialise)
    return general_program(program, options, job->frame, error);
  char root[TRAX_PATH_SIZE], note[256] = "";
  struct trax_specialise_options specialise = {.root = root,
                                               .source = options->source,
                                               .cache = options->cache,
                                               .icache_bytes = chosen->icache_bytes,
                                               .queues = chosen->queues,
                                               .interrupt = &trax_signal,
                                               .record = options->layers};
  if (!installation(root))
    return trax_fail(error, "the place of trax-render itself is not known: %s", strerror(errno));
  program->specialised = false;
  trax_status status = trax_program_specialise(program, job->frame, &specialise, note, error);
  if (status == TRAX_OK && program->specialised && *note && !options->quiet)
    trax_message("trax-render", TRAX_MESSAGE_NOTE, "%s", note);
  if (status != TRAX_OK || program->specialised)
    return status;
  if (!options->quiet)
    trax_message("trax-render", TRAX_MESSAGE_NOTE, "the general program renders, there is no specialised one: %s",
                 note);
  return general_program(program, options, job->frame, error);
}

/* --- the machine --- */

/* A program that records has its stacks in global memory. */
#define RECORDING_STACK (64ull << 10)
#define MOST_THREADS 4096

static trax_status emulated_config(trax_config *config, const struct options *options, const struct trax_frame *frame,
                                   trax_error *error) {
  trax_status status = trax_config_load(config, options->config ? options->config : "4x32", error);
  if (status != TRAX_OK)
    return status;
  /* The machine's memory grows with the scene and the picture, unless its size is set. */
  uint64_t bytes = 0;
  if (frame)
    bytes += frame->scene->size + frame->params_size + trax_frame_image_bytes(frame);
  if (frame && frame->rays)
    bytes += (sizeof(struct trax_input_ray) + sizeof(struct trax_ray_hit)) * (uint64_t)frame->rays->count;
  if (frame && options->layers)
    bytes += trax_record_bytes(frame->params) + MOST_THREADS * RECORDING_STACK;
  uint64_t mib = (bytes >> 20) + 3; /* the rest is for the program and the buffers' guards */
  if (mib > 1024) {
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)mib);
    status = trax_config_set(config, "memory.size_mib", text, error);
  }
  for (size_t i = 0; i < options->setting_count && status == TRAX_OK; i++)
    status = trax_config_set(config, options->settings[i].key, options->settings[i].value, error);
  return status == TRAX_OK ? trax_config_check(config, error) : status;
}

static trax_status choose(struct chosen *chosen, const struct options *options, const struct trax_frame *frame,
                          trax_error *error) {
  trax_config *config = trax_config_create();
  const trax_status status =
      config ? emulated_config(config, options, frame, error) : trax_fail(error, "out of memory");
  if (status == TRAX_OK)
    *chosen = (struct chosen){options->queues ? options->queues : (unsigned)trax_config_get(config, "chip.tms"),
                              (uint32_t)trax_config_get(config, "icache.bytes")};
  trax_config_destroy(config);
  return status;
}

trax_status emulated_cache_lines(unsigned *lines, const struct options *options, trax_error *error) {
  enum { LINE_BYTES = 64, MOST_LINES = 4096 };
  trax_config *config = trax_config_create();
  const trax_status status = config ? emulated_config(config, options, NULL, error) : trax_fail(error, "out of memory");
  if (status == TRAX_OK) {
    const uint32_t count = (uint32_t)trax_config_get(config, "dcache.bytes") / LINE_BYTES;
    *lines = count < 1 ? 1 : count < MOST_LINES ? count : MOST_LINES;
  }
  trax_config_destroy(config);
  return status;
}

static double statistic(const trax_machine *machine, const char *name) {
  double value = 0;
  trax_stats_get(machine, name, &value);
  return value;
}

/* doubt: why the prediction of a sampled run is uncertain; may be NULL. */
static void print_machine(const trax_machine *machine, const char *doubt) {
  printf("cycles      %.0f (%.3f ms)\n", statistic(machine, "cycles"), 1e3 * statistic(machine, "seconds"));
  double low;
  if (trax_stats_get(machine, "sampled.cycles_low", &low)) {
    printf("sampled     %.0f to %.0f cycles with 95 %% confidence, %.1f %% of the slots in %.0f ranges simulated\n",
           low, statistic(machine, "sampled.cycles_high"),
           100.0 * statistic(machine, "sampled.detailed_slots") / statistic(machine, "sampled.slots"),
           statistic(machine, "sampled.windows"));
    printf("predicted   %.0f cycles, before any was simulated", statistic(machine, "sampled.predicted_cycles"));
    if (doubt)
      printf("; uncertain: the model is not fitted to %s", doubt);
    putchar('\n');
  }
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

/* Renders the picture by the twin, whose accesses predict which parts are worth simulating. */
static trax_status begin_sampling(struct trax_picture_sampling *sampling, struct trax_picture *picture,
                                  const struct job *job, const struct trax_program *program, trax_machine *machine,
                                  trax_error *error) {
  struct step step = {.line = job->progress, .name = "predicting"};
  struct trax_render_run twin = {.progress = show_step, .progress_context = &step, .interrupt = &trax_signal};
  sampling->slots = job->options->sampling;
  if (!(sampling->slots.fraction > 0) && !(sampling->slots.error > 0))
    sampling->slots.fraction = DEFAULT_FRACTION;
  const trax_status status = trax_picture_sampling_init(sampling, picture, job->frame, program, machine, &twin, error);
  if (job->options->source) { /* the twin is of the installed source: of this one it predicts, and counts nothing */
    sampling->slots.rays = 0;
    sampling->slots.kinds = NULL;
  }
  return status;
}

/* The picture in a line. */
static const char *describe(char *text, size_t size, const struct job *job) {
  const struct options *options = job->options;
  const char *slash = strrchr(options->meshes[0], '/');
  char more[32] = "", view[128] = "";
  if (options->mesh_count > 1)
    snprintf(more, sizeof more, " and %zu more", options->mesh_count - 1);
  if (options->view)
    snprintf(view, sizeof view, ", view %.100s", options->view);
  snprintf(text, size, "%.200s%s%s, %ux%u", slash ? slash + 1 : options->meshes[0], more, view,
           job->frame->params->width, job->frame->params->height);
  return text;
}

static void print_note(const char *text) {
  trax_message("trax-render", TRAX_MESSAGE_NOTE, "%s", text);
}

/* The cycles of a recording program mean nothing and are not printed. */
static const char *engine_of(const struct options *options) {
  return options->layers ? "functional" : options->engine == ENGINE_REFERENCE ? "reference" : NULL; /* the machine's */
}

/* Runs the loaded program. *doubt: why a prediction is uncertain; NULL: it is not. */
static trax_status run_loaded(struct trax_picture *picture, const struct job *job, const struct trax_program *program,
                              trax_machine *machine, struct trax_costs *costs, const char **doubt, trax_error *error) {
  const struct options *options = job->options;
  struct trax_run_progress shown = {.line = job->progress, .task = "rendering"};
  char title[512];
  struct trax_explain_options explain = options->explain;
  uint32_t places[MOST_PIXELS];
  explain.note = options->quiet ? NULL : print_note;
  explain.story_places = places;
  explain.story_count = options->pixels.count;
  for (unsigned i = 0; i < options->pixels.count; i++)
    places[i] = options->pixels.at[i][1] * options->frame.width + options->pixels.at[i][0];
  struct trax_simulated_options run = {
      .explain = &explain,
      .costs = costs,
      .title = describe(title, sizeof title, job),
      .layers = options->layers,
      .is_twin = !options->program && !options->source,
      .run = {.output = stderr,
              .total_items = (uint64_t)job->frame->params->width * job->frame->params->height,
              .progress = trax_run_progress_show,
              .progress_context = &shown,
              .interrupt = &trax_signal,
              .engine = engine_of(options),
              .host_threads = options->threads,
              .ray_cycles = options->ray_cycles != NULL}};
  struct trax_picture_sampling sampling = {0};
  trax_status status = TRAX_OK;
  if (options->sampled) {
    status = begin_sampling(&sampling, picture, job, program, machine, error);
    run.run.slots = &sampling.slots;
    run.run.total_items = 0; /* most are left out */
  }
  if (status == TRAX_OK)
    status = trax_simulated_run(picture, job->frame, machine, &run, error);
  *doubt = options->program ? "another program" : sampling.doubt;
  trax_picture_sampling_release(&sampling);
  trax_progress_line_clear(job->progress);
  if (status == TRAX_FAULT)
    trax_machine_print_fault(machine, stderr);
  return status;
}

/* Runs the loaded program, and prints and writes what the options ask of the run. */
static trax_status render_loaded(struct trax_picture *picture, const struct job *job,
                                 const struct trax_program *program, trax_machine *machine, trax_error *error) {
  const struct options *options = job->options;
  const bool writes_costs = options->cost_picture || options->cost_values;
  const char *doubt = NULL;
  struct trax_costs costs = {0};
  trax_status status = TRAX_OK;
  if (writes_costs)
    status = trax_costs_init(&costs, job->frame->params->width, job->frame->params->height,
                             options->cost ? options->cost : "cycles", error);
  if (status == TRAX_OK)
    status = run_loaded(picture, job, program, machine, writes_costs ? &costs : NULL, &doubt, error);
  if (status == TRAX_OK && job->rays)
    status = trax_rays_take(job->rays, machine, error);
  if (status == TRAX_OK && !options->quiet && !options->layers)
    print_machine(machine, doubt);
  if (status == TRAX_OK && options->stats)
    status = trax_stats_write_json(machine, options->stats, error);
  if (status == TRAX_OK && options->ray_cycles)
    status = trax_ray_cycles_write(machine, options->ray_cycles, error);
  if (status == TRAX_OK && writes_costs)
    status = write_costs(&costs, options, error);
  trax_costs_release(&costs);
  return status;
}

static trax_status run_program(struct trax_picture *picture, const struct job *job, const struct trax_program *program,
                               trax_error *error) {
  const struct options *options = job->options;
  if (trax_files_check_input(options->import.files, program->path, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_config *config = trax_config_create();
  trax_status status = config ? emulated_config(config, options, job->frame, error) : trax_fail(error, "out of memory");
  trax_machine *machine = status == TRAX_OK ? trax_machine_create(config, error) : NULL;
  if (status == TRAX_OK)
    status = machine ? trax_simulated_load(machine, job->frame, program, error) : TRAX_ERROR;
  if (status == TRAX_OK && options->keep)
    status = prepare_write(options->keep, job->frame, program, machine, error);
  if (status == TRAX_OK && !options->prepare)
    status = render_loaded(picture, job, program, machine, error);
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return status;
}

trax_status emulate(struct trax_picture *picture, const struct job *job, trax_error *error) {
  struct trax_program program;
  struct chosen chosen;
  trax_progress_line_show(job->progress, "compiling", -1, NULL);
  trax_status status = choose(&chosen, job->options, job->frame, error);
  if (status == TRAX_OK)
    status = find_program(&program, job, &chosen, error);
  return status == TRAX_OK ? run_program(picture, job, &program, error) : status;
}
