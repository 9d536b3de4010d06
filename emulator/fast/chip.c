#include "fast/chip.h"

static trax_status create(struct trax_run *run, trax_error *error) {
#ifdef TRAX_FAST_HAVE_AVX2
  if (run->engine != &trax_fast_any_engine && __builtin_cpu_supports("x86-64-v3"))
    return trax_chip_create(run, &trax_fast_variant_v3, error);
#endif
  return trax_chip_create(run, &trax_fast_variant, error);
}

/* --- cycles --- */

/* Simulates the memory's step of cycle t. */
static void serve(struct trax_chip *chip, uint64_t t) {
  trax_memory_cycle(&chip->memory, chip->tm, t);
  for (uint32_t i = 0; i < chip->tms; i++)
    trax_tm_receive(&chip->tm[i], 0);
}

/* Simulates cycle *t of all TMs and of the memory; *t receives the next cycle in which anything can happen. */
static enum trax_advance run_cycle(struct trax_chip *chip, uint64_t *t) {
  bool faulted = false;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (chip->tm[i].next_cycle <= *t) {
      chip->variant->cycle(&chip->tm[i], *t);
      faulted |= chip->tm[i].fault.kind != TRAX_FAULT_NONE;
    }
  serve(chip, *t);
  if (faulted) {
    ++*t;
    return TRAX_HAS_FAULTED;
  }
  uint64_t next = trax_memory_next_cycle(&chip->memory, *t);
  for (uint32_t i = 0; i < chip->tms; i++)
    if (chip->tm[i].next_cycle < next)
      next = chip->tm[i].next_cycle;
  if (!trax_chip_running(chip) && !trax_memory_has_waiting(&chip->memory)) {
    const uint64_t idle_from = trax_memory_idle_from(&chip->memory);
    chip->end = idle_from > *t + 1 ? idle_from : *t + 1;
    next = chip->end;
  }
  *t = next; /* never TRAX_NEVER: a TP that has not ended is awake, in a wheel, or waits for a request */
  return TRAX_GOES_ON;
}

/* Simulates cycles from *t on in which one TM alone does anything. False: there are none. */
static bool run_ahead(struct trax_chip *chip, uint64_t *t, uint64_t until) {
  struct trax_tm *tm = NULL;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (chip->tm[i].next_cycle > *t)
      until = chip->tm[i].next_cycle < until ? chip->tm[i].next_cycle : until;
    else if (tm)
      return false;
    else
      tm = &chip->tm[i];
  if (!tm || !*t || !trax_tm_has_one_awake(tm))
    return false;
  const uint64_t transfer = trax_memory_next_cycle(&chip->memory, *t - 1);
  const uint64_t requests = tm->stats->memory_requests;
  if (!trax_fast_run_alone(tm, *t, transfer < until ? transfer : until))
    return false;
  if (tm->stats->memory_requests != requests)
    serve(chip, tm->now);
  *t = tm->now + 1;
  return true;
}

/* Whether one thread is left, and no increment of another one is under way. */
static bool has_one_thread(const struct trax_chip *chip) {
  uint32_t increments = 0;
  if (chip->burst == 1 || trax_chip_running(chip) != 1)
    return false;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t tp = 0; tp < chip->tm[i].tps; tp++)
      increments += chip->tm[i].tp[tp].increments;
  return !increments;
}

static void commit(void *context) {
  struct trax_chip *chip = context;
  if (chip->epochs)
    trax_epochs_commit(chip->epochs);
  if (chip->alone) /* bursts may have stored */
    trax_fast_roll_back(chip);
}

static enum trax_advance advance(void *context, uint64_t *t, uint64_t until) {
  enum { CYCLES = 1024 }; /* the most cycles outside epochs in one call */
  struct trax_chip *chip = context;
  if (chip->translation && !chip->epochs)
    trax_translation_extend(chip->translation);
  if (!chip->alone && has_one_thread(chip)) {
    commit(chip);
    chip->alone = true;
  }
  for (unsigned cycles = 0; cycles < CYCLES && *t < until && !chip->end; cycles++) {
    if (chip->epochs && !chip->alone && trax_epochs_advance(chip->epochs, t, until))
      break;
    if (run_ahead(chip, t, until))
      continue;
    const uint64_t before = *t;
    if (run_cycle(chip, t) == TRAX_HAS_FAULTED)
      return TRAX_HAS_FAULTED;
    if (chip->end)
      break;
    *t = *t < until ? *t : until;
    chip->single_cycles += chip->tms > 1 && !chip->alone ? *t - before : 0;
  }
  if (*t >= until)
    commit(chip); /* a watch may see memory and output */
  if (!chip->end)
    return TRAX_GOES_ON;
  /* Only the last transfers are under way. */
  *t = chip->end < until ? chip->end : until;
  return *t == chip->end ? TRAX_HAS_ENDED : TRAX_GOES_ON;
}

/* --- between cycles --- */

/* Reports how often the run of so many cycles left the fast path. */
static void report_slow_paths(const struct trax_chip *chip, uint64_t cycles) {
  const struct trax_tm *first = &chip->tm[0]; /* all TMs are configured alike */
  struct trax_slow_paths *paths = &chip->machine->slow_paths;
  *paths =
      (struct trax_slow_paths){.known = true,
                               .has_epochs = chip->epochs != NULL,
                               .is_observed = chip->machine->observer && !chip->machine->observer->go_back,
                               .has_many_lines = chip->program.lines == TRAX_FAST_LINES,
                               .conflicts = chip->conflicts,
                               .short_epochs = chip->short_epochs,
                               .part = {[TRAX_SLOW_OBSERVED] = chip->burst == 1 ? cycles : 0,
                                        [TRAX_SLOW_SINGLE_CYCLES] = chip->single_cycles,
                                        [TRAX_SLOW_FETCHES] = first->simple_fetch ? 0 : cycles,
                                        [TRAX_SLOW_ADDERS] = first->fp.even ? 0 : cycles,
                                        [TRAX_SLOW_DATA_BANKS] = first->dcache.banks > TRAX_FAST_BANKS ? cycles : 0}};
  for (uint32_t i = 0; i < chip->tms; i++) {
    paths->part[TRAX_SLOW_LINES] += chip->tm[i].looked_up;
    paths->part[TRAX_SLOW_HITS] += first->serial_hits ? chip->tm[i].stats->dcache_hits : 0;
    paths->part[TRAX_SLOW_AT_ISSUE] += chip->tm[i].at_issue;
  }
}

static void settle(void *context, uint64_t t) {
  struct trax_chip *chip = context;
  for (uint32_t i = 0; i < chip->tms && !chip->machine->fault.kind; i++)
    chip->machine->fault = chip->tm[i].fault;
  trax_fast_settle(chip);
  for (uint32_t i = 0; i < chip->tms; i++) {
    trax_tm_settle(&chip->tm[i], t);
    trax_fast_settle_rays(&chip->tm[i]);
    chip->tm[i].stats->queue_peak = chip->tm[i].queue.peak;
  }
  report_slow_paths(chip, t);
}

static void tell(void *context) {
  const struct trax_chip *chip = context;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (unsigned tp = 0; chip->tm[i].observed && tp < chip->tm[i].tps; tp++)
      trax_fast_tell_issued(&chip->tm[i], tp);
}

static void import_state(void *context, uint64_t t) {
  struct trax_chip *chip = context;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t tp = 0; tp < chip->tm[i].tps; tp++)
      chip->tm[i].tp[tp].inst = trax_text_at(chip->text, chip->tm[i].tp[tp].pc);
  trax_fast_import(chip, t);
}

static struct trax_thread thread(void *context, uint32_t number) {
  const struct trax_chip *chip = context;
  const struct trax_tm *tm = &chip->tm[number / chip->tm->tps];
  const unsigned tp = number % tm->tps;
  return (struct trax_thread){tm->tp[tp].reg, tm->tp[tp].local, tm->tp[tp].pc, tm->ended >> tp & 1};
}

static void set_pc(void *context, uint32_t number, uint32_t pc) {
  const struct trax_chip *chip = context;
  struct trax_tm *tm = &chip->tm[number / chip->tm->tps];
  const unsigned tp = number % tm->tps;
  tm->tp[tp].pc = pc;
  tm->holding &= ~((uint64_t)1 << tp & tm->awake);
}

static uint64_t progressed(void *context) {
  const struct trax_chip *chip = context;
  uint64_t latest = 0;
  for (uint32_t i = 0; i < chip->tms; i++)
    latest = chip->tm[i].progressed > latest ? chip->tm[i].progressed : latest;
  return latest;
}

static uint32_t queued(const void *context, uint32_t tm, uint64_t t) {
  const struct trax_chip *chip = context;
  const struct trax_queue *queue = &chip->tm[tm].queue;
  uint32_t arrived = 0; /* completed requests in the queue of a TM whose threads have all ended */
  for (uint32_t i = 0; i < queue->started; i++)
    arrived += queue->requests[queue->places[i]].completion < t;
  return queue->count - arrived;
}

/* --- the engines --- */

#define ENGINE(NAME, MEANING)                                                                                          \
  {.name = NAME,                                                                                                       \
   .meaning = MEANING,                                                                                                 \
   .is_timed = true,                                                                                                   \
   .is_observed = true,                                                                                                \
   .counts_rays = true,                                                                                                \
   .create = create,                                                                                                   \
   .destroy = trax_chip_destroy,                                                                                       \
   .advance = advance,                                                                                                 \
   .commit = commit,                                                                                                   \
   .collect = trax_fast_collect,                                                                                       \
   .settle = settle,                                                                                                   \
   .tell = tell,                                                                                                       \
   .export_state = trax_fast_roll_back,                                                                                \
   .import_state = import_state,                                                                                       \
   .thread = thread,                                                                                                   \
   .set_pc = set_pc,                                                                                                   \
   .progressed = progressed,                                                                                           \
   .queued = queued,                                                                                                   \
   .visit = trax_state_visit,                                                                                          \
   .check = trax_state_check}

const struct trax_engine trax_fast_engine = ENGINE("fast", "the default, for what the host has");
const struct trax_engine trax_fast_any_engine = ENGINE("fast-any", "the same for any host of the family");
const struct trax_engine trax_fast_interpreted_engine = ENGINE("fast-interpreted", "without translation");
const struct trax_engine trax_fast_translated_engine = ENGINE("fast-translated", "translation at once");
