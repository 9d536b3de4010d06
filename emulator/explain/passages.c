#include "explain/passages.h"
#include "explain/places.h"
#include "explain/reading.h"
#include "explain/stories.h"
#include "machine/ray_cycles.h"
#include "trax/grow.h"
#include "trax/pool.h"

#include <stdlib.h>
#include <string.h>

/* A stretch in a log. Its pieces, accesses, charges, refusals and cycles follow. */
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
  AHEAD = 512, /* bytes of a stretch, about */
};

/* The additions of a TM. */
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
  struct trax_charged *charged;            /* of the observer's logs, when the passages were held, */
  size_t charged_capacity, *charged_count; /* [threads] */
  uint64_t cycle;                          /* of the latest passage that was ordered */
  struct trax_reading *reading;
  struct trax_pool *placers; /* its items are TMs; NULL: there is one thread */
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

void *trax_passages_room(struct trax_passages *passages, uint32_t tm) {
  struct log *log = &passages->logs[tm];
  const size_t bytes = sizeof(struct stored) + TRAX_STRETCH_ROOM;
  return reserve(log, bytes) ? log->bytes + log->now.used + sizeof(struct stored) : NULL;
}

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
  const bool in_room = (const uint8_t *)stretch->piece == log->bytes + log->now.used + sizeof stored;
  const size_t refused = refused_bytes(stored.is_refused, stretch->count), cycles = cycles_bytes(stored.has_cycles);
  const size_t pieces = stretch->pieces * sizeof *stretch->piece,
               accessed = stretch->accessed_count * sizeof *stretch->accessed,
               arrays = pieces + accessed + charged * sizeof *thread->charged, gap = -arrays & 7;
  if (reserve(log, sizeof stored + arrays + gap + refused + cycles)) {
    append(log, &stored, sizeof stored);
    if (in_room) {
      log->now.used += pieces + accessed;
    } else {
      append(log, stretch->piece, pieces);
      append(log, stretch->accessed, accessed);
    }
    append(log, thread->charged, charged * sizeof *thread->charged);
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
  for (size_t i = 0; i < AHEAD; i += 64) /* the host does not know where the stretches after this one are */
    __builtin_prefetch(at + AHEAD + i);
  struct trax_piece *piece = (void *)(at + sizeof *stored);
  const struct trax_accessed *accessed = (const void *)(piece + stored->pieces);
  struct trax_charged *charged = (void *)((uint8_t *)(piece + stored->pieces) + stored->accessed * sizeof *accessed);
  const uintptr_t arrays_end = (uintptr_t)(charged + stored->charged);
  uint8_t *refused = (uint8_t *)(charged + stored->charged) + (-arrays_end & 7);
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
  const size_t count = prepare(passages), batch = trax_reading_batch(passages->reading);
  if (!count)
    passages->explain->observer.lost = true;
  if (count && passages->placers)
    trax_pool_run(passages->placers);
  for (size_t begin = 0; begin < count; begin = passages->count) {
    order(passages, count - begin < batch ? count : begin + batch);
    trax_reading_read(passages->reading, passages->order + begin, passages->count - begin);
  }
  trax_reading_drain(passages->reading, passages->cycle);
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

bool trax_passages_start(struct trax_passages *passages, unsigned threads) {
  trax_error error; /* without a pool, the passages are made one by one */
  if (threads > 1 && !passages->placers)
    passages->placers =
        trax_pool_create(threads < passages->tms ? threads : passages->tms, passages->tms, place_log, passages, &error);
  return trax_reading_start(passages->reading, threads);
}

void trax_passages_end(struct trax_passages *passages) {
  trax_reading_flush(passages->reading);
}

void trax_passages_destroy(struct trax_passages *passages) {
  if (!passages)
    return;
  trax_pool_destroy(passages->placers);
  trax_reading_destroy(passages->reading);
  for (unsigned i = 0; i < TRAX_PASSAGES_ROUNDS; i++) {
    for (uint32_t tm = 0; passages->sets[i] && tm < passages->tms; tm++) {
      free(passages->sets[i][tm].bytes);
      free(passages->sets[i][tm].passages);
    }
    free(passages->sets[i]);
  }
  free(passages->order);
  free(passages->charged);
  free(passages->charged_count);
  free(passages);
}
