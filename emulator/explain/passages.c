#include "explain/passages.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* A stretch in a chunk. Its pieces, charges, accesses and refusals follow. */
struct stored {
  uint32_t thread, next_pc, result;
  uint16_t count, pieces, accessed;
  bool is_refused; /* it has refusals */
  uint32_t charged;
};

enum { PADDING = 32 /* bytes behind the refusals, which readers load by vectors */ };

struct chunk {
  uint8_t *bytes;
  size_t used, capacity;
  uint32_t instructions, calls;
};

struct trax_passages {
  struct trax_explain *explain;
  void (*read)(struct trax_explain *explain, struct trax_passage *passage);
  struct chunk chunks[TRAX_PASSAGES_CHUNKS]; /* a ring */
  bool threaded;
  pthread_t thread;
  pthread_mutex_t mutex;
  pthread_cond_t filled, emptied;
  uint64_t full, read_count; /* chunks so far that were filled, and those that were read */
  bool ended;                /* no more come */
};

static size_t refused_bytes(bool is_refused, uint32_t count) {
  return is_refused ? (2 * (size_t)count + 3) / 4 * 4 : 0;
}

static void read_chunk(struct trax_passages *passages, struct chunk *chunk) {
  for (uint8_t *at = chunk->bytes, *const end = at + chunk->used; at < end;) {
    const struct stored *stored = (const void *)at;
    struct trax_piece *piece = (void *)(at + sizeof *stored);
    struct trax_charged *charged = (void *)(piece + stored->pieces);
    struct trax_accessed *accessed = (void *)(charged + stored->charged);
    const uint16_t *refused = (void *)(accessed + stored->accessed);
    passages->read(passages->explain, &(struct trax_passage){.thread = stored->thread,
                                                             .count = stored->count,
                                                             .piece = piece,
                                                             .pieces = stored->pieces,
                                                             .charged = charged,
                                                             .charged_count = stored->charged,
                                                             .accessed = accessed,
                                                             .accessed_count = stored->accessed,
                                                             .refused = stored->is_refused ? refused : NULL,
                                                             .next_pc = stored->next_pc,
                                                             .result = stored->result});
    at = (uint8_t *)refused + refused_bytes(stored->is_refused, stored->count);
  }
  chunk->used = chunk->instructions = chunk->calls = 0;
}

static void *read_chunks(void *context) {
  struct trax_passages *passages = context;
  pthread_mutex_lock(&passages->mutex);
  for (;;) {
    while (passages->read_count == passages->full && !passages->ended)
      pthread_cond_wait(&passages->filled, &passages->mutex);
    if (passages->read_count == passages->full)
      break;
    pthread_mutex_unlock(&passages->mutex);
    read_chunk(passages, &passages->chunks[passages->read_count % TRAX_PASSAGES_CHUNKS]);
    pthread_mutex_lock(&passages->mutex);
    passages->read_count++;
    pthread_cond_signal(&passages->emptied);
  }
  pthread_mutex_unlock(&passages->mutex);
  return NULL;
}

/* Waits until at most `most` chunks are to be read. */
static void wait_for_reader(struct trax_passages *passages, uint64_t most) {
  while (passages->full - passages->read_count > most)
    pthread_cond_wait(&passages->emptied, &passages->mutex);
}

static struct chunk *current(struct trax_passages *passages) {
  return &passages->chunks[passages->full % TRAX_PASSAGES_CHUNKS];
}

static void end_chunk(struct trax_passages *passages) {
  if (!passages->threaded) {
    read_chunk(passages, current(passages));
    return;
  }
  pthread_mutex_lock(&passages->mutex);
  passages->full++;
  pthread_cond_signal(&passages->filled);
  wait_for_reader(passages, TRAX_PASSAGES_CHUNKS - 1);
  pthread_mutex_unlock(&passages->mutex);
}

static bool reserve(struct chunk *chunk, size_t bytes) {
  if (chunk->used + bytes + PADDING <= chunk->capacity)
    return true;
  const size_t capacity = 2 * (chunk->used + bytes + PADDING);
  uint8_t *larger = realloc(chunk->bytes, capacity);
  if (!larger)
    return false;
  chunk->bytes = larger;
  chunk->capacity = capacity;
  return true;
}

static void append(struct chunk *chunk, const void *array, size_t bytes) {
  if (bytes)
    memcpy(chunk->bytes + chunk->used, array, bytes);
  chunk->used += bytes;
}

/* Takes what belongs to a stretch out of the log. */
static void shorten(struct trax_thread_log *log, size_t charged, uint32_t count) {
  log->charged_count -= charged;
  for (size_t i = 0; i < log->charged_count; i++) {
    log->charged[i] = log->charged[charged + i];
    log->charged[i].at -= count;
  }
}

void trax_passages_add(struct trax_passages *passages, const struct trax_stretch *stretch,
                       struct trax_thread_log *log) {
  struct chunk *chunk = current(passages);
  size_t charged = log->charged_count;
  while (charged && log->charged[charged - 1].at >= stretch->count)
    charged--;
  const struct stored stored = {.thread =
                                    stretch->tm * passages->explain->machine->config.chip.tps_per_tm + stretch->tp,
                                .count = (uint16_t)stretch->count,
                                .next_pc = stretch->next_pc,
                                .result = stretch->result,
                                .pieces = (uint16_t)stretch->pieces,
                                .charged = (uint32_t)charged,
                                .accessed = (uint16_t)stretch->accessed_count,
                                .is_refused = stretch->refused != NULL};
  const size_t refused = refused_bytes(stored.is_refused, stretch->count);
  const size_t bytes = sizeof stored + stretch->pieces * sizeof *stretch->piece + charged * sizeof *log->charged +
                       stretch->accessed_count * sizeof *stretch->accessed + refused;
  if (reserve(chunk, bytes)) {
    append(chunk, &stored, sizeof stored);
    append(chunk, stretch->piece, stretch->pieces * sizeof *stretch->piece);
    append(chunk, log->charged, charged * sizeof *log->charged);
    append(chunk, stretch->accessed, stretch->accessed_count * sizeof *stretch->accessed);
    append(chunk, stretch->refused, refused);
  } else {
    passages->explain->observer.lost = true;
  }
  shorten(log, charged, stretch->count);
  chunk->instructions += stretch->count;
  chunk->calls += stretch->count == 1;
  if (chunk->instructions >= TRAX_PASSAGES_INSTRUCTIONS || chunk->calls >= TRAX_PASSAGES_CALLS)
    end_chunk(passages);
}

void trax_passages_finish(struct trax_passages *passages) {
  end_chunk(passages);
  pthread_mutex_lock(&passages->mutex);
  wait_for_reader(passages, 0);
  pthread_mutex_unlock(&passages->mutex);
}

struct trax_passages *trax_passages_create(struct trax_explain *explain,
                                           void (*read)(struct trax_explain *explain, struct trax_passage *passage)) {
  struct trax_passages *passages = calloc(1, sizeof *passages);
  if (!passages)
    return NULL;
  passages->explain = explain;
  passages->read = read;
  pthread_mutex_init(&passages->mutex, NULL);
  pthread_cond_init(&passages->filled, NULL);
  pthread_cond_init(&passages->emptied, NULL);
  return passages;
}

void trax_passages_start(struct trax_passages *passages) {
  if (!passages->threaded)
    passages->threaded = pthread_create(&passages->thread, NULL, read_chunks, passages) == 0;
}

void trax_passages_destroy(struct trax_passages *passages) {
  if (!passages)
    return;
  if (passages->threaded) {
    pthread_mutex_lock(&passages->mutex);
    passages->ended = true;
    pthread_cond_signal(&passages->filled);
    pthread_mutex_unlock(&passages->mutex);
    pthread_join(passages->thread, NULL);
  }
  for (unsigned i = 0; i < TRAX_PASSAGES_CHUNKS; i++)
    free(passages->chunks[i].bytes);
  pthread_cond_destroy(&passages->emptied);
  pthread_cond_destroy(&passages->filled);
  pthread_mutex_destroy(&passages->mutex);
  free(passages);
}
