#include "explain/passages.h"
#include "explain/places.h"
#include "explain/stories.h"
#include "explain/tally.h"
#include "machine/ray_cycles.h"
#include "trax/grow.h"
#include "trax/pool.h"

#include <stdlib.h>
#include <string.h>

/* A stretch in a log. Its pieces, charges, accesses, refusals and cycles follow. */
struct stored {
  uint64_t cycle;
  uint32_t thread, next_pc, result;
  uint16_t count, pieces, accessed;
  bool is_refused, has_cycles; /* it has refusals, cycles */
  bool stores, misses;
  uint32_t charged;
};

enum {
  PADDING = 8, /* bytes behind the refusals, which readers load by vectors */
  MUCH = 4096, /* new in the logs, after which few are read at once */
  BATCH = 64,  /* passages that one reader reads after the other, if there is one thread: they stay in its caches */
  MOST_TALLIES = 4
};
/* Thread-cycles between two flushes of the tallies. Half as many may follow until the logs have been read. */
static const uint64_t most_tallied = UINT32_MAX / 2;

/* What a TM has added. */
struct log {
  _Alignas(64) uint8_t *bytes;
  size_t capacity;
  struct extent {
    size_t used;
    uint32_t instructions, stretches;
  } now, kept; /* kept: that the engine does not go back behind */
  struct passage {
    struct trax_passage passage;
    uint64_t cycle;
  } * passages; /* [stretches], when they are read: `placed` of them exist, and `ordered` are in the chip's order */
  size_t passages_capacity;
  size_t placed_bytes;
  uint32_t placed, ordered;
};

struct trax_passages {
  struct trax_explain *explain;
  uint32_t tms;
  struct log *sets[TRAX_PASSAGES_ROUNDS]; /* each [tms]; without stories the first one alone is used */
  struct log *logs;                       /* the present one of these */
  struct trax_passage **order;            /* of all logs */
  size_t count, order_capacity;
  uint32_t most; /* instructions in the logs */
  bool holds;
  struct trax_charged *charged;             /* of the observer's logs, when the passages were held, */
  size_t charged_capacity, *charged_count;  /* [threads] */
  struct trax_pool *placers, *readers;      /* items: TMs, work; NULL: there is one thread */
  struct trax_tally *tallies[MOST_TALLIES]; /* [tally_count]: one of a thread */
  unsigned tally_count;
  uint64_t cycle, flushed; /* of the latest passage that was ordered; when they were flushed */
  /* [work_count]: what the items of `readers` do. A tally has a part of the passages, a reader all of them. */
  struct work {
    struct trax_reader *reader; /* NULL: a tally */
    unsigned tally;
  } work[TRAX_READER_KINDS + MOST_TALLIES];
  unsigned work_count;
};

/* --- adding --- */

static size_t refused_bytes(bool is_refused, uint32_t count) {
  return is_refused ? ((size_t)count + 7) / 8 * 8 : 0;
}

static size_t cycles_bytes(bool has_cycles) {
  return has_cycles ? TRAX_CAUSE_COUNT * sizeof(uint64_t) : 0;
}

static bool reserve(struct log *log, size_t bytes) {
  if (log->now.used + bytes + PADDING <= log->capacity)
    return true;
  const size_t capacity = 2 * (log->now.used + bytes + PADDING);
  uint8_t *larger = realloc(log->bytes, capacity);
  if (!larger)
    return false;
  log->bytes = larger;
  log->capacity = capacity;
  return true;
}

static void append(struct log *log, const void *array, size_t bytes) {
  if (bytes)
    memcpy(log->bytes + log->now.used, array, bytes);
  log->now.used += bytes;
}

/* Takes what belongs to a stretch out of the thread's log. */
static void shorten(struct trax_thread_log *log, size_t charged, uint32_t count) {
  log->charged_count -= charged;
  for (size_t i = 0; i < log->charged_count; i++) {
    log->charged[i] = log->charged[charged + i];
    log->charged[i].at -= count;
  }
}

static uint32_t size_of(const struct log *log) {
  return log->now.instructions + 64 * log->now.stretches;
}

static void read_logs(struct trax_passages *passages);

void trax_passages_add(struct trax_passages *passages, const struct trax_stretch *stretch,
                       struct trax_thread_log *thread) {
  struct log *log = &passages->logs[stretch->tm];
  size_t charged = thread->charged_count;
  while (charged && thread->charged[charged - 1].at >= stretch->count)
    charged--;
  const struct stored stored = {.cycle = stretch->cycle,
                                .thread =
                                    stretch->tm * passages->explain->machine->config.chip.tps_per_tm + stretch->tp,
                                .count = (uint16_t)stretch->count,
                                .next_pc = stretch->next_pc,
                                .result = stretch->result,
                                .pieces = (uint16_t)stretch->pieces,
                                .charged = (uint32_t)charged,
                                .accessed = (uint16_t)stretch->accessed_count,
                                .is_refused = stretch->refused != NULL,
                                .stores = stretch->stores,
                                .misses = stretch->misses,
                                .has_cycles = stretch->cycles != NULL};
  const size_t refused = refused_bytes(stored.is_refused, stretch->count), cycles = cycles_bytes(stored.has_cycles);
  const size_t arrays = stretch->pieces * sizeof *stretch->piece + charged * sizeof *thread->charged +
                        stretch->accessed_count * sizeof *stretch->accessed;
  const size_t gap = -arrays & 7;
  if (reserve(log, sizeof stored + arrays + gap + refused + cycles)) {
    append(log, &stored, sizeof stored);
    append(log, stretch->piece, stretch->pieces * sizeof *stretch->piece);
    append(log, thread->charged, charged * sizeof *thread->charged);
    append(log, stretch->accessed, stretch->accessed_count * sizeof *stretch->accessed);
    log->now.used += gap;
    append(log, stretch->refused, refused ? stretch->count : 0);
    log->now.used = (log->now.used + 7) / 8 * 8;
    append(log, stretch->cycles, cycles);
    log->now.stretches++;
  } else {
    __atomic_store_n(&passages->explain->observer.lost, true, __ATOMIC_RELAXED);
  }
  if (thread->charged_count)
    shorten(thread, charged, stretch->count);
  log->now.instructions += stretch->count;
  if (size_of(log) * passages->tms < passages->most)
    return;
  if (passages->holds)
    __atomic_store_n(&passages->explain->observer.full, true, __ATOMIC_RELAXED);
  else
    read_logs(passages);
}

/* --- placing --- */

static void place(struct trax_explain *explain, struct trax_passage *passage, const struct trax_places_range **range) {
  struct trax_open_thread *open = &explain->open_threads[passage->thread];
  struct trax_charged *charged = passage->charged, *const charged_end = charged + passage->charged_count;
  unsigned at = 0;
  for (size_t i = 0; i < passage->pieces; i++) {
    struct trax_piece *piece = &passage->piece[i];
    piece->index = trax_places_index_again(explain->places, piece->pc, range);
    for (; charged < charged_end && charged->at < at + piece->count; charged++)
      charged->index = piece->index + (charged->at - at);
    at += piece->count;
  }
  const struct trax_piece *last = &passage->piece[passage->pieces - 1];
  passage->last = last->index + last->count - 1;
  passage->inst = *trax_places_inst(explain->places, passage->last);
  open->end_pc = passage->next_pc;
}

/* Makes the next passage of a TM's log. */
static void place_next(const struct trax_passages *passages, struct log *log, const struct trax_places_range **range) {
  uint8_t *at = log->bytes + log->placed_bytes;
  const struct stored *stored = (const void *)at;
  struct trax_piece *piece = (void *)(at + sizeof *stored);
  struct trax_charged *charged = (void *)(piece + stored->pieces);
  const struct trax_accessed *accessed = (const void *)(charged + stored->charged);
  const uintptr_t arrays_end = (uintptr_t)(accessed + stored->accessed);
  uint8_t *refused = (uint8_t *)(accessed + stored->accessed) + (-arrays_end & 7);
  struct passage *placed = &log->passages[log->placed++];
  struct trax_passage *passage = &placed->passage;
  placed->cycle = stored->cycle;
  *passage = (struct trax_passage){.thread = stored->thread,
                                   .count = stored->count,
                                   .piece = piece,
                                   .pieces = stored->pieces,
                                   .charged = charged,
                                   .charged_count = stored->charged,
                                   .accessed = accessed,
                                   .accessed_count = stored->accessed,
                                   .stores = stored->stores,
                                   .misses = stored->misses,
                                   .kind = TRAX_NO_RAY,
                                   .refused = stored->is_refused ? (const void *)refused : NULL,
                                   .next_pc = stored->next_pc,
                                   .result = stored->result};
  place(passages->explain, passage, range);
  at = refused + refused_bytes(stored->is_refused, stored->count);
  if (stored->has_cycles) {
    uint64_t *cycles = (void *)at;
    trax_counters_add(cycles, passages->explain->open_threads[passage->thread].begin_cycles, cycles_bytes(true), -1);
    passage->cycles = cycles;
  }
  log->placed_bytes = (size_t)(at + cycles_bytes(stored->has_cycles) - log->bytes);
}

/* Makes the passages of a TM's log. */
static void place_log(void *context, uint32_t tm) {
  const struct trax_passages *passages = context;
  const struct trax_places_range *range = NULL;
  while (passages->logs[tm].placed < passages->logs[tm].now.stretches)
    place_next(passages, &passages->logs[tm], &range);
}

/* Makes place for all passages. Returns their number; 0: out of memory. */
static size_t prepare(struct trax_passages *passages) {
  size_t count = 0;
  for (uint32_t tm = 0; tm < passages->tms; tm++) {
    struct log *log = &passages->logs[tm];
    if (!trax_grow_to((void **)&log->passages, log->now.stretches, &log->passages_capacity, sizeof *log->passages))
      return 0;
    log->placed = log->ordered = 0;
    log->placed_bytes = 0;
    count += log->now.stretches;
  }
  passages->count = 0;
  return trax_grow_to((void **)&passages->order, count, &passages->order_capacity, sizeof *passages->order) ? count : 0;
}

/* Orders the passages up to number `end` by their cycles and TMs. Those that do not exist are made just before they are
   read, so that they are in the host's caches. */
static void order(struct trax_passages *passages, size_t end) {
  const struct trax_places_range *range = NULL;
  while (passages->count < end) {
    struct log *first = NULL;
    uint64_t cycle = UINT64_MAX;
    for (uint32_t tm = 0; tm < passages->tms; tm++) {
      struct log *log = &passages->logs[tm];
      if (log->ordered == log->now.stretches)
        continue;
      if (log->ordered == log->placed)
        place_next(passages, log, &range);
      if (log->passages[log->ordered].cycle < cycle) {
        first = log;
        cycle = log->passages[log->ordered].cycle;
      }
    }
    passages->cycle = cycle;
    passages->order[passages->count++] = &first->passages[first->ordered++].passage;
  }
}

/* --- reading --- */

static void follow(const struct trax_passages *passages, size_t begin, size_t end) {
  const struct trax_explain *explain = passages->explain;
  for (size_t i = begin; i < end; i++) {
    for (unsigned k = 0; k < explain->reader_count; k++)
      if (explain->readers[k]->kind->follow)
        explain->readers[k]->kind->follow(explain->readers[k], passages->order[i]);
    if (passages->order[i]->context >= TRAX_TALLY_CONTEXTS)
      trax_tally_add_alone(passages->tallies[0], passages->order[i]);
  }
}

static void read_part(const struct trax_passages *passages, const struct work *work, size_t begin, size_t end) {
  struct trax_reader *reader = work->reader;
  for (size_t i = begin; reader && i < end; i++)
    reader->kind->passage(reader, passages->order[i]);
  for (size_t i = begin; !reader && i < end; i++)
    trax_tally_add(passages->tallies[work->tally], passages->order[i]);
}

static void do_work(void *context, uint32_t item) {
  const struct trax_passages *passages = context;
  const struct work *work = &passages->work[item];
  const size_t count = passages->count;
  if (work->reader)
    read_part(passages, work, 0, count);
  else
    read_part(passages, work, count * work->tally / passages->tally_count,
              count * (work->tally + 1) / passages->tally_count);
}

/* Lists the work for so many threads, each of which begins with its tally (trax/pool.h). False: out of memory. */
static bool list_work(struct trax_passages *passages, unsigned threads) {
  struct trax_explain *explain = passages->explain;
  unsigned tallies = 0, readers = 0, next = 0;
  for (unsigned i = 0; i < explain->reader_count; i++)
    readers += explain->readers[i]->kind->passage != NULL;
  passages->tally_count = threads < MOST_TALLIES ? threads : MOST_TALLIES;
  for (unsigned i = 0; i < passages->tally_count; i++)
    if (!passages->tallies[i] && !(passages->tallies[i] = trax_tally_create(explain)))
      return false;
  const unsigned count = readers + passages->tally_count;
  passages->work_count = 0;
  while (passages->work_count < count) {
    if (tallies < passages->tally_count && passages->work_count == count * tallies / passages->tally_count) {
      passages->work[passages->work_count++] = (struct work){.tally = tallies++};
      continue;
    }
    while (next < explain->reader_count && !explain->readers[next]->kind->passage)
      next++;
    passages->work[passages->work_count++] = (struct work){.reader = explain->readers[next++]};
  }
  return true;
}

void trax_passages_flush(struct trax_passages *passages) {
  for (unsigned i = 0; i < passages->tally_count; i++)
    trax_tally_flush(passages->tallies[i]);
  passages->flushed = passages->cycle;
}

static void take_tallies(struct trax_passages *passages) {
  if ((passages->cycle - passages->flushed) * passages->explain->machine->stats.threads >= most_tallied)
    trax_passages_flush(passages);
  for (unsigned i = 0; i < passages->tally_count; i++)
    trax_tally_drain(passages->tallies[i]);
}

static void empty_logs(struct trax_passages *passages) {
  for (uint32_t tm = 0; tm < passages->tms; tm++) {
    passages->logs[tm].now = passages->logs[tm].kept = (struct extent){0};
  }
}

static void read_logs(struct trax_passages *passages) {
  uint32_t instructions = 0;
  for (uint32_t tm = 0; tm < passages->tms; tm++)
    instructions += passages->logs[tm].now.instructions;
  if (!instructions)
    return;
  passages->explain->found = 0;
  const size_t count = prepare(passages);
  if (!count) {
    passages->explain->observer.lost = true;
  } else if (passages->readers) {
    if (passages->placers)
      trax_pool_run(passages->placers);
    order(passages, count);
    follow(passages, 0, count);
    trax_pool_run(passages->readers);
  }
  for (size_t begin = 0; !passages->readers && begin < count; begin += BATCH) {
    const size_t end = count - begin < BATCH ? count : begin + BATCH;
    order(passages, end);
    follow(passages, begin, end);
    for (unsigned i = 0; i < passages->work_count; i++)
      read_part(passages, &passages->work[i], begin, end);
  }
  take_tallies(passages);
  passages->most = passages->explain->found < MUCH ? TRAX_PASSAGES_MANY : TRAX_PASSAGES_FEW;
  if (passages->explain->stories) {
    passages->logs = passages->sets[++passages->explain->round % TRAX_PASSAGES_ROUNDS];
    trax_stories_forget(passages->explain->stories);
  }
  empty_logs(passages);
}

/* --- holding --- */

/* Saves the charges that are in no stretch yet. */
static void save_charges(struct trax_passages *passages) {
  const struct trax_observer *observer = &passages->explain->observer;
  size_t count = 0;
  for (uint64_t i = 0; i < passages->explain->machine->stats.threads; i++)
    count += observer->logs[i].charged_count;
  if (!trax_grow_to((void **)&passages->charged, count, &passages->charged_capacity, sizeof *passages->charged)) {
    passages->explain->observer.lost = true;
    count = 0;
  }
  struct trax_charged *to = passages->charged;
  for (uint64_t i = 0; i < passages->explain->machine->stats.threads; i++) {
    passages->charged_count[i] = count ? observer->logs[i].charged_count : 0;
    if (passages->charged_count[i])
      memcpy(to, observer->logs[i].charged, passages->charged_count[i] * sizeof *to);
    to += passages->charged_count[i];
  }
}

void trax_passages_keep(struct trax_passages *passages, bool holds) {
  uint32_t size = 0;
  for (uint32_t tm = 0; tm < passages->tms; tm++)
    size += size_of(&passages->logs[tm]);
  if (passages->explain->observer.full || size >= passages->most / 2)
    read_logs(passages);
  for (uint32_t tm = 0; tm < passages->tms; tm++)
    passages->logs[tm].kept = passages->logs[tm].now;
  passages->explain->observer.full = false;
  passages->holds = holds;
  if (holds)
    save_charges(passages);
}

void trax_passages_finish(struct trax_passages *passages) {
  read_logs(passages);
}

void trax_passages_go_back(struct trax_passages *passages) {
  const struct trax_charged *from = passages->charged;
  for (uint32_t tm = 0; tm < passages->tms; tm++)
    passages->logs[tm].now = passages->logs[tm].kept;
  for (uint64_t i = 0; i < passages->explain->machine->stats.threads; i++) {
    struct trax_thread_log *log = &passages->explain->observer.logs[i];
    log->charged_count = passages->charged_count[i]; /* a log does not become smaller */
    if (log->charged_count)
      memcpy(log->charged, from, log->charged_count * sizeof *from);
    from += log->charged_count;
  }
  passages->explain->observer.full = false;
}

/* --- creation --- */

struct trax_passages *trax_passages_create(struct trax_explain *explain) {
  struct trax_passages *passages = calloc(1, sizeof *passages);
  if (!passages)
    return NULL;
  passages->explain = explain;
  passages->tms = explain->machine->config.chip.tms;
  passages->most = TRAX_PASSAGES_FEW;
  bool complete = true;
  for (unsigned i = 0; i < TRAX_PASSAGES_ROUNDS; i++) {
    passages->sets[i] = aligned_alloc(_Alignof(struct log), passages->tms * sizeof *passages->logs);
    complete &= passages->sets[i] != NULL;
    if (passages->sets[i])
      memset(passages->sets[i], 0, passages->tms * sizeof *passages->logs);
  }
  passages->logs = passages->sets[0];
  passages->charged_count = calloc(explain->machine->stats.threads, sizeof *passages->charged_count);
  if (complete && passages->charged_count)
    return passages;
  trax_passages_destroy(passages);
  return NULL;
}

bool trax_passages_start(struct trax_passages *passages, unsigned threads) {
  trax_error error; /* without pools, one thread reads */
  if (passages->readers)
    return true;
  if (!list_work(passages, threads))
    return false;
  if (threads < 2)
    return true;
  passages->placers =
      trax_pool_create(threads < passages->tms ? threads : passages->tms, passages->tms, place_log, passages, &error);
  passages->readers = trax_pool_create(threads < passages->work_count ? threads : passages->work_count,
                                       passages->work_count, do_work, passages, &error);
  return true;
}

void trax_passages_destroy(struct trax_passages *passages) {
  if (!passages)
    return;
  trax_pool_destroy(passages->placers);
  trax_pool_destroy(passages->readers);
  for (unsigned i = 0; i < TRAX_PASSAGES_ROUNDS; i++) {
    for (uint32_t tm = 0; passages->sets[i] && tm < passages->tms; tm++) {
      free(passages->sets[i][tm].bytes);
      free(passages->sets[i][tm].passages);
    }
    free(passages->sets[i]);
  }
  for (unsigned i = 0; i < MOST_TALLIES; i++)
    trax_tally_destroy(passages->tallies[i]);
  free(passages->order);
  free(passages->charged);
  free(passages->charged_count);
  free(passages);
}
