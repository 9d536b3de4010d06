#include "accuracy.h"

#include "trax/special_latency.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* --- variants --- */

enum { MOST_BITS = 23, LEAST_BITS = 8, MOST_VARIANTS = 16 + 2 * (MOST_BITS - LEAST_BITS + 1) };

static struct trax_variant *add(struct trax_variant *variants, size_t *count, const char *group) {
  struct trax_variant *variant = &variants[(*count)++];
  *variant = (struct trax_variant){.group = group, .samples = 1};
  return variant;
}

static void add_unit(struct trax_variant *variants, size_t *count, unsigned bits, enum trax_latency latency) {
  struct trax_variant *variant = add(variants, count, "unit");
  variant->bits = bits;
  variant->latency = latency;
  snprintf(variant->name, sizeof variant->name, "%u bits, %s", bits,
           latency == TRAX_LATENCY_DIGITS ? "digits" : "newton");
}

/* The scene otherwise: what is not varied is as it was. */
static struct trax_variant *add_tree(struct trax_variant *variants, size_t *count, const char *group,
                                     const struct trax_rebuild_options *own) {
  struct trax_variant *variant = add(variants, count, group);
  variant->rebuilt = true;
  variant->tree = *own;
  return variant;
}

trax_status trax_variants(struct trax_variant **variants, size_t *count, const struct trax_scene *scene,
                          trax_error *error) {
  struct trax_rebuild_options own = {.nodes = scene->header->node_layout};
  *variants = NULL;
  if (trax_scene_is_split(&own.split, scene, error) != TRAX_OK)
    return TRAX_ERROR;
  *count = 0;
  struct trax_variant *all = *variants = calloc(MOST_VARIANTS, sizeof **variants);
  if (!all)
    return trax_fail(error, "out of memory");
  strcpy(add(all, count, "default")->name, "default");
  for (enum trax_triangle_method triangle = 0; triangle < TRAX_TRIANGLE_METHODS; triangle++)
    for (int fast_math = 0; fast_math < 2; fast_math++) {
      if (triangle == TRAX_TRIANGLE_WATERTIGHT && !fast_math)
        continue;
      struct trax_variant *variant = add(all, count, fast_math ? "math" : "triangle");
      variant->method.triangle = triangle;
      variant->method.fast_math = fast_math;
      snprintf(variant->name, sizeof variant->name, "%s%s", trax_triangle_names[triangle],
               fast_math ? ", fast-math" : "");
    }
  for (enum trax_node_layout nodes = 0; nodes < TRAX_NODE_LAYOUTS; nodes++) {
    if (nodes == own.nodes)
      continue;
    struct trax_variant *variant = add_tree(all, count, "tree", &own);
    variant->tree.nodes = nodes;
    snprintf(variant->name, sizeof variant->name, "%s nodes", trax_node_formats[nodes].name);
  }
  struct trax_variant *split = add_tree(all, count, "tree", &own);
  split->tree.split = !own.split;
  strcpy(split->name, own.split ? "whole triangles" : "split triangles");
  struct trax_variant *coarse = add_tree(all, count, "vertices", &own);
  coarse->tree.vertex_bits = 16;
  strcpy(coarse->name, "vertices of 16 bits");
  for (unsigned bits = MOST_BITS; bits >= LEAST_BITS; bits--) {
    add_unit(all, count, bits, TRAX_LATENCY_DIGITS);
    if (trax_latency_newton(bits) != trax_latency_digits(bits))
      add_unit(all, count, bits, TRAX_LATENCY_NEWTON);
  }
  for (uint32_t samples = 2; samples <= 16; samples *= 2) {
    struct trax_variant *variant = add(all, count, "samples");
    variant->samples = samples;
    snprintf(variant->name, sizeof variant->name, "%u samples", samples);
  }
  for (size_t i = 0; i < *count; i++)
    if (!all[i].rebuilt)
      all[i].tree = own;
  return TRAX_OK;
}

unsigned trax_variant_latency(const struct trax_variant *variant) {
  switch (variant->latency) {
  case TRAX_LATENCY_DIGITS:
    return trax_latency_digits(variant->bits);
  case TRAX_LATENCY_NEWTON:
    return trax_latency_newton(variant->bits);
  default:
    return 0;
  }
}

/* --- fronts --- */

static bool beats(const double a[2], const double b[2], bool first) {
  if (a[0] > b[0] || a[1] > b[1])
    return false;
  return a[0] < b[0] || a[1] < b[1] || first;
}

void trax_accuracy_fronts(struct trax_accuracy_row *rows, size_t count) {
  for (size_t i = 0; i < count; i++) {
    rows[i].numerical_front = rows[i].variant.samples == 1;
    rows[i].total_front = true;
    const double *own = rows[i].figures;
    for (size_t j = 0; j < count; j++) {
      if (j == i)
        continue;
      const double *other = rows[j].figures;
      if (rows[j].variant.samples == rows[i].variant.samples &&
          beats((const double[]){other[TRAX_ACCURACY_CYCLES], other[TRAX_ACCURACY_RMSE]},
                (const double[]){own[TRAX_ACCURACY_CYCLES], own[TRAX_ACCURACY_RMSE]}, j < i))
        rows[i].numerical_front = false;
      if (beats((const double[]){other[TRAX_ACCURACY_CYCLES], other[TRAX_ACCURACY_TOTAL_RMSE]},
                (const double[]){own[TRAX_ACCURACY_CYCLES], own[TRAX_ACCURACY_TOTAL_RMSE]}, j < i))
        rows[i].total_front = false;
    }
  }
}

/* --- machines --- */

static trax_status set_number(trax_config *config, const char *key, unsigned value, trax_error *error) {
  char text[16];
  snprintf(text, sizeof text, "%u", value);
  return trax_config_set(config, key, text, error);
}

/* The run's chip with the variant's unit. */
static trax_status chip_of(trax_config **config, const struct trax_variant *variant,
                           const struct trax_accuracy_run *run, trax_error *error) {
  *config = trax_config_copy(run->config);
  if (!*config)
    return trax_fail(error, "out of memory");
  trax_status status = TRAX_OK;
  if (variant->bits)
    status = set_number(*config, "special.precision_bits", variant->bits, error);
  if (status == TRAX_OK && trax_variant_latency(variant))
    status = set_number(*config, "special.latency_cycles", trax_variant_latency(variant), error);
  return status;
}

struct step {
  const struct trax_accuracy_run *run;
  double before, part; /* of the variant */
};

static void show_step(void *context, const trax_progress *status) {
  const struct step *step = context;
  if (step->run->progress && status->total_items)
    step->run->progress(step->run->progress_context,
                        step->before + step->part * (double)status->items / (double)status->total_items);
}

/* A machine that has rendered the frame, and the picture. */
static trax_status render(trax_machine **machine, struct trax_picture *picture, const struct trax_frame *frame,
                          const struct trax_program *program, const trax_config *config, const char *engine,
                          struct step step, trax_error *error) {
  *machine = trax_machine_create(config, error);
  trax_status status = *machine ? trax_simulated_load(*machine, frame, program, error) : TRAX_ERROR;
  const struct trax_simulated_options options = {
      .run = {.output = stderr,
              .total_items = (uint64_t)frame->params->width * frame->params->height,
              .progress = show_step,
              .progress_context = &step,
              .interrupt = step.run->specialise.interrupt,
              .engine = engine,
              .host_threads = step.run->host_threads}};
  return status == TRAX_OK ? trax_simulated_run(picture, frame, *machine, &options, error) : status;
}

static trax_status find_program(struct trax_program *program, const struct trax_frame *frame,
                                const struct trax_accuracy_run *run, bool record, trax_error *error) {
  struct trax_specialise_options options = run->specialise;
  char note[256];
  options.record = record;
  program->specialised = false;
  trax_status status = trax_program_specialise(program, frame, &options, note, error);
  if (status == TRAX_OK && !program->specialised)
    status = trax_fail(error, "there is no program compiled for the picture: %s", note);
  return status;
}

/* --- figures --- */

static trax_status take_costs(double figures[TRAX_ACCURACY_FIGURE_COUNT], trax_machine *machine,
                              const struct trax_program_size *size, trax_error *error) {
  static const struct {
    enum trax_accuracy_figure figure;
    const char *name;
  } taken[] = {{TRAX_ACCURACY_CYCLES, "cycles"},       {TRAX_ACCURACY_INSTRUCTIONS, "instructions"},
               {TRAX_ACCURACY_MEMORY, "memory.bytes"}, {TRAX_ACCURACY_ENERGY, "energy.total"},
               {TRAX_ACCURACY_MRPS, "mrps"},           {TRAX_ACCURACY_HOST_SECONDS, "host_seconds"}};
  for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
    trax_stats_get(machine, taken[i].name, &figures[taken[i].figure]);
  figures[TRAX_ACCURACY_CODE] = size->code_bytes;
  const uint8_t *scene;
  uint32_t scene_bytes;
  if (trax_machine_read_buffer(machine, "scene", &scene, &scene_bytes, error) != TRAX_OK)
    return TRAX_ERROR;
  figures[TRAX_ACCURACY_SCENE] = scene_bytes;
  return TRAX_OK;
}

static trax_status take_errors(double figures[TRAX_ACCURACY_FIGURE_COUNT], const struct trax_frame *frame,
                               const uint8_t *record, const struct trax_accuracy_run *run, trax_error *error) {
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
  trax_hit_errors(&hits, run->exact, (const struct trax_sample_record *)(const void *)(recorded + pixels), frame,
                  run->original);
  figures[TRAX_ACCURACY_RMSE] = numerical.rmse;
  figures[TRAX_ACCURACY_LARGEST] = numerical.largest;
  figures[TRAX_ACCURACY_SAMPLING_RMSE] = sampling.rmse;
  figures[TRAX_ACCURACY_TOTAL_RMSE] = total.rmse;
  figures[TRAX_ACCURACY_WRONG] = (double)hits.wrong_pixels;
  figures[TRAX_ACCURACY_MISSED] = (double)hits.missed;
  figures[TRAX_ACCURACY_GROWN] = (double)hits.grown;
  figures[TRAX_ACCURACY_OTHER] = (double)hits.other;
  figures[TRAX_ACCURACY_TIED] = (double)hits.tied;
  figures[TRAX_ACCURACY_SHADOW] = (double)hits.shadow;
  trax_status status = trax_flip(&figures[TRAX_ACCURACY_FLIP], channels, run->exact->channels, width, height, error);
  if (status == TRAX_OK)
    status = trax_flip(&figures[TRAX_ACCURACY_TOTAL_FLIP], channels, run->converged->channels, width, height, error);
  free(channels);
  return status;
}

/* The program that records is another one, so its picture must be shown to be the same; -ffast-math may compile it to
   other roundings. */
static trax_status check_recorded(double figures[TRAX_ACCURACY_FIGURE_COUNT], const struct trax_picture *picture,
                                  const struct trax_picture *recorded, const struct trax_method *method,
                                  trax_error *error) {
  struct trax_difference difference;
  trax_picture_compare(&difference, picture, recorded, 0);
  figures[TRAX_ACCURACY_CHANGED] = (double)difference.unequal;
  if (difference.unequal && !method->fast_math)
    return trax_fail(error, "the program that records renders %llu pixels otherwise than the program that is measured",
                     (unsigned long long)difference.unequal);
  return TRAX_OK;
}

trax_status trax_accuracy_measure(struct trax_accuracy_row *row, const struct trax_variant *variant,
                                  const struct trax_frame *frame, const struct trax_accuracy_run *run,
                                  trax_error *error) {
  struct trax_program measured = {0}, recording = {0};
  struct trax_program_size size;
  struct trax_picture picture = {0}, recorded = {0};
  trax_machine *machine = NULL;
  trax_config *config = NULL;
  const uint8_t *record;
  uint32_t record_bytes;
  *row = (struct trax_accuracy_row){.variant = *variant};
  trax_status status = find_program(&measured, frame, run, false, error);
  if (status == TRAX_OK)
    status = trax_program_measure(&size, measured.path, error);
  if (status == TRAX_OK)
    status = find_program(&recording, frame, run, true, error);
  if (status == TRAX_OK)
    status = chip_of(&config, variant, run, error);
  if (status == TRAX_OK)
    status =
        render(&machine, &picture, frame, &measured, config, "fast", (struct step){.run = run, .part = 0.75}, error);
  if (status == TRAX_OK)
    status = take_costs(row->figures, machine, &size, error);
  trax_machine_destroy(machine);
  machine = NULL;
  if (status == TRAX_OK)
    status = render(&machine, &recorded, frame, &recording, config, "functional",
                    (struct step){.run = run, .before = 0.75, .part = 0.25}, error);
  if (status == TRAX_OK)
    status = check_recorded(row->figures, &picture, &recorded, &variant->method, error);
  if (status == TRAX_OK)
    status = trax_machine_read_buffer(machine, "record", &record, &record_bytes, error);
  if (status == TRAX_OK)
    status = take_errors(row->figures, frame, record, run, error);
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  trax_picture_release(&picture);
  trax_picture_release(&recorded);
  return status;
}

/* --- the key --- */

/* The programs' names are hashes of their sources, constants and compiler (specialise.c). */
trax_status trax_accuracy_key(char key[33], const struct trax_variant *variant, const struct trax_frame *frame,
                              const struct trax_accuracy_run *run, trax_error *error) {
  struct trax_program programs[2] = {{.specialised = false}, {.specialised = false}};
  trax_config *config = NULL;
  char *text = NULL;
  size_t size = 0;
  trax_status status = TRAX_OK;
  for (int record = 0; record < 2 && status == TRAX_OK; record++)
    status = find_program(&programs[record], frame, run, record, error);
  if (status == TRAX_OK)
    status = chip_of(&config, variant, run, error);
  FILE *out = status == TRAX_OK ? open_memstream(&text, &size) : NULL;
  if (status == TRAX_OK && !out)
    status = trax_fail(error, "out of memory");
  if (status == TRAX_OK) {
    for (int record = 0; record < 2; record++)
      fprintf(out, "%s\n", strrchr(programs[record].path, '/') + 1);
    const struct trax_scene_header *header = frame->scene->header;
    fprintf(out, "scene %08x %u\nconverged %u\n", header->checksum, header->file_size, run->converged->samples);
    trax_config_print(config, out);
    fclose(out);
    XXH3_state_t *state = XXH3_createState();
    if (state) {
      XXH3_128bits_reset(state);
      XXH3_128bits_update(state, text, size);
      XXH3_128bits_update(state, frame->params, frame->params_size);
      const XXH128_hash_t hash = XXH3_128bits_digest(state);
      snprintf(key, 33, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
      XXH3_freeState(state);
    } else {
      status = trax_fail(error, "out of memory");
    }
  }
  free(text);
  trax_config_destroy(config);
  return status;
}
