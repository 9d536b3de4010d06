#include "core/memory.h"

#include "core/tm.h"

#include <math.h>
#include <string.h>

static uint64_t greatest_common_divisor(uint64_t a, uint64_t b) {
  return b ? greatest_common_divisor(b, a % b) : a;
}

void trax_memory_create(struct trax_memory *memory, const struct trax_config *config) {
  memset(memory, 0, sizeof *memory);
  const uint64_t megabytes_per_second = (uint64_t)llround(config->memory.bandwidth_gbps * 1000);
  const uint64_t megahertz = config->chip.clock_mhz;
  const uint64_t divisor = greatest_common_divisor(megabytes_per_second, megahertz);
  memory->units_per_cycle = megabytes_per_second / divisor;
  memory->units_per_byte = megahertz / divisor;
  memory->latency = config->memory.latency_cycles;
}

static uint64_t cycle_from(const struct trax_memory *memory, uint64_t units) { /* rounded up */
  return (units + memory->units_per_cycle - 1) / memory->units_per_cycle;
}

static void increment(const struct trax_memory *memory, struct trax_request *request, struct trax_space *space) {
  if (memory->before_increment)
    memory->before_increment(memory->context, request->address);
  memcpy(&request->value, space->bytes + request->address, sizeof request->value);
  const uint32_t incremented = request->value + 1;
  memcpy(space->bytes + request->address, &incremented, sizeof incremented);
}

void trax_memory_show(struct trax_memory *memory, struct trax_tm *tm) {
  tm->queue.shown++;
  memory->waiting_tms |= (uint64_t)1 << tm->number;
}

void trax_memory_cycle(struct trax_memory *memory, struct trax_tm *tms, struct trax_space *space, uint64_t t) {
  while (memory->waiting_tms && memory->free_from < (t + 1) * memory->units_per_cycle) {
    const unsigned number = trax_arbiter_look(memory->turn, memory->waiting_tms);
    trax_arbiter_to_back(&memory->turn, number);
    struct trax_tm *tm = &tms[number];
    struct trax_request *request = trax_queue_first_waiting(&tm->queue);
    if (++tm->queue.started == tm->queue.shown)
      memory->waiting_tms &= ~((uint64_t)1 << number);

    const uint64_t now = t * memory->units_per_cycle;
    const uint64_t begin = memory->free_from > now ? memory->free_from : now;
    memory->free_from = begin + request->bytes * memory->units_per_byte;
    request->completion = cycle_from(memory, memory->free_from) + memory->latency;
    if (request->completion < tm->next_cycle)
      tm->next_cycle = request->completion;
    if (request->kind == TRAX_REQUEST_ATOMIC)
      increment(memory, request, space);
  }
}

uint64_t trax_memory_next_cycle(const struct trax_memory *memory, uint64_t t) {
  if (!memory->waiting_tms)
    return UINT64_MAX;
  const uint64_t free_cycle = memory->free_from / memory->units_per_cycle; /* the bus frees during it */
  return free_cycle > t + 1 ? free_cycle : t + 1;
}

uint64_t trax_memory_idle_from(const struct trax_memory *memory) {
  return cycle_from(memory, memory->free_from);
}
