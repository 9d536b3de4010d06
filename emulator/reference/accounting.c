/* docs/timing.md, "Accounting", and the arbiter of its section "Words". */
#include "reference/reference.h"

int trax_ref_arbitrate(trax_ref_pointer *pointer, const bool *asks, uint32_t n) {
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t position = *pointer + i < n ? *pointer + i : *pointer + i - n;
    if (asks[position]) {
      *pointer = position + 1 < n ? position + 1 : 0;
      return (int)position;
    }
  }
  return -1;
}

void trax_ref_charge_idle(struct trax_ref_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->tps; i++) {
    struct trax_ref_tp *tp = &tm->tp[i];
    tp->charged = false;
    if (tp->ended)
      trax_ref_charge(tm, tp, t, TRAX_CAUSE_HALTED);
    else if (t < tp->bubble_ends)
      trax_ref_charge(tm, tp, t, TRAX_CAUSE_BRANCH);
  }
}
