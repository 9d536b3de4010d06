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

enum { FARTHEST_LOOK = 16, NO_LOOK = 255 };

void trax_fast_plan(struct trax_fast_tm *ftm, unsigned number, bool fetched) {
  const struct trax_fast_program *program = &ftm->fast->program;
  const struct trax_fast_tp *ftp = &ftm->tp[number];
  const uint32_t busy = ftm->busy_registers[number];
  const unsigned at = ftm->heads.at[number], last = ftm->heads.last[number];
  const uint16_t line = program->line[trax_fast_index(ftp, at)];
  const bool uncertain = ftm->uncertain >> number & 1;
  unsigned next = at + 1;
  for (; next <= last && next <= at + FARTHEST_LOOK; next++) {
    const uint32_t index = trax_fast_index(ftp, next);
    if ((program->note[index].waits & busy) ||
        (uncertain && (program->line[index] != line || line == TRAX_FAST_LINES - 1)))
      break;
  }
  if (fetched || !uncertain || next < ftm->heads.look[number])
    ftm->heads.look[number] = (uint8_t)next;
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
    ftm->deferred &= ~bit;
    ftm->uncertain = (ftm->uncertain & ~bit) | (all_resident(ftm, number, count) ? 0 : bit);
    ftp->asks[count - 1] |= TRAX_ASKS_SLOWLY;
    ftm->heads.last[number] = (uint8_t)(count - 1);
    ftm->heads.load[number] = 0;
    ftm->heads.look[number] = (ftm->busy | ftm->uncertain) & bit ? 0 : NO_LOOK;
    trax_fast_set_head(&ftm->heads, number, 0);
  } else {
    const uint32_t index = (uint32_t)(ftp->resume - ftm->fast->program.inst);
    trax_fast_execute_at_issue(ftm, number, ftm->fast->program.asks[index] & TRAX_ASKS_FETCH, index, 0);
    tp->inst = ftm->fast->program.note[index].decoded;
    tp->pc = ftp->resume_pc;
    ftm->outside |= tp->inst->resource == TRAX_RESOURCE_NO_TEXT ? bit : 0;
  }
}

uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  if (ftm->heads.at[number] == ftm->heads.last[number]) {
    trax_fast_refill(ftm, number);
  } else {
    ftm->heads.load[number] += (ftm->heads.low[number] & TRAX_ASKS_KIND) == TRAX_ASKS_BANK;
    trax_fast_set_head(&ftm->heads, number, ftm->heads.at[number] + 1u);
  }
  return ftm->deferred & bit ? ftm->tm->tp[number].pc : trax_fast_head_note(ftm, number)->pc;
}

void trax_fast_show(struct trax_fast_tm *ftm, unsigned number) {
  const uint32_t index = trax_fast_head(ftm, number);
  struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftm->deferred >> number & 1)
    return; /* set when it became the head; classify has set the address */
  tp->inst = ftm->fast->program.note[index].decoded;
  tp->pc = ftm->fast->program.note[index].pc;
  tp->address = tp->inst->bytes ? ftm->tp[number].address[ftm->heads.load[number]] : 0;
}

void trax_fast_close(struct trax_fast_tm *ftm, unsigned number, unsigned executed, unsigned issued) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  ftp->issued += issued;
  ftp->jumps += ftp->burst_jumps;
  for (unsigned i = issued; i < executed; i++) { /* takes the steps that are not issued off the counts */
    const uint32_t index = trax_fast_index(ftp, i);
    const uint32_t next =
        i + 1 < executed ? trax_fast_index(ftp, i + 1) : (uint32_t)(ftp->resume - ftm->fast->program.inst);
    ftm->changes[index]--;
    ftm->changes[index + 1]++;
    ftp->jumps -= next != index + 1;
  }
}

void trax_fast_line_has_come(struct trax_fast_tm *ftm, unsigned number, uint32_t line) {
  const struct trax_fast_program *program = &ftm->fast->program;
  const struct trax_cache_tags *tags = &ftm->tm->icache[number].tags;
  const uint64_t gone = ftm->tm->icache[number].gone; /* its number + 1 */
  for (size_t i = 0; i < program->count; i++) {
    const struct trax_fast_section *section = &program->sections[i];
    const uint64_t last_line = (section->begin + section->bytes) >> tags->line_shift;
    const uint64_t comes_as = section->line + (uint64_t)line - section->first_line;
    const uint64_t goes_as = section->line + gone - 1 - section->first_line;
    if (gone > section->first_line && gone - 1 <= last_line && goes_as < TRAX_FAST_LINES - 1)
      trax_fast_set_resident(ftm, number, (uint32_t)goes_as, false);
    if (line >= section->first_line && line <= last_line && comes_as < TRAX_FAST_LINES - 1)
      trax_fast_set_resident(ftm, number, (uint32_t)comes_as, true);
  }
  for (unsigned tp = 0; tp < ftm->tm->tps; tp++)
    if (ftm->icache_of[tp] == number) {
      if (gone) {
        ftm->uncertain |= (uint64_t)1 << tp;
        ftm->heads.look[tp] = 0;
      }
    }
}
