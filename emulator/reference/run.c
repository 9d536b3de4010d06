/* docs/timing.md, "The machine", "Start and end", "A cycle". */
#include "reference/run.h"

#include "engine/run.h"
#include "reference/reference.h"

#include <stdlib.h>

static bool create_tm(struct trax_ref_tm *tm, uint32_t number, struct trax_machine *machine, FILE *output) {
  const struct trax_config *config = &machine->config;
  tm->number = number;
  tm->tps = config->chip.tps_per_tm;
  tm->config = config;
  for (trax_op op = 0; op < TRAX_OP_COUNT; op++)
    tm->timing[op] = trax_timing_of(op, config);
  for (trax_shared unit = 0; unit < TRAX_SHARED_COUNT; unit++)
    tm->kind[unit] = trax_shared_kind(unit, config);
  tm->machine = machine;
  tm->output = output;
  tm->stats = &machine->tm_stats[number];
  tm->queue = calloc(config->memory.queue_depth, sizeof *tm->queue);
  bool complete = tm->queue && trax_ref_lines_create(&tm->dcache, config->dcache.bytes, config->dcache.line_bytes,
                                                     config->dcache.ways, config->dcache.replacement);
  for (uint32_t i = 0; complete && i * config->icache.tps_per_cache < tm->tps; i++)
    complete = trax_ref_lines_create(&tm->icache[i].lines, config->icache.bytes, config->icache.line_bytes,
                                     config->icache.ways, TRAX_REPLACE_FIFO);
  for (uint32_t i = 0; i < tm->tps; i++) {
    tm->tp[i].number = i;
    tm->tp[i].pc = trax_machine_entry_of(machine, number * tm->tps + i);
  }
  return complete;
}

bool trax_ref_create(struct trax_ref_chip *chip, struct trax_machine *machine, FILE *output) {
  *chip = (struct trax_ref_chip){
      .machine = machine, .tms = machine->config.chip.tms, .config = &machine->config, .stats = &machine->stats.memory};
  chip->tm = calloc(chip->tms, sizeof *chip->tm);
  bool complete = chip->tm && trax_ref_controller_create(&chip->controller, &machine->config, chip->stats) &&
                  trax_ref_l2_create(&chip->l2, &machine->config);
  for (uint32_t i = 0; complete && i < chip->tms; i++)
    complete = create_tm(&chip->tm[i], i, machine, output);
  return complete;
}

void trax_ref_destroy(struct trax_ref_chip *chip) {
  for (uint32_t i = 0; chip->tm && i < chip->tms; i++) {
    trax_ref_lines_destroy(&chip->tm[i].dcache);
    for (uint32_t icache = 0; icache < MOST; icache++)
      trax_ref_lines_destroy(&chip->tm[i].icache[icache].lines);
    free(chip->tm[i].queue);
  }
  trax_ref_l2_destroy(&chip->l2);
  trax_dram_destroy(chip->controller.dram);
  free(chip->tm);
}

bool trax_ref_is_over(const struct trax_ref_chip *chip, uint64_t t) {
  for (uint32_t i = 0; i < chip->tms; i++) {
    for (uint32_t tp = 0; tp < chip->tm[i].tps; tp++)
      if (!chip->tm[i].tp[tp].ended)
        return false;
    for (uint32_t place = 0; place < chip->tm[i].places; place++)
      if (chip->tm[i].queue[place].stage != SERVED)
        return false;
  }
  for (uint32_t i = 0; i < chip->l2.misses; i++)
    if (chip->l2.miss[i].arrival == UNKNOWN)
      return false;
  return trax_ref_buses_idle(chip, t);
}

static trax_status create(struct trax_run *run, trax_error *error) {
  struct trax_ref_chip *chip = run->chip = calloc(1, sizeof *chip);
  return chip && trax_ref_create(chip, run->machine, run->options->output) ? TRAX_OK
                                                                           : trax_fail(error, "out of memory");
}

static void destroy(void *chip) {
  if (chip)
    trax_ref_destroy(chip);
  free(chip);
}

static void cycle(struct trax_ref_chip *chip, uint64_t t) {
  for (uint32_t i = 0; i < chip->tms; i++)
    trax_ref_arrivals(&chip->tm[i], t);
  for (uint32_t i = 0; i < chip->tms; i++) {
    struct trax_ref_tm *tm = &chip->tm[i];
    trax_ref_charge_idle(tm, t);
    trax_ref_fetch(tm, t);
    trax_ref_check_operands(tm, t);
    trax_ref_grant_units(tm, t);
    trax_ref_grant_data_banks(tm, t);
    trax_ref_grant_places(tm, t);
    trax_ref_issue(tm, t);
  }
  trax_ref_l2_cycle(chip, t);
  trax_ref_controller_cycle(chip, t);
}

static enum trax_advance advance(void *chip, uint64_t *t, uint64_t until) {
  enum { CYCLES = 64 }; /* of one call */
  const struct trax_ref_chip *it = chip;
  for (unsigned i = 0; i < CYCLES && *t < until; i++) {
    cycle(chip, (*t)++);
    if (it->machine->fault.kind)
      return TRAX_HAS_FAULTED;
    if (trax_ref_is_over(chip, *t))
      return TRAX_HAS_ENDED;
  }
  return TRAX_GOES_ON;
}

/* --- access between cycles --- */

static struct trax_ref_tp *tp_of(void *context, uint32_t number) {
  const struct trax_ref_chip *chip = context;
  return &chip->tm[number / chip->tm->tps].tp[number % chip->tm->tps];
}

static struct trax_thread thread(void *chip, uint32_t number) {
  struct trax_ref_tp *tp = tp_of(chip, number);
  return (struct trax_thread){tp->reg, tp->local, tp->pc, tp->ended};
}

static void set_pc(void *chip, uint32_t number, uint32_t pc) {
  tp_of(chip, number)->pc = pc;
  tp_of(chip, number)->holds = false;
}

static uint32_t queued(const void *context, uint32_t tm, uint64_t t) {
  const struct trax_ref_chip *chip = context;
  (void)t;
  return chip->tm[tm].places;
}

const struct trax_engine trax_reference_engine = {
    .name = "reference",
    .meaning = "docs/timing.md as a program: the same, many times slower",
    .is_timed = true,
    .is_observed = true,
    .create = create,
    .destroy = destroy,
    .advance = advance,
    .thread = thread,
    .set_pc = set_pc,
    .queued = queued,
};
