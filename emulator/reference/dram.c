/* docs/timing-memory.md, "DRAM": what a channel takes from the TMs and the second-level cache. dram/dram.h has the
 * rest. */
#include "reference/reference.h"

static enum trax_dram_queue queue_of(const struct trax_ref_request *request) {
  return request && request->kind == WRITE ? TRAX_DRAM_WRITE : TRAX_DRAM_READ;
}

/* Whether the channel can take the request; NULL: a miss of the second-level cache. */
static bool is_admitted(const struct trax_ref_chip *chip, uint32_t channel, const struct trax_ref_request *request) {
  return (request && request->kind == ATOMIC) || trax_dram_has_place(chip->controller.dram, channel, queue_of(request));
}

static uint64_t completion(const struct trax_ref_chip *chip, uint64_t over) {
  return over + chip->config->memory.latency_cycles + (chip->config->l2.bytes ? chip->config->l2.latency_cycles : 0);
}

static void take_miss(struct trax_ref_chip *chip, struct trax_ref_miss *miss, uint64_t t) {
  trax_ref_notify_miss(chip, miss, t);
  miss->in_dram = true;
  trax_dram_bring(chip->controller.dram, TRAX_DRAM_READ, (uint32_t)miss->came, miss->line * chip->config->l2.line_bytes,
                  trax_ref_l2_line_cost(chip->config), t);
}

static void take_request(struct trax_ref_chip *chip, struct trax_ref_request *request, uint64_t t) {
  if (request->kind == ATOMIC) {
    const uint64_t done = trax_ref_increment(chip, request, t + 1);
    request->stage = SERVED;
    request->completion = completion(chip, done) + chip->config->memory.atomic_latency_cycles;
    return;
  }
  trax_ref_notify_request(chip, request, t);
  if (!chip->config->l2.bytes)
    request->came = chip->controller.came++;
  request->stage = IN_DRAM;
  trax_dram_bring(chip->controller.dram, queue_of(request), (uint32_t)request->came, request->address, request->bytes,
                  t);
}

/* Takes the next request that waits for the channel and for which there is a place. False: there is none. */
static bool take(struct trax_ref_chip *chip, uint32_t channel, uint64_t t) {
  struct trax_ref_request *request;
  struct trax_ref_miss *miss;
  if (chip->config->l2.bytes) {
    if (!trax_ref_first_at_channel(chip, channel, &request, &miss) || !is_admitted(chip, channel, request))
      return false;
    if (miss)
      take_miss(chip, miss, t);
    else
      take_request(chip, request, t);
    return true;
  }
  bool asks[MOST];
  for (uint32_t i = 0; i < chip->tms; i++) {
    request = trax_ref_oldest_at_channel(&chip->tm[i], channel);
    asks[i] = request && is_admitted(chip, channel, request);
  }
  const int winner = trax_ref_arbitrate(&chip->controller.channel[channel].pointer, asks, chip->tms);
  if (winner >= 0)
    take_request(chip, trax_ref_oldest_at_channel(&chip->tm[winner], channel), t);
  return winner >= 0;
}

static void count(struct trax_memory_stats *stats, uint32_t channel, uint32_t bytes) {
  stats->transfers++;
  stats->bytes += bytes;
  stats->channel[channel].transfers++;
  stats->channel[channel].bytes += bytes;
}

/* The request `came` has been served; its data are over in the cycle `over`. */
static void complete(struct trax_ref_chip *chip, uint32_t channel, uint32_t came, uint64_t over) {
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t place = 0; place < chip->tm[i].places; place++) {
      struct trax_ref_request *request = &chip->tm[i].queue[place];
      if (request->stage == IN_DRAM && (uint32_t)request->came == came) {
        request->stage = SERVED;
        request->completion = completion(chip, over);
        count(chip->stats, channel, request->bytes);
        return;
      }
    }
  for (uint32_t i = 0; i < chip->l2.misses; i++) {
    struct trax_ref_miss *miss = &chip->l2.miss[i];
    if (miss->in_dram && miss->arrival == UNKNOWN && (uint32_t)miss->came == came) {
      trax_ref_l2_started(chip, miss, over + chip->config->memory.latency_cycles);
      count(chip->stats, channel, trax_ref_l2_line_cost(chip->config));
      return;
    }
  }
}

void trax_ref_serve_dram(struct trax_ref_chip *chip, uint32_t channel, uint64_t t) {
  struct trax_dram_served served;
  while (take(chip, channel, t))
    ;
  while (trax_dram_serve(chip->controller.dram, channel, t, &served)) {
    complete(chip, channel, served.id, served.over);
    while (take(chip, channel, t))
      ;
  }
}
