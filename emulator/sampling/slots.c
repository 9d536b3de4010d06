/* How slots are sampled. The run is begun as ever and its end, the last slots and what follows them, is simulated too;
   of what lies between, ranges of `unit` slots are drawn with probabilities in proportion to what they are expected to
   cost, one from each of as many parts of equal cost as there are draws. In the exact run, the time from when a range's
   first slot is handed out until its last one is sums up, over all ranges, to the run's. So each range's time is
   measured, in a machine brought near the state that it would be in: between ranges the counter is set to some slots
   before the next one, and threads take these as soon as they are done with what they have.

   Of several queues with a counter each, the place of a slot is the sum of the counters when it is handed out, and
   they are set to where they are thought to be then: queues with cheap slots are ahead of others, and were they not,
   cheap slots would be measured more often than they are met. Ranges lie where no queue is near its end. */
#include "sampling/slots.h"

#include "sampling/estimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  LEAST_DRAWS = 16,
  PILOT_DRAWS = 24, /* after which it is known how many an interval takes */
  LEAST_UNIT = 256,
  UNIT_ROUNDS = 2, /* slots of each thread, unless it is asked for otherwise */
  WARM_UP_ROUNDS = 4,
  LEAST_STEP = 32, /* cycles from one look at the counter to the next */
  MOST_STEP = 2000
};

#define LEAST_COST 0.02 /* of a unit, relative to the mean: what was thought to cost nothing may cost something */
#define ENOUGH 0.8      /* of the slots: then all of them might as well be simulated */
#define BIAS 0.01       /* of what is estimated: what a warm-up leaves of another place's caches (docs/sampling.md) */

enum phase { BEGINNING, WARM_UP, UNIT, LEAD, END };

/* All that is counted: the TMs' statistics, the TPs' charges, and beyond the TMs. */
enum {
  TM_WORDS = sizeof(struct trax_tm_stats) / sizeof(uint64_t),
  MEMORY_WORDS = sizeof(struct trax_memory_stats) / sizeof(uint64_t)
};

struct trax_slots {
  struct trax_run *run;
  struct trax_watch watch;
  trax_slot_sampling asked;
  uint64_t random;

  uint32_t first, last, units; /* slots: the first unit's, and the first behind the last one */
  double *sizes;               /* [units + 1]: what the units before each are expected to cost */
  uint32_t *draws;             /* [draw_count]: units, in the order of simulation */
  double *ratios;              /* [done]: cycles measured for what was expected, of a draw each */
  size_t draw_count, done, most_draws;
  bool extended; /* draws were added after a pilot */

  enum phase phase;
  uint32_t target;  /* the place that ends the phase */
  double begun;     /* when the phase's first slot was handed out */
  uint64_t counted; /* when `before` was read */
  uint32_t seen;    /* the place, when it was looked at last, in cycle */
  uint64_t seen_at;
  double exact_cycles;           /* of beginning and end */
  double unit_cycles, unit_cost; /* measured, and expected, of all units so far */
  uint64_t slots_left_out;

  size_t tp_words, memory_words, words; /* where the TPs' and the memory's counts begin, and how many there are */
  uint64_t *counts;                     /* the next three */
  uint64_t *before, *now, *exact;
  double *measured; /* of draws, by their expected costs: what costs more is drawn more often, and counts no more */
  uint64_t exact_counted;
  double measured_counted; /* cycles that these are about */
};

/* --- counts --- */

static void read_counts(const struct trax_slots *slots, uint64_t *words) {
  const struct trax_machine *machine = slots->run->machine;
  memcpy(words, machine->tm_stats, slots->tp_words * sizeof *words);
  memcpy(words + slots->tp_words, machine->tp_stats, (slots->memory_words - slots->tp_words) * sizeof *words);
  memcpy(words + slots->memory_words, &machine->stats.memory, sizeof machine->stats.memory);
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

/* --- draws --- */

static uint64_t scrambled(uint64_t seed) { /* splitmix64 */
  seed = (seed ^ seed >> 30) * 0xBF58476D1CE4E5B9u;
  seed = (seed ^ seed >> 27) * 0x94D049BB133111EBu;
  return seed ^ seed >> 31;
}

/* From 0 to below 1. */
static double any(struct trax_slots *slots) {
  return (double)(scrambled(slots->random += 0x9E3779B97F4A7C15u) >> 11) * 0x1p-53;
}

static double size_of(const struct trax_slots *slots, uint32_t unit) {
  return slots->sizes[unit + 1] - slots->sizes[unit];
}

/* `count` more, one from each part of equal cost, as far as there is room. */
static void draw(struct trax_slots *slots, size_t count) {
  const size_t room = slots->most_draws - slots->draw_count;
  count = count < room ? count : room;
  for (size_t i = 0; i < count; i++)
    slots->draws[slots->draw_count++] = trax_estimate_unit(
        slots->sizes, slots->units, slots->sizes[slots->units] * ((double)i + any(slots)) / (double)count);
}

/* --- the plan --- */

static double cost_before(const struct trax_slots *slots, uint32_t slot) {
  const trax_slot_sampling *asked = &slots->asked;
  if (!asked->costs)
    return slot;
  const uint32_t block = slot / asked->block, left = slot % asked->block;
  const double cost = asked->costs[block];
  return left ? cost + (asked->costs[block + 1] - cost) * left / asked->block : cost;
}

static uint32_t rounded_up(uint64_t value, uint32_t multiple) {
  return (uint32_t)((value + multiple - 1) / multiple * multiple);
}

/* How many draws simulate that share of the work, warm-ups included. */
static double draws_for(const struct trax_slots *slots, double fraction) {
  double squares = 0;
  for (uint32_t i = 0; i < slots->units; i++)
    squares += pow(size_of(slots, i), 2);
  const double drawn = squares / slots->sizes[slots->units]; /* the expected size of a draw */
  const double with_warm_up = drawn * (1 + (double)slots->asked.warm_up / slots->asked.unit);
  return fraction * slots->sizes[slots->units] / with_warm_up;
}

static uint32_t queue_slots(const trax_slot_sampling *asked, uint32_t queue) {
  if (asked->queues == 1) /* which has no tiles */
    return asked->slots;
  const uint32_t tiles = asked->slots / asked->tile;
  return (tiles - queue + asked->queues - 1) / asked->queues * asked->tile;
}

/* How many slots a queue has handed out where `place`, a multiple of the block, begins. */
static uint32_t handed_out(const trax_slot_sampling *asked, uint32_t queue, uint32_t place) {
  if (asked->queues == 1)
    return place;
  if (asked->handed_out)
    return asked->handed_out[(size_t)(place / asked->block) * asked->queues + queue];
  const uint32_t round = asked->tile * asked->queues, begun = place % round, before = queue * asked->tile;
  const uint32_t more = begun > before ? begun - before : 0;
  return place / round * asked->tile + (more < asked->tile ? more : asked->tile);
}

/* The last place, a multiple of the block, where so many slots are left, of each queue its part of them. */
static uint32_t place_with(const trax_slot_sampling *asked, uint64_t left) {
  uint64_t most = asked->slots > left ? asked->slots - left : 0, least = 0;
  if (asked->queues == 1)
    return (uint32_t)most;
  least /= asked->block, most /= asked->block;
  while (least < most) {
    const uint64_t middle = (least + most + 1) / 2;
    bool enough = true;
    for (uint32_t queue = 0; queue < asked->queues && enough; queue++)
      enough =
          handed_out(asked, queue, (uint32_t)middle * asked->block) + left / asked->queues <= queue_slots(asked, queue);
    least = enough ? middle : least;
    most = enough ? most : middle - 1;
  }
  return (uint32_t)(least * asked->block);
}

static bool make_room(struct trax_slots *slots, size_t most) {
  slots->most_draws = most;
  slots->draws = calloc(most, sizeof *slots->draws);
  slots->ratios = calloc(most, sizeof *slots->ratios);
  return slots->draws && slots->ratios;
}

/* Units, their sizes, and draws; slots->units stays 0 if all is to be simulated. */
static trax_status plan(struct trax_slots *slots, uint32_t threads, trax_error *error) {
  trax_slot_sampling *asked = &slots->asked;
  asked->block = asked->block ? asked->block : 1;
  asked->queues = asked->queues ? asked->queues : 1;
  const uint64_t unit = UNIT_ROUNDS * (uint64_t)threads;
  asked->unit = rounded_up(asked->unit ? asked->unit : unit > LEAST_UNIT ? unit : LEAST_UNIT, asked->block);
  asked->warm_up = rounded_up(asked->warm_up ? asked->warm_up : WARM_UP_ROUNDS * (uint64_t)threads, asked->block);
  asked->seed = asked->seed ? asked->seed : 1;
  slots->random = scrambled(asked->seed << 32 | slots->run->machine->config.chip.tms << 16 |
                            threads); /* chips choose differently */
  slots->first = rounded_up(asked->warm_up > unit ? asked->warm_up : unit, asked->block);
  const uint64_t end = place_with(asked, asked->warm_up + (uint64_t)threads), ends = slots->first + asked->slots - end;
  if (asked->fraction >= 1 || ends >= asked->slots)
    return TRAX_OK;
  const uint32_t units = (uint32_t)((asked->slots - ends) / asked->unit);
  slots->last = slots->first + units * asked->unit;
  slots->sizes = calloc((size_t)units + 1, sizeof *slots->sizes);
  if (!slots->sizes)
    return trax_fail(error, "out of memory for %u ranges of slots", units);
  const double mean = units ? (cost_before(slots, slots->last) - cost_before(slots, slots->first)) / units : 0;
  for (uint32_t i = 0; i < units; i++) {
    const uint32_t slot = slots->first + i * asked->unit;
    const double cost = cost_before(slots, slot + asked->unit) - cost_before(slots, slot);
    slots->sizes[i + 1] = slots->sizes[i] + cost + LEAST_COST * (mean > 0 ? mean : 1);
  }
  slots->units = units;
  double count = units ? asked->error > 0 ? PILOT_DRAWS : draws_for(slots, asked->fraction) : 0;
  count = count < LEAST_DRAWS ? LEAST_DRAWS : count;
  if (ends + count * ((double)asked->unit + asked->warm_up) > ENOUGH * asked->slots)
    slots->units = 0;
  else if (!make_room(slots, (size_t)(ENOUGH * asked->slots / ((double)asked->unit + asked->warm_up))))
    return trax_fail(error, "out of memory for ranges of slots");
  if (slots->units)
    draw(slots, (size_t)count);
  return TRAX_OK;
}

/* --- phases --- */

static void set_counters(struct trax_slots *slots, uint32_t place, uint64_t t) {
  struct trax_run *run = slots->run;
  trax_run_export(run);
  for (uint32_t queue = 0; queue < slots->asked.queues; queue++) {
    const uint32_t value = handed_out(&slots->asked, queue, place);
    memcpy(run->machine->space.bytes + slots->asked.counter + 4 * queue, &value, sizeof value);
  }
  trax_run_import(run, t);
}

/* The place. A counter goes on where its queue is empty. */
static uint32_t read_counters(const struct trax_slots *slots) {
  uint32_t sum = 0;
  for (uint32_t queue = 0; queue < slots->asked.queues; queue++) {
    const uint32_t most = queue_slots(&slots->asked, queue);
    uint32_t value;
    memcpy(&value, slots->run->machine->space.bytes + slots->asked.counter + 4 * queue, sizeof value);
    sum += value < most ? value : most;
  }
  return sum;
}

/* After a pilot: as many draws as the interval takes, or as make sense. */
static void extend(struct trax_slots *slots) {
  const size_t needed = trax_estimate_draws(slots->ratios, slots->done, slots->asked.error);
  slots->extended = true;
  draw(slots, needed - slots->draw_count);
}

/* At time `at`, in cycle t, the place, which is n now, was slots->target. */
static void go_on(struct trax_slots *slots, double at, uint64_t t, uint32_t n) {
  if (slots->done == slots->draw_count && slots->asked.error > 0 && !slots->extended)
    extend(slots);
  const bool more = slots->done < slots->draw_count;
  const uint32_t start = more ? slots->first + slots->draws[slots->done] * slots->asked.unit : slots->last;
  if (start == slots->target) { /* the next one is the next slot's */
    slots->phase = more ? UNIT : END;
    slots->begun = at;
    slots->target = more ? start + slots->asked.unit : UINT32_MAX;
    begin_counts(slots, t);
    return;
  }
  slots->phase = more ? WARM_UP : LEAD;
  slots->target = start;
  if (n > start || start - n > slots->asked.warm_up) {
    const uint32_t place = start - slots->asked.warm_up;
    slots->slots_left_out += (uint64_t)place - n; /* going back counts what is simulated twice */
    set_counters(slots, place, t);
    slots->seen = place;
    slots->seen_at = t;
  }
}

static void end_unit(struct trax_slots *slots, double at, uint64_t t) {
  const double cycles = at - slots->begun, size = size_of(slots, slots->draws[slots->done]);
  const size_t before = slots->done;
  slots->unit_cycles += cycles;
  slots->unit_cost += size;
  slots->ratios[slots->done++] = cycles / size;
  while (slots->done < slots->draw_count && slots->draws[slots->done] == slots->draws[slots->done - 1])
    slots->ratios[slots->done++] = cycles / size; /* drawn again */
  add_unit_counts(slots, (double)(slots->done - before) / size, t);
}

/* When to look next: somewhat before the place is expected to reach the target. */
static uint64_t next_look(const struct trax_slots *slots, uint64_t t) {
  if (slots->phase == END)
    return TRAX_NEVER;
  const double left = slots->target - slots->seen, known = slots->unit_cycles;
  double cycles = slots->seen ? left * (double)t / slots->seen : 0, most = MOST_STEP;
  if (known > 0) {
    cycles = (cost_before(slots, slots->target) - cost_before(slots, slots->seen)) * known / slots->unit_cost;
    most = known / (double)slots->done / 8;
  }
  const double one = cycles / left;
  cycles = fmin(cycles / 2, most);
  return t + (uint64_t)fmax(cycles, fmax(one, LEAST_STEP));
}

/* The phase ends: at time `at`, before cycle t, when the place is n. */
static void end_phase(struct trax_slots *slots, double at, uint64_t t, uint32_t n) {
  switch (slots->phase) {
  case BEGINNING:
    slots->exact_cycles = at;
    add_exact_counts(slots, t);
    go_on(slots, at, t, n);
    break;
  case UNIT:
    end_unit(slots, at, t);
    go_on(slots, at, t, n);
    break;
  case WARM_UP:
  case LEAD:
    slots->phase = slots->phase == LEAD ? END : UNIT;
    slots->begun = at;
    slots->target = slots->phase == END ? UINT32_MAX : slots->target + slots->asked.unit;
    begin_counts(slots, t);
    break;
  case END:
    break;
  }
}

static trax_status look(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct trax_slots *slots = watch->context;
  uint32_t n = read_counters(slots);
  (void)run;
  while (n >= slots->target) { /* it was passed between the last look and this one, at an even pace */
    const double share = (double)(slots->target - slots->seen) / (n - slots->seen);
    const double at = (double)slots->seen_at + share * (double)(t - slots->seen_at);
    end_phase(slots, at, t, n);
    if (slots->seen_at == t) /* the counters were set */
      n = slots->seen;
  }
  slots->seen = n;
  slots->seen_at = t;
  watch->next = next_look(slots, t);
  return TRAX_OK;
}

/* --- the run --- */

static trax_status check_queues(const trax_slot_sampling *asked, trax_error *error) {
  if (asked->queues > TRAX_MAX_SLOT_QUEUES)
    return trax_fail(error, "slots wait in %u queues; allowed are %d at most", asked->queues, TRAX_MAX_SLOT_QUEUES);
  if (asked->queues < 2)
    return TRAX_OK;
  if (!asked->tile || asked->slots % asked->tile)
    return trax_fail(error, "%u slots of several queues are not whole tiles of %u", asked->slots, asked->tile);
  if (asked->handed_out && !asked->block)
    return trax_fail(error, "what queues have handed out needs the number of slots in a block");
  for (uint64_t place = 0; asked->handed_out && place < asked->slots; place += asked->block) {
    const uint32_t *row = &asked->handed_out[place / asked->block * asked->queues];
    uint64_t sum = 0;
    for (uint32_t queue = 0; queue < asked->queues; queue++) {
      if (row[queue] > queue_slots(asked, queue) || (place && row[queue] < (row - asked->queues)[queue]))
        return trax_fail(error, "queue %u cannot have handed out %u slots at slot %llu", queue, row[queue],
                         (unsigned long long)place);
      sum += row[queue];
    }
    if (sum != place)
      return trax_fail(error, "queues have handed out %llu slots at slot %llu", (unsigned long long)sum,
                       (unsigned long long)place);
  }
  return TRAX_OK;
}

static trax_status check(const trax_slot_sampling *asked, const struct trax_machine *machine, trax_error *error) {
  const uint32_t words = asked->queues ? asked->queues : 1;
  if (asked->counter % 4 || asked->counter + 4 * (uint64_t)words > machine->space.size)
    return trax_fail(error, "the counter of slots at 0x%08x is not a word of global memory", asked->counter);
  if (!asked->slots)
    return trax_fail(error, "there are no slots to sample");
  if (check_queues(asked, error))
    return TRAX_ERROR;
  if (!(asked->error > 0) && !(asked->fraction > 0 && asked->fraction <= 1))
    return trax_fail(error, "the fraction of slots to simulate is %g; allowed is above 0 to 1", asked->fraction);
  if (asked->error < 0 || asked->error >= 1 || isnan(asked->error))
    return trax_fail(error, "the error wanted is %g; allowed is 0 to below 1", asked->error);
  if (asked->costs && !asked->block)
    return trax_fail(error, "costs of slots need the number of slots in a block");
  for (uint32_t i = 0; asked->costs && i * (uint64_t)asked->block < asked->slots; i++)
    if (!(asked->costs[i + 1] >= asked->costs[i]) || !isfinite(asked->costs[i + 1]))
      return trax_fail(error, "the cost of the slots from %u on is not a number of 0 or more", i * asked->block);
  return TRAX_OK;
}

struct trax_slots *trax_slots_create(struct trax_run *run, const trax_slot_sampling *sampling, trax_error *error) {
  struct trax_machine *machine = run->machine;
  const uint32_t threads = (uint32_t)machine->stats.threads;
  if (check(sampling, machine, error))
    return NULL;
  struct trax_slots *slots = calloc(1, sizeof *slots);
  if (!slots) {
    trax_fail(error, "out of memory");
    return NULL;
  }
  slots->run = run;
  slots->asked = *sampling;
  slots->tp_words = machine->config.chip.tms * (size_t)TM_WORDS;
  slots->memory_words = slots->tp_words + (size_t)threads * TRAX_CAUSE_COUNT;
  slots->words = slots->memory_words + MEMORY_WORDS;
  slots->counts = calloc(3 * slots->words, sizeof *slots->counts);
  slots->measured = calloc(slots->words, sizeof *slots->measured);
  if (!slots->counts || !slots->measured || plan(slots, threads, error)) {
    if (!slots->counts || !slots->measured)
      trax_fail(error, "out of memory");
    trax_slots_destroy(slots);
    return NULL;
  }
  slots->before = slots->counts;
  slots->now = slots->before + slots->words;
  slots->exact = slots->now + slots->words;
  slots->target = slots->first;
  slots->watch = (struct trax_watch){.next = slots->units ? LEAST_STEP : TRAX_NEVER, .look = look, .context = slots};
  trax_machine_watch(machine, &slots->watch);
  return slots;
}

void trax_slots_destroy(struct trax_slots *slots) {
  if (!slots)
    return;
  trax_machine_unwatch(slots->run->machine, &slots->watch);
  free(slots->sizes);
  free(slots->draws);
  free(slots->ratios);
  free(slots->counts);
  free(slots->measured);
  free(slots);
}

/* The counts of the whole run: those of beginning and end, and of the units as many times as these stand for. */
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
#undef ESTIMATE
}

/* Makes the sum over the TMs what it is known to be, the shares of the TMs staying about what they are. */
static void set_total(struct trax_slots *slots, size_t offset, uint64_t total) {
  uint64_t sum = 0, given = 0;
  for (uint32_t i = 0; i < slots->run->machine->config.chip.tms; i++)
    sum += ((const uint64_t *)&slots->run->machine->tm_stats[i])[offset];
  for (uint32_t i = 0; i < slots->run->machine->config.chip.tms && total; i++) {
    uint64_t *value = &((uint64_t *)&slots->run->machine->tm_stats[i])[offset];
    *value = i + 1 == slots->run->machine->config.chip.tms
                 ? total - given
                 : (uint64_t)((double)*value / (double)(sum ? sum : 1) * (double)total);
    given += *value;
  }
}

trax_status trax_slots_finish(struct trax_slots *slots, uint64_t t, trax_error *error) {
  struct trax_machine *machine = slots->run->machine;
  struct trax_sampling_stats *stats = &machine->stats.sampling;
  *stats = (struct trax_sampling_stats){.is_sampled = true,
                                        .predicted = slots->asked.costs ? cost_before(slots, slots->asked.slots) : 0,
                                        .asked = slots->asked,
                                        .low = (double)t,
                                        .high = (double)t,
                                        .detailed_cycles = t,
                                        .detailed_slots = slots->asked.slots};
  for (uint32_t i = 0; i < slots->run->machine->config.chip.tms; i++)
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      stats->detailed_instructions += machine->tm_stats[i].instructions[op];
  if (!slots->units)
    return TRAX_OK;
  if (slots->phase != END)
    return trax_fail(error,
                     "the program ended before its counter at 0x%08x reached slot %u of %u: the slots are not "
                     "taken by increments of this word",
                     slots->asked.counter, slots->target, slots->asked.slots);
  add_exact_counts(slots, t);
  slots->exact_cycles += (double)t - slots->begun;
  const struct trax_estimate middle = trax_estimate_total(slots->ratios, slots->done, slots->sizes[slots->units]);
  const double cycles = slots->exact_cycles + middle.total;
  machine->stats.cycles = (uint64_t)llround(cycles);
  stats->windows = slots->done;
  const double half = middle.half + BIAS * middle.total;
  stats->low = fmax(cycles - half, slots->exact_cycles);
  stats->high = cycles + half;
  stats->detailed_slots -= slots->slots_left_out;
  estimate_counts(slots, (double)machine->stats.cycles);
  set_total(slots, offsetof(struct trax_tm_stats, rays) / sizeof(uint64_t), slots->asked.rays);
  set_total(slots, offsetof(struct trax_tm_stats, items) / sizeof(uint64_t), slots->asked.items);
  return TRAX_OK;
}
