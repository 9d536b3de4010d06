#include "fast/fast.h"

#include "fast/head.h"

static void create_unit(struct trax_fast_unit *unit, const struct trax_shared_unit *reference) {
  unit->groups = reference->groups;
  for (uint32_t i = 0; i < unit->groups; i++)
    unit->group[i] = trax_group_mask(i, reference->group_size);
}

static trax_status create_tm(struct trax_fast_tm *ftm, struct trax_fast *fast, struct trax_tm *tm, trax_error *error) {
  ftm->fast = fast;
  ftm->tm = tm;
  ftm->tp = calloc(tm->tps, sizeof *ftm->tp);
  if (!ftm->tp)
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < tm->icaches; i++)
    ftm->icache[i].tags = &tm->icache[i].tags;
  create_unit(&ftm->fp_add, &tm->fp_add);
  create_unit(&ftm->fp_mul, &tm->fp_mul);
  create_unit(&ftm->int_mul, &tm->int_mul);
  for (unsigned i = 0; i < tm->tps; i++) {
    ftm->icache_of[i] = (uint8_t)(i / tm->config->icache.tps_per_cache);
    ftm->slot[i].icache = &ftm->icache[ftm->icache_of[i]];
    ftm->tp[i].resume = trax_fast_inst_at(&fast->program, tm->tp[i].pc);
    ftm->tp[i].resume_pc = tm->tp[i].pc;
    ftm->slot[i].step = ftm->slot[i].last = &ftm->tp[i].only;
    trax_fast_advance(ftm, i);
    trax_fast_ask_fetch(ftm, i);
  }
  return TRAX_OK;
}

trax_status trax_fast_create(struct trax_chip *chip, trax_error *error) {
  struct trax_machine *machine = chip->machine;
  struct trax_fast *fast = chip->fast = calloc(1, sizeof *fast);
  if (!fast)
    return trax_fail(error, "out of memory");
  fast->chip = chip;
  fast->burst = machine->trace ? 1 : TRAX_BURST;
  fast->tm = calloc(chip->tms, sizeof *fast->tm);
  if (!fast->tm)
    return trax_fail(error, "out of memory");
  if (trax_fast_blocks_create(&fast->blocks, machine->space.size, error) ||
      trax_fast_program_create(&fast->program, &chip->text, &machine->config, error))
    return TRAX_ERROR;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (create_tm(&fast->tm[i], fast, &chip->tm[i], error))
      return TRAX_ERROR;
  return TRAX_OK;
}

void trax_fast_destroy(struct trax_fast *fast) {
  if (!fast)
    return;
  for (uint32_t i = 0; fast->tm && i < fast->chip->tms; i++)
    free(fast->tm[i].tp);
  free(fast->tm);
  trax_fast_blocks_destroy(&fast->blocks);
  trax_fast_program_destroy(&fast->program);
  free(fast);
}

void trax_fast_settle(struct trax_fast *fast) {
  for (uint32_t i = 0; i < fast->chip->tms; i++) {
    struct trax_fast_tm *ftm = &fast->tm[i];
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      for (unsigned bit = 0; bit < 64; bit++)
        for (uint64_t tps = ftm->tally[cause].planes[bit]; tps; tps &= tps - 1)
          ftm->tm->tp_stats[trax_first(tps)].cycles[cause] += (uint64_t)1 << bit;
  }
}
