#include "fast/head.h"

#include <string.h>

/* Removes the atomic increments that have arrived. */
static void drop_arrived(struct trax_fast_tp *ftp, const struct trax_tp *tp) {
  for (uint64_t rest = ftp->atomics; rest; rest &= rest - 1)
    if (tp->usable[trax_first(rest)] != TRAX_NEVER)
      ftp->atomics &= ~(rest & -rest);
}

/* Whether all lines of the burst are resident. burst_lines may contain lines that the burst does not execute, and is
   ambiguous for programs of more than 64 lines: if it does not decide, the steps are checked. */
static bool all_resident(const struct trax_fast_tm *ftm, unsigned number, unsigned count) {
  const struct trax_fast_tp *ftp = &ftm->tp[number];
  const unsigned icache = ftm->icache_of[number];
  if (!(ftp->burst_lines & ~ftm->resident_lines[icache]))
    return true;
  for (unsigned i = 0; i < count;) {
    const uint8_t segment = ftp->segment[i];
    const uint32_t origin = ftp->origin[segment]; /* as trax_fast_index, which wraps around */
    do
      if (!ftm->resident[icache][ftm->fast->program.line[origin + i]])
        return false;
    while (++i < count && ftp->segment[i] == segment);
  }
  return true;
}

enum { CHECK_HORIZON = 16, NO_CHECK = 255 };

void trax_fast_schedule_check(struct trax_fast_tm *ftm, unsigned number, bool fetched) {
  const struct trax_fast_program *program = &ftm->fast->program;
  const struct trax_fast_tp *ftp = &ftm->tp[number];
  const uint32_t busy = ftm->busy_registers[number];
  const unsigned at = ftm->heads.at[number], last = ftm->heads.last[number];
  const uint16_t line = program->line[trax_fast_index(ftp, at)];
  const bool uncertain = ftm->uncertain >> number & 1;
  unsigned next = at + 1;
  for (; next <= last && next <= at + CHECK_HORIZON; next++) {
    const uint32_t index = trax_fast_index(ftp, next);
    if ((program->timing[index].waits & busy) ||
        (uncertain && (program->line[index] != line || line == TRAX_FAST_LINES - 1)))
      break;
  }
  if (fetched || !uncertain || next < ftm->heads.check_at[number])
    ftm->heads.check_at[number] = (uint8_t)next;
}

void trax_fast_refill(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  drop_arrived(ftp, tp);
  unsigned count = 0;
  if (!ftp->atomics) { /* else it might read or overwrite a register that an increment will write */
    ftp->begin = ftp->resume;
    memcpy(ftp->reg, tp->reg, sizeof ftp->reg);
    count = trax_fast_burst(ftm->fast, ftm, number, ftm->fast->burst);
  }
  if (count) {
    ftm->executes_at_issue &= ~bit;
    ftm->uncertain = (ftm->uncertain & ~bit) | (all_resident(ftm, number, count) ? 0 : bit);
    ftp->step[count - 1] |= TRAX_STEP_SLOW;
    ftm->heads.last[number] = (uint8_t)(count - 1);
    ftm->heads.load[number] = 0;
    ftm->heads.check_at[number] = (ftm->busy | ftm->uncertain) & bit ? 0 : NO_CHECK;
    trax_fast_set_head(&ftm->heads, number, 0);
  } else {
    const uint32_t index = (uint32_t)(ftp->resume - ftm->fast->program.inst);
    trax_fast_execute_at_issue(ftm, number, ftm->fast->program.step[index] & TRAX_STEP_FETCH, index, 0);
    tp->inst = ftm->fast->program.timing[index].decoded;
    tp->pc = ftp->resume_pc;
    ftm->no_text |= tp->inst->resource == TRAX_RESOURCE_NO_TEXT ? bit : 0;
  }
}

uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  if (ftm->heads.at[number] == ftm->heads.last[number]) {
    trax_fast_refill(ftm, number);
  } else {
    ftm->heads.load[number] += (ftm->heads.low[number] & TRAX_STEP_KIND) == TRAX_STEP_BANK;
    trax_fast_set_head(&ftm->heads, number, ftm->heads.at[number] + 1u);
  }
  return ftm->executes_at_issue & bit ? ftm->tm->tp[number].pc : trax_fast_head_timing(ftm, number)->pc;
}

void trax_fast_export_head(struct trax_fast_tm *ftm, unsigned number) {
  const uint32_t index = trax_fast_head(ftm, number);
  struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftm->executes_at_issue >> number & 1)
    return; /* set when it became the head; classify has set the address */
  tp->inst = ftm->fast->program.timing[index].decoded;
  tp->pc = ftm->fast->program.timing[index].pc;
  tp->address = tp->inst->bytes ? ftm->tp[number].address[ftm->heads.load[number]] : 0;
}

void trax_fast_end_burst(struct trax_fast_tm *ftm, unsigned number, unsigned executed, unsigned issued) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  ftp->issued += issued;
  ftp->jumps += ftp->burst_jumps;
  for (unsigned i = issued; i < executed; i++) { /* takes the steps that are not issued off the counts */
    const uint32_t index = trax_fast_index(ftp, i);
    const uint32_t next =
        i + 1 < executed ? trax_fast_index(ftp, i + 1) : (uint32_t)(ftp->resume - ftm->fast->program.inst);
    ftm->count_deltas[index]--;
    ftm->count_deltas[index + 1]++;
    ftp->jumps -= next != index + 1;
  }
}

void trax_fast_line_arrived(struct trax_fast_tm *ftm, unsigned number, uint32_t line) {
  const struct trax_fast_program *program = &ftm->fast->program;
  const struct trax_cache_tags *tags = &ftm->tm->icache[number].tags;
  const uint64_t evicted = ftm->tm->icache[number].evicted; /* its number + 1 */
  for (size_t i = 0; i < program->count; i++) {
    const struct trax_fast_section *section = &program->sections[i];
    const uint64_t last_line = (section->begin + section->bytes) >> tags->line_shift;
    const uint64_t arrived_index = section->line + (uint64_t)line - section->first_line;
    const uint64_t evicted_index = section->line + evicted - 1 - section->first_line;
    if (evicted > section->first_line && evicted - 1 <= last_line && evicted_index < TRAX_FAST_LINES - 1)
      trax_fast_set_resident(ftm, number, (uint32_t)evicted_index, false);
    if (line >= section->first_line && line <= last_line && arrived_index < TRAX_FAST_LINES - 1)
      trax_fast_set_resident(ftm, number, (uint32_t)arrived_index, true);
  }
  for (unsigned tp = 0; tp < ftm->tm->tps; tp++)
    if (ftm->icache_of[tp] == number) {
      if (evicted) {
        ftm->uncertain |= (uint64_t)1 << tp;
        ftm->heads.check_at[tp] = 0;
      }
    }
}
