/* docs/timing-memory.md, "Second-level cache": step 3, before the memory controller. */
#include "reference/reference.h"

#include <stdlib.h>

bool trax_ref_l2_create(struct trax_ref_l2 *l2, const struct trax_config *config) {
  if (!config->l2.bytes)
    return true;
  l2->miss = calloc(config->l2.mshrs, sizeof *l2->miss);
  return trax_ref_lines_create(&l2->lines, config->l2.bytes, config->l2.line_bytes, config->l2.ways,
                               config->l2.replacement) &&
         l2->miss;
}

void trax_ref_l2_destroy(struct trax_ref_l2 *l2) {
  trax_ref_lines_destroy(&l2->lines);
  free(l2->miss);
}

uint32_t trax_ref_bank_of(const struct trax_config *config, uint32_t address) {
  return address / config->l2.line_bytes % config->l2.banks;
}

uint32_t trax_ref_l2_line_cost(const struct trax_config *config) {
  const uint32_t line = config->l2.line_bytes, least = config->memory.min_transfer_bytes;
  if (config->memory.model == TRAX_MEMORY_DRAM)
    return trax_dram_bytes(config, 0, line);
  return line > least ? line : least;
}

/* --- arrivals --- */

/* Returns the first of the remaining lines that arrive in cycle t; NULL: there is none. */
static struct trax_ref_miss *first_arrival(struct trax_ref_l2 *l2, uint64_t t) {
  struct trax_ref_miss *first = NULL;
  for (uint32_t i = 0; i < l2->misses; i++) {
    struct trax_ref_miss *miss = &l2->miss[i];
    if (miss->arrival == t &&
        (!first || miss->channel < first->channel || (miss->channel == first->channel && miss->begun < first->begun)))
      first = miss;
  }
  return first;
}

static void arrive(struct trax_ref_l2 *l2, uint64_t t) {
  for (struct trax_ref_miss *miss; (miss = first_arrival(l2, t)) != NULL; *miss = l2->miss[--l2->misses])
    trax_ref_lines_install(&l2->lines, miss->line);
}

/* --- banks --- */

static struct trax_ref_miss *on_its_way(struct trax_ref_l2 *l2, uint32_t line) {
  for (uint32_t i = 0; i < l2->misses; i++)
    if (l2->miss[i].line == line)
      return &l2->miss[i];
  return NULL;
}

/* The request completes after the line's arrival, or its completion is unknown until that is known. */
static void wait_for_line(struct trax_ref_chip *chip, struct trax_ref_request *request,
                          const struct trax_ref_miss *miss) {
  request->stage = SERVED;
  request->l2_line = miss->line;
  request->completion = miss->arrival == UNKNOWN ? UNKNOWN : miss->arrival + chip->config->l2.latency_cycles;
}

void trax_ref_l2_started(struct trax_ref_chip *chip, struct trax_ref_miss *miss, uint64_t arrival) {
  miss->arrival = arrival;
  miss->begun = chip->l2.begun++;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t place = 0; place < chip->tm[i].places; place++) {
      struct trax_ref_request *request = &chip->tm[i].queue[place];
      if (request->stage == SERVED && request->completion == UNKNOWN && request->l2_line == miss->line)
        wait_for_line(chip, request, miss);
    }
}

static void pass(struct trax_ref_chip *chip, struct trax_ref_request *request) {
  request->stage = AT_CHANNEL;
  request->came = chip->controller.came++;
}

/* Looks up a read: a line of another cache, or a lwnt. */
static void look_up_read(struct trax_ref_chip *chip, struct trax_ref_request *request, uint32_t line, uint64_t t) {
  struct trax_ref_l2 *l2 = &chip->l2;
  struct trax_memory_stats *stats = chip->stats;
  struct trax_ref_miss *miss;
  if (trax_ref_lines_use(&l2->lines, line)) {
    stats->l2_hits++;
    stats->l2_served_bytes += request->bytes;
    request->stage = SERVED;
    request->completion = t + chip->config->l2.latency_cycles;
  } else if ((miss = on_its_way(l2, line)) != NULL) {
    stats->l2_merged++;
    stats->l2_served_bytes += request->bytes;
    wait_for_line(chip, request, miss);
  } else if (request->kind == LOAD_PAST_CACHE) {
    stats->l2_passed++;
    pass(chip, request);
  } else if (l2->misses == chip->config->l2.mshrs) {
    stats->l2_refused++;
  } else {
    stats->l2_misses++;
    stats->l2_read_bytes += trax_ref_l2_line_cost(chip->config);
    miss = &l2->miss[l2->misses++];
    *miss = (struct trax_ref_miss){.line = line,
                                   .channel = trax_ref_channel_of(chip->config, line * chip->config->l2.line_bytes),
                                   .came = chip->controller.came++,
                                   .arrival = UNKNOWN};
    wait_for_line(chip, request, miss);
  }
}

static void look_up(struct trax_ref_chip *chip, struct trax_ref_request *request, uint64_t t) {
  const uint32_t line = request->address / chip->config->l2.line_bytes;
  if (request->kind != WRITE && request->kind != ATOMIC) {
    look_up_read(chip, request, line, t);
    return;
  }
  if (trax_ref_lines_use(&chip->l2.lines, line)) /* updated in place */
    chip->stats->l2_store_hits++;
  else
    chip->stats->l2_store_misses++;
  pass(chip, request);
}

void trax_ref_l2_cycle(struct trax_ref_chip *chip, uint64_t t) {
  if (!chip->config->l2.bytes)
    return;
  arrive(&chip->l2, t);
  for (uint32_t bank = 0; bank < chip->config->l2.banks; bank++) {
    bool asks[MOST];
    for (uint32_t i = 0; i < chip->tms; i++)
      asks[i] = trax_ref_oldest_at_bank(&chip->tm[i], bank) != NULL;
    const int winner = trax_ref_arbitrate(&chip->l2.bank[bank], asks, chip->tms);
    if (winner >= 0)
      look_up(chip, trax_ref_oldest_at_bank(&chip->tm[winner], bank), t);
  }
}
