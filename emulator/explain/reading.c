#include "explain/reading.h"
#include "explain/tally.h"
#include "trax/pool.h"

#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { BATCH = 64 /* passages */, MOST_TALLIES = 4, SPINS = 1000 };

/* Thread-cycles between two flushes of the tallies. As many again may follow until the logs have been read. */
static const uint64_t most_tallied = UINT32_MAX / 2;

struct trax_reading {
  struct trax_explain *explain;
  struct trax_passage *const *passages; /* [count]: those that are being read */
  size_t count;
  struct trax_tally *tallies[MOST_TALLIES]; /* [tally_count]: one of a thread */
  unsigned tally_count;
  uint64_t cycle, flushed; /* up to which passages have been read; of the latest flush */
  struct trax_pool *pool;  /* its items are `work`; NULL: there is one thread */
  struct work {
    enum { FOLLOW, READ, TALLY } what;
    struct trax_reader *reader; /* of READ: it reads all passages */
    unsigned tally;             /* of TALLY: it takes each batch whose number is its own, modulo their number */
  } work[1 + TRAX_READER_KINDS + MOST_TALLIES]; /* [work_count]; the first one follows the passages */
  unsigned work_count;
  bool has_further;       /* a passage is of no tally's contexts */
  atomic_size_t followed; /* the first passages, which may be read */
};

/* Lets readers follow the passages, and gives them to the others by batches. */
static void follow(struct trax_reading *reading) {
  const struct trax_explain *explain = reading->explain;
  for (size_t i = 0; i < reading->count; i++) {
    for (unsigned k = 0; k < explain->reader_count; k++)
      if (explain->readers[k]->kind->follow)
        explain->readers[k]->kind->follow(explain->readers[k], reading->passages[i]);
    reading->has_further |= reading->passages[i]->context >= TRAX_TALLY_CONTEXTS;
    if ((i + 1) % BATCH == 0 || i + 1 == reading->count)
      atomic_store_explicit(&reading->followed, i + 1, memory_order_release);
  }
}

/* Waits until passage number `end` - 1 has been followed, which a thread does that has begun before. */
static void wait_for(const struct trax_reading *reading, size_t end) {
  for (unsigned i = 0; atomic_load_explicit(&reading->followed, memory_order_acquire) < end; i++)
    if (i < SPINS)
      trax_pause();
    else
      sched_yield();
}

static void do_work(void *context, uint32_t item) {
  struct trax_reading *reading = context;
  const struct work *work = &reading->work[item];
  if (work->what == FOLLOW) {
    follow(reading);
    return;
  }
  for (size_t begin = 0, end; begin < reading->count; begin = end) {
    end = reading->count - begin < BATCH ? reading->count : begin + BATCH;
    if (work->what == TALLY && begin / BATCH % reading->tally_count != work->tally)
      continue;
    wait_for(reading, end);
    for (size_t i = begin; work->what == READ && i < end; i++)
      work->reader->kind->passage(work->reader, reading->passages[i]);
    for (size_t i = begin; work->what == TALLY && i < end; i++)
      trax_tally_add(reading->tallies[work->tally], reading->passages[i]);
  }
}

size_t trax_reading_batch(const struct trax_reading *reading) {
  return reading->pool ? SIZE_MAX : BATCH;
}

void trax_reading_read(struct trax_reading *reading, struct trax_passage *const *passages, size_t count) {
  reading->passages = passages;
  reading->count = count;
  reading->has_further = false;
  atomic_store_explicit(&reading->followed, 0, memory_order_relaxed);
  if (reading->pool)
    trax_pool_run(reading->pool);
  for (uint32_t i = 0; !reading->pool && i < reading->work_count; i++)
    do_work(reading, i);
  for (size_t i = 0; reading->has_further && i < count; i++)
    if (passages[i]->context >= TRAX_TALLY_CONTEXTS)
      trax_tally_add_alone(reading->tallies[0], passages[i]);
}

void trax_reading_flush(struct trax_reading *reading) {
  for (unsigned i = 0; i < reading->tally_count; i++)
    trax_tally_flush(reading->tallies[i]);
  reading->flushed = reading->cycle;
}

void trax_reading_drain(struct trax_reading *reading, uint64_t cycle) {
  reading->cycle = cycle;
  if ((cycle - reading->flushed) * reading->explain->machine->stats.threads >= most_tallied)
    trax_reading_flush(reading);
  for (unsigned i = 0; i < reading->tally_count; i++)
    trax_tally_drain(reading->tallies[i]);
}

/* Lists the work for so many threads: what others wait for first, since the first thread begins with it (base/pool.c).
   False: out of memory. */
static bool list_work(struct trax_reading *reading, unsigned threads) {
  struct trax_explain *explain = reading->explain;
  unsigned count = 0;
  reading->tally_count = threads < MOST_TALLIES ? threads : MOST_TALLIES;
  for (unsigned i = 0; i < reading->tally_count; i++)
    if (!reading->tallies[i] && !(reading->tallies[i] = trax_tally_create(explain)))
      return false;
  reading->work[count++] = (struct work){.what = FOLLOW};
  reading->work[count++] = (struct work){.what = TALLY, .tally = 0};
  for (unsigned i = 0; i < explain->reader_count; i++)
    if (explain->readers[i]->kind->passage)
      reading->work[count++] = (struct work){.what = READ, .reader = explain->readers[i]};
  for (unsigned i = 1; i < reading->tally_count; i++)
    reading->work[count++] = (struct work){.what = TALLY, .tally = i};
  reading->work_count = count;
  return true;
}

bool trax_reading_start(struct trax_reading *reading, unsigned threads) {
  trax_error error;
  if (reading->pool)
    return true;
  if (!list_work(reading, threads))
    return false;
  if (threads > reading->work_count)
    threads = reading->work_count;
  if (threads > 1)
    reading->pool = trax_pool_create(threads, reading->work_count, do_work, reading, &error);
  return reading->pool || list_work(reading, 1); /* without a pool, one thread reads */
}

struct trax_reading *trax_reading_create(struct trax_explain *explain) {
  struct trax_reading *reading = calloc(1, sizeof *reading);
  if (reading)
    reading->explain = explain;
  return reading;
}

void trax_reading_destroy(struct trax_reading *reading) {
  if (!reading)
    return;
  trax_pool_destroy(reading->pool);
  for (unsigned i = 0; i < MOST_TALLIES; i++)
    trax_tally_destroy(reading->tallies[i]);
  free(reading);
}
