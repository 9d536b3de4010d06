/* docs/simt.md, "Choice". */
#include "simt/simt.h"

enum { WAITS = 16, WAITS_OF_TURN = 4 };

#define NOWHERE UINT64_MAX /* the place of a lane whose thread has ended */

static uint32_t at_least_one(uint32_t value) {
  return value ? value : 1;
}

/* Instructions of a turn, and the patience that an instruction costs with which threads wait. */
static uint32_t part_of_patience(const struct trax_simt_tm *tm) {
  return at_least_one(tm->ref->config->simt.patience / WAITS);
}

void trax_simt_place(struct trax_simt_tm *tm, uint32_t lane, int32_t calls) {
  const uint32_t shallowness = (uint32_t)(tm->place[lane] >> 32) - (uint32_t)calls;
  tm->place[lane] = tm->ref->tp[lane].ended ? NOWHERE : (uint64_t)shallowness << 32 | tm->ref->tp[lane].pc;
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

/* Returns the place at whose pc the group is. */
static uint64_t choose_place(const struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  if (!(warp->running & trax_simt_bit(warp->turns_lane)))
    warp->turns_left = 0;
  if (!warp->turns_left && warp->issued - warp->waits_from >= tm->ref->config->simt.patience)
    give_turn(tm, warp);
  if (warp->turns_left)
    return tm->place[warp->turns_lane];
  const uint64_t *place = &tm->place[warp->first];
  uint64_t least = NOWHERE;
  for (uint32_t i = 0; i < tm->ref->config->simt.width; i++)
    least = place[i] < least ? place[i] : least;
  return least;
}

/* Whether the latest group is the group again. */
static bool is_first(const struct trax_simt_tm *tm, const struct trax_simt_warp *warp) {
  return warp->stays && warp->issued - warp->waits_from < tm->ref->config->simt.patience &&
         tm->place[trax_simt_first(warp->stays)] < warp->others;
}

/* The group is the running lanes at that pc. */
static void gather(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t at, uint64_t t) {
  const uint64_t *place = &tm->place[warp->first];
  uint64_t group = 0, others = UINT64_MAX;
  bool is_level = true;
  for (uint32_t i = 0; i < tm->ref->config->simt.width; i++) {
    const bool is_there = (uint32_t)place[i] == (uint32_t)at;
    const uint64_t other = is_there ? UINT64_MAX : place[i];
    group |= (uint64_t)is_there << i;
    others = other < others ? other : others;
    is_level &= place[i] >> 32 == at >> 32 || place[i] == NOWHERE;
  }
  warp->group = group << warp->first & warp->running;
  warp->others = is_level ? others : 0;
  for (uint64_t set = warp->group; set;) {
    const uint32_t lane = trax_simt_take(&set);
    if (tm->lane[lane].charged != t)
      trax_simt_catch_up(tm, lane, t);
  }
}

void trax_simt_choose(struct trax_simt_tm *tm, uint64_t t) {
  for (uint64_t awake = tm->awake; awake;) {
    struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&awake)];
    if (warp->group)
      continue;
    if (is_first(tm, warp))
      warp->group = warp->stays;
    else
      gather(tm, warp, choose_place(tm, warp), t);
  }
}

/* Whether threads wait for others with it. */
static bool may_wait(const struct trax_decoded *inst) {
  return inst->resource == TRAX_RESOURCE_FENCE || inst->is_atomic || (inst->is_nontemporal && !inst->is_store);
}

static int32_t deeper(const struct trax_decoded *inst) {
  enum { RA = 1 };
  if (inst->op == TRAX_OP_JAL || inst->op == TRAX_OP_JALR)
    return inst->rd == RA ? 1 : inst->op == TRAX_OP_JALR && inst->rd == TRAX_NO_REGISTER && inst->ra == RA ? -1 : 0;
  return 0;
}

void trax_simt_dissolve(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  const bool waits = may_wait(warp->inst);
  const uint32_t part = part_of_patience(tm), cost = waits ? part : 1;
  const uint32_t of_turn = waits ? at_least_one(part / WAITS_OF_TURN) : 1;
  const int32_t calls = deeper(warp->inst);
  const uint32_t pc = trax_simt_speaker(tm, warp->group)->pc;
  warp->issued += cost;
  warp->stays = calls || warp->group & ~warp->running ? 0 : warp->group;
  for (uint64_t set = warp->group; set;) {
    const uint32_t lane = trax_simt_take(&set);
    tm->last_issued[lane] = warp->issued;
    trax_simt_place(tm, lane, calls);
    if (tm->ref->tp[lane].pc != pc)
      warp->stays = 0;
    tm->lane[lane].charged = t + 1;
  }
  warp->turns_left -= warp->turns_left < of_turn ? warp->turns_left : of_turn;
  warp->group = 0;
  warp->is_checked = warp->has_operands = false;
}
