/* The creation of the memory controller, and the import of a state. */
#include "fast/memory/l2.h"
#include "fast/tm/tm.h"
#include "trax/gcd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_LATENCY 1000000u /* cycles; longer transfers count as this in trax_memory_least_latency */

static uint64_t divide_up(uint64_t a, uint64_t b) {
  return (a + b - 1) / b;
}

static void create_bus(struct trax_memory *memory, const struct trax_config *config) {
  const uint64_t megabytes_per_second = (uint64_t)llround(config->memory.bandwidth_gbps * 1000);
  const uint64_t megahertz = (uint64_t)config->chip.clock_mhz * config->memory.channels;
  const uint64_t divisor = trax_gcd(megabytes_per_second, megahertz);
  memory->units_per_cycle = megabytes_per_second / divisor;
  memory->units_per_byte = megahertz / divisor;
}

uint32_t trax_memory_least_latency(const struct trax_config *config) {
  struct trax_memory bus;
  if (config->l2.bytes)
    return config->l2.latency_cycles;
  if (config->memory.model == TRAX_MEMORY_DRAM)
    return 1 + config->memory.latency_cycles;
  create_bus(&bus, config);
  const uint64_t transfer = divide_up(config->memory.min_transfer_bytes * bus.units_per_byte, bus.units_per_cycle);
  return (uint32_t)(transfer < MOST_LATENCY ? transfer : MOST_LATENCY) + config->memory.latency_cycles;
}

void trax_waiting_begin(struct trax_waiting *waiting) {
  for (unsigned tm = 0; tm < TRAX_MAX_TMS; tm++)
    waiting->list[tm] = trax_empty_list;
}

trax_status trax_memory_create(struct trax_memory *memory, const struct trax_config *config,
                               struct trax_memory_stats *stats, trax_error *error) {
  memset(memory, 0, sizeof *memory);
  memory->stats = stats;
  create_bus(memory, config);
  memory->latency = config->memory.latency_cycles;
  memory->atomic_latency = config->memory.atomic_latency_cycles;
  memory->unit_interval = config->memory.atomic_interval_cycles;
  memory->channels = config->memory.channels;
  memory->interleave_shift = (unsigned)__builtin_ctz(config->memory.interleave_bytes);
  for (uint32_t i = 0; i < memory->channels; i++)
    trax_waiting_begin(&memory->channel[i].waiting);
  if (config->memory.model == TRAX_MEMORY_DRAM && !(memory->dram = trax_dram_create(config, &stats->dram, error)))
    return TRAX_ERROR;
  return config->l2.bytes ? trax_l2_create(&memory->l2, config, error) : TRAX_OK;
}

void trax_memory_destroy(struct trax_memory *memory) {
  trax_dram_destroy(memory->dram);
  trax_l2_destroy(memory->l2);
}

/* --- import --- */

uint32_t trax_memory_import_list(const struct trax_memory *memory, struct trax_tm *tms,
                                 struct trax_request_list *list) {
  uint32_t count = 0;
  list->last = list->first;
  for (trax_request_id id = list->first; id != TRAX_NO_REQUEST; id = trax_memory_request(memory, tms, id)->next) {
    list->last = id;
    count++;
  }
  return count;
}

uint32_t trax_waiting_import(const struct trax_memory *memory, struct trax_tm *tms, struct trax_waiting *waiting) {
  uint32_t count = 0;
  waiting->tms = 0;
  for (unsigned tm = 0; tm < TRAX_MAX_TMS; tm++) {
    count += trax_memory_import_list(memory, tms, &waiting->list[tm]);
    waiting->tms |= (uint64_t)(waiting->list[tm].first != TRAX_NO_REQUEST) << tm;
  }
  return count;
}

void trax_memory_import(struct trax_memory *memory, struct trax_tm *tms, unsigned count) {
  memory->waiting = 0;
  for (unsigned i = 0; i < count; i++)
    trax_queue_import(&tms[i].queue);
  for (unsigned i = 0; i < memory->channels; i++) {
    memory->waiting += trax_waiting_import(memory, tms, &memory->channel[i].waiting);
    for (unsigned queue = 0; memory->dram && queue < TRAX_DRAM_QUEUES; queue++)
      memory->waiting += memory->dram->channel[i].count[queue];
  }
  if (memory->l2)
    trax_l2_import(memory, tms);
}
