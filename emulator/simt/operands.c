/* docs/simt.md, "Operands": step 2. */
#include "simt/simt.h"

void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->warps; i++) {
    struct trax_simt_warp *warp = &tm->warp[i];
    if (warp->has_operands)
      warp->active = warp->left;
    if (!warp->left || warp->has_operands)
      continue;
    const bool is_illegal = trax_ref_is_illegal(tm->ref, trax_simt_speaker(tm, warp->left));
    bool is_refused = false;
    for (uint64_t set = warp->left; set;) {
      struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
      if (is_illegal)
        trax_ref_fault(tm->ref, lane, t, TRAX_FAULT_ILLEGAL, 0);
      else
        trax_ref_check_registers(tm->ref, lane, t);
      is_refused = is_refused || lane->charged;
    }
    warp->has_operands = !is_refused;
    if (!is_refused)
      warp->unit = trax_ref_timing(trax_simt_speaker(tm, warp->left), tm->ref->config).unit;
    warp->active = is_refused ? 0 : warp->left;
  }
}
