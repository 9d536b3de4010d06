/* docs/simt.md, "Choice". */
#include "simt/simt.h"

enum { WAITS = 16, WAITS_OF_TURN = 4 };

static uint32_t at_least_one(uint32_t value) {
  return value ? value : 1;
}

/* Instructions of a turn, and the patience that an instruction costs with which threads wait. */
static uint32_t part_of_patience(const struct trax_simt_tm *tm) {
  return at_least_one(tm->ref->config->simt.patience / WAITS);
}

/* Whether lane a comes before lane b: greatest depth, then least pc. */
static bool is_before(const struct trax_simt_tm *tm, uint32_t a, uint32_t b) {
  if (tm->lane[a].depth != tm->lane[b].depth)
    return tm->lane[a].depth > tm->lane[b].depth;
  return tm->ref->tp[a].pc < tm->ref->tp[b].pc;
}

/* Returns the lane whose pc the group is at. */
static uint32_t choose_lane(const struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  if (warp->turns_left && warp->running & trax_simt_bit(warp->turns_lane))
    return warp->turns_lane;
  uint64_t running = warp->running;
  uint32_t first = trax_simt_take(&running), longest = first;
  while (running) {
    const uint32_t i = trax_simt_take(&running);
    if (is_before(tm, i, first))
      first = i;
    if (tm->lane[i].waited > tm->lane[longest].waited)
      longest = i;
  }
  const bool has_turn = tm->lane[longest].waited >= tm->ref->config->simt.patience;
  warp->turns_lane = longest;
  warp->turns_left = has_turn ? part_of_patience(tm) : 0;
  return has_turn ? longest : first;
}

void trax_simt_choose(struct trax_simt_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->warps; i++) {
    struct trax_simt_warp *warp = &tm->warp[i];
    if (warp->group || !warp->running)
      continue;
    const uint32_t pc = tm->ref->tp[choose_lane(tm, warp)].pc;
    for (uint64_t set = warp->running; set;) {
      const uint32_t lane = trax_simt_take(&set);
      if (tm->ref->tp[lane].pc != pc)
        continue;
      warp->group |= trax_simt_bit(lane);
      trax_simt_catch_up(tm, lane, t);
    }
  }
}

/* Whether threads wait for others with it. */
static bool may_wait(const struct trax_ref_tp *tp) {
  return tp->inst.op == TRAX_OP_FENCE || trax_ref_is(tp, TRAX_IS_ATOMIC) ||
         (trax_ref_is(tp, TRAX_IS_NONTEMPORAL) && !trax_ref_is(tp, TRAX_IS_STORE));
}

static int32_t deeper(const struct trax_ref_tp *tp) {
  enum { RA = 1 };
  const trax_inst *inst = &tp->inst;
  if ((inst->op == TRAX_OP_JAL || inst->op == TRAX_OP_JALR) && inst->rd == RA)
    return 1;
  return inst->op == TRAX_OP_JALR && inst->rd == 0 && inst->ra == RA ? -1 : 0;
}

void trax_simt_dissolve(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  const struct trax_ref_tp *speaker = trax_simt_speaker(tm, warp->group);
  const bool waits = may_wait(speaker);
  const uint32_t part = part_of_patience(tm), cost = waits ? part : 1;
  const uint32_t of_turn = waits ? at_least_one(part / WAITS_OF_TURN) : 1;
  const int32_t calls = deeper(speaker);
  for (uint64_t set = warp->group; set;) {
    struct trax_simt_lane *lane = &tm->lane[trax_simt_take(&set)];
    lane->waited = 0;
    lane->depth += calls;
    lane->charged = t + 1;
  }
  for (uint64_t set = warp->running & ~warp->group; set;)
    tm->lane[trax_simt_take(&set)].waited += cost;
  warp->turns_left -= warp->turns_left < of_turn ? warp->turns_left : of_turn;
  warp->group = 0;
  warp->is_checked = warp->has_operands = false;
}
