/* The creation of a chip and its TMs. */
#define _DEFAULT_SOURCE /* madvise */
#include "fast/chip.h"
#include "fast/time/head.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define HUGE_PAGE ((size_t)1 << 21)
#define LARGE ((size_t)4 << 20) /* bytes of TPs from which on TMs are prefetched; 8x64, of 1.5 MB, would be slower */

static void *create_aligned(size_t count, size_t size) {
  const size_t alignment = count * size < HUGE_PAGE ? 64 : HUGE_PAGE;
  const size_t bytes = (count * size + alignment - 1) / alignment * alignment;
  void *array = aligned_alloc(alignment, bytes);
#ifdef MADV_HUGEPAGE
  if (array && alignment == HUGE_PAGE)
    madvise(array, bytes, MADV_HUGEPAGE);
#endif
  return array ? memset(array, 0, bytes) : NULL;
}

static void prepare_units(struct trax_fast_units *unit, const struct trax_shared_kind *first,
                          const struct trax_shared_kind *second) {
  unit->group_size = first->group_size;
  unit->even = 64 % unit->group_size == 0 && second->group_size == unit->group_size && first->per_group == 1 &&
               second->per_group == 1;
  for (uint32_t i = unit->group_size - 1; unit->even && i < 64; i += unit->group_size)
    unit->top |= (uint64_t)1 << i;
}

static bool create_fetch(struct trax_tm *tm) {
  const uint32_t tps = tm->config->icache.tps_per_cache, banks = tm->config->icache.banks;
  tm->icaches = (tm->tps + tps - 1) / tps;
  tm->icache = calloc(tm->icaches, sizeof *tm->icache);
  tm->simple_fetch = tps == 16 && banks <= 16 && tm->config->icache.ports_per_bank == 1;
  tm->fetch_arbiters = calloc((size_t)tm->icaches * banks, sizeof *tm->fetch_arbiters);
  tm->resident = calloc(tm->icaches, sizeof *tm->resident);
  for (unsigned i = 0; i < tm->tps; i++)
    tm->icache_of[i] = (uint8_t)(i / tps);
  bool complete = tm->icache && tm->fetch_arbiters && tm->resident;
  for (uint32_t i = 0; complete && i < tm->icaches; i++)
    complete = trax_icache_create(&tm->icache[i], tm);
  return complete;
}

static bool create_units(struct trax_tm *tm) {
  for (trax_shared which = 0; which < TRAX_SHARED_COUNT; which++) {
    struct trax_shared_unit *unit = &tm->unit[which];
    unit->kind = trax_shared_kind(which, tm->config);
    if (!trax_always_free(which, tm->config) &&
        !(unit->free_from = calloc((size_t)unit->kind.groups * unit->kind.per_group + 1, sizeof *unit->free_from)))
      return false;
  }
  prepare_units(&tm->fp, &tm->unit[TRAX_SHARED_FP_ADD].kind, &tm->unit[TRAX_SHARED_FP_MUL].kind);
  return true;
}

static trax_status create_tm(struct trax_tm *tm, uint32_t number, struct trax_chip *chip, FILE *output,
                             trax_error *error) {
  struct trax_machine *machine = chip->machine;
  const uint32_t tps = machine->config.chip.tps_per_tm;
  tm->number = number;
  tm->tps = tps;
  tm->wide = tps > 32;
  tm->config = &machine->config;
  tm->chip = chip;
  tm->machine = machine;
  tm->output = output;
  tm->observer = machine->observer;
  if (tm->observer && tm->observer->stretch) {
    if (!(tm->observed = create_aligned(1, sizeof *tm->observed)))
      return trax_fail(error, "out of memory");
    memset(tm->observed->outcomes, TRAX_FAST_NO_OUTCOME, sizeof tm->observed->outcomes);
  }
  tm->stats = &machine->tm_stats[number];
  tm->tp_stats = &machine->tp_stats[(size_t)number * tps];
  tm->exit_statuses = &machine->exit_statuses[(size_t)number * tps];
  if (machine->ray_cycles) {
    tm->ray_counts = &machine->ray_cycles->tms[number];
    tm->rays = &machine->ray_cycles->threads[(size_t)number * tps];
  }
  tm->tp = chip->tp + (size_t)number * tps;
  tm->count_deltas = calloc(chip->program.inst_count + 1, sizeof *tm->count_deltas);
  if (!tm->count_deltas || !trax_queue_create(&tm->queue, tm->config->memory.queue_depth) || !create_fetch(tm) ||
      !trax_dcache_create(&tm->dcache, tm) || !create_units(tm))
    return trax_fail(error, "out of memory");
  tm->serial_hits = tm->config->dcache.hit_latency_cycles > 1 || tm->dcache.tags.by_use;
  tm->awake = trax_group_mask(0, tps);
  tm->running = tps;
  tm->heads.steps = tm->tp->burst.step;
  for (unsigned i = 0; i < TRAX_MAX_TPS_PER_TM; i++) { /* TPs that do not exist have TP 0's steps: vectors read them */
    const unsigned row = i / 32 * 4 + i % 4, column = i % 32 / 4;
    tm->heads.lane[i] = (uint8_t)(8 * row + column);
    tm->heads.begin[row][column] = i < tps ? i * (uint32_t)(sizeof *tm->tp / sizeof(uint16_t)) : 0;
  }
  for (unsigned i = 0; i < tps; i++) {
    struct trax_tp *tp = &tm->tp[i];
    tp->pc = tp->resume_pc = trax_machine_entry_of(machine, number * tps + i);
    tp->inst = trax_text_at(chip->text, tp->pc);
    tp->resume = trax_fast_inst_at(&chip->program, tp->pc);
    trax_fast_advance(tm, i);
  }
  return TRAX_OK;
}

static void destroy_tm(struct trax_tm *tm) {
  for (uint32_t i = 0; tm->icache && i < tm->icaches; i++)
    trax_icache_destroy(&tm->icache[i]);
  for (trax_shared unit = 0; unit < TRAX_SHARED_COUNT; unit++)
    free(tm->unit[unit].free_from);
  trax_dcache_destroy(&tm->dcache);
  trax_queue_destroy(&tm->queue);
  free(tm->icache);
  free(tm->count_deltas);
  free(tm->fetch_arbiters);
  free(tm->resident);
  free(tm->observed);
}

/* Bursts are translated if a bank follows from bits of the address. With an observer of each issue they have one
   instruction. */
static void create_translation(struct trax_chip *chip, const struct trax_run *run) {
  const struct trax_config *const config = &chip->machine->config;
  const uint32_t banks = chip->tm->dcache.banks;
  const bool at_once = run->engine == &trax_fast_translated_engine;
  chip->facts = (struct trax_burst_facts){.step = chip->program.step,
                                          .line = chip->program.line,
                                          .blocks = chip->blocks.state,
                                          .load_step = TRAX_STEP_BANK,
                                          .bank_mask = (banks - 1) << TRAX_STEP_BANK_SHIFT,
                                          .slow_local = config->tp.local_latency_cycles > 1 ? TRAX_STEP_SLOW : 0,
                                          .slow_jump = config->tp.branch_bubble_cycles > 0 ? TRAX_STEP_SLOW : 0,
                                          .end_at_calls = chip->machine->observer != NULL};
  if (run->engine != &trax_fast_interpreted_engine && chip->burst > 1 && !(banks & (banks - 1)))
    chip->translation = trax_translation_create(chip->text, &chip->machine->space, config->special.precision_bits,
                                                chip->tms, at_once, &chip->facts);
  if (chip->translation && at_once)
    trax_translation_extend(chip->translation);
}

trax_status trax_chip_create(struct trax_run *run, const struct trax_fast_variant *variant, trax_error *error) {
  struct trax_machine *machine = run->machine;
  struct trax_chip *chip = run->chip = calloc(1, sizeof *chip);
  if (!chip)
    return trax_fail(error, "out of memory");
  chip->machine = machine;
  chip->text = &run->text;
  chip->variant = variant;
  chip->tms = machine->config.chip.tms;
  chip->burst = machine->observer && !machine->observer->stretch ? 1 : TRAX_BURST;
  machine->calls.before_write = trax_fast_range_written;
  machine->calls.engine = chip;
  if (trax_memory_create(&chip->memory, &machine->config, &machine->stats.memory, error) ||
      trax_fast_blocks_create(&chip->blocks, &machine->space, error) ||
      trax_fast_program_create(&chip->program, chip->text, &machine->config,
                               machine->observer && machine->observer->stretch, error))
    return TRAX_ERROR;
  chip->memory.increment = trax_fast_increment_outside;
  chip->memory.context = chip;
  chip->transfers.to = machine->transfers;
  if (machine->transfers)
    chip->memory.transfers = &chip->transfers;
  chip->tm = create_aligned(chip->tms, sizeof *chip->tm);
  chip->tp = create_aligned((size_t)chip->tms * machine->config.chip.tps_per_tm, sizeof *chip->tp);
  chip->is_large = (size_t)chip->tms * machine->config.chip.tps_per_tm * sizeof *chip->tp >= LARGE;
  if (!chip->tm || !chip->tp)
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < chip->tms; i++)
    if (create_tm(&chip->tm[i], i, chip, run->options->output, error))
      return TRAX_ERROR;
  if (trax_epochs_create(chip, run, error))
    return TRAX_ERROR;
  create_translation(chip, run);
  return TRAX_OK;
}

void trax_chip_destroy(void *context) {
  struct trax_chip *chip = context;
  if (!chip)
    return;
  chip->machine->calls.before_write = NULL;
  trax_epochs_destroy(chip->epochs);
  for (uint32_t i = 0; chip->tm && i < chip->tms; i++)
    destroy_tm(&chip->tm[i]);
  free(chip->tm);
  free(chip->tp);
  trax_translation_destroy(chip->translation);
  trax_memory_destroy(&chip->memory);
  trax_fast_blocks_destroy(&chip->blocks);
  trax_fast_program_destroy(&chip->program);
  trax_transfer_log_destroy(&chip->transfers);
  free(chip);
}
