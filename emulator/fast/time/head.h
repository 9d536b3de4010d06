/* The head of a TP is the instruction that it fetches or holds. All that its timing needs is recorded when it becomes
   the head. */
#ifndef TRAX_FAST_HEAD_H
#define TRAX_FAST_HEAD_H

#include "fast/chip.h"

/* Returns the index of a step's instruction in trax_fast_program.inst. */
static inline uint32_t trax_fast_index(const struct trax_tp *tp, unsigned step) {
  const uint32_t first = tp->burst.first;
  return first + (uint32_t)(int16_t)(tp->burst.index[step] - first);
}

/* Returns the index of the TP's head. */
static inline uint32_t trax_fast_head(const struct trax_tm *tm, unsigned tp) {
  return trax_fast_index(&tm->tp[tp], tm->heads.at[tp]);
}

static inline const struct trax_fast_timing *trax_fast_head_timing(const struct trax_tm *tm, unsigned tp) {
  return &tm->chip->program.timing[trax_fast_head(tm, tp)];
}

/* Returns the bit of a register in busy_registers. */
static inline uint32_t trax_fast_register_bit(unsigned rd) {
  return (uint32_t)((uint64_t)1 << rd); /* 0 for TRAX_NO_REGISTER */
}

/* Sets the next step that must be checked when it becomes the head: one that needs a register of busy_registers or, if
   the TP is uncertain, is in another line than this head. `fetched`: this head has been checked and fetched in this
   cycle; otherwise an earlier check stays scheduled, since lines may have been evicted. */
void trax_fast_schedule_check(struct trax_tm *tm, unsigned tp, bool fetched);

static inline void trax_fast_set_busy(struct trax_tm *tm, unsigned tp, unsigned rd) {
  tm->busy_registers[tp] |= trax_fast_register_bit(rd);
  tm->busy |= (uint64_t)1 << tp;
  trax_fast_schedule_check(tm, tp, false);
}

/* Sets the TP's bit of trax_tm.load_hits. */
static inline void trax_fast_find_line(struct trax_tm *tm, unsigned tp) {
  const struct trax_cache_tags *const tags = &tm->dcache.tags;
  const bool hits = trax_cache_tags_have(tags, trax_line_of(tags, tm->heads.address[tp]));
  tm->load_hits = (tm->load_hits & ~((uint64_t)1 << tp)) | (uint64_t)hits << tp;
}

/* `load`: the number of loads of global memory before the head in its burst. */
static inline void trax_fast_set_load(struct trax_tm *tm, unsigned tp, unsigned load) {
  tm->heads.load[tp] = (uint8_t)load;
  tm->heads.address[tp] = tm->tp[tp].burst.access[load].address;
  trax_fast_find_line(tm, tp);
}

/* Executes the next burst. If its first instruction cannot be executed before its issue, the head executes at issue. */
void trax_fast_refill(struct trax_tm *tm, unsigned tp);
/* Writes the head to the TP's structure, which tm.c and tp.c use: inst, pc, address. */
void trax_fast_export_head(struct trax_tm *tm, unsigned tp);
/* Adds `sign` to the numbers of executions of the steps from `from` to `to`. */
void trax_fast_count_steps(struct trax_tm *tm, unsigned tp, unsigned from, unsigned to, int sign);
/* Ends the TP's burst of `executed` steps, of which the first `issued` were issued; the others count as not executed.
 */
void trax_fast_end_burst(struct trax_tm *tm, unsigned tp, unsigned executed, unsigned issued);
/* An instruction cache holds the line of this number from now on, or no longer. */
void trax_fast_set_resident(struct trax_tm *tm, unsigned icache, uint64_t line, bool is_resident);
/* After a line has arrived in an instruction cache, and perhaps evicted another one. */
void trax_fast_line_arrived(struct trax_tm *tm, unsigned icache, uint32_t line);

/* `index`: of a line, as in trax_fast_program.line. */
static inline bool trax_fast_is_resident(const struct trax_tm *tm, unsigned icache, uint32_t index) {
  return tm->resident[icache][index / 64] >> index % 64 & 1;
}

/* Makes the TP's next instruction its head, after a new burst if necessary. */
void trax_fast_advance(struct trax_tm *tm, unsigned tp);

/* Makes an instruction the TP's head, which executes at issue; its step is the only one. */
static inline void trax_fast_execute_at_issue(struct trax_tm *tm, unsigned number, uint16_t step, uint32_t index,
                                              uint32_t address) {
  struct trax_tp *tp = &tm->tp[number];
  tm->executes_at_issue |= (uint64_t)1 << number;
  tm->storing &= ~((uint64_t)1 << number);
  tm->watched[number] = 0;
  tp->burst.step[0] = step | TRAX_STEP_SLOW;
  tp->burst.first = index;
  tp->burst.index[0] = (uint16_t)index;
  tp->burst.access[0].address = address;
  tm->heads.last[number] = 0;
  trax_fast_set_load(tm, number, 0);
  trax_fast_set_head(&tm->heads, number, 0);
}

#endif
