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
  MAX_CALLS = 1 << 22
};
_Static_assert(TRAX_MOST_STRETCH <= UINT8_MAX, "a byte holds the length of a piece");

struct call {
  uint32_t return_pc, stack_pointer, context; /* context: of the callee */
};

struct trax_profile_thread {
  uint32_t context, stack_pointer;
  uint32_t latest, latest_context; /* the instruction that was issued last; UINT32_MAX: none */
  struct call *calls;
  size_t depth, capacity;
};

/* The records that the limit leaves out must not depend on the engine's stretches, so stretches are single before it is
   reached. Calls come in the order of the chip's issues in any case. */
_Static_assert(MAX_RECORDS / 2 > TRAX_PASSAGES_FEW, "stretches become single before the limit is reached");

/* Returns the record of an instruction in a context; UINT32_MAX: out of memory. */
static __attribute__((noinline)) uint32_t find_record(struct trax_profile *profile, uint32_t context, uint32_t index) {
  const struct trax_map_entry *entry = trax_map_put(&profile->record_of, sizeof *entry, (uint64_t)context << 32 | index,
                                                    (uint32_t)profile->record_count);
  if (!entry ||
      !trax_grow((void **)&profile->records, profile->record_count, &profile->record_capacity,
                 sizeof *profile->records) ||
      !trax_grow((void **)&profile->longest, profile->record_count, &profile->longest_capacity,
                 sizeof *profile->longest)) {
    profile->reader.explain->out_of_memory = true;
    return UINT32_MAX;
  }
  const uint32_t record = entry->value;
  if (record == profile->record_count) {
    if (record == MAX_RECORDS / 2)
      profile->reader.explain->observer.single = true;
    profile->reader.explain->found++;
    profile->longest[record] = 0;
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

/* Makes records for the instructions of a piece. */
static void add_piece(struct trax_profile *profile, uint32_t context, const struct trax_piece *piece) {
  const uint32_t first = record_at(profile, context, piece->index);
  if (first == UINT32_MAX || profile->longest[first] >= piece->count)
    return;
  for (uint32_t i = profile->longest[first]; i < piece->count; i++)
    record_at(profile, context, piece->index + i);
  profile->longest[first] = (uint8_t)piece->count;
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

static void follow_passage(void *self, struct trax_passage *passage) {
  struct trax_profile *profile = self;
  struct trax_profile_thread *thread = &profile->threads[passage->thread];
  passage->context = thread->context;
  for (size_t i = 0; i < passage->pieces; i++)
    add_piece(profile, passage->context, &passage->piece[i]);
  add_charges(profile, thread, passage->context, passage);
  if (!passage->count)
    return;
  thread->latest = passage->last;
  thread->latest_context = passage->context;
  follow(profile, thread, passage);
}

static void add_counts(void *self, const struct trax_counts *counts) {
  struct trax_profile *profile = self;
  const struct trax_places *places = profile->reader.explain->places;
  struct trax_profile_counts *sum = counts_of(profile, counts->context, counts->index);
  sum->cycles[TRAX_CAUSE_ISSUED] += counts->executed;
  sum->cycles[TRAX_CAUSE_ICACHE_BANK] += counts->fetch;
  sum->cycles[trax_places_refusals(places)[counts->index]] += counts->others;
  for (unsigned i = 1; i < TRAX_OUTCOMES && trax_places_accesses(places)[counts->index] == TRAX_ACCESS_LOAD; i++) {
    sum->loads += counts->outcomes[i];
    sum->hits += i & TRAX_OUTCOME_HIT ? counts->outcomes[i] : 0;
  }
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
  free(profile->longest);
  free(profile->latest_of);
  free(profile->first_of);
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
    .follow = follow_passage,
    .counts = add_counts,
    .put_members = trax_profile_put_members,
    .close = close_profile};
