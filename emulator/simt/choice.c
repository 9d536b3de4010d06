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

void trax_simt_place(struct trax_simt_tm *tm, uint32_t lane, int32_t calls) {
  const uint32_t shallowness = (uint32_t)(tm->place[lane] >> 32) - (uint32_t)calls;
  tm->place[lane] = (uint64_t)shallowness << 32 | tm->ref->tp[lane].pc;
}

/* Gives the turn to the lane that has waited longest, if that is long enough. */
static void give_turn(const struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  uint64_t running = warp->running;
  uint32_t longest = trax_simt_take(&running);
  while (running) {
    const uint32_t i = trax_simt_take(&running);
    if (tm->last_issued[i] < tm->last_issued[longest])
      longest = i;
  }
  warp->turns_lane = longest;
  warp->waits_from = tm->last_issued[longest];
  if (warp->issued - warp->waits_from >= tm->ref->config->simt.patience)
    warp->turns_left = part_of_patience(tm);
}

/* Returns the lane whose pc the group is at. */
static uint32_t choose_lane(const struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  if (!(warp->running & trax_simt_bit(warp->turns_lane)))
    warp->turns_left = 0;
  if (!warp->turns_left && warp->issued - warp->waits_from >= tm->ref->config->simt.patience)
    give_turn(tm, warp);
  if (warp->turns_left)
    return warp->turns_lane;
  uint64_t running = warp->running;
  uint32_t first = trax_simt_take(&running);
  while (running) {
    const uint32_t i = trax_simt_take(&running);
    if (tm->place[i] < tm->place[first])
      first = i;
  }
  return first;
}

void trax_simt_choose(struct trax_simt_tm *tm, uint64_t t) {
  for (uint64_t awake = tm->awake; awake;) {
    struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&awake)];
    if (warp->group)
      continue;
    const uint32_t pc = (uint32_t)tm->place[choose_lane(tm, warp)];
    for (uint64_t set = warp->running; set;) {
      const uint32_t lane = trax_simt_take(&set);
      if ((uint32_t)tm->place[lane] != pc)
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
  warp->issued += cost;
  for (uint64_t set = warp->group; set;) {
    const uint32_t lane = trax_simt_take(&set);
    tm->last_issued[lane] = warp->issued;
    trax_simt_place(tm, lane, calls);
    tm->lane[lane].charged = t + 1;
  }
  warp->turns_left -= warp->turns_left < of_turn ? warp->turns_left : of_turn;
  warp->group = 0;
  warp->is_checked = warp->has_operands = false;
}
