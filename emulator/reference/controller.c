/* docs/timing-memory.md, "Memory controller". */
#include "reference/reference.h"

#include <math.h>
#include <string.h>

static uint64_t greatest_common_divisor(uint64_t a, uint64_t b) {
  return b ? greatest_common_divisor(b, a % b) : a;
}

/* A channel moves B = (MB/s) / MHz / channels bytes per cycle. The numerator and the denominator of B in lowest terms
   are the units per cycle and per byte. */
void trax_ref_controller_create(struct trax_ref_controller *controller, const struct trax_config *config) {
  const uint64_t numerator = (uint64_t)llround(config->memory.bandwidth_gbps * 1000);
  const uint64_t denominator = (uint64_t)config->chip.clock_mhz * config->memory.channels;
  const uint64_t divisor = greatest_common_divisor(numerator, denominator);
  controller->units_per_cycle = numerator / divisor;
  controller->units_per_byte = denominator / divisor;
}

uint32_t trax_ref_channel_of(const struct trax_config *config, uint32_t address) {
  return address / config->memory.interleave_bytes % config->memory.channels;
}

bool trax_ref_buses_idle(const struct trax_ref_chip *chip, uint64_t t) {
  for (uint32_t i = 0; i < chip->config->memory.channels; i++)
    if (chip->controller.channel[i].free_from > (trax_ref_units)t * chip->controller.units_per_cycle)
      return false;
  return true;
}

/* Begins a transfer and returns the cycle ceil(f). */
static uint64_t transfer(struct trax_ref_chip *chip, uint32_t number, uint32_t bytes, uint64_t t) {
  struct trax_ref_channel *channel = &chip->controller.channel[number];
  const trax_ref_units cycle = chip->controller.units_per_cycle;
  const trax_ref_units begin = channel->free_from > t * cycle ? channel->free_from : t * cycle;
  channel->free_from = begin + bytes * chip->controller.units_per_byte;
  chip->stats->transfers++;
  chip->stats->bytes += bytes;
  chip->stats->channel[number].transfers++;
  chip->stats->channel[number].bytes += bytes;
  return (uint64_t)((channel->free_from + cycle - 1) / cycle);
}

static void increment(struct trax_ref_request *request, struct trax_machine *machine) {
  uint8_t *const word = machine->space.bytes + request->address;
  memcpy(&request->old_value, word, 4);
  const uint32_t new_value = request->old_value + 1;
  memcpy(word, &new_value, 4);
}

static void serve_request(struct trax_ref_chip *chip, struct trax_ref_request *request, uint32_t channel, uint64_t t) {
  const struct trax_config *config = chip->config;
  request->stage = SERVED;
  request->completion = transfer(chip, channel, request->bytes, t) + config->memory.latency_cycles +
                        (config->l2.bytes ? config->l2.latency_cycles : 0);
  if (request->kind == ATOMIC) {
    request->completion += config->memory.atomic_latency_cycles;
    increment(request, chip->machine);
  }
}

static void serve_miss(struct trax_ref_chip *chip, struct trax_ref_miss *miss, uint32_t channel, uint64_t t) {
  const struct trax_config *config = chip->config;
  const uint64_t over = transfer(chip, channel, trax_ref_l2_line_cost(config), t);
  trax_ref_l2_started(chip, miss, over + config->memory.latency_cycles);
}

/* Serves the next request of a channel without a second-level cache. False: no request waits for the channel. */
static bool serve_next(struct trax_ref_chip *chip, uint32_t channel, uint64_t t) {
  bool asks[MOST];
  for (uint32_t i = 0; i < chip->tms; i++)
    asks[i] = trax_ref_oldest_at_channel(&chip->tm[i], channel) != NULL;
  const int winner = trax_ref_arbitrate(&chip->controller.channel[channel].pointer, asks, chip->tms);
  if (winner >= 0)
    serve_request(chip, trax_ref_oldest_at_channel(&chip->tm[winner], channel), channel, t);
  return winner >= 0;
}

/* The same with a second-level cache: the request that came to the channel first. */
static bool serve_first(struct trax_ref_chip *chip, uint32_t channel, uint64_t t) {
  struct trax_ref_request *first_request = NULL;
  struct trax_ref_miss *first_miss = NULL;
  uint64_t first = UNKNOWN;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t place = 0; place < chip->tm[i].places; place++) {
      struct trax_ref_request *request = &chip->tm[i].queue[place];
      if (request->stage == AT_CHANNEL && trax_ref_channel_of(chip->config, request->address) == channel &&
          request->came < first) {
        first = request->came;
        first_request = request;
      }
    }
  for (uint32_t i = 0; i < chip->l2.misses; i++) {
    struct trax_ref_miss *miss = &chip->l2.miss[i];
    if (miss->arrival == UNKNOWN && miss->channel == channel && miss->came < first) {
      first = miss->came;
      first_miss = miss;
    }
  }
  if (first_miss)
    serve_miss(chip, first_miss, channel, t);
  else if (first_request)
    serve_request(chip, first_request, channel, t);
  return first != UNKNOWN;
}

void trax_ref_controller_cycle(struct trax_ref_chip *chip, uint64_t t) {
  const trax_ref_units next = ((trax_ref_units)t + 1) * chip->controller.units_per_cycle;
  for (uint32_t channel = 0; channel < chip->config->memory.channels; channel++)
    while (chip->controller.channel[channel].free_from < next)
      if (!(chip->config->l2.bytes ? serve_first : serve_next)(chip, channel, t))
        break;
}
