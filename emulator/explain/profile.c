/* Counts profiles. Each thread has a call stack: a jal or jalr that writes a register is a call, and a jump through a
   register to the return address of the latest call is a return. A tail call makes no frame: its function runs in the
   caller's. A longjmp ends every call that was made with a stack pointer below the present one. It also ends the call
   that the function it returns to had made.

   A recursive program has as many call stacks as calls, so their number is limited: a stack that is one too many counts
   as the first one that ended with the same call. */
#include "explain/profile.h"
#include "explain/passages.h"
#include "trax/grow.h"

#include <stdlib.h>

enum {
  MAX_DEPTH = 512,
  /* No new stack is kept beyond this number of records, or of calls in all stacks. */
  MAX_RECORDS = 1 << 18,
  MAX_CALLS = 1 << 22,
  MOST_SUMMED = UINT16_MAX /* passages after which no sum of bytes can exceed 32 bits */
};
_Static_assert((uint64_t)MOST_SUMMED *TRAX_MOST_STRETCH *UINT8_MAX <= UINT32_MAX, "");

struct call {
  uint32_t return_pc, stack_pointer, context; /* context: of the callee */
};

struct trax_profile_thread {
  uint32_t context, stack_pointer;
  uint32_t latest, latest_context; /* the instruction that was issued last; UINT32_MAX: none */
  struct call *calls;
  size_t depth, capacity;
};

/* What the limit of records leaves out must not depend on the engine's stretches, so they are single before. Calls come
   in the order of the chip's issues in any case. */
_Static_assert(MAX_RECORDS / 2 > TRAX_PASSAGES_FEW, "stretches become single before the limit is reached");

/* Returns the record of an instruction in a context; UINT32_MAX: out of memory. */
static __attribute__((noinline)) uint32_t find_record(struct trax_profile *profile, uint32_t context, uint32_t index) {
  const struct trax_map_entry *entry = trax_map_put(&profile->record_of, sizeof *entry, (uint64_t)context << 32 | index,
                                                    (uint32_t)profile->record_count);
  if (!entry ||
      !trax_grow((void **)&profile->records, profile->record_count, &profile->record_capacity,
                 sizeof *profile->records) ||
      !trax_grow((void **)&profile->pieces, profile->record_count, &profile->pieces_capacity,
                 sizeof *profile->pieces)) {
    profile->reader.explain->out_of_memory = true;
    return UINT32_MAX;
  }
  const uint32_t record = entry->value;
  if (record == profile->record_count) {
    if (record == MAX_RECORDS / 2)
      profile->reader.explain->observer.single = true;
    profile->reader.explain->found++;
    profile->pieces[record] = (struct trax_profile_pieces){0};
    profile->records[profile->record_count++] = (struct trax_profile_record){.context = context, .index = index};
  }
  profile->latest_of[index] = (struct trax_profile_latest){context, record + 1};
  return record;
}

static inline uint32_t record_at(struct trax_profile *profile, uint32_t context, uint32_t index) {
  const struct trax_profile_latest latest = profile->latest_of[index];
  return latest.record && latest.context == context ? latest.record - 1 : find_record(profile, context, index);
}

static struct trax_profile_counts *counts_of(struct trax_profile *profile, uint32_t context, uint32_t index) {
  static struct trax_profile_counts discarded;
  const uint32_t record = record_at(profile, context, index);
  return record == UINT32_MAX ? &discarded : &profile->records[record].counts;
}

/* --- the call stack --- */

/* The local stack begins at 0 and grows down, so 0 is above all other addresses. */
static bool is_below(uint32_t stack_pointer, uint32_t other) {
  return stack_pointer - 1 < other - 1;
}

/* Returns the context of a call at `index`, below `depth` others; 0: out of memory. */
static uint32_t context_of(struct trax_profile *profile, uint32_t parent, uint32_t index, size_t depth) {
  const uint64_t key = (uint64_t)parent << 32 | index;
  const struct trax_map_entry *entry = trax_map_find(&profile->context_of, sizeof *entry, key);
  if (entry)
    return entry->value;
  if ((profile->record_count >= MAX_RECORDS || profile->call_count >= MAX_CALLS) && profile->first_of[index])
    return profile->first_of[index];
  const uint32_t context = (uint32_t)profile->context_count;
  if (!trax_map_put(&profile->context_of, sizeof *entry, key, context) ||
      !trax_grow((void **)&profile->contexts, profile->context_count, &profile->context_capacity,
                 sizeof *profile->contexts))
    return 0;
  profile->contexts[profile->context_count++] = (struct trax_profile_context){parent, index};
  profile->call_count += depth + 1;
  if (!profile->first_of[index])
    profile->first_of[index] = context;
  return context;
}

static void call(struct trax_profile *profile, struct trax_profile_thread *thread, uint32_t index, uint32_t return_pc) {
  if (thread->depth == MAX_DEPTH || !profile->by_call)
    return;
  const uint32_t context = context_of(profile, thread->context, index, thread->depth);
  if (!context || !trax_grow((void **)&thread->calls, thread->depth, &thread->capacity, sizeof *thread->calls)) {
    profile->reader.explain->out_of_memory = true;
    return;
  }
  thread->calls[thread->depth++] = (struct call){return_pc, thread->stack_pointer, context};
  thread->context = context;
}

/* Returns where the function of an instruction begins; 0: it has no symbol. */
static uint32_t function_at(struct trax_places *places, uint32_t pc) {
  const struct trax_place *place = trax_places_at(places, trax_places_index(places, pc));
  return place->symbol ? pc - place->offset : 0;
}

/* Whether the jump from one pc to another, which is no return, goes back into the middle of the function that made the
   latest call. A function's jump within itself leaves nothing, though it may have called itself. */
static bool leaves_call(const struct trax_profile *profile, const struct trax_profile_thread *thread, uint32_t from,
                        uint32_t to) {
  struct trax_places *places = profile->reader.explain->places;
  const struct call *latest = &thread->calls[thread->depth - 1];
  if (latest->return_pc == to || latest->stack_pointer != thread->stack_pointer)
    return false;
  const uint32_t function = function_at(places, to);
  return function && function != to && function == function_at(places, latest->return_pc - 4) &&
         function != function_at(places, from);
}

static void jump_through_register(const struct trax_profile *profile, struct trax_profile_thread *thread, uint32_t from,
                                  uint32_t to) {
  while (thread->depth && (is_below(thread->calls[thread->depth - 1].stack_pointer, thread->stack_pointer) ||
                           leaves_call(profile, thread, from, to)))
    thread->depth--;
  if (thread->depth && thread->calls[thread->depth - 1].return_pc == to &&
      thread->calls[thread->depth - 1].stack_pointer == thread->stack_pointer) /* else of a call beyond MAX_DEPTH */
    thread->depth--;
  thread->context = thread->depth ? thread->calls[thread->depth - 1].context : 0;
}

/* Follows the last instruction of a passage. */
static void follow(struct trax_profile *profile, struct trax_profile_thread *thread,
                   const struct trax_passage *passage) {
  const trax_inst inst = passage->inst;
  const struct trax_piece *piece = &passage->piece[passage->pieces - 1];
  const uint32_t pc = piece->pc + 4 * (piece->count - 1);
  if (inst.op == TRAX_OP_JAL || inst.op == TRAX_OP_JALR) {
    if (inst.rd && passage->next_pc != pc + 4) /* else a call of a weak function that is not defined */
      call(profile, thread, passage->last, pc + 4);
    else if (!inst.rd && inst.op == TRAX_OP_JALR)
      jump_through_register(profile, thread, pc, passage->next_pc);
  } else if (inst.rd == TRAX_STACK_POINTER && trax_op_table[inst.op].flags & TRAX_WRITES_RD) {
    thread->stack_pointer = passage->result;
  }
}

/* --- the reader --- */

static void add_piece(struct trax_profile *profile, uint32_t context, const struct trax_piece *piece) {
  const uint32_t first = record_at(profile, context, piece->index);
  if (first == UINT32_MAX)
    return;
  for (uint32_t i = profile->pieces[first].longest; i < piece->count; i++)
    record_at(profile, context, piece->index + i);
  if (profile->pieces[first].longest < piece->count)
    profile->pieces[first].longest = piece->count;
  const uint32_t last = record_at(profile, context, piece->index + piece->count - 1);
  profile->pieces[first].begun++;
  if (last != UINT32_MAX)
    profile->pieces[last].ended++;
}

static void add_charges(struct trax_profile *profile, const struct trax_profile_thread *thread, uint32_t context,
                        const struct trax_passage *passage) {
  const struct trax_places *places = profile->reader.explain->places;
  for (size_t i = 0; i < passage->charged_count; i++) {
    const struct trax_charged *charged = &passage->charged[i];
    uint32_t of = context, index = charged->index;
    if (charged->cause == TRAX_CAUSE_HALTED) {
      of = 0;
      index = trax_places_halted(places);
    } else if (charged->cause == TRAX_CAUSE_BRANCH && charged->at) { /* of the jump before it */
      index = trax_passage_index(passage, charged->at - 1u);
    } else if (charged->cause == TRAX_CAUSE_BRANCH && thread->latest != UINT32_MAX) {
      of = thread->latest_context;
      index = thread->latest;
    }
    counts_of(profile, of, index)->cycles[charged->cause] += charged->cycles;
  }
}

/* --- sums --- */

/* Returns the sums of a context; NULL: it has none. */
static const struct trax_profile_sums *sums_of(struct trax_profile *profile, uint32_t context) {
  struct trax_profile_sums *sums = context < TRAX_PROFILE_SUMS ? &profile->sums[context] : NULL;
  if (sums && !sums->fetch) {
    const size_t places = (size_t)trax_places_count(profile->reader.explain->places) + 2 + 8;
    if (!(sums->fetch = calloc(4 * places, sizeof *sums->fetch)))
      return NULL;
    sums->others = sums->fetch + places;
    sums->loads = sums->others + places;
    sums->missed = sums->loads + places;
  }
  return sums;
}

static void take_sums(struct trax_profile *profile) {
  const struct trax_places *places = profile->reader.explain->places;
  const uint8_t *const refusals = trax_places_refusals(places);
  for (uint32_t context = 0; context < TRAX_PROFILE_SUMS; context++) {
    const struct trax_profile_sums *sums = &profile->sums[context];
    for (uint32_t i = 0; sums->fetch && i < trax_places_count(places); i++) {
      if (!(sums->fetch[i] | sums->others[i] | sums->loads[i]))
        continue;
      struct trax_profile_counts *counts = counts_of(profile, context, i);
      counts->cycles[TRAX_CAUSE_ICACHE_BANK] += sums->fetch[i];
      counts->cycles[refusals[i]] += sums->others[i];
      counts->loads += sums->loads[i];
      counts->hits += sums->loads[i] - sums->missed[i];
      sums->fetch[i] = sums->others[i] = sums->loads[i] = sums->missed[i] = 0;
    }
  }
  profile->summed = 0;
}

typedef uint16_t halves __attribute__((vector_size(16), aligned(2), may_alias));
typedef uint32_t words __attribute__((vector_size(32), aligned(4), may_alias));

/* Adds the refusals of `count` neighbouring instructions to sums. */
static void add_to_sums(uint32_t *fetch, uint32_t *others, const uint16_t *refused, uint32_t count) {
  const halves number = {0, 1, 2, 3, 4, 5, 6, 7};
  for (uint32_t i = 0; i < count; i += 8) {
    halves some = *(const halves *)(refused + i);
    if (count - i < 8)
      some &= (halves)(number < (uint16_t)(count - i));
    *(words *)(fetch + i) += __builtin_convertvector(some & 0xFF, words);
    *(words *)(others + i) += __builtin_convertvector(some >> 8, words);
  }
}

static void add_refused(struct trax_profile *profile, uint32_t context, const struct trax_passage *passage) {
  const struct trax_profile_sums *sums = sums_of(profile, context);
  const uint8_t *const refusals = trax_places_refusals(profile->reader.explain->places);
  const uint16_t *refused = passage->refused;
  for (size_t i = 0; i < passage->pieces; refused += passage->piece[i++].count) {
    const struct trax_piece *piece = &passage->piece[i];
    if (sums)
      add_to_sums(sums->fetch + piece->index, sums->others + piece->index, refused, piece->count);
    for (uint32_t k = 0; !sums && k < piece->count; k++)
      if (refused[k]) {
        struct trax_profile_counts *counts = counts_of(profile, context, piece->index + k);
        counts->cycles[TRAX_CAUSE_ICACHE_BANK] += refused[k] & 0xFF;
        counts->cycles[refusals[piece->index + k]] += refused[k] >> 8;
      }
  }
}

static void add_accesses(struct trax_profile *profile, uint32_t context, const struct trax_passage *passage) {
  const uint8_t *const accesses = trax_places_accesses(profile->reader.explain->places);
  const struct trax_profile_sums *sums = sums_of(profile, context);
  for (size_t i = 0; i < passage->accessed_count; i++) {
    const struct trax_accessed *accessed = &passage->accessed[i];
    if (!accessed->outcome || accesses[accessed->index] != TRAX_ACCESS_LOAD)
      continue;
    if (sums) {
      sums->loads[accessed->index]++;
      if (!(accessed->outcome & TRAX_OUTCOME_HIT)) /* few */
        sums->missed[accessed->index]++;
      continue;
    }
    struct trax_profile_counts *counts = counts_of(profile, context, accessed->index);
    counts->loads++;
    counts->hits += accessed->outcome & TRAX_OUTCOME_HIT;
  }
}

static void add_passage(void *self, const struct trax_passage *passage) {
  struct trax_profile *profile = self;
  struct trax_profile_thread *thread = &profile->threads[passage->thread];
  const uint32_t context = thread->context;
  for (size_t i = 0; i < passage->pieces; i++)
    add_piece(profile, context, &passage->piece[i]);
  add_charges(profile, thread, context, passage);
  if (passage->refused)
    add_refused(profile, context, passage);
  add_accesses(profile, context, passage);
  if (++profile->summed == MOST_SUMMED)
    take_sums(profile);
  if (!passage->count)
    return;
  thread->latest = passage->last;
  thread->latest_context = context;
  follow(profile, thread, passage);
}

struct order {
  uint32_t context, index, record;
};

static int by_place(const void *a, const void *b) {
  const struct order *x = a, *y = b;
  if (x->context != y->context)
    return x->context < y->context ? -1 : 1;
  return x->index < y->index ? -1 : x->index > y->index;
}

/* Sets the executions of each record. */
static trax_status add_issued(void *self, trax_error *error) {
  struct trax_profile *profile = self;
  take_sums(profile);
  struct order *order = trax_explain_array(profile->record_count, sizeof *order, error);
  uint64_t executed = 0; /* by the pieces that have begun and not ended */
  if (!order)
    return TRAX_ERROR;
  for (size_t i = 0; i < profile->record_count; i++)
    order[i] = (struct order){profile->records[i].context, profile->records[i].index, (uint32_t)i};
  qsort(order, profile->record_count, sizeof *order, by_place);
  for (size_t i = 0; i < profile->record_count; i++) {
    const struct trax_profile_pieces *pieces = &profile->pieces[order[i].record];
    executed += pieces->begun;
    profile->records[order[i].record].counts.cycles[TRAX_CAUSE_ISSUED] = executed;
    executed -= pieces->ended;
  }
  free(order);
  return TRAX_OK;
}

static trax_status open_profile(void *self, trax_error *error) {
  struct trax_profile *profile = self;
  const struct trax_explain_options *options = &profile->reader.explain->options;
  const uint64_t threads = profile->reader.explain->machine->stats.threads;
  const size_t places = (size_t)trax_places_count(profile->reader.explain->places) + 2;
  profile->by_call = options->profile || options->folded || options->explore;
  if (!(profile->threads = trax_explain_array(threads, sizeof *profile->threads, error)) ||
      !(profile->latest_of = trax_explain_array(places, sizeof *profile->latest_of, error)) ||
      !(profile->first_of = trax_explain_array(places, sizeof *profile->first_of, error)))
    return TRAX_ERROR;
  if (!trax_grow((void **)&profile->contexts, 0, &profile->context_capacity, sizeof *profile->contexts))
    return trax_fail(error, "out of memory for the profile");
  profile->contexts[profile->context_count++] = (struct trax_profile_context){0, 0};
  for (uint64_t i = 0; i < threads; i++)
    profile->threads[i].latest = UINT32_MAX;
  return TRAX_OK;
}

static void close_profile(void *self) {
  struct trax_profile *profile = self;
  for (uint64_t i = 0; profile->threads && i < profile->reader.explain->machine->stats.threads; i++)
    free(profile->threads[i].calls);
  free(profile->threads);
  free(profile->contexts);
  free(profile->records);
  free(profile->pieces);
  free(profile->latest_of);
  free(profile->first_of);
  for (unsigned i = 0; i < TRAX_PROFILE_SUMS; i++)
    free(profile->sums[i].fetch);
  trax_map_free(&profile->context_of);
  trax_map_free(&profile->record_of);
}

const struct trax_reader_kind trax_profile_reader = {
    .bytes = sizeof(struct trax_profile),
    .files = {{.path = TRAX_EXPLAIN_PATH(profile), .put = trax_profile_put},
              {.path = TRAX_EXPLAIN_PATH(folded), .put = trax_profile_put_folded},
              {.path = TRAX_EXPLAIN_PATH(sample), .put = trax_profile_put_sample}},
    .in_page = true,
    .open = open_profile,
    .passage = add_passage,
    .end = add_issued,
    .put_members = trax_profile_put_members,
    .close = close_profile};
