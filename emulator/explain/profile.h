/* The counts of a profile, which profile.c makes and profile_text.c writes. */
#ifndef TRAX_EXPLAIN_PROFILE_H
#define TRAX_EXPLAIN_PROFILE_H

#include "explain/places.h"
#include "explain/span.h"
#include "trax/map.h"

/* The counts of one instruction in one context, or a sum of such counts. */
struct trax_profile_counts {
  uint64_t cycles[TRAX_CAUSE_COUNT]; /* thread-cycles; those issued are the instructions */
  uint64_t loads, hits;              /* through the data cache */
};

struct trax_profile_record {
  uint32_t context, index; /* the instruction's, of trax_places */
  struct trax_profile_counts counts;
};

/* A call chain: the call at `index` in the context `parent`. Context 0 is the program's start. */
struct trax_profile_context {
  uint32_t parent, index;
};

struct trax_profile {
  struct trax_reader reader;
  struct trax_profile_thread *threads; /* [threads] */

  struct trax_profile_context *contexts;
  size_t context_count, context_capacity;
  size_t call_count;          /* of all contexts together */
  struct trax_map context_of; /* (parent, index) */
  uint32_t *first_of;         /* [places]: the first context of the call at the instruction; 0: none */
  bool by_call;               /* a file that is wanted needs contexts; else all is in context 0 */

  struct trax_profile_record *records;
  size_t record_count, record_capacity;
  uint8_t *longest; /* [record_count]: of the pieces of its context that begin with the instruction, whose instructions
                       have records */
  size_t longest_capacity;
  struct trax_map record_of; /* (context, index) */
  struct trax_profile_latest {
    uint32_t context, record; /* its number + 1; 0: none */
  } *latest_of;               /* [places]: the latest record of the instruction; a cache of record_of */
};

static inline uint64_t trax_profile_cycles(const struct trax_profile_counts *counts) {
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum += counts->cycles[cause];
  return sum;
}

static inline void trax_profile_add(struct trax_profile_counts *sum, const struct trax_profile_counts *counts) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum->cycles[cause] += counts->cycles[cause];
  sum->loads += counts->loads;
  sum->hits += counts->hits;
}

/* --- the files and members of the page; self is a trax_profile --- */
trax_status trax_profile_put(void *self, FILE *out, trax_error *error);
trax_status trax_profile_put_folded(void *self, FILE *out, trax_error *error);
trax_status trax_profile_put_sample(void *self, FILE *out, trax_error *error);
trax_status trax_profile_put_members(void *self, FILE *out, trax_error *error);

#endif
