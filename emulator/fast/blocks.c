#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
/* The read set and the write set of the run, by blocks of global memory. A value loaded by a burst is right as long as
   no TP writes the block that it came from. Before a LOADED block is written for the first time, every TP rolls back to
   what it has issued, and its head executes at issue. After that the block is WRITTEN: bursts that load from it are
   watched. Before a word is written from which a watched burst has loaded, that burst's TP rolls back. So data that is
   only read costs nothing, and data that is only written, such as a picture, costs no roll back. The input buffer is
   hardly ever written: all of it counts as LOADED until a first write, so loads from it need not be recorded. */
#include "fast/head.h"
#include "fast/store_buffer.h"

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

/* Rolls a TP back to what it has issued: undoes its burst, and executes the issued steps again. They give the same
   results, since no word that they loaded has been written since. */
static void roll_back_tp(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftm->executes_at_issue & bit)
    return;
  while (ftp->undo_count) {
    const struct trax_fast_undo *undo = &ftp->undo[--ftp->undo_count];
    memcpy(tp->local + undo->offset, &undo->word, sizeof undo->word);
  }
  memcpy(tp->reg, ftp->reg, sizeof ftp->reg);
  const unsigned issued = ftm->heads.at[number];
  const uint32_t head = trax_fast_head(ftm, number);
  const uint16_t step = ftp->step[issued];                           /* the head needs the same resources as before */
  trax_fast_end_burst(ftm, number, ftm->heads.last[number] + 1u, 0); /* takes the whole burst off the counts */
  ftp->resume = ftp->begin;
  ftp->resume_pc = fast->program.timing[ftp->begin - fast->program.inst].pc;
  const unsigned again = trax_fast_burst(fast, ftm, number, issued);
  assert(again == issued && ftp->resume == &fast->program.inst[head]);
  (void)again;
  trax_fast_end_burst(ftm, number, issued, issued);
  tp->inst = fast->program.timing[ftp->resume - fast->program.inst].decoded;
  tp->pc = ftp->resume_pc;
  tp->address = tp->inst->bytes ? tp->reg[tp->inst->ra] + (uint32_t)tp->inst->imm : 0;
  trax_fast_execute_at_issue(ftm, number, step, head, tp->address);
}

void trax_fast_roll_back(struct trax_fast *fast) {
  for (uint32_t i = 0; i < fast->chip->tms; i++)
    for (unsigned tp = 0; tp < fast->tm[i].tm->tps; tp++)
      roll_back_tp(fast, &fast->tm[i], tp);
}

/* Rolls back the TPs whose bursts have loaded from WRITTEN blocks in a range of words; `bits`: those of the words. */
static void roll_back_readers(struct trax_fast_tm *ftm, uint64_t bits, uint32_t begin, uint32_t bytes) {
  for (unsigned number = 0; number < ftm->tm->tps; number++) {
    const struct trax_fast_tp *ftp = &ftm->tp[number];
    if (!(ftm->watched[number] & bits))
      continue;
    uint32_t i = 0;
    while (i < ftp->load_count && (ftp->address[i] & ~3u) - begin >= bytes)
      i++;
    if (i < ftp->load_count)
      roll_back_tp(ftm->fast, ftm, number);
  }
}

void trax_fast_roll_back_readers(struct trax_fast_tm *ftm, uint32_t address) {
  roll_back_readers(ftm, trax_fast_word_bit(address), address & ~3u, 4);
}

void trax_fast_record_readers(struct trax_fast_tm *ftm) {
  const uint8_t *const state = ftm->fast->blocks.state;
  for (unsigned number = 0; number < ftm->tm->tps; number++)
    for (uint32_t i = 0; ftm->watched[number] && i < ftm->tp[number].load_count; i++)
      if (__atomic_load_n(&state[ftm->tp[number].address[i] >> TRAX_BLOCK_SHIFT], __ATOMIC_RELAXED) >=
          TRAX_BLOCK_WRITTEN)
        trax_store_buffer_read(ftm->tm->buffer, ftm->tp[number].address[i]);
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

void trax_fast_word_written(struct trax_fast *fast, uint32_t address, uint8_t state) {
  if (trax_fast_is_loaded(&fast->blocks, address)) {
    trax_fast_roll_back(fast);
    widen(&fast->blocks, address);
  }
  for (uint32_t i = 0; i < fast->chip->tms; i++)
    trax_fast_roll_back_readers(&fast->tm[i], address);
  trax_fast_set_written(&fast->blocks, address, state);
}

void trax_fast_increment_outside(void *fast, uint32_t address) {
  trax_fast_word_written(fast, address, TRAX_BLOCK_SHARED);
}

void trax_fast_range_written(void *context, uint32_t address, uint32_t bytes) {
  struct trax_fast *fast = context;
  for (uint64_t at = address >> TRAX_BLOCK_SHIFT << TRAX_BLOCK_SHIFT; at < address + (uint64_t)bytes;
       at += 1u << TRAX_BLOCK_SHIFT) {
    if (trax_fast_is_loaded(&fast->blocks, (uint32_t)at))
      trax_fast_roll_back(fast);
    trax_fast_set_written(&fast->blocks, (uint32_t)at, TRAX_BLOCK_WRITTEN);
  }
  for (uint32_t i = 0; i < fast->chip->tms; i++)
    roll_back_readers(&fast->tm[i], UINT64_MAX, address & ~3u, bytes + 4);
}
