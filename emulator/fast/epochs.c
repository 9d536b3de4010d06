/* Epochs (docs/fast-engine.md, "Why it equals the reference", 3 to 5): each TM simulates some cycles alone, so that the
   TMs can run on several threads of the host. On one thread, too, this is faster, since the host's caches hold the data
   of one TM at a time. */
#include "fast/chip.h"
#include "fast/merge.h"
#include "machine/snapshot.h"
#include "trax/pool.h"

#include <assert.h>
#include <stdlib.h>

enum {
  LEAST_EPOCH = 16,             /* cycles; shorter epochs do not pay */
  LONGEST_EPOCH = 16,           /* in latencies: from a request to its completion, the least one */
  QUIET = 4,                    /* so many times as long as an epoch there has been no conflict */
  LEAST_SPAN = 512,             /* cycles up to a stop, for which a snapshot pays in observed runs, which stop often */
  FIRST_SNAPSHOT_INTERVAL = 64, /* in latencies; doubles with each snapshot until a roll back */
  LONGEST_SNAPSHOT_INTERVAL = 1024,
  MOST_UNDO = 1 << 16,     /* lines written to global memory after which a snapshot is taken in any case */
  FIRST_PAUSE = 64,        /* cycles simulated one by one after the epoch of a conflict; doubles with each */
  LONGEST_PAUSE = 1 << 20, /* conflict until a snapshot */
};

struct trax_epochs {
  struct trax_chip *chip;
  struct trax_pool *pool;
  unsigned job;                       /* of the pool */
  enum { CHECK, SAVE, RESTORE } work; /* of the job's items: TMs, or as many parts of the snapshot */
  struct trax_merge merge;
  uint64_t latency;    /* cycles */
  unsigned sides;      /* quanta of a latency; of the store buffers, those that are used */
  uint64_t begin, end; /* of the epoch */

  bool has_snapshot;
  uint64_t snapshot_cycle;
  uint32_t snapshot_running;     /* threads that had not ended */
  unsigned snapshot_interval;    /* in latencies */
  struct trax_snapshot snapshot; /* but for the words of global memory, which merge has */

  uint64_t cautious_from, cautious_until; /* these cycles are simulated one by one */
  uint64_t pause;
};

/* --- snapshots --- */

static void work(void *context, uint32_t item) {
  struct trax_epochs *epochs = context;
  if (epochs->work == CHECK)
    trax_merge_check(&epochs->merge, &epochs->chip->tm[item]);
  else if (epochs->work == SAVE)
    trax_snapshot_save(&epochs->snapshot, item, epochs->chip->tms);
  else
    trax_snapshot_restore(&epochs->snapshot, item, epochs->chip->tms);
}

static void run_pool(struct trax_epochs *epochs, unsigned work) {
  epochs->work = work;
  trax_pool_run(epochs->pool, epochs->job);
}

static void take_snapshot(struct trax_epochs *epochs, uint64_t t) {
  if (epochs->chip->translation) /* here alone: epochs that are run again have the same bursts */
    trax_translation_extend(epochs->chip->translation);
  trax_fast_keep(epochs->chip, true);
  run_pool(epochs, SAVE);
  trax_merge_keep(&epochs->merge);
  epochs->has_snapshot = epochs->chip->transfers.holds = true;
  epochs->snapshot_cycle = t;
  epochs->snapshot_running = trax_chip_running(epochs->chip);
}

void trax_epochs_commit(struct trax_epochs *epochs) {
  if (epochs->has_snapshot)
    trax_fast_keep(epochs->chip, false);
  trax_merge_keep(&epochs->merge);
  epochs->has_snapshot = epochs->chip->transfers.holds = false;
}

/* --- epochs --- */

/* Returns the cycles of an epoch from t on: soon after a conflict another one is likely, and costs less if the epoch is
   short. They are whole latencies, so an epoch that is repeated has no cycles of two. */
static uint64_t longest_epoch(const struct trax_epochs *epochs, uint64_t t) {
  const uint64_t quiet = t > epochs->cautious_until ? t - epochs->cautious_until : 0;
  const uint64_t latencies = quiet / (QUIET * epochs->latency);
  return (latencies < 1 ? 1 : latencies < LONGEST_EPOCH ? latencies : LONGEST_EPOCH) * epochs->latency;
}

static uint64_t begin_of(const struct trax_epochs *epochs, unsigned quantum) {
  const uint64_t begin = epochs->begin + quantum * epochs->latency / epochs->sides;
  return begin < epochs->end ? begin : epochs->end;
}

static void simulate(void *context, uint32_t number, unsigned quantum) {
  struct trax_epochs *epochs = context;
  struct trax_tm *tm = &epochs->chip->tm[number];
  if (trax_merge_has_failed(&epochs->merge))
    return;
  if (quantum == 0) {
    if (tm->next_cycle < epochs->begin)
      tm->next_cycle = epochs->begin;
    trax_merge_begin_tm(&epochs->merge, tm);
  }
  trax_merge_give(&epochs->merge, tm, quantum % epochs->sides);
  epochs->chip->variant->run_quantum(tm, begin_of(epochs, quantum + 1));
  trax_merge_take(&epochs->merge, tm);
}

/* Serves the requests of a quantum. */
static void serve(void *context, unsigned quantum) {
  struct trax_epochs *epochs = context;
  if (!trax_merge_has_failed(&epochs->merge))
    trax_merge_quantum(&epochs->merge, quantum % epochs->sides, begin_of(epochs, quantum),
                       begin_of(epochs, quantum + 1));
}

/* Simulates an epoch. False: it must be given up. */
static bool run_epoch(struct trax_epochs *epochs, uint64_t t, uint64_t end) {
  unsigned quanta = 0;
  epochs->begin = t;
  epochs->end = end;
  while (begin_of(epochs, quanta) < end)
    quanta++;
  trax_merge_begin(&epochs->merge);
  trax_pool_run_rounds(epochs->pool, epochs->job, quanta, simulate, serve);
  if (!trax_merge_has_failed(&epochs->merge)) {
    trax_merge_unite(&epochs->merge);
    run_pool(epochs, CHECK);
  }
  return trax_merge_end(&epochs->merge);
}

bool trax_epochs_advance(struct trax_epochs *epochs, uint64_t *t, uint64_t until) {
  struct trax_chip *chip = epochs->chip;
  assert(until > *t);
  if (*t < epochs->cautious_from && epochs->cautious_from < until)
    until = epochs->cautious_from;
  const bool cautious = *t >= epochs->cautious_from && *t < epochs->cautious_until;
  const bool stops = chip->machine->observer && !epochs->has_snapshot && until - *t < LEAST_SPAN;
  if (cautious || stops || until - *t < LEAST_EPOCH) {
    chip->short_epochs += !cautious;
    trax_epochs_commit(epochs); /* writes outside epochs are not recorded, and so cannot be undone */
    return false;
  }
  if (!epochs->has_snapshot) {
    epochs->snapshot_interval = FIRST_SNAPSHOT_INTERVAL;
    take_snapshot(epochs, *t);
  } else if ((chip->machine->observer && chip->machine->observer->full) ||
             4 * trax_chip_running(chip) < 3 * epochs->snapshot_running) { /* the last epoch of the run is given up */
    take_snapshot(epochs, *t);
  } else if (*t - epochs->snapshot_cycle >= epochs->snapshot_interval * epochs->latency ||
             epochs->merge.undo_count >= MOST_UNDO) {
    if (epochs->snapshot_interval < LONGEST_SNAPSHOT_INTERVAL)
      epochs->snapshot_interval *= 2;
    epochs->pause = FIRST_PAUSE;
    take_snapshot(epochs, *t);
  }
  const uint64_t longest = longest_epoch(epochs, *t), end = until - *t < longest ? until : *t + longest;
  if (run_epoch(epochs, *t, end)) {
    *t = end;
    return true;
  }
  run_pool(epochs, RESTORE);
  trax_merge_roll_back(&epochs->merge);
  if (chip->machine->observer)
    chip->machine->observer->go_back(chip->machine->observer->context);
  chip->conflicts++;
  epochs->cautious_from = *t; /* the epochs up to this one will give the same results again */
  epochs->cautious_until = end + epochs->pause;
  if (epochs->pause < LONGEST_PAUSE)
    epochs->pause *= 2;
  *t = epochs->snapshot_cycle;
  return true;
}

trax_status trax_epochs_create(struct trax_chip *chip, struct trax_run *run, trax_error *error) {
  const uint64_t latency = trax_memory_least_latency(&chip->machine->config);
  if (chip->tms < 2 || latency < LEAST_EPOCH || (chip->machine->observer && !chip->machine->observer->go_back))
    return TRAX_OK;
  struct trax_epochs *epochs = chip->epochs = calloc(1, sizeof *epochs);
  if (!epochs)
    return trax_fail(error, "out of memory");
  epochs->chip = chip;
  epochs->latency = latency;
  epochs->pause = FIRST_PAUSE;
  if (!trax_merge_create(&epochs->merge, chip) || !trax_snapshot_create(&epochs->snapshot, trax_state_visit, chip))
    return trax_fail(error, "out of memory");
  if (!(epochs->pool = trax_run_pool(run, error)))
    return TRAX_ERROR;
  /* One thread never runs ahead, so its quanta have a whole latency. */
  epochs->sides = trax_pool_threads(epochs->pool) > 1 ? TRAX_SIDES : 1;
  return trax_pool_add(epochs->pool, chip->tms, work, epochs, &epochs->job, error);
}

void trax_epochs_destroy(struct trax_epochs *epochs) {
  if (!epochs)
    return;
  trax_merge_destroy(&epochs->merge);
  trax_snapshot_destroy(&epochs->snapshot);
  free(epochs);
}
