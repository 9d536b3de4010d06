#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
/* The read set and the write set of the run, by blocks of global memory. A value loaded by a burst is right as long as
   no TP writes the block that it came from. So before a block of the read set is written for the first time, every TP
   rolls back to what it has issued, and its head executes at issue; after that, loads from the block end bursts. A
   block costs one roll back at most, and a block that is only written, such as one of the picture, costs none. Blocks
   are small because data that is written is often next to data that is only read. The input buffer is hardly ever
   written: all of it counts as read until a first write, so loads from it need not be recorded. */
#include "fast/head.h"

#include <assert.h>
#include <string.h>
#include <sys/mman.h>

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
      blocks->state[at >> TRAX_BLOCK_SHIFT] = TRAX_BLOCK_WRITTEN;
  return TRAX_OK;
}

void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks) {
  if (blocks->state)
    munmap(blocks->state, blocks->bytes);
}

/* Rolls a TP back to what it has issued: undoes its burst, and executes the issued steps again. They give the same
   results, since no block that they loaded from has been written yet. */
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

void trax_fast_block_written(struct trax_fast *fast, uint32_t address) {
  if (trax_fast_is_loaded(&fast->blocks, address))
    trax_fast_roll_back(fast);
  trax_fast_set_written(&fast->blocks, address);
}

void trax_fast_range_written(void *fast, uint32_t address, uint32_t bytes) {
  for (uint64_t at = address >> TRAX_BLOCK_SHIFT << TRAX_BLOCK_SHIFT; at < address + (uint64_t)bytes;
       at += 1u << TRAX_BLOCK_SHIFT)
    trax_fast_block_written(fast, (uint32_t)at);
}
