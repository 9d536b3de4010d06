/* Mutants of the order of memory (docs/isa.md, "Order"). What a store or load did to the flat memory of the reference
   engine is changed behind it: a store is taken back and made later, a load gives what a cache that is not there would
   still hold. */
#include "mutants.h"
#include "reference/reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "order.h"

typedef enum kind {
  FENCE_W_IGNORED,
  FENCE_RW_IGNORED,
  FENCE_R_KEEPS,
  FENCE_RW_KEEPS,
  LATE_STORES_BEHIND_AINC,
  LOST_NEIGHBOURS,
  CACHED_LWNT,
  STALE_OWN_SWNT,
  STALE_OWN_AINC,
  STALE_IN_TM,
  NEVER_LEAVES
} kind;

static const struct {
  const char *mnemonic, *what;
} texts[] = {
    [FENCE_W_IGNORED] = {"fence", "w does not wait for stores"},
    [FENCE_RW_IGNORED] = {"fence", "rw does not wait for stores"},
    [FENCE_R_KEEPS] = {"fence", "r keeps the TM's cache"},
    [FENCE_RW_KEEPS] = {"fence", "rw keeps the TM's cache"},
    [LATE_STORES_BEHIND_AINC] = {"ainc", "an earlier store to the word reaches memory behind the increment"},
    [LOST_NEIGHBOURS] = {"sb", "the bytes beside those stored are written as they were a while ago"},
    [CACHED_LWNT] = {"lwnt", "the word comes from the TM's cache"},
    [STALE_OWN_SWNT] = {"swnt", "the TM's cache keeps the old word"},
    [STALE_OWN_AINC] = {"ainc", "the TM's cache keeps the old word"},
    [STALE_IN_TM] = {"lw", "every thread has a cache of its own, which keeps old words"},
    [NEVER_LEAVES] = {"sw", "a store reaches memory only when its thread stores again, or ends"},
};

enum { COUNT = sizeof texts / sizeof *texts, DELAY = 300 /* cycles: longer than a fence */, CACHED = 1024 /* words */ };

unsigned trax_order_mutants(void) {
  return COUNT;
}

void trax_order_mutant(unsigned index, struct trax_mutant_text *text) {
  snprintf(text->mnemonic, sizeof text->mnemonic, "%s", texts[index].mnemonic);
  snprintf(text->what, sizeof text->what, "%s", texts[index].what);
}

static int current(void) {
  return trax_mutant_index(
      trax_statement_mutants() + trax_arithmetic_mutants() + trax_decoding_mutants() + trax_machine_mutants(), COUNT);
}

/* --- a cache of words that nobody keeps coherent, for each thread or each TM --- */

static struct {
  uint32_t address, word; /* address 0: none */
} cached[MOST][MOST][CACHED];

static void forget(const struct trax_ref_tm *tm) {
  memset(cached[tm->number], 0, tm->tps * sizeof cached[0][0]);
}

static uint32_t word_at(const struct trax_ref_tm *tm, uint32_t address) {
  uint32_t word;
  memcpy(&word, tm->machine->space.bytes + address, sizeof word);
  return word;
}

/* A word that this thread's cache has is memory's again. */
static void refresh(const struct trax_ref_tm *tm, uint32_t tp, uint32_t address) {
  const uint32_t word = address & ~3u, slot = word / 4 % CACHED;
  if (cached[tm->number][tp][slot].address == word)
    cached[tm->number][tp][slot].word = word_at(tm, word);
}

static void load_from_cache(const struct trax_ref_tm *tm, uint32_t tp, uint32_t address, uint32_t *reg) {
  const uint32_t slot = address / 4 % CACHED;
  if (cached[tm->number][tp][slot].address != address) {
    cached[tm->number][tp][slot].address = address;
    cached[tm->number][tp][slot].word = *reg;
  }
  *reg = cached[tm->number][tp][slot].word;
}

/* --- a store that waits --- */

static struct waiting {
  bool active;
  uint32_t address, bytes, value;
  uint64_t due;
} waiting[MOST][MOST];

static uint32_t before[MOST][MOST]; /* the aligned word before the thread's store */

static void perform(const struct trax_ref_tm *tm, uint32_t tp) {
  struct waiting *store = &waiting[tm->number][tp];
  if (store->active)
    memcpy(tm->machine->space.bytes + store->address, &store->value, store->bytes);
  store->active = false;
}

static bool is_global(const struct trax_ref_tp *tp) {
  return trax_ref_accesses_memory(tp) && tp->address >= TRAX_NULL_END && tp->address < TRAX_LOCAL_BASE;
}

static bool is_late(int mutant) {
  return mutant == FENCE_W_IGNORED || mutant == FENCE_RW_IGNORED || mutant == LATE_STORES_BEHIND_AINC ||
         mutant == NEVER_LEAVES;
}

void trax_order_before(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  const int mutant = current();
  if (mutant < 0 || !is_global(tp) || tp->address >= tm->machine->space.size)
    return;
  struct waiting *store = &waiting[tm->number][tp->number];
  const bool atomic = trax_ref_is(tp, TRAX_IS_ATOMIC);
  if (is_late(mutant)) {
    if (trax_ref_is(tp, TRAX_IS_LOAD)
            ? !(atomic && mutant == LATE_STORES_BEHIND_AINC) && (store->address ^ tp->address) < 4
            : (store->address ^ tp->address) < 4)
      perform(tm, tp->number);
  }
  if (trax_ref_is(tp, TRAX_IS_STORE))
    before[tm->number][tp->number] = word_at(tm, tp->address & ~3u);
}

static void delay(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint64_t t) {
  struct waiting *store = &waiting[tm->number][tp->number];
  if (store->active) {
    if (current() == NEVER_LEAVES)
      perform(tm, tp->number);
    return;
  }
  store->address = tp->address;
  store->bytes = trax_ref_info(tp)->access_bytes;
  store->value = tp->reg[tp->inst.rb];
  store->due = current() == NEVER_LEAVES ? UNKNOWN : t + DELAY;
  store->active = true;
  memcpy(tm->machine->space.bytes + (tp->address & ~3u), &before[tm->number][tp->number], 4);
}

/* The word of a byte store, once more, with its neighbours as they were. */
static void write_word(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint64_t t) {
  struct waiting *store = &waiting[tm->number][tp->number];
  const uint32_t bytes = trax_ref_info(tp)->access_bytes, word = tp->address & ~3u;
  if (store->active && store->address == word) { /* the thread's own stores are in it */
    memcpy((uint8_t *)&store->value + tp->address % 4, &tp->reg[tp->inst.rb], bytes);
    return;
  }
  perform(tm, tp->number);
  if (bytes == 4)
    return;
  *store = (struct waiting){
      .active = true, .address = word, .bytes = 4, .value = before[tm->number][tp->number], .due = t + DELAY};
  memcpy((uint8_t *)&store->value + tp->address % 4, &tp->reg[tp->inst.rb], bytes);
}

static void behind_store(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint64_t t) {
  const int mutant = current();
  if (is_late(mutant))
    delay(tm, tp, t);
  else if (mutant == LOST_NEIGHBOURS)
    write_word(tm, tp, t);
  else if (mutant == STALE_IN_TM)
    refresh(tm, tp->number, tp->address);
  else if (!(mutant == STALE_OWN_SWNT && trax_ref_is(tp, TRAX_IS_NONTEMPORAL)))
    refresh(tm, 0, tp->address);
}

static void behind_load(const struct trax_ref_tm *tm, struct trax_ref_tp *tp) {
  const int mutant = current();
  const bool past = tp->inst.op == TRAX_OP_LWNT;
  if (tp->inst.rd == 0 || (tp->inst.op != TRAX_OP_LW && !past))
    return;
  uint32_t *const rd = &tp->reg[tp->inst.rd];
  if (mutant == STALE_IN_TM && !past)
    load_from_cache(tm, tp->number, tp->address, rd);
  else if (mutant == CACHED_LWNT || (!past && (mutant == STALE_OWN_SWNT || mutant == STALE_OWN_AINC ||
                                               mutant == FENCE_R_KEEPS || mutant == FENCE_RW_KEEPS)))
    load_from_cache(tm, 0, tp->address, rd);
}

static bool others_have_ended(const struct trax_ref_tm *tm) {
  for (uint32_t i = 0; i < tm->tps; i++)
    if (!tm->tp[i].ended)
      return false;
  return true;
}

static void behind_fence(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  const int kind = tp->inst.imm;
  if (kind & TRAX_FENCE_W && current() != (kind == TRAX_FENCE_W ? FENCE_W_IGNORED : FENCE_RW_IGNORED))
    perform(tm, tp->number);
  if (kind & TRAX_FENCE_R && current() != (kind == TRAX_FENCE_R ? FENCE_R_KEEPS : FENCE_RW_KEEPS))
    forget(tm);
}

void trax_order_behind(const struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  if (current() < 0)
    return;
  if (tp->inst.op == TRAX_OP_FENCE)
    behind_fence(tm, tp);
  if (is_global(tp) && trax_ref_is(tp, TRAX_IS_STORE))
    behind_store(tm, tp, t);
  else if (is_global(tp) && trax_ref_is(tp, TRAX_IS_LOAD) && !trax_ref_is(tp, TRAX_IS_ATOMIC))
    behind_load(tm, tp);
  if (tp->ended && (current() == NEVER_LEAVES || others_have_ended(tm)))
    for (uint32_t i = 0; i < tm->tps; i++)
      if (current() != NEVER_LEAVES || i == tp->number)
        perform(tm, i);
}

void trax_order_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic) {
  if (current() == STALE_OWN_SWNT || current() == CACHED_LWNT || current() == FENCE_R_KEEPS ||
      current() == FENCE_RW_KEEPS)
    refresh(tm, 0, atomic->address);
  else if (current() == STALE_IN_TM)
    refresh(tm, atomic->tp, atomic->address);
}

void trax_order_cycle(const struct trax_ref_tm *tm, uint64_t t) {
  if (current() < 0)
    return;
  if (t == 0) {
    memset(waiting[tm->number], 0, sizeof waiting[0]);
    forget(tm);
  }
  for (uint32_t i = 0; i < tm->tps; i++)
    if (waiting[tm->number][i].active && t >= waiting[tm->number][i].due)
      perform(tm, i);
}

void trax_order_fault(const struct trax_ref_tm *tm) {
  for (uint32_t i = 0; current() >= 0 && i < tm->tps; i++)
    perform(tm, i);
}
