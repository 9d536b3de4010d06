/* Bursts: instructions that are executed before their issue. A burst ends before an instruction whose effect is visible
   to other TPs or whose result depends on time: atomic increments, stores to global memory unless the thread is alone,
   loads from shared blocks, loads and stores past the cache, fences, reads of the cycle counter, traps, ends of
   threads, and all instructions that fault. */
#include "fast/time/head.h"
#define inline __inline__ __attribute__((always_inline)) /* a call costs as much as an instruction */
#include "trax/semantics.h"
#undef inline

#include <string.h>

#define NOWHERE UINT64_MAX /* next_pc of an instruction that does not jump */

#define LIKELY(CONDITION) __builtin_expect(CONDITION, true)

/* `mask`: banks - 1 if banks is a power of two, else 0. */
static inline unsigned data_bank(uint32_t banks, uint32_t mask, uint32_t address) {
  return LIKELY(mask) ? address / 4 & mask : address / 4 % banks;
}

/* Records `count` instructions from index on as the steps from `at` on. */
static inline void record(struct trax_burst *burst, unsigned at, const struct trax_fast_program *program,
                          uint32_t index, const unsigned count) {
  memcpy(burst->step + at, program->step + index, count * sizeof *program->step);
  memcpy(burst->index + at, program->number + index, count * sizeof *program->number);
}

/* Whether the burst has a store to the word among its first `loads` accesses. */
static bool has_stored(const struct trax_tp *tp, uint32_t address, unsigned loads) {
  if (tp->stored & trax_fast_word_bit(address))
    for (unsigned i = 0; i < loads; i++)
      if (trax_tp_stores(tp, i) && !((tp->burst.access[i].address ^ address) & ~3u))
        return true;
  return false;
}

/* Performs load `load` of a burst, from a WRITTEN block: before the word is written again, the TP rolls back. If the
   burst is executed again, the word may have been written after the issue of the load, so that the first value counts.
   NOWHERE: the burst has stored to the word, and ends. *line: in an epoch, that of the burst's latest such load. */
static __attribute__((noinline)) uint64_t load_written(struct trax_tm *tm, unsigned number, unsigned load,
                                                       uint32_t address, unsigned bytes,
                                                       struct trax_overlay_line **line) {
  struct trax_tp *const tp = &tm->tp[number];
  uint32_t *const value = &tp->burst.access[load].word;
  if (!tp->again) {
    if (has_stored(tp, address, load))
      return NOWHERE;
    if (!*line || (*line)->number != address / TRAX_OVERLAY_BYTES) {
      tm->watched[number] |= (uint64_t)1 << trax_fast_line_hash(address) % 64;
      tm->readers[trax_fast_line_hash(address)] |= (uint64_t)1 << number;
      *line = tm->buffer ? trax_store_buffer_line(tm->buffer, address) : NULL;
    }
    *value = 0;
    if (*line)
      *value = trax_store_buffer_load(*line, &tm->machine->space, address, bytes);
    else
      memcpy(value, tm->machine->space.bytes + address, bytes);
  }
  return *value;
}

/* Records a store to global memory that takes effect at its issue. False: the store must execute at issue. */
static __attribute__((noinline)) bool store_later(const struct trax_tm *tm, struct trax_tp *tp, unsigned load,
                                                  uint32_t address, uint32_t value, unsigned bytes) {
  const struct trax_chip *const chip = tm->chip;
  /* In an epoch other TMs may set LOADED at any time; its end finds out (merge.c). */
  if (!tp->again && (chip->burst == 1 || trax_space_check(&chip->machine->space, address, bytes, true) ||
                     (!tm->buffer && trax_fast_is_loaded(&chip->blocks, address))))
    return false;
  tp->stores[load / 64] |= (uint64_t)1 << load % 64;
  tp->stored |= trax_fast_word_bit(address);
  tp->burst.access[load].word = value;
  return true;
}

/* Stores to global memory ahead of the issue: the thread is alone. The access keeps the word for a roll back. False:
   the store must execute at issue. */
static __attribute__((noinline)) bool store_ahead(const struct trax_chip *chip, struct trax_tp *tp, unsigned load,
                                                  uint32_t address, uint32_t value, unsigned bytes) {
  const struct trax_space *space = &chip->machine->space;
  if (trax_space_check(space, address, bytes, true) || address - chip->blocks.input < chip->blocks.input_bytes)
    return false;
  uint32_t *const before = &tp->burst.access[load].word;
  memcpy(before, space->bytes + (address & ~3u), sizeof *before);
  tp->stores[load / 64] |= (uint64_t)1 << load % 64;
  memcpy(space->bytes + address, &value, bytes);
  return true;
}

#define BURST burst_whole
#define EXACTLY 0
#include "fast/function/burst_steps.h"
#define BURST burst_exactly
#define EXACTLY 1
#include "fast/function/burst_steps.h"

const void *const *trax_fast_operations(void) {
  const void *const *operations;
  burst_whole(NULL, NULL, 0, 0, &operations);
  return operations;
}

/* Executes the translated burst from `resume` on. 0: its first instruction must be interpreted. */
static unsigned run_translated(struct trax_chip *chip, struct trax_tm *tm, unsigned number) {
  const struct trax_fast_program *const program = &chip->program;
  struct trax_tp *const tp = &tm->tp[number];
  struct trax_translated_burst run = {.reg = tp->reg,
                                      .local = tp->local,
                                      .deltas = tm->count_deltas,
                                      .burst = &tp->burst,
                                      .tm = tm->number,
                                      .input_bytes = chip->blocks.input_bytes};
  const size_t begin = (size_t)(tp->resume - program->inst);
  const unsigned count = trax_translation_burst(chip->translation, begin, &run);
  if (!count)
    return 0;
  tm->watched[number] = tp->stored = 0; /* so nobody asks for `stores` */
  tm->count_deltas[begin]++;
  if (run.index == TRAX_NO_INDEX) {
    const uint32_t end = trax_fast_index(tp, count - 1) + 1;
    tp->resume = trax_fast_inst_at(program, run.pc);
    if (run.pc == program->timing[end].pc) { /* no jump */
      tp->resume = &program->inst[end];
    } else {
      tm->count_deltas[end]--;
      tm->count_deltas[tp->resume - program->inst]++;
      tp->burst.jumps++;
      tp->burst.step[count - 1] |= (uint16_t)chip->facts.slow_jump;
    }
  } else {
    tp->resume = &program->inst[run.index];
  }
  const size_t next = (size_t)(tp->resume - program->inst);
  tm->count_deltas[next]--;
  tp->resume_pc = tp->resume == program->no_text ? run.pc : program->timing[next].pc;
  return count;
}

unsigned trax_fast_burst(struct trax_chip *chip, struct trax_tm *tm, unsigned number, unsigned limit) {
  const struct trax_tp *const tp = &tm->tp[number];
  unsigned count = 0;
  if (limit != TRAX_BURST || tp->atomics)
    return burst_exactly(chip, tm, number, limit, NULL);
  if (chip->translation && !tp->alone && tp->resume->op != TRAX_OP_ILLEGAL &&
      trax_translation_has(chip->translation, (size_t)(tp->resume - chip->program.inst)))
    count = run_translated(chip, tm, number);
  return count ? count : burst_whole(chip, tm, number, limit, NULL);
}
