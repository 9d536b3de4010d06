/* docs/simt.md, "Operands": step 2. */
#include "simt/simt.h"

void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->warps; i++) {
    bool refused = false;
    for (uint64_t set = tm->warp[i].left; set;) {
      struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
      trax_ref_check_operands_of(tm->ref, lane, t);
      refused = refused || lane->charged;
    }
    if (refused)
      trax_simt_charge(tm, tm->warp[i].left, t, TRAX_CAUSE_LOCKSTEP);
  }
}
