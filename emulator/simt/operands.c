/* docs/simt.md, "Operands": step 2. */
#include "simt/simt.h"

/* The registers that all lanes of a group need, as a set. */
static uint32_t needed_registers(const struct trax_ref_tp *lane) {
  const unsigned flags = trax_ref_info(lane)->flags;
  uint32_t set = trax_ref_is(lane, TRAX_READS_RD | TRAX_WRITES_RD) ? 1u << lane->inst.rd : 0;
  for (unsigned n = 0; n < trax_group_a(flags); n++)
    set |= 1u << (lane->inst.ra + n) % TRAX_NUM_REGISTERS;
  for (unsigned n = 0; n < trax_group_b(flags); n++)
    set |= 1u << (lane->inst.rb + n) % TRAX_NUM_REGISTERS;
  return set;
}

static bool are_usable(const struct trax_ref_tp *lane, uint32_t registers, uint64_t t) {
  for (; registers; registers &= registers - 1)
    if (lane->scoreboard[__builtin_ctz(registers)].usable > t)
      return false;
  return true;
}

/* Checks a lane. False: it is refused. A lane that was accepted stays so, and another one waits for its
   register.
   needs: registers after whose check it is accepted; 0: there is more to check. */
static bool check(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint32_t i, uint32_t needs, uint64_t t) {
  struct trax_ref_tp *lane = &tm->ref->tp[i];
  uint8_t *const waits_for = &tm->lane[i].waits_for;
  if (warp->is_checked && !*waits_for)
    return true;
  if (warp->is_checked && lane->scoreboard[*waits_for].usable > t) {
    trax_simt_charge(tm, warp, trax_simt_bit(i), t, lane->scoreboard[*waits_for].cause);
    return false;
  }
  if (needs && are_usable(lane, needs, t)) {
    *waits_for = 0;
    return true;
  }
  *waits_for = (uint8_t)trax_ref_check_registers(tm->ref, lane, t);
  return !trax_simt_note_charge(warp, lane);
}

/* Whether all lanes of the group are accepted. */
static bool check_group(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  const struct trax_ref_tp *first = trax_simt_speaker(tm, warp->left);
  const bool is_illegal = !warp->is_checked && trax_ref_is_illegal(tm->ref, first);
  const bool has_more = trax_ref_accesses_memory(first) || first->inst.op == TRAX_OP_FENCE;
  const uint32_t needs = has_more ? 0 : needed_registers(first);
  bool passes = true;
  for (uint64_t set = warp->left; set;) {
    const uint32_t i = trax_simt_take(&set);
    if (is_illegal) {
      trax_ref_fault(tm->ref, &tm->ref->tp[i], t, TRAX_FAULT_ILLEGAL, 0);
      trax_simt_note_charge(warp, &tm->ref->tp[i]);
      passes = false;
    } else {
      passes = check(tm, warp, i, needs, t) && passes;
    }
  }
  warp->is_checked = true;
  return passes;
}

void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t) {
  for (uint64_t awake = tm->awake; awake;) {
    struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&awake)];
    if (warp->left && !warp->has_operands && check_group(tm, warp, t)) {
      warp->has_operands = true;
      warp->unit = trax_ref_timing(trax_simt_speaker(tm, warp->left), tm->ref->config).unit;
    }
    warp->active = warp->has_operands ? warp->left : 0;
  }
}
