#include "machines.h"

#include "machine/machine.h"

#include <stdlib.h>
#include <string.h>

#define MAX_CYCLES 2000000000 /* a run that takes longer hangs */

static trax_machine *make_machine(const char *preset, const char *const settings[][2], trax_error *error) {
  trax_config *config = trax_config_create();
  trax_machine *machine = NULL;
  if (!config) {
    trax_fail(error, "out of memory");
    return NULL;
  }
  trax_status status = trax_config_preset(config, preset, error);
  for (; settings && (*settings)[0] && status == TRAX_OK; settings++)
    status = trax_config_set(config, (*settings)[0], (*settings)[1], error);
  if (status == TRAX_OK)
    machine = trax_machine_create(config, error);
  trax_config_destroy(config);
  return machine;
}

trax_status machine_trace(const char *program, const struct trax_scene *scene, const struct query_params *params,
                          const struct query_ray *rays, struct query_answer *answers, uint64_t *cycles,
                          trax_error *error) {
  trax_machine *machine = make_machine("1x32", NULL, error);
  if (!machine)
    return TRAX_ERROR;
  const uint32_t size = params->count * (uint32_t)sizeof *answers;
  trax_status status = trax_machine_load_elf(machine, program, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "scene", scene->bytes, (uint32_t)scene->size, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "params", params, sizeof *params, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "rays", rays, params->count * (uint32_t)sizeof *rays, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "answers", NULL, size, error);
  const trax_run_options options = {
      .engine = cycles ? "fast" : "functional", .max_cycles = MAX_CYCLES, .host_threads = 1};
  if (status == TRAX_OK)
    status = trax_machine_run(machine, &options, error);
  const uint8_t *bytes;
  uint32_t bytes_size;
  if (status == TRAX_OK)
    status = trax_machine_read_buffer(machine, "answers", &bytes, &bytes_size, error);
  if (status == TRAX_OK) {
    double value = 0;
    if (cycles && trax_stats_get(machine, "cycles", &value))
      *cycles = (uint64_t)value;
    memcpy(answers, bytes, size);
  }
  trax_machine_destroy(machine);
  return status;
}

/* A machine on which everything waits for everything. */
static const struct {
  const char *preset;
  const char *settings[8][2];
} machines[] = {
    {"4x32", {{0}}},
    {"8x64", {{0}}},
    {"1x32", {{"chip.tps_per_tm", "1"}}},
    {"1x32", {{"chip.tps_per_tm", "64"}, {"fpu.tps_per_cluster", "64"}, {"int_mul.tps_per_unit", "64"}}},
    {"1x32", {{"icache.banks", "1"}, {"icache.tps_per_cache", "32"}, {"dcache.tps_per_bank", "32"}}},
    {"1x32", {{"memory.queue_depth", "1"}, {"dcache.mshrs", "1"}}},
    {"2x32", {{"icache.bytes", "64"}, {"dcache.bytes", "64"}}},
    {"4x32", {{"memory.bandwidth_gbps", "0.1"}}},
    {"4x32", {{"memory.latency_cycles", "10000"}, {"memory.queue_depth", "1"}}},
    {"2x32", {{"special.latency_cycles", "1000"}, {"fpu.add_latency_cycles", "100"}}},
    {"2x32", {{"memory.atomic_latency_cycles", "5000"}, {"memory.min_transfer_bytes", "4096"}}},
    {"4x32", {{"l2.bytes", "64"}, {"l2.ways", "1"}, {"l2.banks", "1"}, {"l2.mshrs", "1"}}},
};

static trax_status compare_with(const struct trax_picture *expected, const struct trax_picture *picture,
                                const char *what, trax_error *error) {
  struct trax_difference difference;
  trax_picture_compare(&difference, expected, picture, 0);
  if (difference.unequal)
    return trax_fail(error, "%s: %llu pixels differ from the native picture's", what,
                     (unsigned long long)difference.unequal);
  return TRAX_OK;
}

static trax_status compare_machine(const struct trax_picture *expected, const struct trax_frame *frame,
                                   const char *path, unsigned number, trax_error *error) {
  struct trax_picture picture = {0};
  char what[64];
  trax_machine *machine = make_machine(machines[number].preset, machines[number].settings, error);
  if (!machine)
    return TRAX_ERROR;
  struct trax_program program = {.specialised = false};
  snprintf(program.path, sizeof program.path, "%s", path);
  const struct trax_simulated_options options = {.run = {.max_cycles = MAX_CYCLES, .host_threads = 1}};
  trax_status status = trax_simulated_load(machine, frame, &program, error);
  if (status == TRAX_OK)
    status = trax_simulated_run(&picture, frame, machine, &options, error);
  trax_machine_destroy(machine);
  snprintf(what, sizeof what, "machine %u", number);
  if (status == TRAX_OK)
    status = compare_with(expected, &picture, what, error);
  trax_picture_release(&picture);
  return status;
}

trax_status machine_pictures(const char *directory, const struct trax_frame *frame, bool all_machines,
                             trax_error *error) {
  struct trax_picture expected = {0}, picture = {0};
  struct trax_render_run run = {0};
  char program[4096];
  snprintf(program, sizeof program, "%s/trax-raytracer%s.elf", directory,
           frame->params->features & TRAX_FEATURE_BIT(EXACT) ? "-exact" : "");
  trax_status status = trax_render_twin(&expected, frame, 1, &run, error);
  for (uint32_t i = 0; status == TRAX_OK && i < expected.width * expected.height; i++)
    if (expected.pixels[i] >> 24 != 0xFF)
      status = trax_fail(error, "pixel %u was left out", i);
  if (status == TRAX_OK)
    status = trax_render_twin(&picture, frame, 64, &run, error);
  if (status == TRAX_OK)
    status = compare_with(&expected, &picture, "64 native threads", error);
  trax_picture_release(&picture);
  for (unsigned i = 0; status == TRAX_OK && i < (all_machines ? sizeof machines / sizeof *machines : 1); i++)
    status = compare_machine(&expected, frame, program, i, error);
  trax_picture_release(&expected);
  return status;
}
