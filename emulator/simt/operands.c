/* docs/simt.md, "Operands": step 2. */
#include "simt/simt.h"

/* Whether a lane waits for a register of the set. */
static bool waits(struct trax_simt_tm *tm, uint32_t lane, uint32_t needed, uint64_t t) {
  uint32_t *const pending = &tm->lane[lane].pending;
  for (uint32_t set = needed & *pending; set; set &= set - 1) {
    if (tm->ref->tp[lane].scoreboard[__builtin_ctz(set)].usable > t)
      return true;
    *pending &= ~(set & -set);
  }
  return false;
}

/* Checks a lane. False: it is refused. */
static bool check(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint32_t i, uint64_t t) {
  struct trax_ref_tp *lane = &tm->ref->tp[i];
  if (waits(tm, i, warp->inst->needs, t)) {
    tm->lane[i].waits_for = (uint8_t)trax_ref_wait_for_registers(tm->ref, lane, t);
  } else {
    tm->lane[i].waits_for = 0;
    if (warp->inst->decoded->resource != TRAX_RESOURCE_MEMORY)
      return true;
    trax_ref_find_address(tm->ref, lane, t);
  }
  return !trax_simt_note_charge(warp, lane);
}

/* The same for one that has been checked. If it was accepted it stays so, and else it waits for its register. */
static bool check_again(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint32_t i, uint64_t t) {
  const uint8_t waits_for = tm->lane[i].waits_for;
  if (!waits_for)
    return true;
  const struct trax_ref_register *reg = &tm->ref->tp[i].scoreboard[waits_for];
  if (reg->usable <= t)
    return check(tm, warp, i, t);
  trax_simt_charge(tm, warp, trax_simt_bit(i), t, reg->cause);
  return false;
}

static void fault(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  for (uint64_t set = warp->left; set;) {
    struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    trax_ref_fault(tm->ref, lane, t, TRAX_FAULT_ILLEGAL, 0);
    trax_simt_note_charge(warp, lane);
  }
}

/* Whether all lanes of the group are accepted. */
static bool check_group(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  bool passes = true;
  if (warp->is_checked) {
    for (uint64_t set = warp->left; set;)
      passes &= check_again(tm, warp, trax_simt_take(&set), t);
  } else if (warp->inst->decoded->resource != TRAX_RESOURCE_ILLEGAL) {
    for (uint64_t set = warp->left; set;)
      passes &= check(tm, warp, trax_simt_take(&set), t);
  } else {
    fault(tm, warp, t);
    passes = false;
  }
  warp->is_checked = true;
  return passes;
}

/* Notes what the active lanes ask for. */
static void note_asks(struct trax_simt_tm *tm, const struct trax_simt_warp *warp, uint64_t bit) {
  switch (warp->inst->decoded->resource) {
  case TRAX_RESOURCE_UNIT:
    tm->for_units |= tm->refuses[warp->inst->decoded->unit] ? bit : 0;
    break;
  case TRAX_RESOURCE_MEMORY:
    tm->for_memory |= bit;
    tm->for_turns |= bit;
    break;
  case TRAX_RESOURCE_END:
  case TRAX_RESOURCE_FENCE:
    tm->for_turns |= bit;
    break;
  }
}

void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t) {
  tm->for_units = tm->for_memory = tm->for_turns = 0;
  for (uint64_t awake = tm->awake; awake;) {
    const uint32_t i = trax_simt_take(&awake);
    struct trax_simt_warp *warp = &tm->warp[i];
    if (!warp->left)
      trax_simt_charge_fetch(tm, warp, t);
    else if (!warp->has_operands)
      warp->has_operands = check_group(tm, warp, t);
    warp->active = warp->has_operands ? warp->left : 0;
    if (warp->active)
      note_asks(tm, warp, trax_simt_bit(i));
  }
}
