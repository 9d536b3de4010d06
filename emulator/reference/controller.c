/* docs/timing.md, "Memory controller". */
#include "reference/reference.h"

#include <math.h>
#include <string.h>

/* B = (MB/s) / MHz bytes move in a cycle. A cycle of as many units as there are MB/s and a byte of as many as there are
   MHz are whole numbers; a common divisor changes nothing but how long the run may be. */
void trax_ref_controller_create(struct trax_ref_controller *controller, const struct trax_config *config) {
  uint64_t cycle = (uint64_t)llround(config->memory.bandwidth_gbps * 1000), byte = config->chip.clock_mhz;
  for (uint64_t divisor = 2; divisor <= byte; divisor++)
    while (cycle % divisor == 0 && byte % divisor == 0) {
      cycle /= divisor;
      byte /= divisor;
    }
  *controller = (struct trax_ref_controller){.units_per_cycle = cycle, .units_per_byte = byte};
}

/* The oldest request of a TM that waits; NULL: none does. */
static struct trax_ref_request *first_waiting(struct trax_ref_tm *tm) {
  for (uint32_t i = 0; i < tm->places; i++)
    if (!tm->queue[i].started)
      return &tm->queue[i];
  return NULL;
}

static void increment(struct trax_ref_request *request, struct trax_machine *machine) {
  uint8_t *const word = machine->space.bytes + request->address;
  memcpy(&request->old_value, word, 4);
  const uint32_t new_value = request->old_value + 1;
  memcpy(word, &new_value, 4);
}

static void start(struct trax_ref_chip *chip, struct trax_ref_request *request, uint64_t t) {
  struct trax_ref_controller *controller = &chip->controller;
  const uint64_t cycle = controller->units_per_cycle;
  const uint64_t begin = controller->free_from > t * cycle ? controller->free_from : t * cycle;
  controller->free_from = begin + request->bytes * controller->units_per_byte;
  struct trax_memory_stats *stats = &chip->machine->stats.memory;
  stats->transfers++;
  stats->bytes += request->bytes;
  stats->channel[0].transfers++;
  stats->channel[0].bytes += request->bytes;
  request->started = true;
  request->completion = (controller->free_from + cycle - 1) / cycle + chip->machine->config.memory.latency_cycles;
  if (request->kind == ATOMIC)
    increment(request, chip->machine);
}

void trax_ref_controller_cycle(struct trax_ref_chip *chip, uint64_t t) {
  while (chip->controller.free_from < (t + 1) * chip->controller.units_per_cycle) {
    bool asks[MOST];
    for (uint32_t i = 0; i < chip->tms; i++)
      asks[i] = first_waiting(&chip->tm[i]) != NULL;
    const int winner = trax_ref_pick(&chip->controller.turn, asks, chip->tms);
    if (winner < 0)
      return;
    start(chip, first_waiting(&chip->tm[winner]), t);
  }
}
