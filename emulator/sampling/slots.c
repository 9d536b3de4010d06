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
#include "sampling/counts.h"
#include "sampling/estimate.h"
#include "sampling/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_STEP = 32, MOST_STEP = 2000 }; /* cycles between inspections of the counters */

#define FAR 4 /* times the possible draws. The number of needed draws may be wrong, but not by this factor */

enum phase { BEGINNING, WARM_UP, UNIT, LEAD, END };

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
  uint32_t last_place;           /* the place at the latest inspection, */
  uint64_t last_cycle;           /* and its cycle */
  double exact_cycles;           /* length of beginning and end */
  double unit_cycles, unit_cost; /* measured time and expected cost of all units so far */
  uint64_t slots_left_out;

  struct trax_slot_counts counts;
};

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

/* Adds the draws that the wanted interval still needs. The end of the run is not known yet, and only makes the interval
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
    trax_slot_counts_begin(&slots->counts, t);
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
  trax_slot_counts_add_unit(&slots->counts, slots->done - before, size, t);
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
    trax_slot_counts_add_exact(&slots->counts, t);
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
    trax_slot_counts_begin(&slots->counts, t);
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
  slots->ratios = calloc(slots->plan.most_draws ? slots->plan.most_draws : 1, sizeof *slots->ratios);
  if (!slots->ratios || trax_slot_counts_create(&slots->counts, run, slots->plan.most_draws) != TRAX_OK) {
    trax_fail(error, "out of memory for the counts of sampled slots");
    trax_slots_destroy(slots);
    return NULL;
  }
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
  trax_slot_counts_destroy(&slots->counts);
  free(slots);
}

/* How many cycles the end took longer than expected. A thread that was in a long slot at a jump is still in it: in the
   exact run this slot may have ended long before. */
static double late_end(const struct trax_slots *slots, uint64_t t) {
  const struct trax_slot_plan *plan = &slots->plan;
  const double expected =
      trax_slot_plan_cost_before(plan, plan->asked.slots) - trax_slot_plan_cost_before(plan, plan->last);
  return fmax((double)t - slots->begun - expected * slots->unit_cycles / slots->unit_cost, 0);
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
  trax_slot_counts_add_exact(&slots->counts, t);
  slots->exact_cycles += (double)t - slots->begun;
  const struct trax_estimate middle =
      trax_estimate_total(slots->ratios, slots->done, slots->plan.sizes[slots->plan.units]);
  const double cycles = slots->exact_cycles + middle.total;
  machine->stats.cycles = (uint64_t)llround(cycles);
  stats->windows = slots->done;
  const double half = half_of(&middle), late = late_end(slots, t);
  stats->low = fmax(cycles - half, slots->exact_cycles) - late;
  stats->high = cycles + half;
  stats->detailed_slots -= slots->slots_left_out;
  trax_slot_counts_estimate(&slots->counts, &slots->plan.asked);
  return TRAX_OK;
}
