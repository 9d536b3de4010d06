#include "explain/passages.h"
#include "explain/places.h"
#include "explain/reading.h"
#include "explain/stories.h"
#include "machine/ray_cycles.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

enum {
  PADDING = 8, /* bytes behind the refusals, which readers load by vectors */
  MUCH = 4096, /* new in the logs, after which few are read at once */
  BLOCK = 1 << 15
};

/* The additions of a TM: passages, each followed by its pieces, accesses, charges, refusals and cycles, in blocks,
   where they stay. */
struct log {
  _Alignas(64) struct block {
    uint8_t *bytes;
    size_t capacity;
  } *blocks; /* [block_count] */
  size_t block_count, block_capacity;
  struct trax_passage **passages; /* [stretches] */
  struct trax_read_run *runs;     /* [runs] */
  size_t passage_capacity, run_capacity;
  const struct trax_places_range *range; /* of the latest piece */
  struct extent {
    size_t block, used; /* used: of this block */
    uint32_t instructions, stretches, runs;
    uint64_t cycle; /* of the latest stretch */
  } now, kept;      /* kept: that the engine does not go back behind */
};

struct trax_passages {
  struct trax_explain *explain;
  uint32_t tms;
  struct log *sets[TRAX_PASSAGES_ROUNDS]; /* each [tms]; without stories the first one alone is used */
  struct log *logs;                       /* the present one of these */
  uint32_t most;                          /* instructions in the logs */
  bool holds;
  struct trax_charged *charged;            /* of the observer's logs, when the passages were held, */
  size_t charged_capacity, *charged_count; /* [threads] */
  struct trax_reading *reading;
};

/* --- adding --- */

/* Returns place for a passage with its arrays; NULL: out of memory. */
static void *reserve(struct log *log, size_t bytes) {
  for (; log->now.block < log->block_count; log->now.block++, log->now.used = 0)
    if (log->now.used + bytes <= log->blocks[log->now.block].capacity)
      return log->blocks[log->now.block].bytes + log->now.used;
  const size_t capacity = bytes < BLOCK ? BLOCK : bytes;
  if (!trax_grow((void **)&log->blocks, log->block_count, &log->block_capacity, sizeof *log->blocks))
    return NULL;
  uint8_t *const block = malloc(capacity);
  if (block)
    log->blocks[log->block_count++] = (struct block){block, capacity};
  return block;
}

/* Copies an array, if it is not there already, and returns it; *at moves behind it. */
static void *put(uint8_t **at, const void *array, size_t bytes) {
  uint8_t *const copy = *at;
  if (bytes && array != copy)
    memcpy(copy, array, bytes);
  *at += bytes;
  return copy;
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

void *trax_passages_room(struct trax_passages *passages, uint32_t tm) {
  struct trax_passage *passage = reserve(&passages->logs[tm], sizeof *passage + TRAX_STRETCH_ROOM);
  return passage ? passage + 1 : NULL;
}

/* Finds the instructions of the passage's pieces and charges. */
static void place(const struct trax_places *places, struct trax_passage *passage,
                  const struct trax_places_range **range) {
  struct trax_charged *charged = passage->charged, *const charged_end = charged + passage->charged_count;
  unsigned at = 0;
  for (unsigned i = 0; i < passage->pieces; i++) {
    struct trax_piece *piece = &passage->piece[i];
    piece->index = trax_places_index_again(places, piece->pc, range);
    for (; charged < charged_end && charged->at < at + piece->count; charged++)
      charged->index = piece->index + (charged->at - at);
    at += piece->count;
  }
  const struct trax_piece *last = &passage->piece[passage->pieces - 1];
  passage->last = last->index + last->count - 1;
  passage->inst = passage->count == 1 ? *trax_places_inst(places, passage->last) : (trax_inst){0};
}

/* False: out of memory. */
static bool end_run(struct log *log) {
  if (!trax_grow((void **)&log->runs, log->now.runs, &log->run_capacity, sizeof *log->runs))
    return false;
  log->runs[log->now.runs++] = (struct trax_read_run){log->now.cycle, log->now.stretches};
  return true;
}

/* False: out of memory. */
static bool add(const struct trax_passages *passages, struct log *log, const struct trax_stretch *stretch,
                const struct trax_charged *charged, size_t charged_count) {
  const struct trax_explain *explain = passages->explain;
  const size_t refused = stretch->refused ? stretch->count + PADDING : 0,
               cycles = stretch->cycles ? TRAX_CAUSE_COUNT * sizeof *stretch->cycles : 0,
               bytes = sizeof(struct trax_passage) + stretch->pieces * sizeof *stretch->piece +
                       stretch->accessed_count * sizeof *stretch->accessed + charged_count * sizeof *charged + refused +
                       cycles + 2 * _Alignof(struct trax_passage);
  struct trax_passage *const passage = reserve(log, bytes);
  if (!passage ||
      !trax_grow((void **)&log->passages, log->now.stretches, &log->passage_capacity, sizeof *log->passages))
    return false;
  uint8_t *at = (uint8_t *)(passage + 1);
  passage->thread = stretch->tm * explain->machine->config.chip.tps_per_tm + stretch->tp;
  passage->context = 0;
  passage->count = (uint16_t)stretch->count;
  passage->pieces = (uint16_t)stretch->pieces;
  passage->accessed_count = (uint16_t)stretch->accessed_count;
  passage->charged_count = (uint32_t)charged_count;
  passage->kind = TRAX_NO_RAY;
  passage->stores = stretch->stores;
  passage->misses = stretch->misses;
  passage->next_pc = stretch->next_pc;
  passage->result = stretch->result;
  passage->piece = put(&at, stretch->piece, stretch->pieces * sizeof *stretch->piece);
  passage->accessed = put(&at, stretch->accessed, stretch->accessed_count * sizeof *stretch->accessed);
  passage->charged = put(&at, charged, charged_count * sizeof *charged);
  passage->refused = NULL;
  passage->cycles = NULL;
  if (refused) {
    passage->refused = put(&at, stretch->refused, stretch->count);
    at += PADDING;
  }
  at += -(uintptr_t)at % _Alignof(struct trax_passage);
  if (cycles) {
    uint64_t *const own = put(&at, stretch->cycles, cycles);
    trax_counters_add(own, explain->open_threads[passage->thread].begin_cycles, cycles, -1);
    passage->cycles = own;
  }
  place(explain->places, passage, &log->range);
  log->passages[log->now.stretches++] = passage;
  log->now.cycle = stretch->cycle;
  log->now.used += (size_t)(at - (uint8_t *)passage);
  return stretch->count > 1 || end_run(log);
}

void trax_passages_add(struct trax_passages *passages, const struct trax_stretch *stretch,
                       struct trax_thread_log *thread) {
  struct log *log = &passages->logs[stretch->tm];
  size_t charged = thread->charged_count;
  while (charged && thread->charged[charged - 1].at >= stretch->count)
    charged--;
  if (!add(passages, log, stretch, thread->charged, charged))
    __atomic_store_n(&passages->explain->observer.lost, true, __ATOMIC_RELAXED);
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

/* --- reading --- */

static void empty_logs(struct trax_passages *passages) {
  for (uint32_t tm = 0; tm < passages->tms; tm++) {
    passages->logs[tm].now = passages->logs[tm].kept = (struct extent){0};
  }
}

static void read_logs(struct trax_passages *passages) {
  struct trax_read_log *const read = trax_reading_logs(passages->reading);
  size_t count = 0;
  for (uint32_t tm = 0; tm < passages->tms; tm++) {
    struct log *log = &passages->logs[tm];
    const size_t in_runs = log->now.runs ? log->runs[log->now.runs - 1].end : 0;
    if (in_runs < log->now.stretches && !end_run(log)) {
      passages->explain->observer.lost = true;
      log->now.stretches = (uint32_t)in_runs;
    }
    read[tm] = (struct trax_read_log){log->passages, log->now.stretches, log->runs, log->now.runs};
    count += log->now.stretches;
  }
  if (!count)
    return;
  passages->explain->found = 0;
  trax_reading_read(passages->reading);
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
  passages->reading = trax_reading_create(explain);
  if (complete && passages->charged_count && passages->reading)
    return passages;
  trax_passages_destroy(passages);
  return NULL;
}

bool trax_passages_start(struct trax_passages *passages, struct trax_pool *pool) {
  return trax_reading_start(passages->reading, pool);
}

void trax_passages_end(struct trax_passages *passages) {
  trax_reading_flush(passages->reading);
}

void trax_passages_destroy(struct trax_passages *passages) {
  if (!passages)
    return;
  trax_reading_destroy(passages->reading);
  for (unsigned i = 0; i < TRAX_PASSAGES_ROUNDS; i++) {
    for (uint32_t tm = 0; passages->sets[i] && tm < passages->tms; tm++) {
      struct log *log = &passages->sets[i][tm];
      for (size_t k = 0; k < log->block_count; k++)
        free(log->blocks[k].bytes);
      free(log->blocks);
      free(log->passages);
      free(log->runs);
    }
    free(passages->sets[i]);
  }
  free(passages->charged);
  free(passages->charged_count);
  free(passages);
}
