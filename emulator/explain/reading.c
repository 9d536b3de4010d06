#include "explain/reading.h"
#include "explain/tally.h"
#include "trax/grow.h"
#include "trax/pool.h"

#include <stdatomic.h>
#include <stdlib.h>

/* A thread takes the task of another one only if it has had nothing to do for some time, since the task's data come
   from that thread's caches. */
enum {
  BATCH = 64 /* passages */,
  LEAD = 4 /* batches */,
  MOST_LANES = 4,
  STEAL_AFTER = 100 /* polls */,
  MOST_POLLS = 1000,
  AHEAD = 320 /* bytes of a passage, about */
};

/* Thread-cycles between two flushes of the tallies. As many again may follow until the logs have been read. */
static const uint64_t most_tallied = UINT32_MAX / 2;

/* Takes batch after batch, one thread at a time. */
struct task {
  _Alignas(64) atomic_size_t done; /* passages */
  atomic_bool taken;
  struct trax_reader *reader; /* NULL: it orders the passages and follows them */
  unsigned lane;              /* that takes it unless it is late */
};

struct trax_reading {
  struct task tasks[1 + TRAX_READER_KINDS]; /* [task_count]; the first one goes before the others */
  _Alignas(64) atomic_size_t tallied;       /* passages that a lane has taken to tally them */
  struct trax_explain *explain;
  unsigned task_count, follower_count;
  struct trax_reader *followers[TRAX_READER_KINDS]; /* [follower_count]: readers that follow the passages */
  uint32_t tms;
  struct trax_read_log *logs; /* [tms]: those that are being read */
  struct cursor {
    uint64_t cycle;               /* of the log's next run; UINT64_MAX: there is none */
    size_t runs, passages;        /* of the log, that are in the order */
  } *cursors;                     /* [tms] */
  struct trax_passage **passages; /* [count], in the order of the chip: the first `ordered` of them */
  size_t count, capacity, ordered;
  bool has_further;                       /* a passage is of no tally's contexts */
  uint64_t cycle, flushed;                /* the latest one of a passage in the order; of the latest flush */
  struct trax_pool *pool;                 /* NULL: there is one lane */
  unsigned job, lanes;                    /* of the pool; its items are lanes, each for a thread */
  struct trax_tally *tallies[MOST_LANES]; /* [lanes] */
};

/* --- tasks --- */

/* Orders passages, at least up to number `end`. */
static void order(struct trax_reading *reading, size_t end) {
  while (reading->ordered < end) {
    struct cursor *first = reading->cursors;
    for (struct cursor *cursor = first + 1; cursor < reading->cursors + reading->tms; cursor++)
      if (cursor->cycle < first->cycle)
        first = cursor;
    const struct trax_read_log *log = &reading->logs[first - reading->cursors];
    reading->cycle = first->cycle > reading->cycle ? first->cycle : reading->cycle;
    while (first->passages < log->runs[first->runs].end)
      reading->passages[reading->ordered++] = log->passages[first->passages++];
    first->cycle = ++first->runs < log->run_count ? log->runs[first->runs].cycle : UINT64_MAX;
  }
}

/* Lets readers follow the passages. */
static void follow(struct trax_reading *reading, size_t begin, size_t end) {
  const struct trax_explain *explain = reading->explain;
  order(reading, end);
  for (size_t i = begin; i < end; i++) {
    struct trax_passage *passage = reading->passages[i];
    for (size_t k = 0; k < AHEAD; k += 64)
      __builtin_prefetch((const char *)reading->passages[i + 4 < end ? i + 4 : i] + k);
    for (unsigned k = 0; k < reading->follower_count; k++)
      reading->followers[k]->kind->follow(reading->followers[k], passage);
    explain->end_pcs[passage->thread] = passage->next_pc;
    reading->has_further |= passage->context >= TRAX_TALLY_CONTEXTS;
  }
}

static void run_task(struct trax_reading *reading, const struct task *task, size_t begin, size_t end) {
  if (!task->reader)
    follow(reading, begin, end);
  for (size_t i = begin; task->reader && i < end; i++)
    task->reader->kind->passage(task->reader, reading->passages[i]);
}

/* Returns the passages that all have read or tallied. */
static size_t slowest(const struct trax_reading *reading) {
  size_t least = atomic_load_explicit(&reading->tallied, memory_order_relaxed);
  for (unsigned i = 1; i < reading->task_count; i++) {
    const size_t done = atomic_load_explicit(&reading->tasks[i].done, memory_order_relaxed);
    least = done < least ? done : least;
  }
  return least;
}

/* Returns the passages up to which a task may go now. The first one does not go far before the others, so that the
   passages stay in the host's caches. */
static size_t limit_of(const struct trax_reading *reading, const struct task *task) {
  if (task->reader)
    return atomic_load_explicit(&reading->tasks->done, memory_order_acquire);
  const size_t limit = slowest(reading) + (reading->lanes > 1 ? LEAD : 1) * BATCH;
  return limit < reading->count ? limit : reading->count;
}

/* Takes a batch of a task. any: of any lane. False: there is none. */
static bool take_task(struct trax_reading *reading, unsigned lane, bool any) {
  for (struct task *task = reading->tasks; task < reading->tasks + reading->task_count; task++) {
    const size_t limit = limit_of(reading, task);
    if ((task->lane != lane && !any) || atomic_load(&task->done) >= limit || atomic_exchange(&task->taken, true))
      continue;
    const size_t begin = atomic_load(&task->done); /* another thread may have taken a batch meanwhile */
    if (begin < limit) {
      const size_t end = limit - begin < BATCH ? limit : begin + BATCH;
      run_task(reading, task, begin, end);
      atomic_store(&task->done, end);
    }
    atomic_store_explicit(&task->taken, false, memory_order_release);
    if (begin < limit)
      return true;
  }
  return false;
}

/* Tallies a batch. False: there is none. */
static bool tally(struct trax_reading *reading, unsigned lane) {
  size_t begin = atomic_load(&reading->tallied);
  const size_t limit = atomic_load_explicit(&reading->tasks->done, memory_order_acquire),
               end = limit - begin < BATCH ? limit : begin + BATCH;
  if (begin >= limit || !atomic_compare_exchange_strong(&reading->tallied, &begin, end))
    return false;
  for (size_t i = begin; i < end; i++)
    trax_tally_add(reading->tallies[lane], reading->passages[i]);
  return true;
}

/* --- lanes --- */

/* Takes batches until there are none. A lane that has had nothing to do for long leaves the rest to those who have the
   tasks: the host may have given their processor to others, and a thread that has left the pool's work sleeps. */
static void run_lane(void *context, uint32_t lane) {
  struct trax_reading *reading = context;
  for (unsigned polls = 0; slowest(reading) < reading->count && polls < MOST_POLLS;)
    if (take_task(reading, lane, polls >= STEAL_AFTER) || tally(reading, lane)) {
      polls = 0;
    } else {
      polls++;
      trax_pause();
    }
}

struct trax_read_log *trax_reading_logs(struct trax_reading *reading) {
  return reading->logs;
}

void trax_reading_flush(struct trax_reading *reading) {
  for (unsigned i = 0; i < reading->lanes; i++)
    trax_tally_flush(reading->tallies[i]);
  reading->flushed = reading->cycle;
}

/* Gives the readers the counts that the tallies do not keep. */
static void give_counts(struct trax_reading *reading) {
  for (size_t i = 0; reading->has_further && i < reading->count; i++)
    if (reading->passages[i]->context >= TRAX_TALLY_CONTEXTS)
      trax_tally_add_alone(reading->tallies[0], reading->passages[i]);
  if ((reading->cycle - reading->flushed) * reading->explain->machine->stats.threads >= most_tallied)
    trax_reading_flush(reading);
  for (unsigned i = 0; i < reading->lanes; i++)
    trax_tally_drain(reading->tallies[i]);
}

void trax_reading_read(struct trax_reading *reading) {
  reading->count = reading->ordered = 0;
  reading->has_further = false;
  for (uint32_t tm = 0; tm < reading->tms; tm++) {
    const struct trax_read_log *log = &reading->logs[tm];
    reading->count += log->count;
    reading->cursors[tm] = (struct cursor){.cycle = log->run_count ? log->runs->cycle : UINT64_MAX};
  }
  if (!trax_grow_to((void **)&reading->passages, reading->count, &reading->capacity, sizeof *reading->passages)) {
    reading->explain->observer.lost = true;
    return;
  }
  for (unsigned i = 0; i < reading->task_count; i++)
    atomic_store_explicit(&reading->tasks[i].done, 0, memory_order_relaxed);
  atomic_store_explicit(&reading->tallied, 0, memory_order_relaxed);
  if (reading->pool)
    trax_pool_run(reading->pool, reading->job);
  else
    run_lane(reading, 0);
  give_counts(reading);
}

/* --- creation --- */

/* Divides the tasks among so many lanes. False: out of memory. */
static bool divide(struct trax_reading *reading, unsigned lanes) {
  const struct trax_explain *explain = reading->explain;
  for (unsigned i = 0; i < lanes; i++)
    if (!reading->tallies[i] && !(reading->tallies[i] = trax_tally_create(reading->explain)))
      return false;
  unsigned count = 1;
  reading->follower_count = 0;
  for (unsigned i = 0; i < explain->reader_count; i++) {
    const struct trax_reader_kind *kind = explain->readers[i]->kind;
    if (kind->follow)
      reading->followers[reading->follower_count++] = explain->readers[i];
    if (kind->passage && (!kind->wants_passages || kind->wants_passages(&explain->options))) {
      reading->tasks[count].reader = explain->readers[i];
      reading->tasks[count].lane = lanes > 1 ? 1 + (count - 1) % (lanes - 1) : 0;
      count++;
    }
  }
  reading->task_count = count;
  reading->lanes = lanes;
  return true;
}

bool trax_reading_start(struct trax_reading *reading, struct trax_pool *pool) {
  trax_error error;
  const unsigned threads = pool ? trax_pool_threads(pool) : 1, lanes = threads < MOST_LANES ? threads : MOST_LANES;
  if (!divide(reading, lanes))
    return false;
  if (lanes > 1 && trax_pool_add(pool, lanes, run_lane, reading, &reading->job, &error) != TRAX_OK)
    return divide(reading, 1);
  reading->pool = lanes > 1 ? pool : NULL;
  return true;
}

struct trax_reading *trax_reading_create(struct trax_explain *explain) {
  struct trax_reading *reading = aligned_alloc(_Alignof(struct trax_reading), sizeof *reading);
  if (!reading)
    return NULL;
  *reading = (struct trax_reading){.explain = explain, .tms = explain->machine->config.chip.tms};
  reading->logs = calloc(reading->tms, sizeof *reading->logs);
  reading->cursors = calloc(reading->tms, sizeof *reading->cursors);
  if (reading->logs && reading->cursors)
    return reading;
  trax_reading_destroy(reading);
  return NULL;
}

void trax_reading_destroy(struct trax_reading *reading) {
  if (!reading)
    return;
  for (unsigned i = 0; i < MOST_LANES; i++)
    trax_tally_destroy(reading->tallies[i]);
  free(reading->logs);
  free(reading->cursors);
  free(reading->passages);
  free(reading);
}
