#include "sampling/plan.h"

#include "sampling/estimate.h"

#include <math.h>
#include <stdlib.h>

enum {
  LEAST_DRAWS = 16,
  PILOT_DRAWS = 24, /* after these, the number of draws for the wanted interval is computed */
  LEAST_UNIT = 256,
  UNIT_ROUNDS = 2, /* default slots of a unit, and of a warm-up, for each thread */
  WARM_UP_ROUNDS = 4
};

#define LEAST_COST 0.02 /* added to each unit, relative to the mean: a predicted cost of 0 may be wrong */
#define ENOUGH 0.8      /* share of the slots to simulate from which all of them are simulated */

/* --- draws --- */

static uint64_t scrambled(uint64_t seed) { /* splitmix64 */
  seed = (seed ^ seed >> 30) * 0xBF58476D1CE4E5B9u;
  seed = (seed ^ seed >> 27) * 0x94D049BB133111EBu;
  return seed ^ seed >> 31;
}

/* A random number from 0 to below 1. */
static double random_fraction(struct trax_slot_plan *plan) {
  return (double)(scrambled(plan->random += 0x9E3779B97F4A7C15u) >> 11) * 0x1p-53;
}

double trax_slot_plan_size(const struct trax_slot_plan *plan, uint32_t unit) {
  return plan->sizes[unit + 1] - plan->sizes[unit];
}

void trax_slot_plan_draw(struct trax_slot_plan *plan, size_t count) {
  const size_t room = plan->most_draws - plan->draw_count;
  count = count < room ? count : room;
  for (size_t i = 0; i < count; i++)
    plan->draws[plan->draw_count++] = trax_estimate_unit(
        plan->sizes, plan->units, plan->sizes[plan->units] * ((double)i + random_fraction(plan)) / (double)count);
}

/* The number of draws that simulate that share of the work, warm-ups included. */
static double draws_for(const struct trax_slot_plan *plan, double fraction) {
  double squares = 0;
  for (uint32_t i = 0; i < plan->units; i++)
    squares += pow(trax_slot_plan_size(plan, i), 2);
  const double drawn = squares / plan->sizes[plan->units]; /* the expected size of a draw */
  const double with_warm_up = drawn * (1 + (double)plan->asked.warm_up / plan->asked.unit);
  return fraction * plan->sizes[plan->units] / with_warm_up;
}

/* --- costs and queues --- */

double trax_slot_plan_cost_before(const struct trax_slot_plan *plan, uint32_t slot) {
  const trax_slot_sampling *asked = &plan->asked;
  if (!asked->costs)
    return slot;
  const uint32_t block = slot / asked->block, left = slot % asked->block;
  const double cost = asked->costs[block];
  return left ? cost + (asked->costs[block + 1] - cost) * left / asked->block : cost;
}

uint32_t trax_slot_plan_queue_slots(const trax_slot_sampling *asked, uint32_t queue) {
  if (asked->queues == 1) /* a single queue has no tiles */
    return asked->slots;
  const uint32_t tiles = asked->slots / asked->tile;
  return (tiles - queue + asked->queues - 1) / asked->queues * asked->tile;
}

uint32_t trax_slot_plan_handed_out(const trax_slot_sampling *asked, uint32_t queue, uint32_t place) {
  if (asked->queues == 1)
    return place;
  if (asked->handed_out)
    return asked->handed_out[(size_t)(place / asked->block) * asked->queues + queue];
  const uint64_t round = (uint64_t)asked->tile * asked->queues, begun = place % round;
  const uint64_t before = (uint64_t)queue * asked->tile, more = begun > before ? begun - before : 0;
  return (uint32_t)(place / round * asked->tile + (more < asked->tile ? more : asked->tile));
}

/* The last place at which `left` slots are left, and in each queue its equal share of them. It is a multiple of the
   block. */
static uint32_t place_with(const trax_slot_sampling *asked, uint64_t left) {
  uint64_t most = asked->slots > left ? asked->slots - left : 0, least = 0;
  if (asked->queues == 1)
    return (uint32_t)most;
  least /= asked->block, most /= asked->block;
  while (least < most) {
    const uint64_t middle = (least + most + 1) / 2;
    bool enough = true;
    for (uint32_t queue = 0; queue < asked->queues && enough; queue++)
      enough = trax_slot_plan_handed_out(asked, queue, (uint32_t)middle * asked->block) + left / asked->queues <=
               trax_slot_plan_queue_slots(asked, queue);
    least = enough ? middle : least;
    most = enough ? most : middle - 1;
  }
  return (uint32_t)(least * asked->block);
}

/* --- checks --- */

static trax_status check_queues(const trax_slot_sampling *asked, trax_error *error) {
  if (asked->queues > TRAX_MAX_SLOT_QUEUES)
    return trax_fail(error, "slots wait in %u queues; allowed are %d at most", asked->queues, TRAX_MAX_SLOT_QUEUES);
  if (asked->queues < 2)
    return TRAX_OK;
  if (!asked->tile || asked->slots % asked->tile)
    return trax_fail(error, "%u slots of several queues are not whole tiles of %u", asked->slots, asked->tile);
  if (asked->handed_out && !asked->block)
    return trax_fail(error, "the slots that queues have handed out need the number of slots in a block");
  for (uint64_t place = 0; asked->handed_out && place < asked->slots; place += asked->block) {
    const uint32_t *row = &asked->handed_out[place / asked->block * asked->queues];
    uint64_t sum = 0;
    for (uint32_t queue = 0; queue < asked->queues; queue++) {
      if (row[queue] > trax_slot_plan_queue_slots(asked, queue) || (place && row[queue] < (row - asked->queues)[queue]))
        return trax_fail(error, "queue %u cannot have handed out %u slots at slot %llu", queue, row[queue],
                         (unsigned long long)place);
      sum += row[queue];
    }
    if (sum != place)
      return trax_fail(error, "queues have handed out %llu slots at slot %llu", (unsigned long long)sum,
                       (unsigned long long)place);
  }
  return TRAX_OK;
}

static trax_status check(const trax_slot_sampling *asked, const struct trax_machine *machine, trax_error *error) {
  const uint32_t words = asked->queues ? asked->queues : 1;
  if (asked->counter % 4 || asked->counter + 4 * (uint64_t)words > machine->space.size)
    return trax_fail(error, "the counter of slots at 0x%08x is not a word of global memory", asked->counter);
  if (!asked->slots)
    return trax_fail(error, "there are no slots to sample");
  if (check_queues(asked, error))
    return TRAX_ERROR;
  if (!(asked->error > 0) && !(asked->fraction > 0 && asked->fraction <= 1))
    return trax_fail(error, "the fraction of slots to simulate is %g; allowed is above 0 to 1", asked->fraction);
  if (asked->error < 0 || asked->error >= 1 || isnan(asked->error))
    return trax_fail(error, "the error wanted is %g; allowed is 0 to below 1", asked->error);
  if (asked->error > 0 && asked->error <= TRAX_SAMPLING_BIAS)
    return trax_fail(error,
                     "the error wanted is %g %%; no interval is narrower than plus and minus %g %%: simulate all",
                     100 * asked->error, 100 * TRAX_SAMPLING_BIAS);
  if (asked->costs && !asked->block)
    return trax_fail(error, "costs of slots need the number of slots in a block");
  for (uint32_t i = 0; asked->costs && i * (uint64_t)asked->block < asked->slots; i++)
    if (!(asked->costs[i + 1] >= asked->costs[i]) || !isfinite(asked->costs[i + 1]))
      return trax_fail(error, "the cost of the slots from %u on is not a number of 0 or more", i * asked->block);
  return TRAX_OK;
}

/* --- the plan --- */

/* The greatest multiple stands for values beyond it, which are more than all slots. */
static uint32_t rounded_up(uint64_t value, uint32_t multiple) {
  const uint64_t rounded = (value + multiple - 1) / multiple * multiple, most = UINT32_MAX / multiple * multiple;
  return (uint32_t)(rounded < most ? rounded : most);
}

static bool make_room(struct trax_slot_plan *plan, size_t most) {
  plan->most_draws = most;
  plan->draws = calloc(most, sizeof *plan->draws);
  return plan->draws != NULL;
}

trax_status trax_slot_plan_create(struct trax_slot_plan *plan, const struct trax_machine *machine,
                                  const trax_slot_sampling *sampling, trax_error *error) {
  *plan = (struct trax_slot_plan){.asked = *sampling};
  trax_slot_sampling *asked = &plan->asked;
  const uint32_t threads = (uint32_t)machine->stats.threads;
  if (check(asked, machine, error))
    return TRAX_ERROR;
  asked->block = asked->block ? asked->block : 1;
  asked->queues = asked->queues ? asked->queues : 1;
  const uint64_t unit = UNIT_ROUNDS * (uint64_t)threads;
  asked->unit = rounded_up(asked->unit ? asked->unit : unit > LEAST_UNIT ? unit : LEAST_UNIT, asked->block);
  asked->warm_up = rounded_up(asked->warm_up ? asked->warm_up : WARM_UP_ROUNDS * (uint64_t)threads, asked->block);
  asked->seed = asked->seed ? asked->seed : 1;
  /* The chip is part of the seed, so that estimates for different chips are independent. */
  plan->random = scrambled(asked->seed << 32 | machine->config.chip.tms << 16 | threads);
  plan->first = rounded_up(asked->warm_up > unit ? asked->warm_up : unit, asked->block);
  const uint64_t end = place_with(asked, asked->warm_up + (uint64_t)threads);
  const uint64_t ends = plan->first + (uint64_t)asked->slots - end;
  if (asked->fraction >= 1 || ends >= asked->slots)
    return TRAX_OK;
  const uint32_t units = (uint32_t)((asked->slots - ends) / asked->unit);
  plan->last = plan->first + units * asked->unit;
  plan->sizes = calloc((size_t)units + 1, sizeof *plan->sizes);
  if (!plan->sizes)
    return trax_fail(error, "out of memory for %u ranges of slots", units);
  const double all = trax_slot_plan_cost_before(plan, plan->last) - trax_slot_plan_cost_before(plan, plan->first);
  const double mean = units ? all / units : 0;
  for (uint32_t i = 0; i < units; i++) {
    const uint32_t slot = plan->first + i * asked->unit;
    const double cost = trax_slot_plan_cost_before(plan, slot + asked->unit) - trax_slot_plan_cost_before(plan, slot);
    plan->sizes[i + 1] = plan->sizes[i] + cost + LEAST_COST * (mean > 0 ? mean : 1);
  }
  plan->units = units;
  double count = units ? asked->error > 0 ? PILOT_DRAWS : draws_for(plan, asked->fraction) : 0;
  count = count < LEAST_DRAWS ? LEAST_DRAWS : count;
  if (ends + count * ((double)asked->unit + asked->warm_up) > ENOUGH * asked->slots)
    plan->units = 0;
  else if (!make_room(plan, (size_t)(ENOUGH * asked->slots / ((double)asked->unit + asked->warm_up))))
    return trax_fail(error, "out of memory for ranges of slots");
  if (plan->units)
    trax_slot_plan_draw(plan, (size_t)count);
  return TRAX_OK;
}

void trax_slot_plan_destroy(struct trax_slot_plan *plan) {
  free(plan->sizes);
  free(plan->draws);
}
