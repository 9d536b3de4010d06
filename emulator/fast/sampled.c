/* Sampled simulation, in the manner of SMARTS (Wunderlich, Wenisch, Falsafi, Hoe: "SMARTS: Accelerating
   Microarchitecture Simulation via Rigorous Statistical Sampling", ISCA 2003), for many threads that share one chip.

   A sampling unit is a window of some cycles of the whole chip. Between windows lies a gap: the functional mode
   executes a number of instructions, all threads at an equal pace, at its end in short turns and with the caches' tags
   following; then the exact engine warms up queues, units and the threads' distribution over the program, not yet
   measured. The instructions of all gaps of a stratum times cycles per instruction of its windows (a ratio estimate) is
   the gaps' time. The more samples there are, the further apart they come: each stratum has twice the period of the one
   before.

   Where threads end, time is not proportional to instructions: the beginning, and everything from the first end of a
   thread until no other has ended for some time, is simulated exactly. A gap stops when a thread ends in it.

   What is on its way to or from memory stays so during a gap, with the registers and threads that wait for it: in the
   threads' new places such waits are as likely as in the old ones, and the warm-up begins with queues as full as they
   were. Only what an increment under way would do to registers and memory is done at once. */
#include "fast/sampled.h"

#include "core/estimate.h"
#include "fast/functional.h"

#include <math.h>
#include <string.h>

/* What is not asked for otherwise. */
enum {
  PERIOD = 8000,       /* instructions of each thread */
  LEAST_WINDOW = 1000, /* cycles */
  HOLD = 20000,
  BEGINNING = 4 /* a fourth of that is simulated before the first gap */
};

enum { MOST_PENALTY = 10000, MOST_DRAIN = 1000000, STRATUM_WINDOWS = 16, LONGEST_PERIOD = 100000000 };

/* All that is counted: the TMs' statistics, the TPs' charges, and beyond the TMs. */
enum {
  TM_WORDS = sizeof(struct trax_tm_stats) / sizeof(uint64_t),
  MEMORY_WORDS = sizeof(struct trax_memory_stats) / sizeof(uint64_t)
};

enum phase { EXACT, WARM_UP, WINDOW };

struct trax_sampled {
  struct trax_chip *chip;
  struct trax_functional *functional;
  struct trax_watch watch;
  trax_sampling sampling;

  enum phase phase;
  uint64_t begun;   /* cycle in which the phase began */
  uint32_t running; /* threads when it began */
  uint64_t period;  /* instructions from one window to the next, at present */
  uint64_t gap;     /* instructions until the next window's warm-up */
  uint64_t limit;   /* of cycles */

  size_t tp_words, memory_words, words; /* where the TPs' and the memory's counts begin, and how many there are */
  uint64_t *counts;                     /* the next four */
  uint64_t *before, *now;               /* [words]: at the beginning of the phase, and at its end */
  uint64_t *measured;                   /* [words]: of all phases that are measured */
  uint64_t *windows; /* [words]: of the stratum's windows; those of the one before until it has one */
  double *estimated; /* [words]: of the gaps that are over */
  uint64_t measured_cycles;

  /* The present stratum. */
  uint64_t window_instructions[STRATUM_WINDOWS];
  uint32_t window_count;
  uint64_t windows_sum, windows_cycles; /* instructions and cycles that `windows` is about */
  uint64_t gap_instructions;

  /* Of the strata that are over. */
  double gap_cycles; /* estimate */
  double weighted;   /* sum of (a stratum's gap cycles)^2 / windows: times the variance of a window, that of all */
  double residuals;  /* sum of squares of windows' relative deviations */
  uint64_t freedom;  /* their degrees of freedom */
  uint64_t window_total, detailed_instructions;
};

/* --- counts --- */

static void read_counts(const struct trax_sampled *sampled, uint64_t *words) {
  const struct trax_machine *machine = sampled->chip->machine;
  memcpy(words, machine->tm_stats, sampled->tp_words * sizeof *words);
  memcpy(words + sampled->tp_words, machine->tp_stats, (sampled->memory_words - sampled->tp_words) * sizeof *words);
  memcpy(words + sampled->memory_words, &machine->stats.memory, sizeof machine->stats.memory);
}

static uint64_t issued(const struct trax_sampled *sampled) {
  uint64_t sum = 0;
  for (size_t i = sampled->tp_words + TRAX_CAUSE_ISSUED; i < sampled->memory_words; i += TRAX_CAUSE_COUNT)
    sum += sampled->now[i] - sampled->before[i];
  return sum;
}

static void add_counts(const struct trax_sampled *sampled, uint64_t *sum) {
  for (size_t i = 0; i < sampled->words; i++)
    sum[i] += sampled->now[i] - sampled->before[i];
}

/* --- estimates --- */

double trax_student_95(uint64_t degrees_of_freedom) {
  static const double few[] = {0, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179};
  const double z = 1.959964, n = (double)degrees_of_freedom;
  if (degrees_of_freedom < sizeof few / sizeof *few)
    return few[degrees_of_freedom];
  return z + (pow(z, 3) + z) / (4 * n) + (5 * pow(z, 5) + 16 * pow(z, 3) + 3 * z) / (96 * n * n) +
         (3 * pow(z, 7) + 19 * pow(z, 5) + 17 * pow(z, 3) - 15 * z) / (384 * n * n * n);
}

/* Cycles per instruction of the stratum's windows, or of the latest that there are. */
static double cycles_per_instruction(const struct trax_sampled *sampled) {
  return sampled->windows_sum ? (double)sampled->windows_cycles / (double)sampled->windows_sum : 0;
}

static void close_stratum(struct trax_sampled *sampled) {
  const double cycles = (double)sampled->gap_instructions * cycles_per_instruction(sampled);
  const double factor = sampled->windows_cycles ? cycles / (double)sampled->windows_cycles : 0;
  for (size_t i = 0; i < sampled->words; i++)
    sampled->estimated[i] += factor * (double)sampled->windows[i];
  sampled->gap_cycles += cycles;
  sampled->weighted += cycles * cycles / (sampled->window_count ? sampled->window_count : 1);
  if (sampled->window_count > 1) {
    const double mean = (double)sampled->windows_sum / sampled->window_count;
    for (uint32_t i = 0; i < sampled->window_count; i++)
      sampled->residuals += pow((double)sampled->window_instructions[i] / mean - 1, 2);
    sampled->freedom += sampled->window_count - 1;
  }
  sampled->window_count = 0;
  sampled->gap_instructions = 0;
}

static void record_window(struct trax_sampled *sampled, uint64_t cycles) {
  if (!sampled->window_count) {
    memset(sampled->windows, 0, sampled->words * sizeof *sampled->windows);
    sampled->windows_sum = sampled->windows_cycles = 0;
  }
  const uint64_t instructions = issued(sampled);
  sampled->window_instructions[sampled->window_count++] = instructions;
  sampled->windows_sum += instructions;
  sampled->windows_cycles += cycles;
  sampled->window_total++;
  add_counts(sampled, sampled->windows);
  if (sampled->window_count == STRATUM_WINDOWS) {
    close_stratum(sampled);
    sampled->period = 2 * sampled->period < LONGEST_PERIOD ? 2 * sampled->period : LONGEST_PERIOD;
    sampled->gap = sampled->period;
  }
}

/* --- gaps --- */

static bool is_started(const struct trax_queue *queue, uint32_t place) {
  if (!queue->heap)
    return (place < queue->oldest ? place + queue->depth : place) - queue->oldest < queue->started;
  for (uint32_t i = 0; i < queue->started; i++)
    if (queue->heap[i] == place)
      return true;
  return false;
}

static void increment(struct trax_request *request, struct trax_space *space) {
  memcpy(&request->value, space->bytes + request->address, sizeof request->value);
  const uint32_t incremented = request->value + 1;
  memcpy(space->bytes + request->address, &incremented, sizeof incremented);
}

/* The increments under way are performed, in the TMs' order; what remains of them is their time. */
static void perform_increments(struct trax_chip *chip) {
  for (uint32_t i = 0; i < chip->tms; i++) {
    struct trax_queue *queue = &chip->tm[i].queue;
    for (uint32_t place = 0; place < queue->depth; place++) {
      struct trax_request *request = &queue->requests[place];
      if (!trax_queue_is_taken(queue, place) || request->kind != TRAX_REQUEST_ATOMIC)
        continue;
      if (!is_started(queue, place))
        increment(request, &chip->machine->space);
      chip->tm[i].tp[request->tp].reg[request->rd] = request->value;
      chip->tm[i].tp[request->tp].increments--;
      request->kind = TRAX_REQUEST_LOAD;
    }
  }
}

/* The TP waits for nothing and holds nothing any more. */
static void detach(struct trax_tm *tm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  for (unsigned slot = 0; slot < TRAX_WHEEL; slot++) {
    tm->wheel[slot] &= ~bit;
    if (!tm->wheel[slot])
      tm->wheel_occupied &= ~((uint64_t)1 << slot);
  }
  for (uint32_t i = 0; i < tm->icaches; i++)
    for (uint32_t j = 0; j < tm->icache[i].pending_count; j++)
      tm->icache[i].pending[j].waiting &= ~bit;
  tm->awaiting &= ~bit;
  tm->holding &= ~bit;
}

/* The threads are elsewhere now. */
static void follow(struct trax_tm *tm, uint64_t ended_before, uint64_t t) {
  for (unsigned number = 0; number < tm->tps; number++) {
    const uint64_t bit = (uint64_t)1 << number;
    struct trax_tp *tp = &tm->tp[number];
    tp->inst = trax_text_at(tm->text, tp->pc);
    if (tm->ended & ~ended_before & bit) {
      detach(tm, number);
    } else if (!(tm->ended & bit) && tp->inst->ask == TRAX_ASK_OUTSIDE) { /* will fault */
      detach(tm, number);
      tm->awake |= bit;
    }
  }
  tm->next_cycle = t;
}

/* How many instructions a thread loses by a miss, from what has been measured. */
static uint32_t miss_penalty(const struct trax_sampled *sampled) {
  uint64_t misses = 0, waits = 0, others = 0, instructions = 0;
  for (uint32_t i = 0; i < sampled->chip->tms; i++)
    misses += ((const struct trax_tm_stats *)(sampled->measured + i * (size_t)TM_WORDS))->dcache_misses;
  for (size_t i = sampled->tp_words; i < sampled->memory_words; i += TRAX_CAUSE_COUNT) {
    instructions += sampled->measured[i + TRAX_CAUSE_ISSUED];
    waits += sampled->measured[i + TRAX_CAUSE_DATA_MISS];
    for (unsigned cause = 0; cause < TRAX_CAUSE_HALTED; cause++)
      others += cause == TRAX_CAUSE_DATA_MISS ? 0 : sampled->measured[i + cause];
  }
  if (!misses || !others)
    return 0;
  const double penalty = (double)waits / (double)misses * (double)instructions / (double)others;
  return penalty < MOST_PENALTY ? (uint32_t)penalty : MOST_PENALTY;
}

static trax_status pass_gap(struct trax_sampled *sampled, uint64_t t) {
  struct trax_chip *chip = sampled->chip;
  uint64_t ended[64];
  for (uint32_t i = 0; i < chip->tms; i++)
    ended[i] = chip->tm[i].ended;
  trax_chip_gather(chip);
  perform_increments(chip);
  uint64_t executed = 0;
  const trax_status status =
      trax_functional_advance(sampled->functional, sampled->gap, miss_penalty(sampled), t - 1, &executed);
  for (uint32_t i = 0; i < chip->tms; i++)
    follow(&chip->tm[i], ended[i], t);
  trax_chip_scatter(chip, t);
  trax_functional_collect(sampled->functional);
  trax_chip_settle(chip, t);
  sampled->gap_instructions += executed;
  sampled->gap = sampled->period;
  chip->skipped += (uint64_t)((double)executed * cycles_per_instruction(sampled));
  return status;
}

/* --- phases --- */

static void enter(struct trax_sampled *sampled, enum phase phase, uint64_t t) {
  const uint64_t cycles[] = {
      [EXACT] = sampled->sampling.hold, [WARM_UP] = sampled->sampling.warm_up, [WINDOW] = sampled->sampling.window};
  sampled->phase = phase;
  sampled->begun = t;
  sampled->running = trax_chip_running(sampled->chip);
  sampled->watch.next = sampled->running ? t + cycles[phase] : TRAX_NEVER;
  read_counts(sampled, sampled->before);
}

/* The phase ends before cycle t: what it counts for. */
static void close_phase(struct trax_sampled *sampled, uint64_t t) {
  read_counts(sampled, sampled->now);
  const uint64_t instructions = issued(sampled);
  sampled->detailed_instructions += instructions;
  if (sampled->phase == WARM_UP) {
    sampled->gap_instructions += instructions;
    return;
  }
  sampled->measured_cycles += t - sampled->begun;
  add_counts(sampled, sampled->measured);
  if (sampled->phase == WINDOW && trax_chip_running(sampled->chip) == sampled->running) {
    record_window(sampled, t - sampled->begun);
  } else if (!sampled->windows_sum) { /* better than nothing for a gap that no window follows */
    memcpy(sampled->windows, sampled->measured, sampled->words * sizeof *sampled->windows);
    sampled->windows_sum = instructions;
    sampled->windows_cycles = t - sampled->begun;
  }
}

static trax_status look(struct trax_watch *watch, struct trax_chip *chip, uint64_t t) {
  struct trax_sampled *sampled = watch->context;
  trax_status status = TRAX_OK;
  trax_chip_settle(chip, t);
  close_phase(sampled, t);
  bool ended = trax_chip_running(chip) != sampled->running;
  if (!ended && sampled->phase == WARM_UP) {
    enter(sampled, WINDOW, t);
    return TRAX_OK;
  }
  if (!ended) {
    status = pass_gap(sampled, t);
    ended = trax_chip_running(chip) != sampled->running;
  }
  if (ended)
    close_stratum(sampled);
  enter(sampled, ended ? EXACT : WARM_UP, t);
  if (chip->skipped + t >= sampled->limit && !status)
    status = TRAX_STUCK;
  return status;
}

/* --- the run --- */

static uint64_t scrambled(uint64_t seed) { /* splitmix64 */
  seed = (seed + 0x9E3779B97F4A7C15u) * 0xBF58476D1CE4E5B9u;
  seed = (seed ^ seed >> 27) * 0x94D049BB133111EBu;
  return seed ^ seed >> 31;
}

static uint64_t value_or(uint64_t value, uint64_t otherwise) {
  return value ? value : otherwise;
}

/* Cycles in which the memory moves what the threads may have asked it for, and an answer's way back. */
static uint64_t drain_time(const struct trax_config *config) {
  const double bytes_per_cycle = config->memory.bandwidth_gbps * 1000 / config->chip.clock_mhz;
  const uint32_t of_threads = 2 * config->chip.tps_per_tm, depth = config->memory.queue_depth;
  const uint32_t requests = config->chip.tms * (of_threads < depth ? of_threads : depth);
  const double cycles = requests * (double)config->dcache.line_bytes / bytes_per_cycle;
  return (uint64_t)(cycles < MOST_DRAIN ? cycles : MOST_DRAIN) + config->memory.latency_cycles;
}

static trax_sampling completed(const trax_sampling *asked, const struct trax_config *config) {
  const uint64_t threads = (uint64_t)config->chip.tms * config->chip.tps_per_tm, drain = drain_time(config);
  const uint64_t window = drain > LEAST_WINDOW ? drain : LEAST_WINDOW;
  return (trax_sampling){.period = value_or(asked->period, PERIOD * threads),
                         .window = value_or(asked->window, window),
                         .warm_up = value_or(asked->warm_up, 2 * window),
                         .hold = value_or(asked->hold, HOLD),
                         .seed = value_or(asked->seed, 1)};
}

struct trax_sampled *trax_sampled_create(struct trax_chip *chip, const trax_run_options *options, trax_error *error) {
  const uint64_t threads = trax_chip_running(chip);
  struct trax_sampled *sampled = calloc(1, sizeof *sampled);
  if (!sampled) {
    trax_fail(error, "out of memory");
    return NULL;
  }
  sampled->chip = chip;
  sampled->sampling = completed(&options->sampling, &chip->machine->config);
  sampled->limit = value_or(options->max_cycles, TRAX_NEVER);
  sampled->period = sampled->sampling.period;
  sampled->gap = 1 + scrambled(sampled->sampling.seed) % sampled->period;
  sampled->tp_words = chip->tms * (size_t)TM_WORDS;
  sampled->memory_words = sampled->tp_words + threads * TRAX_CAUSE_COUNT;
  sampled->words = sampled->memory_words + MEMORY_WORDS;
  sampled->functional = trax_functional_create(chip, error);
  sampled->counts = calloc(4 * sampled->words, sizeof *sampled->counts);
  sampled->estimated = calloc(sampled->words, sizeof *sampled->estimated);
  if (!sampled->functional || !sampled->counts || !sampled->estimated) {
    trax_fail(error, "out of memory");
    trax_sampled_destroy(sampled);
    return NULL;
  }
  sampled->before = sampled->counts;
  sampled->now = sampled->before + sampled->words;
  sampled->measured = sampled->now + sampled->words;
  sampled->windows = sampled->measured + sampled->words;
  sampled->running = trax_chip_running(chip);
  sampled->watch =
      (struct trax_watch){.next = sampled->sampling.hold / BEGINNING + 1, .look = look, .context = sampled};
  trax_machine_watch(chip->machine, &sampled->watch);
  return sampled;
}

void trax_sampled_destroy(struct trax_sampled *sampled) {
  if (!sampled)
    return;
  trax_machine_unwatch(sampled->chip->machine, &sampled->watch);
  trax_functional_destroy(sampled->functional);
  free(sampled->counts);
  free(sampled->estimated);
  free(sampled);
}

void trax_sampled_finish(struct trax_sampled *sampled, uint64_t t) {
  struct trax_machine *machine = sampled->chip->machine;
  close_phase(sampled, t);
  close_stratum(sampled);
  const double cycles = (double)sampled->measured_cycles + sampled->gap_cycles;
  const double deviation =
      sampled->freedom ? sqrt(sampled->weighted * sampled->residuals / (double)sampled->freedom) : 0;
  const double half = trax_student_95(sampled->freedom) * deviation;
  machine->stats.cycles = (uint64_t)llround(cycles);
  machine->fault.cycle += machine->fault.kind ? sampled->chip->skipped : 0;
  machine->stats.sampling =
      (struct trax_sampling_stats){.is_sampled = true,
                                   .has_interval = sampled->freedom || !sampled->gap_cycles,
                                   .asked = sampled->sampling,
                                   .windows = sampled->window_total,
                                   .low = fmax(cycles - half, (double)t), /* it took as long to simulate them */
                                   .high = cycles + half,
                                   .detailed_cycles = t,
                                   .detailed_instructions = sampled->detailed_instructions};
  for (size_t i = 0; i < sampled->words; i++)
    sampled->estimated[i] += (double)sampled->measured[i];
  for (uint32_t i = 0; i < sampled->chip->tms; i++) {
    struct trax_tm_stats *stats = &machine->tm_stats[i];
    const struct trax_tm_stats exact = *stats;
    for (size_t j = 0; j < TM_WORDS; j++)
      ((uint64_t *)stats)[j] = (uint64_t)llround(sampled->estimated[i * (size_t)TM_WORDS + j]);
    memcpy(stats->instructions, exact.instructions, sizeof stats->instructions);
    stats->rays = exact.rays;
    stats->items = exact.items;
    stats->nontemporal_loads = exact.nontemporal_loads;
    stats->nontemporal_stores = exact.nontemporal_stores;
    stats->queue_peak = exact.queue_peak;
  }
  for (size_t i = 0; i < MEMORY_WORDS; i++)
    ((uint64_t *)&machine->stats.memory)[i] = (uint64_t)llround(sampled->estimated[sampled->memory_words + i]);
  const double *charges = sampled->estimated + sampled->tp_words;
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++)
    trax_estimate_charges(&machine->tp_stats[thread], charges + thread * TRAX_CAUSE_COUNT, machine->stats.cycles);
}
