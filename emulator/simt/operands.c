/* docs/simt.md, "Operands": step 2. */
#include "simt/simt.h"

/* Checks a lane. False: it is refused. A lane that was accepted stays so, and another one waits for its register. */
static bool check(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint32_t i, uint64_t t) {
  struct trax_ref_tp *lane = &tm->ref->tp[i];
  uint8_t *const waits_for = &tm->lane[i].waits_for;
  if (warp->is_checked && !*waits_for)
    return true;
  if (warp->is_checked && lane->scoreboard[*waits_for].usable > t) {
    trax_simt_charge(tm, warp, trax_simt_bit(i), t, lane->scoreboard[*waits_for].cause);
    return false;
  }
  *waits_for = (uint8_t)trax_ref_check_registers(tm->ref, lane, t);
  return !trax_simt_is_charged(warp, lane);
}

/* Whether all lanes of the group are accepted. */
static bool check_group(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  const bool is_illegal = !warp->is_checked && trax_ref_is_illegal(tm->ref, trax_simt_speaker(tm, warp->left));
  bool passes = true;
  for (uint64_t set = warp->left; set;) {
    const uint32_t i = trax_simt_take(&set);
    if (is_illegal) {
      trax_ref_fault(tm->ref, &tm->ref->tp[i], t, TRAX_FAULT_ILLEGAL, 0);
      trax_simt_is_charged(warp, &tm->ref->tp[i]);
      passes = false;
    } else {
      passes = check(tm, warp, i, t) && passes;
    }
  }
  warp->is_checked = true;
  return passes;
}

void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->warps; i++) {
    struct trax_simt_warp *warp = &tm->warp[i];
    if (warp->left && !warp->has_operands && check_group(tm, warp, t)) {
      warp->has_operands = true;
      warp->unit = trax_ref_timing(trax_simt_speaker(tm, warp->left), tm->ref->config).unit;
    }
    warp->active = warp->has_operands ? warp->left : 0;
  }
}
