#include "fast/time/head.h"

#include "fast/function/burst.h"

#include <string.h>

/* Removes the atomic increments that have arrived. */
static void drop_arrived(struct trax_tp *tp) {
  for (uint64_t rest = tp->atomics; rest; rest &= rest - 1)
    if (tp->usable[trax_first(rest)] != TRAX_NEVER)
      tp->atomics &= ~(rest & -rest);
}

/* Returns how many of the 16 steps behind a step follow it and one another in the program. */
static inline unsigned count_sequential(const uint16_t *index) {
  const __m128i *const at = (const __m128i *)index, *const next = (const __m128i *)(index + 1), one = _mm_set1_epi16(1);
  const __m128i first = _mm_cmpeq_epi16(_mm_sub_epi16(_mm_loadu_si128(next), _mm_loadu_si128(at)), one);
  const __m128i second = _mm_cmpeq_epi16(_mm_sub_epi16(_mm_loadu_si128(next + 1), _mm_loadu_si128(at + 1)), one);
  return trax_first(~(uint64_t)(unsigned)_mm_movemask_epi8(_mm_packs_epi16(first, second)));
}

/* Whether all lines of the burst are resident. trax_burst.lines may contain lines that the burst does not execute, and
   is ambiguous for programs of more than 64 lines: if it does not decide, the lines of the steps are checked. */
static bool all_resident(const struct trax_tm *tm, unsigned number, unsigned count) {
  const struct trax_tp *tp = &tm->tp[number];
  const unsigned icache = tm->icache_of[number];
  if (tm->chip->program.lines <= 64 && !(tp->burst.lines & ~tm->resident[icache][0]))
    return true;
  for (unsigned i = 0, steps; i < count; i += steps) {
    steps = 1 + count_sequential(&tp->burst.index[i]);
    const uint16_t *const line = &tm->chip->program.line[trax_fast_index(tp, i)];
    for (uint32_t at = line[0]; at <= line[(steps < count - i ? steps : count - i) - 1]; at++)
      if (!trax_fast_is_resident(tm, icache, at))
        return false;
  }
  return true;
}

enum { CHECK_HORIZON = 16, NO_CHECK = 255 };

void trax_fast_schedule_check(struct trax_tm *tm, unsigned number, bool fetched) {
  const struct trax_fast_timing *const timing = tm->chip->program.timing;
  const struct trax_tp *tp = &tm->tp[number];
  const uint32_t busy = tm->busy_registers[number], line_bytes = tm->config->icache.line_bytes;
  const unsigned at = tm->heads.at[number], last = tm->heads.last[number];
  const unsigned end = last - at < CHECK_HORIZON ? last + 1 : at + CHECK_HORIZON + 1;
  const uint32_t line = timing[trax_fast_index(tp, at)].pc & -line_bytes;
  const bool uncertain = tm->uncertain >> number & 1;
  unsigned next = at + 1;
  for (bool leaves = false; next < end && !leaves;) { /* steps that follow one another */
    const struct trax_fast_timing *step = &timing[trax_fast_index(tp, next)];
    unsigned stop = next + 1 + count_sequential(&tp->burst.index[next]);
    stop = stop < end ? stop : end;
    if (uncertain) {
      if ((step->pc & -line_bytes) != line)
        break;
      const unsigned next_line = next + (line + line_bytes - step->pc) / 4;
      leaves = next_line < stop;
      stop = leaves ? next_line : stop;
    }
    while (busy && next < stop && !(step->waits & busy))
      next++, step++;
    if (busy && next < stop)
      break;
    next = stop;
  }
  if (fetched || !uncertain || next < tm->heads.check_at[number])
    tm->heads.check_at[number] = (uint8_t)next;
}

void trax_fast_refill(struct trax_tm *tm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tp *tp = &tm->tp[number];
  drop_arrived(tp);
  tp->begin = tp->resume;
  tp->alone = tm->chip->alone;
  memcpy(tp->begin_reg, tp->reg, sizeof tp->begin_reg);
  /* Loads of a thread that is alone are not recorded: they would be ahead of its own increment. */
  const unsigned count = tp->alone && tp->atomics ? 0 : trax_fast_burst(tm->chip, tm, number, tm->chip->burst);
  if (count) {
    tm->executes_at_issue &= ~bit;
    tm->storing = (tm->storing & ~bit) | (tp->alone || tp->stored ? bit : 0);
    tm->uncertain = (tm->uncertain & ~bit) | (all_resident(tm, number, count) ? 0 : bit);
    tp->ends_slowly = tp->burst.step[count - 1] & TRAX_STEP_SLOW;
    tp->burst.step[count - 1] |= TRAX_STEP_SLOW;
    tm->heads.last[number] = (uint8_t)(count - 1);
    trax_fast_set_load(tm, number, 0);
    tm->heads.check_at[number] = (tm->busy | tm->uncertain) & bit ? 0 : NO_CHECK;
    trax_fast_set_head(&tm->heads, number, 0);
  } else {
    const uint32_t index = (uint32_t)(tp->resume - tm->chip->program.inst);
    trax_fast_execute_at_issue(tm, number, tm->chip->program.step[index] & TRAX_STEP_FETCH, index, 0);
    tp->inst = tm->chip->program.timing[index].decoded;
    tp->pc = tp->resume_pc;
    tm->no_text |= tp->inst->resource == TRAX_RESOURCE_NO_TEXT ? bit : 0;
  }
}

void trax_fast_advance(struct trax_tm *tm, unsigned number) {
  if (tm->heads.at[number] == tm->heads.last[number]) {
    trax_fast_refill(tm, number);
  } else {
    if ((tm->heads.low[number] & TRAX_STEP_KIND) == TRAX_STEP_BANK)
      trax_fast_set_load(tm, number, tm->heads.load[number] + 1u);
    trax_fast_set_head(&tm->heads, number, tm->heads.at[number] + 1u);
  }
}

void trax_fast_export_head(struct trax_tm *tm, unsigned number) {
  const uint32_t index = trax_fast_head(tm, number);
  struct trax_tp *tp = &tm->tp[number];
  if (tm->executes_at_issue >> number & 1)
    return; /* set when it became the head; classify has set the address */
  tp->inst = tm->chip->program.timing[index].decoded;
  tp->pc = tm->chip->program.timing[index].pc;
  tp->address = tp->inst->bytes ? tm->heads.address[number] : 0;
}

void trax_fast_count_steps(struct trax_tm *tm, unsigned number, unsigned from, unsigned to, int sign) {
  for (unsigned i = from; i < to; i++) {
    const uint32_t index = trax_fast_index(&tm->tp[number], i);
    tm->count_deltas[index] += sign;
    tm->count_deltas[index + 1] -= sign;
  }
}

void trax_fast_end_burst(struct trax_tm *tm, unsigned number, unsigned executed, unsigned issued) {
  struct trax_tp *tp = &tm->tp[number];
  tp->issued += issued;
  tp->jumps += tp->burst.jumps;
  trax_fast_count_steps(tm, number, issued, executed, -1);
  for (unsigned i = issued; i < executed; i++) {
    const uint32_t next =
        i + 1 < executed ? trax_fast_index(tp, i + 1) : (uint32_t)(tp->resume - tm->chip->program.inst);
    tp->jumps -= next != trax_fast_index(tp, i) + 1;
  }
}

void trax_fast_set_resident(struct trax_tm *tm, unsigned icache, uint64_t line, bool is_resident) {
  const struct trax_fast_program *program = &tm->chip->program;
  for (size_t i = 0; i < program->count; i++) { /* neighbouring sections may share a line */
    const struct trax_fast_section *section = &program->sections[i];
    const uint64_t index = section->line + line - section->first_line;
    if (line >= section->first_line && line <= section->last_line && index < TRAX_FAST_LINES - 1) {
      uint64_t *const bits = &tm->resident[icache][index / 64];
      *bits = (*bits & ~((uint64_t)1 << index % 64)) | (uint64_t)is_resident << index % 64;
    }
  }
}

void trax_fast_line_arrived(struct trax_tm *tm, unsigned number, uint32_t line) {
  const uint32_t evicted = tm->icache[number].evicted; /* its number + 1 */
  if (evicted)
    trax_fast_set_resident(tm, number, evicted - 1, false);
  trax_fast_set_resident(tm, number, line, true);
  for (unsigned tp = 0; evicted && tp < tm->tps; tp++)
    if (tm->icache_of[tp] == number) {
      tm->uncertain |= (uint64_t)1 << tp;
      tm->heads.check_at[tp] = 0;
    }
}
