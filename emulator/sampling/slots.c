/* How slots are measured. The run begins as usual, and its end, the last slots and what follows them, is simulated
   completely. In between, only the units of the plan (plan.h) are measured. In an exact run, the times from the
   hand-out of a unit's first slot to that of its last one add up, over all units, to the run's time. So the time of
   each drawn unit is measured, in a machine whose state is close to that of the exact run: between units, the counter
   is set to some slots before the next unit, and threads take these warm-up slots when they have finished the ones they
   have.

   Several queues have a counter each, and advance at different rates: one with cheap slots is ahead of the others. The
   place of a slot is the sum of the counters when it is handed out. The counters are set to the values predicted for
   that place. With equal counters, cheap slots would be measured more often than they occur. Units lie where no queue
   is near its end. */
#include "sampling/slots.h"

#include "machine/ray_cycles.h"
#include "sampling/estimate.h"
#include "sampling/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_STEP = 32, MOST_STEP = 2000 }; /* cycles between inspections of the counters */

__extension__ typedef unsigned __int128 trax_wide;

#define FAR 4 /* times the possible draws. The number of needed draws may be wrong, but not by this factor */

enum phase { BEGINNING, WARM_UP, UNIT, LEAD, END };

/* The statistics of a TM and of the memory are arrays of 64-bit counters. */
enum {
  TM_WORDS = sizeof(struct trax_tm_stats) / sizeof(uint64_t),
  MEMORY_WORDS = sizeof(struct trax_memory_stats) / sizeof(uint64_t),
  RAY_WORDS = sizeof(trax_ray_counts) / sizeof(uint64_t)
};

struct trax_slots {
  struct trax_run *run;
  struct trax_watch watch;
  struct trax_slot_plan plan;
  double *ratios; /* [done]: of each draw, the measured cycles divided by the expected cost */
  size_t done;    /* draws that have been measured */
  bool failed;    /* the wanted interval cannot be reached; the reason is in `error` */
  trax_error error;

  enum phase phase;
  uint32_t target;               /* the place that ends the phase */
  double begun;                  /* the time at which the phase's first slot was handed out */
  uint64_t counted;              /* the cycle in which `before` was read */
  uint32_t last_place;           /* the place at the latest inspection, */
  uint64_t last_cycle;           /* and its cycle */
  double exact_cycles;           /* length of beginning and end */
  double unit_cycles, unit_cost; /* measured time and expected cost of all units so far */
  uint64_t slots_left_out;

  /* Arrays of all counters: first the TMs', then the TPs' charges, the memory's and, if they are counted, the rays'. */
  size_t tp_words, memory_words, ray_words, words; /* the first indices of the latter three, and the length */
  uint64_t *counts;                     /* the allocation of the next three */
  uint64_t *before, *now, *exact;       /* exact: counted in beginning and end */
  double *measured; /* counted in units, divided by their expected costs, since costly units are drawn more often */
  uint64_t exact_counted;  /* cycles of `exact` */
  double measured_counted; /* cycles of `measured`, weighted alike */
};

#define WORD_OF(member) (offsetof(struct trax_tm_stats, member) / sizeof(uint64_t))

/* --- counts --- */

static void read_counts(const struct trax_slots *slots, uint64_t *words) {
  const struct trax_machine *machine = slots->run->machine;
  memcpy(words, machine->tm_stats, slots->tp_words * sizeof *words);
  memcpy(words + slots->tp_words, machine->tp_stats, (slots->memory_words - slots->tp_words) * sizeof *words);
  memcpy(words + slots->memory_words, &machine->stats.memory, sizeof machine->stats.memory);
  if (machine->ray_cycles)
    trax_ray_cycles_sum(machine, *(trax_ray_counts *)(words + slots->ray_words));
}

static void begin_counts(struct trax_slots *slots, uint64_t t) {
  trax_run_settle(slots->run, t);
  read_counts(slots, slots->before);
  slots->counted = t;
}

static void add_exact_counts(struct trax_slots *slots, uint64_t t) {
  trax_run_settle(slots->run, t);
  read_counts(slots, slots->now);
  for (size_t i = 0; i < slots->words; i++)
    slots->exact[i] += slots->now[i] - slots->before[i];
  slots->exact_counted += t - slots->counted;
}

static void add_unit_counts(struct trax_slots *slots, double weight, uint64_t t) {
  trax_run_settle(slots->run, t);
  read_counts(slots, slots->now);
  for (size_t i = 0; i < slots->words; i++)
    slots->measured[i] += weight * (double)(slots->now[i] - slots->before[i]);
  slots->measured_counted += weight * (double)(t - slots->counted);
}

/* Sets a part to the rays' counts in `now`, less those in `before` if that is not NULL. */
static void set_ray_part(const struct trax_slots *slots, struct trax_ray_part *part, const uint64_t *now,
                         const uint64_t *before) {
  uint64_t *const counts = part->counts[0];
  memcpy(counts, now + slots->ray_words, sizeof part->counts);
  for (size_t i = 0; i < RAY_WORDS && before; i++)
    counts[i] -= before[slots->ray_words + i];
  memset(part->rays, 0, sizeof part->rays);
  for (size_t word = WORD_OF(rays_primary); word < slots->tp_words; word += TM_WORDS)
    for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
      part->rays[kind] += now[word + kind] - (before ? before[word + kind] : 0);
}

/* Keeps the rays' counts of the unit that has been measured by `draws` draws. */
static void add_ray_parts(struct trax_slots *slots, size_t draws, double weight) {
  struct trax_ray_cycles *rays = slots->run->machine->ray_cycles;
  for (; rays && draws > 0; draws--) {
    struct trax_ray_part *part = &rays->parts[rays->part_count++];
    part->weight = weight;
    set_ray_part(slots, part, slots->now, slots->before);
  }
}

/* --- phases --- */

static void set_counters(struct trax_slots *slots, uint32_t place, uint64_t t) {
  struct trax_run *run = slots->run;
  trax_run_export(run);
  for (uint32_t queue = 0; queue < slots->plan.asked.queues; queue++) {
    const uint32_t value = trax_slot_plan_handed_out(&slots->plan.asked, queue, place);
    memcpy(run->machine->space.bytes + slots->plan.asked.counter + 4 * queue, &value, sizeof value);
  }
  trax_run_import(run, t);
}

/* Returns the place. Threads go on incrementing the counter of an empty queue, so each is limited to its slots. */
static uint32_t read_counters(const struct trax_slots *slots) {
  uint32_t sum = 0;
  for (uint32_t queue = 0; queue < slots->plan.asked.queues; queue++) {
    const uint32_t most = trax_slot_plan_queue_slots(&slots->plan.asked, queue);
    uint32_t value;
    memcpy(&value, slots->run->machine->space.bytes + slots->plan.asked.counter + 4 * queue, sizeof value);
    sum += value < most ? value : most;
  }
  return sum;
}

/* Half the width of the interval that the draws so far give. */
static double half_of(const struct trax_estimate *estimate) {
  return estimate->half + TRAX_SAMPLING_BIAS * estimate->total;
}

/* Adds the draws that the wanted interval still needs. The end of the run, of which nothing is known yet, only makes it
   narrower. */
static void extend(struct trax_slots *slots) {
  struct trax_slot_plan *plan = &slots->plan;
  const double size = plan->sizes[plan->units];
  const struct trax_estimate middle = trax_estimate_total(slots->ratios, slots->done, size);
  const double wanted = plan->asked.error * (slots->exact_cycles + middle.total);
  if (half_of(&middle) <= wanted)
    return;
  const double needed =
      trax_estimate_draws(slots->ratios, slots->done, size, wanted - TRAX_SAMPLING_BIAS * middle.total);
  if (plan->draw_count == plan->most_draws || needed > FAR * (double)plan->most_draws) {
    slots->failed = true;
    trax_fail(&slots->error,
              "%zu ranges give plus and minus %.2f %%, and %.2f %% would take more ranges than there is work for: ask "
              "for less, for shorter ranges, or simulate all",
              slots->done, 100 * half_of(&middle) / (slots->exact_cycles + middle.total), 100 * plan->asked.error);
    return;
  }
  const double most = fmin(needed, (double)plan->most_draws);
  trax_slot_plan_draw(plan, most > (double)plan->draw_count ? (size_t)most - plan->draw_count : 1);
}

/* Begins the next phase. At time `at` the place was slots->target; in cycle t it is n. */
static void begin_phase(struct trax_slots *slots, double at, uint64_t t, uint32_t n) {
  if (slots->done == slots->plan.draw_count && slots->plan.asked.error > 0)
    extend(slots);
  const bool more = slots->done < slots->plan.draw_count;
  const uint32_t start =
      more ? slots->plan.first + slots->plan.draws[slots->done] * slots->plan.asked.unit : slots->plan.last;
  if (start == slots->target) { /* the next unit begins here: it needs no warm-up */
    slots->phase = more ? UNIT : END;
    slots->begun = at;
    slots->target = more ? start + slots->plan.asked.unit : UINT32_MAX;
    begin_counts(slots, t);
    return;
  }
  slots->phase = more ? WARM_UP : LEAD;
  slots->target = start;
  if (n > start || start - n > slots->plan.asked.warm_up) {
    const uint32_t place = start - slots->plan.asked.warm_up;
    slots->slots_left_out += (uint64_t)place - n; /* negative if slots are simulated again */
    set_counters(slots, place, t);
    slots->last_place = place;
    slots->last_cycle = t;
  }
}

static void end_unit(struct trax_slots *slots, double at, uint64_t t) {
  const double cycles = at - slots->begun, size = trax_slot_plan_size(&slots->plan, slots->plan.draws[slots->done]);
  const size_t before = slots->done;
  slots->unit_cycles += cycles;
  slots->unit_cost += size;
  slots->ratios[slots->done++] = cycles / size;
  while (slots->done < slots->plan.draw_count && slots->plan.draws[slots->done] == slots->plan.draws[slots->done - 1])
    slots->ratios[slots->done++] = cycles / size; /* the same unit was drawn again */
  add_unit_counts(slots, (double)(slots->done - before) / size, t);
  add_ray_parts(slots, slots->done - before, 1 / size);
}

/* Returns the cycle of the next inspection: half-way to the one in which the place should reach the target. */
static uint64_t next_inspection(const struct trax_slots *slots, uint64_t t) {
  if (slots->phase == END)
    return TRAX_NEVER;
  const double left = slots->target - slots->last_place, known = slots->unit_cycles;
  double cycles = slots->last_place ? left * (double)t / slots->last_place : 0, most = MOST_STEP;
  if (known > 0) {
    cycles = (trax_slot_plan_cost_before(&slots->plan, slots->target) -
              trax_slot_plan_cost_before(&slots->plan, slots->last_place)) *
             known / slots->unit_cost;
    most = known / (double)slots->done / 8;
  }
  const double one = cycles / left;
  cycles = fmin(cycles / 2, most);
  return t + (uint64_t)fmax(cycles, fmax(one, LEAST_STEP));
}

/* Ends the phase. At time `at` the place was slots->target; in cycle t it is n. */
static void end_phase(struct trax_slots *slots, double at, uint64_t t, uint32_t n) {
  switch (slots->phase) {
  case BEGINNING:
    slots->exact_cycles = at;
    add_exact_counts(slots, t);
    begin_phase(slots, at, t, n);
    break;
  case UNIT:
    end_unit(slots, at, t);
    begin_phase(slots, at, t, n);
    break;
  case WARM_UP:
  case LEAD:
    slots->phase = slots->phase == LEAD ? END : UNIT;
    slots->begun = at;
    slots->target = slots->phase == END ? UINT32_MAX : slots->target + slots->plan.asked.unit;
    begin_counts(slots, t);
    break;
  case END:
    break;
  }
}

static trax_status inspect(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct trax_slots *slots = watch->context;
  uint32_t n = read_counters(slots);
  (void)run;
  while (n >= slots->target) { /* the time at which the place was `target` is interpolated */
    const double share = (double)(slots->target - slots->last_place) / (n - slots->last_place);
    const double at = (double)slots->last_cycle + share * (double)(t - slots->last_cycle);
    end_phase(slots, at, t, n);
    if (slots->last_cycle == t) /* begin_phase has set the counters */
      n = slots->last_place;
  }
  slots->last_place = n;
  slots->last_cycle = t;
  watch->next = next_inspection(slots, t);
  return slots->failed ? TRAX_ERROR : TRAX_OK;
}

/* --- the run --- */

struct trax_slots *trax_slots_create(struct trax_run *run, const trax_slot_sampling *sampling, trax_error *error) {
  struct trax_machine *machine = run->machine;
  const uint32_t threads = (uint32_t)machine->stats.threads;
  struct trax_slots *slots = calloc(1, sizeof *slots);
  if (!slots) {
    trax_fail(error, "out of memory");
    return NULL;
  }
  slots->run = run;
  if (trax_slot_plan_create(&slots->plan, machine, sampling, error) != TRAX_OK) {
    trax_slots_destroy(slots);
    return NULL;
  }
  slots->tp_words = machine->config.chip.tms * (size_t)TM_WORDS;
  slots->memory_words = slots->tp_words + (size_t)threads * TRAX_CAUSE_COUNT;
  slots->ray_words = slots->memory_words + MEMORY_WORDS;
  slots->words = slots->ray_words + (machine->ray_cycles ? RAY_WORDS : 0);
  slots->counts = calloc(3 * slots->words, sizeof *slots->counts);
  slots->measured = calloc(slots->words, sizeof *slots->measured);
  slots->ratios = calloc(slots->plan.most_draws ? slots->plan.most_draws : 1, sizeof *slots->ratios);
  bool created = slots->counts && slots->measured && slots->ratios;
  if (machine->ray_cycles) {
    struct trax_ray_cycles *rays = machine->ray_cycles;
    rays->parts = calloc(1 + slots->plan.most_draws, sizeof *rays->parts);
    rays->part_count = 1; /* beginning and end */
    created &= rays->parts != NULL;
  }
  if (!created) {
    trax_fail(error, "out of memory for the counts of sampled slots");
    trax_slots_destroy(slots);
    return NULL;
  }
  slots->before = slots->counts;
  slots->now = slots->before + slots->words;
  slots->exact = slots->now + slots->words;
  slots->target = slots->plan.first;
  slots->watch =
      (struct trax_watch){.next = slots->plan.units ? LEAST_STEP : TRAX_NEVER, .inspect = inspect, .context = slots};
  trax_machine_watch(machine, &slots->watch);
  return slots;
}

void trax_slots_destroy(struct trax_slots *slots) {
  if (!slots)
    return;
  trax_machine_unwatch(slots->run->machine, &slots->watch);
  trax_slot_plan_destroy(&slots->plan);
  free(slots->ratios);
  free(slots->counts);
  free(slots->measured);
  free(slots);
}

/* The same of the rays' counters, whose parts are kept. */
static void estimate_rays(struct trax_slots *slots, double factor) {
  const struct trax_machine *machine = slots->run->machine;
  struct trax_ray_cycles *rays = machine->ray_cycles;
  memset(rays->tms, 0, machine->config.chip.tms * sizeof *rays->tms);
  rays->parts[0].weight = 1;
  set_ray_part(slots, &rays->parts[0], slots->exact, NULL);
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
static void estimate_counts(struct trax_slots *slots, double cycles) {
  struct trax_machine *machine = slots->run->machine;
  const double factor = (cycles - (double)slots->exact_counted) / slots->measured_counted;
  double charges[TRAX_CAUSE_COUNT];
#define ESTIMATE(i) ((double)slots->exact[i] + factor * slots->measured[i])
  for (uint32_t i = 0; i < slots->run->machine->config.chip.tms; i++) {
    const uint64_t queue_peak = machine->tm_stats[i].queue_peak;
    for (size_t j = 0; j < TM_WORDS; j++)
      ((uint64_t *)&machine->tm_stats[i])[j] = (uint64_t)llround(ESTIMATE(i * (size_t)TM_WORDS + j));
    machine->tm_stats[i].queue_peak = queue_peak;
  }
  for (size_t i = 0; i < MEMORY_WORDS; i++)
    ((uint64_t *)&machine->stats.memory)[i] = (uint64_t)llround(ESTIMATE(slots->memory_words + i));
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++) {
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      charges[cause] = ESTIMATE(slots->tp_words + thread * TRAX_CAUSE_COUNT + cause);
    trax_estimate_charges(&machine->tp_stats[thread], charges, machine->stats.cycles);
  }
  if (machine->ray_cycles)
    estimate_rays(slots, factor);
#undef ESTIMATE
}

/* Scales `kinds` counters of all TMs, at these offsets, so that their sum is `total`. Without a sum, the last one gets
   it. */
static void set_total(struct trax_slots *slots, const size_t *offsets, size_t kinds, uint64_t total) {
  struct trax_machine *machine = slots->run->machine;
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
static void set_rays(struct trax_slots *slots) {
#define KIND_WORD(X, ID, NAME, ...) WORD_OF(rays_##NAME),
  static const size_t offsets[] = {TRAX_RAY_KINDS(KIND_WORD, )};
#undef KIND_WORD
  struct trax_machine *machine = slots->run->machine;
  const trax_slot_sampling *asked = &slots->plan.asked;
  bool known = asked->kinds != NULL;
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT && known; kind++) /* the program may call its rays otherwise */
    for (uint32_t i = 0; i < machine->config.chip.tms; i++)
      known &= asked->kinds[kind] || !((const uint64_t *)&machine->tm_stats[i])[offsets[kind]];
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT && known; kind++)
    set_total(slots, &offsets[kind], 1, asked->kinds[kind]);
  if (!known && asked->rays)
    set_total(slots, offsets, TRAX_RAY_KIND_COUNT, asked->rays);
  for (uint32_t i = 0; i < machine->config.chip.tms; i++) {
    machine->tm_stats[i].rays = 0;
    for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
      machine->tm_stats[i].rays += ((const uint64_t *)&machine->tm_stats[i])[offsets[kind]];
  }
}

trax_status trax_slots_finish(struct trax_slots *slots, uint64_t t, trax_error *error) {
  struct trax_machine *machine = slots->run->machine;
  struct trax_sampling_stats *stats = &machine->stats.sampling;
  *stats = (struct trax_sampling_stats){
      .is_sampled = true,
      .predicted = slots->plan.asked.costs ? trax_slot_plan_cost_before(&slots->plan, slots->plan.asked.slots) : 0,
      .asked = slots->plan.asked,
      .low = (double)t,
      .high = (double)t,
      .detailed_cycles = t,
      .detailed_slots = slots->plan.asked.slots};
  stats->asked.costs = NULL; /* the caller may release them */
  stats->asked.handed_out = NULL;
  stats->asked.kinds = NULL;
  for (uint32_t i = 0; i < slots->run->machine->config.chip.tms; i++)
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      stats->detailed_instructions += machine->tm_stats[i].instructions[op];
  if (slots->failed)
    return trax_fail(error, "%s", slots->error.message);
  if (!slots->plan.units) {
    if (machine->ray_cycles)
      machine->ray_cycles->part_count = 0;
    return TRAX_OK;
  }
  if (slots->phase != END)
    return trax_fail(error,
                     "the program ended before its counter at 0x%08x reached slot %u of %u: the slots are not "
                     "taken by increments of this word",
                     slots->plan.asked.counter, slots->target, slots->plan.asked.slots);
  add_exact_counts(slots, t);
  slots->exact_cycles += (double)t - slots->begun;
  const struct trax_estimate middle =
      trax_estimate_total(slots->ratios, slots->done, slots->plan.sizes[slots->plan.units]);
  const double cycles = slots->exact_cycles + middle.total;
  machine->stats.cycles = (uint64_t)llround(cycles);
  stats->windows = slots->done;
  const double half = half_of(&middle);
  stats->low = fmax(cycles - half, slots->exact_cycles);
  stats->high = cycles + half;
  stats->detailed_slots -= slots->slots_left_out;
  estimate_counts(slots, (double)machine->stats.cycles);
  set_rays(slots);
  if (slots->plan.asked.items)
    set_total(slots, &(const size_t){WORD_OF(items)}, 1, slots->plan.asked.items);
  return TRAX_OK;
}
