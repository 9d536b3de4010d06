#include "fast/fast.h"

#include "fast/head.h"
#include "fast/variant.h"

#include <stdlib.h>
#include <string.h>

static void create_units(struct trax_fast_units *unit, const struct trax_shared_unit *first,
                         const struct trax_shared_unit *second) {
  const struct trax_shared_kind *const kinds[2] = {&first->kind, &second->kind};
  unit->group_size = first->kind.group_size;
  unit->even = 64 % unit->group_size == 0 && kinds[1]->group_size == unit->group_size && kinds[0]->per_group == 1 &&
               kinds[1]->per_group == 1;
  for (unsigned kind = 0; kind < 2; kind++) {
    unit->uneven[kind].groups = kinds[kind]->groups;
    unit->uneven[kind].per_group = kinds[kind]->per_group;
    for (uint32_t i = 0; i < kinds[kind]->groups; i++)
      unit->uneven[kind].group[i] = trax_group_mask(i, kinds[kind]->group_size);
  }
  for (uint32_t i = unit->group_size - 1; unit->even && i < 64; i += unit->group_size)
    unit->top |= (uint64_t)1 << i;
  unit->below_top = ~unit->top;
}

static void *create_aligned(size_t count, size_t size) {
  void *array = aligned_alloc(64, (count * size + 63) / 64 * 64);
  return array ? memset(array, 0, count * size) : NULL;
}

static bool create_fetch(struct trax_fast_tm *ftm, const struct trax_tm *tm) {
  const uint32_t tps = tm->config->icache.tps_per_cache, banks = tm->config->icache.banks;
  ftm->simple_fetch = tps == 16 && banks <= 16 && tm->config->icache.ports_per_bank == 1;
  ftm->vectors = (banks + TRAX_FAST_LANES - 1) / TRAX_FAST_LANES;
  ftm->fetch_rr_masks = create_aligned((size_t)tm->icaches * ftm->vectors, sizeof *ftm->fetch_rr_masks);
  ftm->resident = calloc(tm->icaches, sizeof *ftm->resident);
  ftm->resident_lines = calloc(tm->icaches, sizeof *ftm->resident_lines);
  for (unsigned i = 0; i < tm->tps; i++)
    ftm->icache_of[i] = (uint8_t)(i / tps);
  return ftm->fetch_rr_masks && ftm->resident && ftm->resident_lines;
}

static trax_status create_tm(struct trax_fast_tm *ftm, struct trax_fast *fast, struct trax_tm *tm, trax_error *error) {
  ftm->fast = fast;
  ftm->tm = tm;
  ftm->wide = tm->tps > 32;
  ftm->tp = create_aligned(tm->tps, sizeof *ftm->tp);
  ftm->count_deltas = calloc(fast->program.inst_count + 1, sizeof *ftm->count_deltas);
  if (!create_fetch(ftm, tm) || !ftm->tp || !ftm->count_deltas)
    return trax_fail(error, "out of memory");
  ftm->data_banks = tm->dcache.banks;
  while (1u << ftm->data_bank_bits < ftm->data_banks)
    ftm->data_bank_bits++;
  create_units(&ftm->fp, &tm->unit[TRAX_SHARED_FP_ADD], &tm->unit[TRAX_SHARED_FP_MUL]);
  create_units(&ftm->int_mul, &tm->unit[TRAX_SHARED_INT_MUL], &tm->unit[TRAX_SHARED_INT_MUL]);
  ftm->serial_hits = tm->config->dcache.hit_latency_cycles > 1 || tm->dcache.tags.by_use;
  ftm->heads.steps = ftm->tp->step;
  for (unsigned i = 0; i < TRAX_MAX_TPS_PER_TM; i++) { /* TPs that do not exist have TP 0's steps: vectors read them */
    trax_fast_begin_heads(&ftm->heads, i, i < tm->tps ? i * (uint32_t)(sizeof *ftm->tp / sizeof(uint16_t)) : 0);
    ftm->address_of[i] = ftm->tp[i < tm->tps ? i : 0].address;
  }
  for (unsigned i = 0; i < tm->tps; i++) {
    ftm->tp[i].resume = trax_fast_inst_at(&fast->program, tm->tp[i].pc);
    ftm->tp[i].resume_pc = tm->tp[i].pc;
    trax_fast_advance(ftm, i);
  }
  return TRAX_OK;
}

trax_status trax_fast_create(struct trax_chip *chip, trax_error *error) {
  struct trax_machine *machine = chip->machine;
  struct trax_fast *fast = chip->fast = calloc(1, sizeof *fast);
  if (!fast)
    return trax_fail(error, "out of memory");
  fast->chip = chip;
  machine->calls.before_write = trax_fast_range_written;
  machine->calls.engine = fast;
  chip->memory.before_increment = trax_fast_increment_outside;
  chip->memory.context = fast;
  fast->burst = machine->observer ? 1 : TRAX_BURST;
  const size_t bytes = chip->tms * sizeof *fast->tm; /* a multiple of the alignment, as aligned_alloc requires */
  fast->tm = aligned_alloc(_Alignof(struct trax_fast_tm), bytes);
  if (!fast->tm)
    return trax_fail(error, "out of memory");
  memset(fast->tm, 0, bytes);
  if (trax_fast_blocks_create(&fast->blocks, &machine->space, error) ||
      trax_fast_program_create(&fast->program, chip->text, &machine->config, error))
    return TRAX_ERROR;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (create_tm(&fast->tm[i], fast, &chip->tm[i], error))
      return TRAX_ERROR;
  return TRAX_OK;
}

void trax_fast_destroy(struct trax_fast *fast) {
  if (!fast)
    return;
  fast->chip->machine->calls.before_write = NULL;
  for (uint32_t i = 0; fast->tm && i < fast->chip->tms; i++) {
    free(fast->tm[i].tp);
    free(fast->tm[i].count_deltas);
    free(fast->tm[i].fetch_rr_masks);
    free(fast->tm[i].resident);
    free(fast->tm[i].resident_lines);
  }
  free(fast->tm);
  trax_fast_blocks_destroy(&fast->blocks);
  trax_fast_program_destroy(&fast->program);
  free(fast);
}

void trax_fast_collect(struct trax_fast *fast) {
  for (uint32_t i = 0; i < fast->chip->tms; i++) {
    struct trax_fast_tm *ftm = &fast->tm[i];
    int64_t count = 0;
    for (size_t index = 0; index < fast->program.inst_count; index++) {
      count += ftm->count_deltas[index];
      ftm->tm->stats->instructions[fast->program.timing[index].decoded->op] += (uint64_t)count;
      ftm->count_deltas[index] = 0;
    }
    ftm->count_deltas[fast->program.inst_count] = 0;
  }
}

/* Counts the accesses to local memory: all loads and stores that were neither past nor through the data cache. */
static void count_local(struct trax_tm_stats *stats) {
  uint64_t loads = 0, stores = 0;
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++) {
    const unsigned flags = trax_op_table[op].flags;
    loads += (flags & (TRAX_IS_LOAD | TRAX_IS_ATOMIC)) == TRAX_IS_LOAD ? stats->instructions[op] : 0;
    stores += flags & TRAX_IS_STORE ? stats->instructions[op] : 0;
  }
  stats->local_loads =
      loads - stats->dcache_hits - stats->dcache_merged - stats->dcache_misses - stats->nontemporal_loads;
  stats->local_stores = stores - stats->store_hits - stats->store_misses - stats->nontemporal_stores;
}

/* The causes of refusals, in the order of struct trax_fast_refused and of the counters. */
static const trax_cause refusal_causes[TRAX_FAST_REFUSALS] = {
#define CAUSE(MEMBER, CAUSE) TRAX_CAUSE_##CAUSE,
    TRAX_FAST_REFUSED(CAUSE)
#undef CAUSE
};

static void charge_refusals(struct trax_fast_tm *ftm) {
  ftm->fast->chip->variant->count_log(&ftm->refusal_counts);
  for (unsigned bit = 0; bit < 64; bit++)
    for (unsigned refused = 0; refused < TRAX_FAST_REFUSALS; refused++)
      for (uint64_t tps = ftm->refusal_counts.planes[bit][refused]; tps; tps &= tps - 1)
        ftm->tm->tp_stats[trax_first(tps)].cycles[refusal_causes[refused]] += (uint64_t)1 << bit;
  memset(&ftm->refusal_counts, 0, sizeof ftm->refusal_counts);
}

void trax_fast_notify_refusals(const struct trax_fast_tm *ftm, const struct trax_fast_refused *refused) {
  const uint64_t losers[] = {
#define LOSERS(MEMBER, CAUSE) refused->MEMBER,
      TRAX_FAST_REFUSED(LOSERS)
#undef LOSERS
  };
  for (unsigned i = 0; i < TRAX_FAST_REFUSALS; i++)
    for (uint64_t rest = losers[i]; rest; rest &= rest - 1)
      trax_tm_notify_charge(ftm->tm, trax_first(rest), refusal_causes[i], ftm->tm->now, 1);
}

/* Returns how many steps of the current burst have been issued. */
static unsigned issued_of_burst(const struct trax_fast_tm *ftm, unsigned tp) {
  return (ftm->executes_at_issue | ftm->tm->ended) >> tp & 1 ? 0 : ftm->heads.at[tp];
}

/* Counts the issued part of a burst, and takes it off what the burst's end will count. */
static void count_burst(struct trax_fast_tm *ftm, unsigned tp) {
  struct trax_fast_tp *ftp = &ftm->tp[tp];
  const unsigned issued = issued_of_burst(ftm, tp);
  uint64_t jumps = 0;
  for (unsigned i = 0; i < issued; i++)
    jumps += trax_fast_index(ftp, i + 1) != trax_fast_index(ftp, i) + 1;
  ftm->tm->tp_stats[tp].cycles[TRAX_CAUSE_ISSUED] += ftp->issued + issued;
  ftm->tm->stats->taken_branches += ftp->jumps + jumps;
  ftp->issued = -(uint64_t)issued;
  ftp->jumps = -jumps;
}

/* Adds (sign 1) or removes (sign -1) the executed instructions that have not been issued. */
static void count_unissued(struct trax_fast_tm *ftm, int64_t sign) {
  for (unsigned tp = 0; tp < ftm->tm->tps; tp++)
    if (!((ftm->executes_at_issue | ftm->tm->ended) >> tp & 1))
      for (unsigned i = ftm->heads.at[tp]; i <= ftm->heads.last[tp]; i++) {
        const uint32_t index = trax_fast_index(&ftm->tp[tp], i);
        ftm->count_deltas[index] += sign;
        ftm->count_deltas[index + 1] -= sign;
      }
}

/* Reports how often the run left the fast path. */
static void report_fast_path(const struct trax_fast *fast) {
  struct trax_fast_path *path = &fast->chip->machine->fast_path;
  const struct trax_fast_tm *first = &fast->tm[0]; /* all TMs are configured alike */
  path->known = true;
  path->text_lines = fast->program.lines;
  path->observed = fast->burst == 1;
  path->general_fetch = !first->simple_fetch;
  path->uneven_units = !first->fp.even;
  path->many_data_banks = first->data_banks > 2 * TRAX_FAST_LANES;
  path->serial_hits = first->serial_hits;
  path->looked_up = path->single_hits = path->at_issue = 0;
  for (uint32_t i = 0; i < fast->chip->tms; i++) {
    path->looked_up += fast->tm[i].looked_up;
    path->single_hits += fast->tm[i].single_hits;
    path->at_issue += fast->tm[i].at_issue;
  }
}

void trax_fast_settle(struct trax_fast *fast) {
  for (uint32_t i = 0; i < fast->chip->tms; i++) {
    struct trax_fast_tm *ftm = &fast->tm[i];
    for (unsigned tp = 0; tp < ftm->tm->tps; tp++)
      count_burst(ftm, tp);
    charge_refusals(ftm);
    count_unissued(ftm, -1);
  }
  trax_fast_collect(fast);
  report_fast_path(fast);
  for (uint32_t i = 0; i < fast->chip->tms; i++) {
    count_local(fast->tm[i].tm->stats);
    count_unissued(&fast->tm[i], 1);
  }
}
