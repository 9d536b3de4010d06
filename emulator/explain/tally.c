#include "explain/tally.h"
#include "explain/places.h"
#include "machine/ray_cycles.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

#ifdef __x86_64__
#include <immintrin.h>
#endif

#define ALWAYS_INLINE inline __attribute__((always_inline))

enum {
  CONTEXTS = TRAX_TALLY_CONTEXTS,
  KINDS = TRAX_RAY_KIND_COUNT + 1,
  BEHIND = 8 /* entries behind the last instruction, which vectors reach */
};

/* Accesses of an instruction to one region: what most of them change is in a line of the host's cache. */
struct accesses {
  uint32_t begin, bytes; /* of the region; bytes: its bytes - 1 */
  uint32_t hits;         /* accesses of the outcome TRAX_OUTCOME_HIT alone, which are most */
  uint32_t others;       /* those of the instruction's refusals that belong to earlier regions */
};

/* Counts of a call chain and a kind of ray. All are [places + BEHIND]. */
struct slot {
  uint32_t *executed;       /* as differences */
  uint32_t *fetch, *others; /* refusals (trax_stretch.refused) */
  struct accesses *accesses;
  uint32_t (*outcomes)[TRAX_OUTCOMES]; /* other accesses to the same region */
};

struct trax_tally {
  struct trax_explain *explain;
  size_t places;
  void (*add_pieces)(const struct slot *slot, const struct trax_passage *passage);
  struct slot slots[CONTEXTS][KINDS]; /* `executed` is NULL before the first passage */
  struct trax_counts *ended;          /* [ended_count]: accesses to regions that are not the latest */
  size_t ended_count, ended_capacity;
};

static void lose(const struct trax_tally *tally) {
  __atomic_store_n(&tally->explain->observer.lost, true, __ATOMIC_RELAXED);
}

/* Sets region and outcomes to those of the instruction's latest region, if it has been accessed. */
static void read_accesses(const struct trax_tally *tally, const struct slot *slot, uint32_t index,
                          struct trax_counts *counts) {
  const struct accesses *accesses = &slot->accesses[index];
  uint64_t any = counts->outcomes[TRAX_OUTCOME_HIT] = accesses->hits;
  for (unsigned i = 0; i < TRAX_OUTCOMES; i++)
    any += counts->outcomes[i] += slot->outcomes[index][i];
  if (any)
    counts->region = trax_objects_region(&tally->explain->objects, accesses->begin);
}

static void clear_accesses(const struct slot *slot, uint32_t index) {
  slot->accesses[index] = (struct accesses){0};
  memset(slot->outcomes[index], 0, sizeof slot->outcomes[index]);
}

/* --- adding --- */

static bool open_slot(const struct trax_tally *tally, struct slot *slot) {
  const size_t count = tally->places + BEHIND;
  if (!(slot->executed = calloc(count, 3 * sizeof *slot->executed + sizeof *slot->accesses + sizeof *slot->outcomes)))
    return false;
  slot->fetch = slot->executed + count;
  slot->others = slot->fetch + count;
  slot->accesses = (struct accesses *)(slot->others + count);
  slot->outcomes = (uint32_t(*)[TRAX_OUTCOMES])(slot->accesses + count);
  return true;
}

/* Ends the counts of the instruction's latest region; others: its refusals so far. */
static void end_region(struct trax_tally *tally, const struct slot *slot, const struct trax_passage *passage,
                       uint32_t index, uint32_t others) {
  struct trax_counts ended = {.context = passage->context,
                              .kind = passage->kind,
                              .index = index,
                              .others = others - slot->accesses[index].others};
  read_accesses(tally, slot, index, &ended);
  if (!ended.region)
    return;
  if (!trax_grow((void **)&tally->ended, tally->ended_count, &tally->ended_capacity, sizeof *tally->ended)) {
    lose(tally);
    return;
  }
  tally->ended[tally->ended_count++] = ended;
  clear_accesses(slot, index);
}

/* Access `number` of the passage is the first to another region. The passage's refusals are not in the slot yet. */
static __attribute__((noinline)) void change_region(struct trax_tally *tally, const struct slot *slot,
                                                    const struct trax_passage *passage, size_t number, uint32_t index) {
  uint32_t others = slot->others[index];
  for (size_t i = 0; passage->refused && i < number; i++)
    if (trax_passage_index(passage, passage->accessed[i].at) == index)
      others += trax_refused_others(passage->refused[passage->accessed[i].at]);
  end_region(tally, slot, passage, index, others);
  const struct trax_region *region = trax_objects_region(&tally->explain->objects, passage->accessed[number].address);
  slot->accesses[index] =
      (struct accesses){.begin = region->begin, .bytes = region->last - region->begin, .others = others};
}

static void add_accesses(struct trax_tally *tally, const struct slot *slot, const struct trax_passage *passage) {
  const struct trax_piece *piece = passage->piece;
  uint32_t begin = 0; /* the number of the piece's first instruction */
  for (size_t i = 0; i < passage->accessed_count; i++) {
    const struct trax_accessed accessed = passage->accessed[i];
    for (; accessed.at - begin >= piece->count; piece++)
      begin += piece->count;
    const uint32_t index = piece->index + (accessed.at - begin);
    struct accesses *accesses = &slot->accesses[index];
    if (__builtin_expect(accessed.address - accesses->begin > accesses->bytes, false))
      change_region(tally, slot, passage, i, index);
    if (__builtin_expect(accessed.outcome == TRAX_OUTCOME_HIT, true))
      accesses->hits++;
    else
      slot->outcomes[index][accessed.outcome & (TRAX_OUTCOMES - 1)]++;
  }
}

/* Adds eight bytes to eight sums. */
typedef void add_eight(uint32_t *sums, uint64_t bytes);

static inline void add_eight_anywhere(uint32_t *sums, uint64_t bytes) {
  for (unsigned i = 0; i < 8; i++)
    sums[i] += bytes >> 8 * i & 0xFF;
}

/* Adds the refusals of `count` neighbouring instructions. */
static ALWAYS_INLINE void add_refused(uint32_t *fetch, uint32_t *others, const uint8_t *refused, uint32_t count,
                                      add_eight *add) {
  const uint64_t low = UINT64_MAX / UINT8_MAX * TRAX_MOST_REFUSED; /* of each byte */
  uint64_t some;
  for (uint32_t i = 0; i < count; i += 8) {
    memcpy(&some, refused + i, sizeof some);
    if (count - i < 8)
      some &= ((uint64_t)1 << 8 * (count - i)) - 1;
    add(fetch + i, some & low);
    add(others + i, some >> TRAX_REFUSED_SHIFT & low);
  }
}

static ALWAYS_INLINE void add_pieces(const struct slot *slot, const struct trax_passage *passage, add_eight *add) {
  const uint8_t *refused = passage->refused;
  for (const struct trax_piece *piece = passage->piece; piece < passage->piece + passage->pieces; piece++) {
    slot->executed[piece->index]++;
    slot->executed[piece->index + piece->count]--;
    if (refused) {
      add_refused(slot->fetch + piece->index, slot->others + piece->index, refused, piece->count, add);
      refused += piece->count;
    }
  }
}

static void add_pieces_anywhere(const struct slot *slot, const struct trax_passage *passage) {
  add_pieces(slot, passage, add_eight_anywhere);
}

#ifdef __x86_64__
static inline __attribute__((target("avx2"))) void add_eight_by_avx2(uint32_t *sums, uint64_t bytes) {
  __m256i *const to = (__m256i *)sums;
  const __m256i terms = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)bytes));
  _mm256_storeu_si256(to, _mm256_add_epi32(_mm256_loadu_si256(to), terms));
}

static __attribute__((target("avx2"))) void add_pieces_by_avx2(const struct slot *slot,
                                                               const struct trax_passage *passage) {
  add_pieces(slot, passage, add_eight_by_avx2);
}
#endif

void trax_tally_add(struct trax_tally *tally, const struct trax_passage *passage) {
  if (passage->context >= CONTEXTS)
    return;
  struct slot *slot = &tally->slots[passage->context][passage->kind];
  if (!slot->executed && !open_slot(tally, slot)) {
    lose(tally);
    return;
  }
  add_accesses(tally, slot, passage);
  tally->add_pieces(slot, passage);
}

/* --- giving --- */

static void give(const struct trax_tally *tally, const struct trax_counts *counts) {
  const struct trax_explain *explain = tally->explain;
  for (unsigned i = 0; i < explain->reader_count; i++)
    if (explain->readers[i]->kind->counts)
      explain->readers[i]->kind->counts(explain->readers[i], counts);
}

void trax_tally_add_alone(const struct trax_tally *tally, const struct trax_passage *passage) {
  const struct trax_accessed *accessed = passage->accessed, *const end = accessed + passage->accessed_count;
  for (unsigned at = 0; at < passage->count; at++) {
    struct trax_counts counts = {.context = passage->context,
                                 .kind = passage->kind,
                                 .index = trax_passage_index(passage, at),
                                 .executed = 1,
                                 .fetch = passage->refused ? trax_refused_fetch(passage->refused[at]) : 0,
                                 .others = passage->refused ? trax_refused_others(passage->refused[at]) : 0};
    if (accessed < end && accessed->at == at) {
      counts.region = trax_objects_region(&tally->explain->objects, accessed->address);
      counts.outcomes[accessed++->outcome & (TRAX_OUTCOMES - 1)] = 1;
    }
    give(tally, &counts);
  }
}

void trax_tally_drain(struct trax_tally *tally) {
  for (size_t i = 0; i < tally->ended_count; i++)
    give(tally, &tally->ended[i]);
  tally->ended_count = 0;
}

static void flush_slot(const struct trax_tally *tally, const struct slot *slot, uint32_t context, unsigned kind) {
  uint32_t executed = 0;
  for (uint32_t i = 0; i < tally->places; i++) {
    struct trax_counts counts = {.context = context,
                                 .kind = kind,
                                 .index = i,
                                 .executed = executed += slot->executed[i],
                                 .fetch = slot->fetch[i],
                                 .others = slot->others[i] - slot->accesses[i].others};
    slot->executed[i] = slot->fetch[i] = slot->others[i] = 0;
    if (!(counts.executed | counts.fetch | counts.others))
      continue;
    read_accesses(tally, slot, i, &counts);
    clear_accesses(slot, i);
    give(tally, &counts);
  }
}

void trax_tally_flush(struct trax_tally *tally) {
  trax_tally_drain(tally);
  for (uint32_t context = 0; context < CONTEXTS; context++)
    for (unsigned kind = 0; kind < KINDS; kind++)
      if (tally->slots[context][kind].executed)
        flush_slot(tally, &tally->slots[context][kind], context, kind);
}

struct trax_tally *trax_tally_create(struct trax_explain *explain) {
  struct trax_tally *tally = calloc(1, sizeof *tally);
  if (!tally)
    return NULL;
  tally->explain = explain;
  tally->places = (size_t)trax_places_count(explain->places) + 2;
  tally->add_pieces = add_pieces_anywhere;
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2"))
    tally->add_pieces = add_pieces_by_avx2;
#endif
  return tally;
}

void trax_tally_destroy(struct trax_tally *tally) {
  if (!tally)
    return;
  for (uint32_t context = 0; context < CONTEXTS; context++)
    for (unsigned kind = 0; kind < KINDS; kind++)
      free(tally->slots[context][kind].executed);
  free(tally->ended);
  free(tally);
}
