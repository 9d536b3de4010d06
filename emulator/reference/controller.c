/* docs/timing-memory.md, "Memory controller". */
#include "reference/reference.h"
#include "trax/gcd.h"

#include <math.h>
#include <string.h>

/* A channel moves B = (MB/s) / MHz / channels bytes per cycle. The numerator and the denominator of B in lowest terms
   are the units per cycle and per byte. */
bool trax_ref_controller_create(struct trax_ref_controller *controller, const struct trax_config *config,
                                struct trax_memory_stats *stats) {
  const uint64_t numerator = (uint64_t)llround(config->memory.bandwidth_gbps * 1000);
  const uint64_t denominator = (uint64_t)config->chip.clock_mhz * config->memory.channels;
  const uint64_t divisor = trax_gcd(numerator, denominator);
  controller->units_per_cycle = numerator / divisor;
  controller->units_per_byte = denominator / divisor;
  if (config->memory.model == TRAX_MEMORY_DRAM)
    controller->dram = trax_dram_create(config, &stats->dram, NULL);
  return config->memory.model != TRAX_MEMORY_DRAM || controller->dram;
}

uint32_t trax_ref_channel_of(const struct trax_config *config, uint32_t address) {
  if (config->memory.model == TRAX_MEMORY_DRAM) {
    struct trax_dram_map map;
    trax_dram_map_create(&map, config, NULL); /* cannot fail: the configuration is valid */
    return trax_dram_place_of(&map, address).field[TRAX_DRAM_CHANNEL];
  }
  return address / config->memory.interleave_bytes % config->memory.channels;
}

bool trax_ref_buses_idle(const struct trax_ref_chip *chip, uint64_t t) {
  for (uint32_t i = 0; i < chip->config->memory.channels; i++)
    if (chip->controller.dram
            ? trax_dram_idle_from(chip->controller.dram, i) > t
            : chip->controller.channel[i].free_from > (trax_ref_units)t * chip->controller.units_per_cycle)
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

uint64_t trax_ref_increment(struct trax_ref_chip *chip, struct trax_ref_request *request, uint64_t over) {
  struct trax_ref_channel *channel = &chip->controller.channel[request->channel];
  uint8_t *const word = chip->machine->space.bytes + request->address;
  memcpy(&request->old_value, word, 4);
  const uint32_t new_value = request->old_value + 1;
  memcpy(word, &new_value, 4);
  const uint64_t done = over > channel->unit_free_from ? over : channel->unit_free_from;
  channel->unit_free_from = done + chip->config->memory.atomic_interval_cycles;
  return done;
}

static void serve_request(struct trax_ref_chip *chip, struct trax_ref_request *request, uint32_t channel, uint64_t t) {
  const struct trax_config *config = chip->config;
  trax_ref_notify_request(chip, request, t);
  uint64_t over = transfer(chip, channel, request->bytes, t);
  if (request->kind == ATOMIC)
    over = trax_ref_increment(chip, request, over) + config->memory.atomic_latency_cycles;
  request->stage = SERVED;
  request->completion = over + config->memory.latency_cycles + (config->l2.bytes ? config->l2.latency_cycles : 0);
}

static void serve_miss(struct trax_ref_chip *chip, struct trax_ref_miss *miss, uint32_t channel, uint64_t t) {
  const struct trax_config *config = chip->config;
  trax_ref_notify_miss(chip, miss, t);
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

bool trax_ref_first_at_channel(struct trax_ref_chip *chip, uint32_t channel, struct trax_ref_request **request,
                               struct trax_ref_miss **miss) {
  uint64_t first = UNKNOWN;
  *request = NULL;
  *miss = NULL;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t place = 0; place < chip->tm[i].places; place++) {
      struct trax_ref_request *other = &chip->tm[i].queue[place];
      if (other->stage == AT_CHANNEL && other->channel == channel && other->came < first) {
        first = other->came;
        *request = other;
      }
    }
  for (uint32_t i = 0; i < chip->l2.misses; i++) {
    struct trax_ref_miss *other = &chip->l2.miss[i];
    if (other->arrival == UNKNOWN && !other->in_dram && other->channel == channel && other->came < first) {
      first = other->came;
      *miss = other;
    }
  }
  if (*miss)
    *request = NULL;
  return first != UNKNOWN;
}

/* The same with a second-level cache: the request that came to the channel first. */
static bool serve_first(struct trax_ref_chip *chip, uint32_t channel, uint64_t t) {
  struct trax_ref_request *request;
  struct trax_ref_miss *miss;
  if (!trax_ref_first_at_channel(chip, channel, &request, &miss))
    return false;
  if (miss)
    serve_miss(chip, miss, channel, t);
  else
    serve_request(chip, request, channel, t);
  return true;
}

void trax_ref_controller_cycle(struct trax_ref_chip *chip, uint64_t t) {
  const trax_ref_units next = ((trax_ref_units)t + 1) * chip->controller.units_per_cycle;
  for (uint32_t channel = 0; channel < chip->config->memory.channels; channel++) {
    if (chip->controller.dram) {
      trax_ref_serve_dram(chip, channel, t);
      continue;
    }
    while (chip->controller.channel[channel].free_from < next)
      if (!(chip->config->l2.bytes ? serve_first : serve_next)(chip, channel, t))
        break;
  }
}
