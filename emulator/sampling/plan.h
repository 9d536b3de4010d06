/* The plan of a slot-sampled run: which ranges of slots are measured, in which order, and what they are expected to
   cost.

   All slots but some at the beginning and the end are divided into units of the same number of slots. A draw is a unit
   that is measured. Draws are made with probabilities in proportion to the units' expected costs: the work is divided
   into as many parts of equal cost as there are draws, and one place is drawn in each part. */
#ifndef TRAX_SAMPLING_PLAN_H
#define TRAX_SAMPLING_PLAN_H

#include "machine/machine.h"

/* The error that caches cause after a warm-up, relative to the estimate. It is added to the interval's half width
   (docs/sampling.md). */
#define TRAX_SAMPLING_BIAS 0.01

struct trax_slot_plan {
  trax_slot_sampling asked; /* with the defaults filled in */
  uint64_t random;          /* the generator's state */
  uint32_t first, last;     /* the first slot of the first unit, and the first slot after the last unit */
  uint32_t units;           /* 0: everything is simulated */
  double *sizes;            /* [units + 1]: the expected cost of the units before each, then of all */
  uint32_t *draws;          /* [draw_count]: units, in the order of simulation; [most_draws] allocated */
  size_t draw_count, most_draws;
};

/* Checks the options and makes the plan for a machine. Errors: bad options, out of memory. The plan must be destroyed
   in either case. */
trax_status trax_slot_plan_create(struct trax_slot_plan *plan, const struct trax_machine *machine,
                                  const trax_slot_sampling *sampling, trax_error *error);
void trax_slot_plan_destroy(struct trax_slot_plan *plan);

/* Adds `count` draws, or as many as there is room for. */
void trax_slot_plan_draw(struct trax_slot_plan *plan, size_t count);

/* The expected cost of a unit, and of all slots before `slot`. */
double trax_slot_plan_size(const struct trax_slot_plan *plan, uint32_t unit);
double trax_slot_plan_cost_before(const struct trax_slot_plan *plan, uint32_t slot);

/* The number of slots of a queue, and how many of them it has handed out at `place`, a multiple of the block. */
uint32_t trax_slot_plan_queue_slots(const trax_slot_sampling *asked, uint32_t queue);
uint32_t trax_slot_plan_handed_out(const trax_slot_sampling *asked, uint32_t queue, uint32_t place);

#endif
