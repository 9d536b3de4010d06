#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
/* The read set and the write set of the run, by blocks of global memory. A value loaded by a burst is right as long as
   no TP writes the block that it came from. Before a LOADED block is written for the first time, every TP rolls back to
   what it has issued, and its head executes at issue. After that the block is WRITTEN: bursts that load from it are
   watched. Before a word is written from which a watched burst has loaded, that burst's TP rolls back. So data that is
   only read costs nothing, and data that is only written, such as a picture, costs no roll back. The input buffer is
   hardly ever written: all of it counts as LOADED until a first write, so loads from it need not be recorded. */
#include "fast/function/burst.h"
#include "fast/store_buffer.h"
#include "fast/time/head.h"

#include <assert.h>
#include <string.h>
#include <sys/mman.h>

enum { FIRST_AREA = 256 /* blocks */, MOST_DOUBLINGS = 12 };

trax_status trax_fast_blocks_create(struct trax_fast_blocks *blocks, const struct trax_space *space,
                                    trax_error *error) {
  blocks->bytes = space->size >> TRAX_BLOCK_SHIFT; /* the host provides what is touched */
  blocks->input = space->input;
  blocks->input_bytes = space->input_bytes;
  void *state = mmap(NULL, blocks->bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (state == MAP_FAILED)
    return trax_fail(error, "cannot reserve %zu bytes of host memory", blocks->bytes);
  blocks->state = state;
  for (size_t i = 0; i < space->hole_count; i++) /* so that loads from holes end bursts, and fault at issue */
    for (uint64_t at = space->holes[i].begin; at < space->holes[i].end; at += 1u << TRAX_BLOCK_SHIFT)
      blocks->state[at >> TRAX_BLOCK_SHIFT] = TRAX_BLOCK_HOLE;
  return TRAX_OK;
}

void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks) {
  if (blocks->state)
    munmap(blocks->state, blocks->bytes);
}

/* Undoes the stores of the TP's burst. */
static void undo_stores(const struct trax_chip *chip, struct trax_tp *tp) {
  for (; tp->burst.undo_begin <= TRAX_BURST; tp->burst.undo_begin++) {
    const struct trax_burst_access *undo = &tp->burst.access[tp->burst.undo_begin];
    memcpy(tp->local + (undo->address - TRAX_LOCAL_BASE), &undo->word, sizeof undo->word);
  }
  for (uint32_t i = tp->alone ? tp->burst.load_count : 0; i-- > 0;)
    if (tp->stores[i / 64] >> i % 64 & 1)
      memcpy(chip->machine->space.bytes + (tp->burst.access[i].address & ~3u), &tp->burst.access[i].word,
             sizeof tp->burst.access[i].word);
}

/* Undoes the TP's burst, and executes the issued steps again. They give the same results, since the values of loads
   from WRITTEN blocks are kept, and no other word that they loaded has been written since. */
void trax_fast_roll_back_tp(struct trax_tm *tm, unsigned number) {
  struct trax_chip *const chip = tm->chip;
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tp *tp = &tm->tp[number];
  if (tm->executes_at_issue & bit)
    return;
  if (tm->observed)
    trax_fast_tell_before(tm, number);
  undo_stores(chip, tp);
  memcpy(tp->reg, tp->begin_reg, sizeof tp->begin_reg);
  const unsigned issued = tm->heads.at[number];
  const uint32_t head = trax_fast_head(tm, number);
  const uint16_t step = tp->burst.step[issued];                    /* the head needs the same resources as before */
  trax_fast_end_burst(tm, number, tm->heads.last[number] + 1u, 0); /* takes the whole burst off the counts */
  tp->resume = tp->begin;
  tp->resume_pc = chip->program.timing[tp->begin - chip->program.inst].pc;
  tp->again = true;
  const unsigned again = trax_fast_burst(chip, tm, number, issued);
  tp->again = false;
  assert(again == issued && tp->resume == &chip->program.inst[head]);
  (void)again;
  trax_fast_end_burst(tm, number, issued, issued);
  tp->inst = chip->program.timing[tp->resume - chip->program.inst].decoded;
  tp->pc = tp->resume_pc;
  tp->address = tp->inst->bytes ? tp->reg[tp->inst->ra] + (uint32_t)tp->inst->imm : 0;
  trax_fast_execute_at_issue(tm, number, step, head, tp->address);
  if (tm->observed)
    tm->observed->told[number] = tm->observed->told_loads[number] = 0;
}

void trax_fast_roll_back(void *context) {
  struct trax_chip *chip = context;
  for (uint32_t i = 0; i < chip->tms; i++)
    for (unsigned tp = 0; tp < chip->tm[i].tps; tp++)
      trax_fast_roll_back_tp(&chip->tm[i], tp);
}

/* Whether the TP's burst has loaded a word, as far as the loads may not have been issued: heads.load is behind a quick
   head that is being issued in the cycle of a store past the cache. */
static bool reads(const struct trax_tm *tm, unsigned number, uint32_t word) {
  const struct trax_tp *tp = &tm->tp[number];
  const uint32_t first = tm->heads.load[number] - (tm->heads.load[number] > 0), end = tp->burst.load_count;
  uint32_t any = 0;
  for (uint32_t i = first; i < end; i++) /* without branches, so that the host's vectors do it */
    any |= (tp->burst.access[i].address & ~3u) == word;
  for (uint32_t i = first; any && i < end; i++)
    if ((tp->burst.access[i].address & ~3u) == word && !trax_tp_stores(tp, i))
      return true;
  return false;
}

uint64_t trax_fast_find_readers(struct trax_tm *tm, uint32_t address, uint64_t but) {
  const unsigned line = trax_fast_line_hash(address);
  uint64_t found = 0;
  for (uint64_t rest = tm->readers[line] & ~but; rest; rest &= rest - 1)
    if (!(tm->watched[trax_first(rest)] >> line % 64 & 1)) /* of an earlier burst */
      tm->readers[line] &= ~(rest & -rest);
    else if (reads(tm, trax_first(rest), address & ~3u))
      found |= rest & -rest;
  return found;
}

void trax_fast_roll_back_readers(struct trax_tm *tm, uint32_t address, uint64_t but) {
  for (uint64_t rest = trax_fast_find_readers(tm, address, but); rest; rest &= rest - 1)
    trax_fast_roll_back_tp(tm, trax_first(rest));
}

void trax_fast_record_readers(struct trax_tm *tm) {
  const uint8_t *const state = tm->chip->blocks.state;
  for (unsigned number = 0; number < tm->tps; number++) {
    const struct trax_tp *const tp = &tm->tp[number];
    const uint32_t end = tm->watched[number] ? tp->burst.load_count : 0;
    struct trax_overlay_line *line = NULL;
    for (uint32_t i = tm->heads.load[number]; i < end; i++) {
      const uint32_t address = tp->burst.access[i].address & ~3u;
      if (trax_tp_stores(tp, i) ||
          __atomic_load_n(&state[address >> TRAX_BLOCK_SHIFT], __ATOMIC_RELAXED) < TRAX_BLOCK_WRITTEN)
        continue;
      if (!line || line->number != address / TRAX_OVERLAY_BYTES)
        line = trax_store_buffer_line(tm->buffer, address);
      if (line)
        line->read |= trax_overlay_bits(address, 4);
    }
  }
}

/* After a roll back of all TPs: makes all blocks around an address WRITTEN, so that their first writes need no roll
   back of their own. Each roll back does so for a larger area. */
static void widen(struct trax_fast_blocks *blocks, uint32_t address) {
  const size_t area =
      (size_t)FIRST_AREA << (blocks->roll_backs < MOST_DOUBLINGS ? blocks->roll_backs++ : MOST_DOUBLINGS);
  const size_t begin = (address >> TRAX_BLOCK_SHIFT) & ~(area - 1);
  for (size_t i = begin; i < begin + area && i < blocks->bytes; i++)
    if (blocks->state[i] < TRAX_BLOCK_WRITTEN)
      blocks->state[i] = TRAX_BLOCK_WRITTEN;
}

void trax_fast_word_written(struct trax_chip *chip, uint32_t address, uint8_t state) {
  if (trax_fast_is_loaded(&chip->blocks, address)) {
    trax_fast_roll_back(chip);
    widen(&chip->blocks, address);
  }
  for (uint32_t i = 0; i < chip->tms; i++)
    trax_fast_roll_back_readers(&chip->tm[i], address, 0);
  trax_fast_set_written(&chip->blocks, address, state);
}

bool trax_fast_store(struct trax_tm *tm, unsigned number, unsigned load, unsigned bytes, uint64_t t) {
  struct trax_chip *const chip = tm->chip;
  const struct trax_burst_access *const store = &tm->tp[number].burst.access[load];
  const uint32_t address = store->address, value = store->word;
  const uint64_t bit = (uint64_t)1 << number;
  if (tm->buffer) {
    trax_fast_roll_back_readers(tm, address, bit);
    trax_fast_store_in_epoch(&chip->blocks, tm->buffer, t, address, value, bytes);
    return true;
  }
  if (trax_fast_is_loaded(&chip->blocks, address))
    return false;
  for (uint32_t i = 0; i < chip->tms; i++)
    trax_fast_roll_back_readers(&chip->tm[i], address, &chip->tm[i] == tm ? bit : 0);
  trax_fast_set_written(&chip->blocks, address, TRAX_BLOCK_WRITTEN);
  memcpy(chip->machine->space.bytes + address, &value, bytes);
  return true;
}

uint32_t trax_fast_increment_outside(void *context, uint32_t address) {
  struct trax_chip *chip = context;
  uint32_t word;
  trax_fast_word_written(chip, address, TRAX_BLOCK_SHARED);
  memcpy(&word, chip->machine->space.bytes + address, sizeof word);
  const uint32_t incremented = word + 1;
  memcpy(chip->machine->space.bytes + address, &incremented, sizeof incremented);
  return word;
}

void trax_fast_range_written(void *context, uint32_t address, uint32_t bytes) {
  struct trax_chip *chip = context;
  for (uint64_t at = address >> TRAX_BLOCK_SHIFT << TRAX_BLOCK_SHIFT; at < address + (uint64_t)bytes;
       at += 1u << TRAX_BLOCK_SHIFT) {
    if (trax_fast_is_loaded(&chip->blocks, (uint32_t)at))
      trax_fast_roll_back(chip);
    trax_fast_set_written(&chip->blocks, (uint32_t)at, TRAX_BLOCK_WRITTEN);
  }
  for (uint32_t i = 0; i < chip->tms; i++)
    for (unsigned tp = 0; tp < chip->tm[i].tps; tp++)
      if (chip->tm[i].watched[tp])
        trax_fast_roll_back_tp(&chip->tm[i], tp);
}
