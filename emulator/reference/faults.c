/* docs/timing.md, "Faults". */
#include "reference/reference.h"

#include <string.h>

trax_fault_kind trax_ref_text(const struct trax_ref_tm *tm, uint32_t pc, uint32_t *word) {
  const struct trax_space *space = &tm->machine->space;
  if (pc % 4 != 0)
    return TRAX_FAULT_MISALIGNED_PC;
  for (size_t i = 0; i < space->segment_count; i++) {
    const struct trax_segment *segment = &space->segments[i];
    if (segment->permissions & TRAX_PERMIT_EXECUTE && pc >= segment->address &&
        (uint64_t)pc + 4 <= (uint64_t)segment->address + segment->bytes) {
      memcpy(word, space->bytes + pc, sizeof *word);
      return TRAX_FAULT_NONE;
    }
  }
  return TRAX_FAULT_EXECUTE;
}

trax_fault_kind trax_ref_check_access(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  const uint32_t bytes = trax_ref_info(tp)->access_bytes;
  if (trax_ref_accesses_local(tp))
    return tp->address % bytes != 0 ? TRAX_FAULT_MISALIGNED : TRAX_FAULT_NONE;
  return trax_space_check(&tm->machine->space, tp->address, bytes, trax_ref_is(tp, TRAX_IS_STORE | TRAX_IS_ATOMIC));
}

void trax_ref_fault(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_fault_kind kind,
                    uint32_t address) {
  const uint32_t thread = tm->number * tm->tps + tp->number;
  trax_ref_charge(tm, tp, t, TRAX_CAUSE_HALTED);
  tp->ended = true;
  tm->machine->exit_statuses[thread] = 1;
  struct trax_fault *fault = &tm->machine->fault;
  if (fault->kind && fault->thread < thread)
    return;
  *fault = (struct trax_fault){
      .kind = kind, .address = address, .pc = tp->pc, .thread = thread, .tm = tm->number, .tp = tp->number, .cycle = t};
  if (tp->holds) {
    fault->bytes = trax_ref_info(tp)->access_bytes;
    fault->write = trax_ref_is(tp, TRAX_IS_STORE | TRAX_IS_ATOMIC);
    trax_ref_text(tm, tp->pc, &fault->word);
  }
  memcpy(fault->registers, tp->reg, sizeof fault->registers);
  memcpy(fault->local, tp->local, sizeof fault->local);
}
