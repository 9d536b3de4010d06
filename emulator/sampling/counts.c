#include "sampling/counts.h"

#include "machine/ray_cycles.h"
#include "sampling/estimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef unsigned __int128 trax_wide;

/* The statistics of a TM and of the memory are arrays of 64-bit counters. */
enum {
  TM_WORDS = sizeof(struct trax_tm_stats) / sizeof(uint64_t),
  MEMORY_WORDS = sizeof(struct trax_memory_stats) / sizeof(uint64_t),
  RAY_WORDS = sizeof(trax_ray_counts) / sizeof(uint64_t)
};

#define WORD_OF(member) (offsetof(struct trax_tm_stats, member) / sizeof(uint64_t))

trax_status trax_slot_counts_create(struct trax_slot_counts *counts, struct trax_run *run, size_t most_draws) {
  struct trax_machine *machine = run->machine;
  struct trax_ray_cycles *rays = machine->ray_cycles;
  counts->run = run;
  counts->tp_words = machine->config.chip.tms * (size_t)TM_WORDS;
  counts->memory_words = counts->tp_words + (size_t)machine->stats.threads * TRAX_CAUSE_COUNT;
  counts->ray_words = counts->memory_words + MEMORY_WORDS;
  counts->words = counts->ray_words + (rays ? RAY_WORDS : 0);
  counts->before = calloc(3 * counts->words, sizeof *counts->before);
  counts->measured = calloc(counts->words, sizeof *counts->measured);
  if (rays) {
    rays->parts = calloc(1 + most_draws, sizeof *rays->parts);
    rays->part_count = 1; /* beginning and end */
  }
  if (!counts->before || !counts->measured || (rays && !rays->parts))
    return TRAX_ERROR;
  counts->now = counts->before + counts->words;
  counts->exact = counts->now + counts->words;
  return TRAX_OK;
}

void trax_slot_counts_destroy(struct trax_slot_counts *counts) {
  free(counts->before);
  free(counts->measured);
}

static void read_counts(const struct trax_slot_counts *counts, uint64_t *words) {
  const struct trax_machine *machine = counts->run->machine;
  memcpy(words, machine->tm_stats, counts->tp_words * sizeof *words);
  memcpy(words + counts->tp_words, machine->tp_stats, (counts->memory_words - counts->tp_words) * sizeof *words);
  memcpy(words + counts->memory_words, &machine->stats.memory, sizeof machine->stats.memory);
  if (machine->ray_cycles)
    trax_ray_cycles_sum(machine, *(trax_ray_counts *)(words + counts->ray_words));
}

void trax_slot_counts_begin(struct trax_slot_counts *counts, uint64_t t) {
  trax_run_settle(counts->run, t);
  read_counts(counts, counts->before);
  counts->counted = t;
}

void trax_slot_counts_add_exact(struct trax_slot_counts *counts, uint64_t t) {
  trax_run_settle(counts->run, t);
  read_counts(counts, counts->now);
  for (size_t i = 0; i < counts->words; i++)
    counts->exact[i] += counts->now[i] - counts->before[i];
  counts->exact_counted += t - counts->counted;
}

static void add_unit(struct trax_slot_counts *counts, double weight, uint64_t t) {
  trax_run_settle(counts->run, t);
  read_counts(counts, counts->now);
  for (size_t i = 0; i < counts->words; i++)
    counts->measured[i] += weight * (double)(counts->now[i] - counts->before[i]);
  counts->measured_counted += weight * (double)(t - counts->counted);
}

/* Sets a part to the rays' counts in `now`, less those in `before` if that is not NULL. */
static void set_ray_part(const struct trax_slot_counts *counts, struct trax_ray_part *part, const uint64_t *now,
                         const uint64_t *before) {
  uint64_t *const cells = part->counts[0];
  memcpy(cells, now + counts->ray_words, sizeof part->counts);
  for (size_t i = 0; i < RAY_WORDS && before; i++)
    cells[i] -= before[counts->ray_words + i];
  memset(part->rays, 0, sizeof part->rays);
  for (size_t word = WORD_OF(rays_primary); word < counts->tp_words; word += TM_WORDS)
    for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
      part->rays[kind] += now[word + kind] - (before ? before[word + kind] : 0);
}

/* Keeps the rays' counts of the unit that has been measured by `draws` draws. */
static void add_ray_parts(struct trax_slot_counts *counts, size_t draws, double weight) {
  struct trax_ray_cycles *rays = counts->run->machine->ray_cycles;
  for (; rays && draws > 0; draws--) {
    struct trax_ray_part *part = &rays->parts[rays->part_count++];
    part->weight = weight;
    set_ray_part(counts, part, counts->now, counts->before);
  }
}

void trax_slot_counts_add_unit(struct trax_slot_counts *counts, size_t draws, double size, uint64_t t) {
  add_unit(counts, (double)draws / size, t);
  add_ray_parts(counts, draws, 1 / size);
}

/* Estimates the rays' counters, whose parts are kept. */
static void estimate_rays(struct trax_slot_counts *counts, double factor) {
  const struct trax_machine *machine = counts->run->machine;
  struct trax_ray_cycles *rays = machine->ray_cycles;
  memset(rays->tms, 0, machine->config.chip.tms * sizeof *rays->tms);
  rays->parts[0].weight = 1;
  set_ray_part(counts, &rays->parts[0], counts->exact, NULL);
  for (size_t i = 1; i < rays->part_count; i++)
    rays->parts[i].weight *= factor;
  for (unsigned kind = 0; kind < TRAX_RAY_ROWS; kind++)
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
      double sum = 0;
      for (size_t i = 0; i < rays->part_count; i++)
        sum += rays->parts[i].weight * (double)rays->parts[i].counts[kind][cause];
      rays->tms[0][kind][cause] = (uint64_t)llround(sum);
    }
}

/* Estimates the counters of the whole run: those of beginning and end, and those of the units, scaled to all units. */
static void estimate_counts(struct trax_slot_counts *counts, double cycles) {
  struct trax_machine *machine = counts->run->machine;
  const double factor = (cycles - (double)counts->exact_counted) / counts->measured_counted;
  double charges[TRAX_CAUSE_COUNT];
#define ESTIMATE(i) ((double)counts->exact[i] + factor * counts->measured[i])
  for (uint32_t i = 0; i < counts->run->machine->config.chip.tms; i++) {
    const uint64_t queue_peak = machine->tm_stats[i].queue_peak;
    for (size_t j = 0; j < TM_WORDS; j++)
      ((uint64_t *)&machine->tm_stats[i])[j] = (uint64_t)llround(ESTIMATE(i * (size_t)TM_WORDS + j));
    machine->tm_stats[i].queue_peak = queue_peak;
  }
  for (size_t i = 0; i < MEMORY_WORDS; i++)
    ((uint64_t *)&machine->stats.memory)[i] = (uint64_t)llround(ESTIMATE(counts->memory_words + i));
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++) {
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      charges[cause] = ESTIMATE(counts->tp_words + thread * TRAX_CAUSE_COUNT + cause);
    trax_estimate_charges(&machine->tp_stats[thread], charges, machine->stats.cycles);
  }
  if (machine->ray_cycles)
    estimate_rays(counts, factor);
#undef ESTIMATE
}

/* Scales `kinds` counters of all TMs, at these offsets, so that their sum is `total`. Without a sum, the last one gets
   it. */
static void set_total(struct trax_slot_counts *counts, const size_t *offsets, size_t kinds, uint64_t total) {
  struct trax_machine *machine = counts->run->machine;
  const uint32_t tms = machine->config.chip.tms;
  uint64_t sum = 0, passed = 0, given = 0;
  for (uint32_t i = 0; i < tms; i++)
    for (size_t kind = 0; kind < kinds; kind++)
      sum += ((const uint64_t *)&machine->tm_stats[i])[offsets[kind]];
  for (uint32_t i = 0; i < tms; i++)
    for (size_t kind = 0; kind < kinds; kind++) {
      uint64_t *value = &((uint64_t *)&machine->tm_stats[i])[offsets[kind]];
      passed += *value;
      const bool last = i + 1 == tms && kind + 1 == kinds;
      const uint64_t upto = last ? total : sum ? (uint64_t)((trax_wide)total * passed / sum) : 0;
      *value = upto - given;
      given = upto;
    }
}

/* Sets the rays that are known. Those of a TM are the sum of its kinds, known or not. */
static void set_rays(struct trax_slot_counts *counts, const trax_slot_sampling *asked) {
#define KIND_WORD(X, ID, NAME, ...) WORD_OF(rays_##NAME),
  static const size_t offsets[] = {TRAX_RAY_KINDS(KIND_WORD, )};
#undef KIND_WORD
  struct trax_machine *machine = counts->run->machine;
  bool known = asked->kinds != NULL;
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT && known; kind++) /* the program may call its rays otherwise */
    for (uint32_t i = 0; i < machine->config.chip.tms; i++)
      known &= asked->kinds[kind] || !((const uint64_t *)&machine->tm_stats[i])[offsets[kind]];
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT && known; kind++)
    set_total(counts, &offsets[kind], 1, asked->kinds[kind]);
  if (!known && asked->rays)
    set_total(counts, offsets, TRAX_RAY_KIND_COUNT, asked->rays);
  for (uint32_t i = 0; i < machine->config.chip.tms; i++) {
    machine->tm_stats[i].rays = 0;
    for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
      machine->tm_stats[i].rays += ((const uint64_t *)&machine->tm_stats[i])[offsets[kind]];
  }
}

void trax_slot_counts_estimate(struct trax_slot_counts *counts, const trax_slot_sampling *asked) {
  estimate_counts(counts, (double)counts->run->machine->stats.cycles);
  set_rays(counts, asked);
  if (asked->items)
    set_total(counts, &(const size_t){WORD_OF(items)}, 1, asked->items);
}
