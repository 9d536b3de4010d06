/* docs/simt.md, "A cycle". */
#include "simt/run.h"

#include "engine/run.h"
#include "simt/simt.h"

#include <stdlib.h>

static void create_tm(struct trax_simt_tm *tm, struct trax_ref_tm *ref, const struct trax_text *text) {
  const uint32_t width = ref->config->simt.width;
  tm->ref = ref;
  tm->text = text;
  tm->warps = ref->tps / width;
  for (uint32_t i = 0; i < ref->tps; i++) {
    tm->warp[i / width].first = i / width * width;
    tm->fetched[i / width].arrivals = TRAX_NEVER;
    tm->warp[i / width].running |= trax_simt_bit(i);
    tm->awake |= trax_simt_bit(i / width);
    tm->place[i] = TRAX_SIMT_SURFACE << 32 | ref->tp[i].pc;
    tm->lane[i].warp = (uint8_t)(i / width);
    tm->lane[i].icache = (uint8_t)(i / ref->config->icache.tps_per_cache);
  }
  tm->wakes = TRAX_NEVER;
  for (trax_shared unit = 0; unit < TRAX_SHARED_COUNT; unit++) {
    const struct trax_shared_kind *kind = &ref->kind[unit];
    tm->refuses[unit] = kind->per_group < kind->group_size || !trax_always_free(unit, ref->config);
  }
}

/* Notes when memory is to be visited again. */
static void look_ahead(struct trax_simt_chip *chip) {
  const bool is_always = chip->ref.config->l2.bytes || chip->ref.controller.dram;
  chip->is_waited_for = is_always;
  chip->arrives = is_always ? 0 : TRAX_NEVER;
  for (uint32_t i = 0; !is_always && i < chip->ref.tms; i++)
    for (uint32_t place = 0; place < chip->ref.tm[i].places; place++) {
      const struct trax_ref_request *request = &chip->ref.tm[i].queue[place];
      if (request->stage != SERVED)
        chip->is_waited_for = true;
      else if (request->completion < chip->arrives)
        chip->arrives = request->completion;
    }
}

static trax_status create(struct trax_run *run, trax_error *error) {
  struct trax_simt_chip *chip = run->chip = calloc(1, sizeof *chip);
  if (!chip || !trax_ref_create(&chip->ref, run->machine, run->options->output) ||
      !(chip->tm = calloc(chip->ref.tms, sizeof *chip->tm)) || !trax_simt_decode(chip, &run->text))
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < chip->ref.tms; i++)
    create_tm(&chip->tm[i], &chip->ref.tm[i], &run->text);
  look_ahead(chip);
  return TRAX_OK;
}

static void destroy(void *context) {
  struct trax_simt_chip *chip = context;
  if (!chip)
    return;
  trax_ref_destroy(&chip->ref);
  free(chip->tm);
  free(chip->inst);
  free(chip);
}

/* The steps of a TM. */
static void steps(struct trax_simt_tm *tm, uint64_t t) {
  trax_simt_choose(tm, t);
  trax_simt_fetch(tm, t);
  trax_simt_check_operands(tm, t);
  trax_simt_grant_units(tm, t);
  trax_simt_grant_data_banks(tm, t);
  trax_simt_grant_places(tm, t);
  trax_simt_issue(tm, t);
}

/* The requests that arrive in cycle t. Returns the TMs that have any, as a set. */
static uint64_t arrivals(struct trax_simt_chip *chip, uint64_t t) {
  uint64_t has_arrived = 0;
  for (uint32_t i = 0; t >= chip->arrives && i < chip->ref.tms; i++) {
    const uint32_t places = chip->ref.tm[i].places;
    trax_ref_arrivals(&chip->ref.tm[i], t);
    has_arrived |= (uint64_t)(chip->ref.tm[i].places != places) << i;
  }
  return has_arrived;
}

static void cycle(struct trax_simt_chip *chip, uint64_t t) {
  const uint64_t has_arrived = arrivals(chip, t);
  for (uint32_t i = 0; i < chip->ref.tms; i++) {
    struct trax_simt_tm *tm = &chip->tm[i];
    const uint32_t places = tm->ref->places;
    if (t >= tm->wakes || has_arrived >> i & 1)
      trax_simt_wake(tm, t, has_arrived >> i & 1);
    if (tm->awake)
      steps(tm, t);
    chip->is_waited_for |= tm->ref->places > places;
  }
  const bool is_waited_for = chip->is_waited_for;
  if (is_waited_for) {
    trax_ref_l2_cycle(&chip->ref, t);
    trax_ref_controller_cycle(&chip->ref, t);
  }
  if (is_waited_for || has_arrived)
    look_ahead(chip);
}

static bool has_running(const struct trax_simt_tm *tm) {
  for (uint32_t i = 0; i < tm->warps; i++)
    if (tm->warp[i].running)
      return true;
  return false;
}

/* The next cycle, from t on, in which anything happens. When all threads have ended, the run's end may be next. */
static uint64_t next_event(const struct trax_simt_chip *chip, uint64_t t) {
  uint64_t next = chip->is_waited_for ? t : chip->arrives;
  bool are_running = false;
  for (uint32_t i = 0; i < chip->ref.tms && next > t; i++) {
    if (chip->tm[i].awake)
      return t;
    next = chip->tm[i].wakes < next ? chip->tm[i].wakes : next;
    are_running = are_running || has_running(&chip->tm[i]);
  }
  return are_running ? next : t;
}

static enum trax_advance advance(void *context, uint64_t *t, uint64_t until) {
  enum { CYCLES = 64 }; /* of one call */
  struct trax_simt_chip *chip = context;
  for (unsigned i = 0; i < CYCLES && *t < until; i++) {
    cycle(chip, (*t)++);
    chip->t = *t;
    if (chip->ref.machine->fault.kind)
      return TRAX_HAS_FAULTED;
    if (trax_ref_is_over(&chip->ref, *t))
      return TRAX_HAS_ENDED;
    const uint64_t next = next_event(chip, *t);
    chip->t = *t = next < until ? next : until;
  }
  return TRAX_GOES_ON;
}

/* --- access between cycles --- */

static void settle(void *context, uint64_t t) {
  struct trax_simt_chip *chip = context;
  const uint32_t width = chip->ref.config->simt.width;
  for (uint32_t i = 0; i < chip->ref.tms; i++) {
    struct trax_simt_tm *tm = &chip->tm[i];
    for (uint32_t lane = 0; lane < tm->ref->tps; lane++)
      if (!(tm->warp[lane / width].group & trax_simt_bit(lane)))
        trax_simt_catch_up(tm, lane, t);
    for (uint32_t warp = 0; warp < tm->warps; warp++)
      if (!(tm->awake & trax_simt_bit(warp)))
        trax_simt_charge_sleep(tm, &tm->warp[warp], t);
    trax_simt_settle_rays(tm);
  }
}

static struct trax_thread thread(void *context, uint32_t number) {
  const struct trax_simt_chip *chip = context;
  struct trax_ref_tm *tm = &chip->ref.tm[number / chip->ref.tm->tps];
  struct trax_ref_tp *lane = &tm->tp[number % tm->tps];
  return (struct trax_thread){lane->reg, lane->local, lane->pc, lane->ended};
}

/* The warp's lanes discard what they have fetched and not issued, and it chooses again. */
static void set_pc(void *context, uint32_t number, uint32_t pc) {
  struct trax_simt_chip *chip = context;
  const uint32_t tps = chip->ref.tm->tps;
  struct trax_simt_tm *tm = &chip->tm[number / tps];
  struct trax_simt_warp *warp = &tm->warp[number % tps / chip->ref.config->simt.width];
  trax_simt_wake(tm, chip->t, true);
  for (uint64_t set = warp->group; set;) {
    struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    lane->holds = lane->awaits_line = false;
    tm->lane[lane->number].charged = chip->t;
  }
  warp->group = warp->left = warp->stays = 0;
  warp->is_checked = warp->has_operands = false;
  tm->ref->tp[number % tps].pc = pc;
  if (!tm->ref->tp[number % tps].ended)
    tm->place[number % tps] = (tm->place[number % tps] >> 32 << 32) | pc;
}

static uint32_t queued(const void *context, uint32_t tm, uint64_t t) {
  const struct trax_simt_chip *chip = context;
  (void)t;
  return chip->ref.tm[tm].places;
}

const struct trax_engine trax_simt_engine = {
    .name = "simt",
    .meaning = "docs/simt.md as a program: warps of TPs that execute together",
    .is_timed = true,
    .is_observed = true,
    .has_warps = true,
    .counts_rays = true,
    .create = create,
    .destroy = destroy,
    .advance = advance,
    .settle = settle,
    .thread = thread,
    .set_pc = set_pc,
    .queued = queued,
};
