/* docs/simt.md, "Accounting", and step 5 of "A cycle". */
#include "machine/ray_cycles.h"
#include "simt/simt.h"

/* The register that a lane waits for under the cause; 0: none. */
static unsigned register_of(const struct trax_simt_tm *tm, uint32_t lane, trax_cause cause) {
  return trax_is_wait(cause) ? tm->lane[lane].waits_for : 0;
}

void trax_simt_charge(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t set, uint64_t t,
                      trax_cause cause) {
  struct trax_tp_stats *stats = &tm->ref->machine->tp_stats[tm->ref->number * tm->ref->tps];
  const bool is_observed = tm->ref->machine->observer;
  set &= warp->uncharged;
  warp->active &= ~set;
  warp->uncharged &= ~set;
  while (set) {
    const uint32_t i = trax_simt_take(&set);
    stats[i].cycles[cause]++;
    if (is_observed)
      trax_ref_notify_charge(tm->ref, &tm->ref->tp[i], t, cause, register_of(tm, i, cause));
  }
}

void trax_simt_charge_idle(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  trax_simt_charge(tm, warp, warp->group & ~warp->running, t, TRAX_CAUSE_HALTED);
  uint64_t in_bubble = 0;
  for (uint64_t set = warp->uncharged; set;) {
    const uint32_t lane = trax_simt_take(&set);
    if (t < tm->ref->tp[lane].bubble_ends)
      in_bubble |= trax_simt_bit(lane);
  }
  trax_simt_charge(tm, warp, in_bubble, t, TRAX_CAUSE_BRANCH);
}

void trax_simt_charge_cycles(const struct trax_simt_tm *tm, uint32_t lane, trax_cause cause, uint64_t since,
                             uint64_t cycles) {
  struct trax_machine *machine = tm->ref->machine;
  machine->tp_stats[tm->ref->number * tm->ref->tps + lane].cycles[cause] += cycles;
  if (cycles && machine->observer && machine->observer->charge)
    machine->observer->charge(machine->observer->context, tm->ref->number, lane, cause, register_of(tm, lane, cause),
                              since, cycles);
}

void trax_simt_catch_up(struct trax_simt_tm *tm, uint32_t lane, uint64_t t) {
  if (tm->lane[lane].charged == t)
    return;
  const struct trax_ref_tp *tp = &tm->ref->tp[lane];
  const uint64_t since = tm->lane[lane].charged, ends = tp->ended ? 0 : tp->bubble_ends;
  const uint64_t bubble = ends <= since ? since : ends < t ? ends : t;
  trax_simt_charge_cycles(tm, lane, TRAX_CAUSE_BRANCH, since, bubble - since);
  trax_simt_charge_cycles(tm, lane, tp->ended ? TRAX_CAUSE_HALTED : TRAX_CAUSE_DIVERGENCE, bubble, t - bubble);
  tm->lane[lane].charged = t;
}

static const uint64_t *charges_of(const struct trax_simt_tm *tm, uint32_t thread) {
  return tm->ref->machine->tp_stats[thread].cycles;
}

/* After a trap, which may count rays. */
static void count_rays(struct trax_simt_tm *tm, const struct trax_ref_tp *lane, uint32_t value) {
  struct trax_ray_cycles *rays = tm->ref->machine->ray_cycles;
  const uint32_t thread = tm->ref->number * tm->ref->tps + lane->number;
  trax_ray_cycles_trap(&rays->tms[tm->ref->number], &rays->threads[thread], charges_of(tm, thread), lane->inst.imm,
                       value);
}

void trax_simt_settle_rays(struct trax_simt_tm *tm) {
  struct trax_ray_cycles *rays = tm->ref->machine->ray_cycles;
  const uint32_t first = tm->ref->number * tm->ref->tps;
  for (uint32_t i = first; rays && i < first + tm->ref->tps; i++)
    trax_ray_cycles_add(&rays->tms[tm->ref->number], &rays->threads[i], charges_of(tm, i));
}

/* Issues the instruction on the lanes of the warp that were granted all they asked for. */
static void issue(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  const uint32_t writes = warp->inst->decoded->rd == TRAX_NO_REGISTER ? 0 : 1u << warp->inst->decoded->rd;
  const bool counts_rays = warp->inst->decoded->op == TRAX_OP_TRAP && tm->ref->machine->ray_cycles;
  uint64_t issued = 0, ended = 0, bubble_ends = warp->bubble_ends;
  for (uint64_t set = warp->active; set;) {
    const uint32_t i = trax_simt_take(&set);
    struct trax_ref_tp *lane = &tm->ref->tp[i];
    const uint32_t value = counts_rays ? lane->reg[lane->inst.ra] : 0;
    trax_ref_issue_of(tm->ref, lane, t);
    if (counts_rays)
      count_rays(tm, lane, value);
    lane->charged = false; /* for the next cycle */
    issued |= lane->holds ? 0 : trax_simt_bit(i);
    ended |= lane->ended ? trax_simt_bit(i) : 0;
    tm->lane[i].pending |= writes;
    bubble_ends = lane->bubble_ends > bubble_ends ? lane->bubble_ends : bubble_ends;
  }
  warp->bubble_ends = bubble_ends;
  for (uint64_t set = tm->broadcast & issued; set; set &= set - 1)
    tm->ref->stats->broadcast_loads++;
  warp->uncharged &= ~warp->active;
  warp->left &= ~issued;
  warp->running &= ~ended;
  warp->active = 0;
}

void trax_simt_issue(struct trax_simt_tm *tm, uint64_t t) {
  for (uint64_t awake = tm->awake; awake;) {
    const uint32_t i = trax_simt_take(&awake);
    struct trax_simt_warp *warp = &tm->warp[i];
    const bool is_held = warp->left;
    if (warp->active)
      issue(tm, warp, t);
    if (warp->uncharged)
      trax_simt_charge(tm, warp, warp->uncharged, t, TRAX_CAUSE_LOCKSTEP);
    if (is_held && !warp->left)
      trax_simt_dissolve(tm, warp, t);
    if (!trax_simt_is_busy(warp))
      trax_simt_sleep(tm, i, t);
  }
}
