/* docs/timing.md, "The machine", "Start and end", "A cycle". */
#include "reference/run.h"

#include "fast/chip.h"
#include "engine/poll.h"
#include "reference/reference.h"

#include <stdlib.h>

static bool create_tm(struct trax_ref_tm *tm, uint32_t number, struct trax_machine *machine, FILE *output) {
  const struct trax_config *config = &machine->config;
  tm->number = number;
  tm->tps = config->chip.tps_per_tm;
  tm->config = config;
  tm->machine = machine;
  tm->output = output;
  tm->stats = &machine->tm_stats[number];
  tm->queue = calloc(config->memory.queue_depth, sizeof *tm->queue);
  bool complete = tm->queue && trax_ref_lines_create(&tm->dcache, config->dcache.bytes, config->dcache.line_bytes,
                                                     config->dcache.ways, config->dcache.lru);
  for (uint32_t i = 0; complete && i * config->icache.tps_per_cache < tm->tps; i++)
    complete = trax_ref_lines_create(&tm->icache[i].lines, config->icache.bytes, config->icache.line_bytes,
                                     config->icache.ways, false);
  for (uint32_t i = 0; i < tm->tps; i++) {
    tm->tp[i].number = i;
    tm->tp[i].pc = machine->entry;
  }
  return complete;
}

static trax_status create(struct trax_ref_chip *chip, struct trax_machine *machine, FILE *output, trax_error *error) {
  *chip = (struct trax_ref_chip){
      .machine = machine, .tms = machine->config.chip.tms, .config = &machine->config, .stats = &machine->stats.memory};
  trax_ref_controller_create(&chip->controller, &machine->config);
  chip->tm = calloc(chip->tms, sizeof *chip->tm);
  bool complete = chip->tm && trax_ref_l2_create(&chip->l2, &machine->config);
  for (uint32_t i = 0; complete && i < chip->tms; i++)
    complete = create_tm(&chip->tm[i], i, machine, output);
  return complete ? TRAX_OK : trax_fail(error, "out of memory");
}

static void destroy(struct trax_ref_chip *chip) {
  for (uint32_t i = 0; chip->tm && i < chip->tms; i++) {
    trax_ref_lines_destroy(&chip->tm[i].dcache);
    for (uint32_t icache = 0; icache < MOST; icache++)
      trax_ref_lines_destroy(&chip->tm[i].icache[icache].lines);
    free(chip->tm[i].queue);
  }
  trax_ref_l2_destroy(&chip->l2);
  free(chip->tm);
}

/* Every thread has ended, no request waits, and the buses are idle. */
static bool is_over(const struct trax_ref_chip *chip, uint64_t t) {
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

static trax_status run(struct trax_ref_chip *chip, const trax_run_options *options, uint64_t *t) {
  struct trax_chip shown = {.machine = chip->machine, .tms = chip->tms, .reference = chip}; /* to watches */
  uint64_t watched = 0;
  struct trax_poll poll;
  trax_poll_begin(&poll, chip->machine, options);
  for (*t = 0; !is_over(chip, *t); ++*t) {
    const trax_status status = *t < watched ? TRAX_OK : trax_chip_look(&shown, *t, &watched);
    if (status)
      return status;
    if (options->max_cycles && *t >= options->max_cycles)
      return TRAX_STUCK;
    if (trax_poll(&poll, *t))
      return TRAX_INTERRUPTED;
    cycle(chip, *t);
    if (chip->machine->fault.kind) {
      ++*t;
      return TRAX_FAULT;
    }
  }
  return TRAX_OK;
}

uint32_t trax_reference_queued(const struct trax_ref_chip *chip, uint32_t tm) {
  return chip->tm[tm].places;
}

trax_status trax_reference_run(struct trax_machine *machine, const trax_run_options *options, uint64_t *cycles,
                               trax_error *error) {
  struct trax_ref_chip chip;
  trax_status status = create(&chip, machine, options->output, error);
  if (status == TRAX_OK)
    status = run(&chip, options, cycles);
  destroy(&chip);
  return status;
}
