/* Export and import of the engine's state (docs/fast-engine.md): between cycles, watches and checkpoints find no
   bursts, and arbiters as pointers. While it simulates, the engine has masks instead, and data that follow from the
   rest. */
#include "fast/time/head.h"
#include "fast/time/variant.h"

#include <string.h>

/* --- arbiters: a pointer, and the round-robin mask of the bits from the pointer on (masks.h) --- */

static trax_arbiter pointer_of(uint64_t rr_mask) {
  return (trax_arbiter)(rr_mask ? trax_first(rr_mask) : 0);
}

static uint64_t rr_mask_of(trax_arbiter pointer) {
  return pointer ? ~(uint64_t)0 << pointer : 0;
}

static uint64_t get_fetch_rr_mask(struct trax_tm *tm, uint32_t icache, uint32_t bank) {
  if (tm->simple_fetch)
    return (uint64_t)*trax_fast_fetch_rr_mask(&tm->fetch_rr_masks16, tm->wide, icache, bank) << 16 * icache;
  return ((const uint64_t *)(tm->fetch_rr_masks + icache * tm->vectors))[bank];
}

void trax_fast_set_fetch_rr_mask(struct trax_tm *tm, uint32_t icache, uint32_t bank, uint64_t rr_mask) {
  if (tm->simple_fetch)
    *trax_fast_fetch_rr_mask(&tm->fetch_rr_masks16, tm->wide, icache, bank) = (uint16_t)(rr_mask >> 16 * icache);
  else
    ((uint64_t *)(tm->fetch_rr_masks + icache * tm->vectors))[bank] = rr_mask;
}

static void export_units(const struct trax_fast_units *units, unsigned kind, struct trax_shared_unit *unit) {
  for (uint32_t i = 0; i < units->uneven[kind].groups; i++)
    unit->arbiter[i] = pointer_of(units->rr_masks[kind] & units->uneven[kind].group[i]);
}

static void import_units(struct trax_fast_units *units, unsigned kind, const struct trax_shared_unit *unit) {
  uint64_t rr_mask = 0;
  for (uint32_t i = 0; i < units->uneven[kind].groups; i++)
    if (unit->arbiter[i])
      rr_mask |= units->uneven[kind].group[i] & ~(uint64_t)0 << unit->arbiter[i];
  units->rr_masks[kind] = rr_mask;
}

static void export_arbiters(struct trax_tm *tm) {
  export_units(&tm->fp, 0, &tm->unit[TRAX_SHARED_FP_ADD]);
  export_units(&tm->fp, 1, &tm->unit[TRAX_SHARED_FP_MUL]);
  export_units(&tm->int_mul, 0, &tm->unit[TRAX_SHARED_INT_MUL]);
  for (uint32_t i = 0; i < tm->icaches; i++)
    for (uint32_t bank = 0; bank < tm->config->icache.banks; bank++)
      tm->icache[i].bank[bank] = pointer_of(get_fetch_rr_mask(tm, i, bank));
  for (uint32_t bank = 0; bank < tm->data_banks; bank++)
    tm->dcache.bank[bank] = pointer_of(((const uint64_t *)tm->data_bank_rr_masks)[bank]);
}

static void import_arbiters(struct trax_tm *tm) {
  import_units(&tm->fp, 0, &tm->unit[TRAX_SHARED_FP_ADD]);
  import_units(&tm->fp, 1, &tm->unit[TRAX_SHARED_FP_MUL]);
  import_units(&tm->int_mul, 0, &tm->unit[TRAX_SHARED_INT_MUL]);
  for (uint32_t i = 0; i < tm->icaches; i++)
    for (uint32_t bank = 0; bank < tm->config->icache.banks; bank++)
      trax_fast_set_fetch_rr_mask(tm, i, bank, rr_mask_of(tm->icache[i].bank[bank]));
  for (uint32_t bank = 0; bank < tm->data_banks; bank++)
    ((uint64_t *)tm->data_bank_rr_masks)[bank] = rr_mask_of(tm->dcache.bank[bank]);
}

void trax_fast_export(struct trax_chip *chip) {
  trax_fast_roll_back(chip);
  for (uint32_t i = 0; i < chip->tms; i++)
    export_arbiters(&chip->tm[i]);
}

/* --- import --- */

static void find_resident_lines(struct trax_tm *tm) {
  const struct trax_fast_program *program = &tm->chip->program;
  memset(tm->resident, 0, tm->icaches * sizeof *tm->resident);
  for (uint32_t i = 0; i < tm->icaches; i++) {
    const struct trax_cache_tags *tags = &tm->icache[i].tags;
    for (size_t j = 0; j < program->count; j++) {
      const struct trax_fast_section *section = &program->sections[j];
      const uint32_t last_line = (section->begin + section->bytes) >> tags->line_shift;
      for (uint32_t line = section->first_line, index = section->line; line <= last_line && index < TRAX_FAST_LINES - 1;
           line++, index++)
        trax_fast_set_resident(tm, i, index, trax_cache_tags_have(tags, line));
    }
  }
}

/* Finds the registers that wait for atomic increments. The increments' words count as written, so that no burst loads
   them before they are incremented. */
static void find_atomics(struct trax_tm *tm) {
  const struct trax_queue *queue = &tm->queue;
  for (uint32_t i = 0; i < queue->depth; i++) {
    const struct trax_request *request = &queue->requests[i];
    if (trax_queue_is_taken(queue, i) && request->kind == TRAX_REQUEST_ATOMIC) {
      tm->tp[request->tp].atomics |= (uint64_t)1 << request->rd;
      trax_fast_set_written(&tm->chip->blocks, request->address, TRAX_BLOCK_SHARED);
    }
  }
}

static void import_tp(struct trax_tm *tm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tp *tp = &tm->tp[number];
  tp->resume = trax_fast_inst_at(&tm->chip->program, tp->pc);
  tp->resume_pc = tp->pc;
  tm->heads.at[number] = tm->heads.last[number] = 0;
  tm->busy_registers[number] = 0;
  tm->busy &= ~bit;
  for (unsigned rd = 0; rd < TRAX_NUM_REGISTERS; rd++)
    if (tp->usable[rd] > t)
      trax_fast_set_busy(tm, number, rd);
  trax_fast_advance(tm, number);
}

void trax_fast_import(struct trax_chip *chip, uint64_t t) {
  chip->alone = false;
  for (uint32_t i = 0; i < chip->tms; i++) {
    for (unsigned tp = 0; tp < chip->tm[i].tps; tp++)
      chip->tm[i].tp[tp].atomics = 0;
    find_atomics(&chip->tm[i]);
  }
  for (uint32_t i = 0; i < chip->tms; i++) {
    struct trax_tm *tm = &chip->tm[i];
    import_arbiters(tm);
    find_resident_lines(tm);
    tm->ready = tm->no_text = 0;
    tm->executes_at_issue = tm->ended; /* ended threads have no bursts */
    tm->recheck = tm->awake & tm->holding;
    for (unsigned tp = 0; tp < tm->tps; tp++)
      if (!(tm->ended >> tp & 1))
        import_tp(tm, tp, t);
  }
}
