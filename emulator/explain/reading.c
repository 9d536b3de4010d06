#include "explain/reading.h"
#include "explain/tally.h"
#include "trax/pool.h"

#include <stdlib.h>

enum { BATCH = 64 /* passages */, MOST_TALLIES = 4 };

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
    struct trax_reader *reader; /* it reads all passages; NULL: a tally takes a part of them */
    unsigned tally;
  } work[TRAX_READER_KINDS + MOST_TALLIES]; /* [work_count] */
  unsigned work_count;
};

static void follow(const struct trax_reading *reading) {
  const struct trax_explain *explain = reading->explain;
  for (size_t i = 0; i < reading->count; i++) {
    for (unsigned k = 0; k < explain->reader_count; k++)
      if (explain->readers[k]->kind->follow)
        explain->readers[k]->kind->follow(explain->readers[k], reading->passages[i]);
    if (reading->passages[i]->context >= TRAX_TALLY_CONTEXTS)
      trax_tally_add_alone(reading->tallies[0], reading->passages[i]);
  }
}

static void do_work(void *context, uint32_t item) {
  const struct trax_reading *reading = context;
  const struct work *work = &reading->work[item];
  const size_t begin = work->reader ? 0 : reading->count * work->tally / reading->tally_count,
               end = work->reader ? reading->count : reading->count * (work->tally + 1) / reading->tally_count;
  for (size_t i = begin; work->reader && i < end; i++)
    work->reader->kind->passage(work->reader, reading->passages[i]);
  for (size_t i = begin; !work->reader && i < end; i++)
    trax_tally_add(reading->tallies[work->tally], reading->passages[i]);
}

size_t trax_reading_batch(const struct trax_reading *reading) {
  return reading->pool ? SIZE_MAX : BATCH;
}

void trax_reading_read(struct trax_reading *reading, struct trax_passage *const *passages, size_t count) {
  reading->passages = passages;
  reading->count = count;
  follow(reading);
  if (reading->pool)
    trax_pool_run(reading->pool);
  for (uint32_t i = 0; !reading->pool && i < reading->work_count; i++)
    do_work(reading, i);
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

/* Lists the work for so many threads, each of which begins with its tally (base/pool.c). False: out of memory. */
static bool list_work(struct trax_reading *reading, unsigned threads) {
  struct trax_explain *explain = reading->explain;
  unsigned tallies = 0, count = 0, next = 0;
  reading->tally_count = threads < MOST_TALLIES ? threads : MOST_TALLIES;
  for (unsigned i = 0; i < reading->tally_count; i++)
    if (!reading->tallies[i] && !(reading->tallies[i] = trax_tally_create(explain)))
      return false;
  for (unsigned i = 0; i < explain->reader_count; i++)
    count += explain->readers[i]->kind->passage != NULL;
  count += reading->tally_count;
  for (reading->work_count = 0; reading->work_count < count; reading->work_count++) {
    struct work *work = &reading->work[reading->work_count];
    if (tallies < reading->tally_count && reading->work_count == count * tallies / reading->tally_count) {
      *work = (struct work){.tally = tallies++};
      continue;
    }
    while (!explain->readers[next]->kind->passage)
      next++;
    *work = (struct work){.reader = explain->readers[next++]};
  }
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
