#include "fast/head.h"

#include <string.h>

/* Forgets the increments whose old values have arrived. */
static void drop_arrived(struct trax_fast_tp *ftp, const struct trax_tp *tp) {
  for (uint64_t rest = ftp->atomics; rest; rest &= rest - 1)
    if (tp->usable[trax_first(rest)] != TRAX_NEVER)
      ftp->atomics &= ~(rest & -rest);
}

void trax_fast_refill(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  drop_arrived(ftp, tp);
  unsigned count = 0;
  if (!ftp->atomics) { /* else it might read or overtake what the increment will write */
    ftp->begin = ftp->resume;
    memcpy(ftp->reg, tp->reg, sizeof ftp->reg);
    count = trax_fast_burst(ftm->fast, ftm, number, ftm->fast->burst);
  }
  if (count) {
    ftm->deferred &= ~bit;
    const bool certain = !(ftp->burst_lines & ~ftm->resident_lines[ftm->icache_of[number]]);
    ftm->uncertain = (ftm->uncertain & ~bit) | (certain ? 0 : bit);
    ftp->steps[count - 1].asks |= TRAX_ASKS_SLOWLY;
    ftm->head[number] = ftp->steps;
    ftp->last = ftp->steps + count - 1;
  } else {
    ftm->deferred |= bit;
    ftp->only = ftp->resume->step;
    ftp->only.asks = TRAX_ASKS_SLOWLY;
    ftm->head[number] = ftp->last = &ftp->only;
    tp->inst = ftp->resume->decoded;
    tp->pc = ftp->resume_pc;
  }
}

uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  if (ftm->head[number] == ftm->tp[number].last)
    trax_fast_refill(ftm, number);
  else
    ftm->head[number]++;
  ftm->asks[number] = ftm->head[number]->asks;
  ftm->smooth = (ftm->smooth & ~bit) | (trax_fast_is_smooth(ftm, number) ? bit & ~ftm->deferred : 0);
  return ftm->deferred & bit ? ftm->tm->tp[number].pc : ftm->fast->program.pc[ftm->head[number]->index];
}

void trax_fast_show(struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_step *step = ftm->head[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftm->deferred >> number & 1)
    return; /* set when it became the head, and its address since */
  tp->inst = ftm->fast->program.inst[step->index].decoded;
  tp->pc = ftm->fast->program.pc[step->index];
  tp->address = step->address;
}

void trax_fast_close(struct trax_fast_tm *ftm, unsigned number, unsigned issued) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  const unsigned executed = (unsigned)(ftp->last - ftp->steps) + 1;
  ftp->issued += issued;
  ftp->jumps += ftp->burst_jumps;
  for (unsigned i = issued; i < executed; i++) { /* takes back what did not happen */
    const uint32_t index = ftp->steps[i].index;
    const uint32_t next = i + 1 < executed ? ftp->steps[i + 1].index : ftp->resume->step.index;
    ftm->changes[index]--;
    ftm->changes[index + 1]++;
    ftp->jumps -= next != index + 1;
  }
}

void trax_fast_line_arrives(struct trax_fast_tm *ftm, unsigned number, uint32_t line) {
  uint8_t *const resident = ftm->resident[number];
  const struct trax_fast_program *program = &ftm->fast->program;
  const struct trax_cache_tags *tags = &ftm->tm->icache[number].tags;
  const uint32_t set = line & tags->set_mask;
  const uint64_t gone = tags->lines[(size_t)set * tags->ways + tags->next[set]]; /* its number + 1 */
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
      if (gone)
        ftm->uncertain |= (uint64_t)1 << tp;
      if (!resident[ftm->head[tp]->line])
        ftm->smooth &= ~((uint64_t)1 << tp);
    }
}
