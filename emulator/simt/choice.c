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
    if (!warp->group && is_first(tm, warp))
      warp->group = warp->stays;
    else if (!warp->group)
      gather(tm, warp, choose_place(tm, warp), t);
    warp->uncharged = warp->group;
    if (t < warp->bubble_ends || warp->group & ~warp->running)
      trax_simt_charge_idle(tm, warp, t);
  }
}

/* Notes where the lanes of a group are, and whether they stay a group. */
static void place_group(struct trax_simt_tm *tm, struct trax_simt_warp *warp, int32_t calls, uint64_t t) {
  const uint32_t pc = trax_simt_speaker(tm, warp->group)->pc;
  bool is_split = calls || warp->group & ~warp->running;
  for (uint64_t set = warp->group; set;) {
    const uint32_t i = trax_simt_take(&set);
    is_split |= tm->ref->tp[i].pc != pc;
    tm->place[i] += (uint64_t)tm->ref->tp[i].pc - (uint32_t)tm->place[i] - ((uint64_t)(int64_t)calls << 32);
    tm->last_issued[i] = warp->issued;
    tm->lane[i].charged = t + 1;
  }
  for (uint64_t set = warp->group & ~warp->running; set;)
    tm->place[trax_simt_take(&set)] = NOWHERE;
  warp->stays = is_split ? 0 : warp->group;
}

void trax_simt_dissolve(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  const bool is_wait = warp->inst->is_wait;
  const uint32_t part = part_of_patience(tm), of_turn = is_wait ? at_least_one(part / WAITS_OF_TURN) : 1;
  warp->issued += is_wait ? part : 1;
  place_group(tm, warp, warp->inst->calls, t);
  warp->turns_left -= warp->turns_left < of_turn ? warp->turns_left : of_turn;
  warp->group = 0;
  warp->is_checked = warp->has_operands = false;
}
