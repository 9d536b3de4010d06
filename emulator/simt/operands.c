/* docs/simt.md, "Operands": step 2. */
#include "simt/simt.h"

/* Successive registers as a set. */
static uint32_t registers(unsigned first, unsigned count) {
  const uint64_t set = ((UINT64_C(1) << count) - 1) << first;
  return (uint32_t)(set | set >> TRAX_NUM_REGISTERS);
}

/* The registers that an instruction needs, as a set. r0 is always usable. */
static uint32_t needed_registers(const struct trax_decoded *inst) {
  return registers(inst->wait_ra, inst->more_ra + 1u) | registers(inst->wait_rb, inst->more_rb + 1u) |
         1u << inst->wait_rd;
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
  const bool is_illegal = warp->inst->resource == TRAX_RESOURCE_ILLEGAL && !warp->is_checked;
  const bool has_more = warp->inst->resource == TRAX_RESOURCE_MEMORY || warp->inst->resource == TRAX_RESOURCE_FENCE;
  const uint32_t needs = has_more ? 0 : needed_registers(warp->inst);
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

/* Notes what the active lanes ask for. */
static void note_asks(struct trax_simt_tm *tm, const struct trax_simt_warp *warp, uint64_t bit) {
  switch (warp->inst->resource) {
  case TRAX_RESOURCE_UNIT:
    tm->for_units |= tm->refuses[warp->inst->unit] ? bit : 0;
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
    if (warp->left && !warp->has_operands)
      warp->has_operands = check_group(tm, warp, t);
    warp->active = warp->has_operands ? warp->left : 0;
    if (warp->active)
      note_asks(tm, warp, trax_simt_bit(i));
  }
}
