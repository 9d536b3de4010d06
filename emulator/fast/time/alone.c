/* Cycles in which one TP of a TM is awake. Nobody else wants what it needs, so it issues a step in each cycle, as long
   as the steps are quick, their operands usable, and their loads hit. A single thread spends most of its time so. */
#include "fast/time/head.h"

/* The kinds of units, and the banks, that the TP has used: their round robins go on behind it. */
struct used {
  uint64_t fetch_banks, data_banks;
  unsigned kinds; /* bits TRAX_STEP_KIND >> 1 */
};

static void pass_unit(struct trax_tm *tm, trax_shared which, unsigned number) {
  struct trax_shared_unit *unit = &tm->unit[which];
  const unsigned group = number / unit->kind.group_size;
  if (which < TRAX_SHARED_INT_MUL && tm->fp.even) {
    const uint64_t mask = trax_group_mask(group, tm->fp.group_size);
    tm->fp.rr_masks[which] = (tm->fp.rr_masks[which] & ~mask) | (mask & (~(uint64_t)1 << number));
  } else {
    trax_arbiter_to_back(&unit->arbiter[group], number);
  }
}

static void set_fetch_rr_mask(struct trax_tm *tm, uint32_t icache, uint32_t bank, uint64_t rr_mask) {
  if (tm->simple_fetch)
    *trax_fast_fetch_rr_mask(&tm->fetch_rr_masks16, tm->wide, icache, bank) = (uint16_t)(rr_mask >> 16 * icache);
  else
    ((uint64_t *)(tm->fetch_rr_masks + icache * tm->vectors))[bank] = rr_mask;
}

static void pass_arbiters(struct trax_tm *tm, unsigned number, const struct used *used) {
  const uint64_t behind = ~(uint64_t)1 << number;
  for (uint64_t rest = used->fetch_banks; rest; rest &= rest - 1)
    set_fetch_rr_mask(tm, tm->icache_of[number], trax_first(rest), behind);
  for (uint64_t rest = used->data_banks; rest; rest &= rest - 1)
    ((uint64_t *)tm->data_bank_rr_masks)[trax_first(rest)] = behind;
  for (trax_shared unit = TRAX_SHARED_FP_ADD; unit <= TRAX_SHARED_INT_MUL; unit++)
    if (used->kinds >> ((TRAX_STEP_FP_ADD >> 1) + unit) & 1)
      pass_unit(tm, unit, number);
}

/* Serves a slow step if it is a store of the burst that needs no place in the memory queue. */
static bool store(struct trax_tm *tm, unsigned number, unsigned at, unsigned load, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_fast_timing *timing = &tm->chip->program.timing[trax_fast_index(tp, at)];
  if (!timing->decoded->is_store || !tm->config->memory.write_combining ||
      (tp->run_begin != tp->run_end && !trax_tp_combines(tp, tp->burst.loads[load], timing->decoded->bytes)))
    return false;
  tp->inst = timing->decoded;
  tp->pc = timing->pc;
  tp->address = tp->burst.loads[load];
  if (trax_burst_stores(&tp->burst, load) && !trax_fast_store(tm, number, load, timing->decoded->bytes, t))
    return false;
  trax_tm_serve(tm, number, t);
  return true;
}

/* Whether the line of step `at` is resident and its operands are usable. `line`: the one that was found latest. */
static bool is_ready(struct trax_tm *tm, unsigned number, unsigned at, uint32_t *line, uint64_t t) {
  const struct trax_tp *tp = &tm->tp[number];
  const struct trax_fast_timing *timing = &tm->chip->program.timing[trax_fast_index(tp, at)];
  if (tm->uncertain >> number & 1) {
    const struct trax_cache_tags *tags = &tm->icache[tm->icache_of[number]].tags;
    const uint32_t own = trax_line_of(tags, timing->pc);
    if (own != *line && !trax_cache_tags_have(tags, own))
      return false;
    *line = own;
  }
  for (uint32_t rest = timing->waits & tm->busy_registers[number]; rest; rest &= rest - 1)
    if (tp->usable[trax_first(rest)] > t)
      return false;
  tm->busy_registers[number] &= ~timing->waits;
  return true;
}

bool trax_fast_run_alone(struct trax_tm *tm, uint64_t t, uint64_t end) {
  const uint64_t begin = t;
  const unsigned number = trax_first(tm->awake);
  struct trax_tp *tp = &tm->tp[number];
  if (((tm->holding | tm->executes_at_issue) >> number & 1) || tm->recheck || tm->serial_hits || tm->observer ||
      tm->dcache.all_fills_end > t || tm->ended >> number & 1)
    return false;
  end = trax_tm_quiet_until(tm, t, end);
  const unsigned last = tm->heads.last[number];
  const bool checks = (tm->busy | tm->uncertain) >> number & 1;
  unsigned at = tm->heads.at[number], load = tm->heads.load[number];
  uint32_t line = UINT32_MAX; /* none */
  const struct trax_cache_tags *const tags = &tm->dcache.tags;
  uint64_t hits = 0;
  struct used used = {0};
  for (; t < end && at < last; t++, at++) {
    const unsigned step = tp->burst.step[at], kind = step & TRAX_STEP_KIND;
    if (checks && !is_ready(tm, number, at, &line, t))
      break;
    if (kind == TRAX_STEP_BANK) {
      if (step & TRAX_STEP_SLOW ? !store(tm, number, at, load, t)
                                : !trax_cache_tags_have(tags, trax_line_of(tags, tp->burst.loads[load])))
        break;
      hits += !(step & TRAX_STEP_SLOW);
      load++;
      used.data_banks |= (uint64_t)1 << (step >> TRAX_STEP_BANK_SHIFT & 63);
    } else if ((step & TRAX_STEP_SLOW) || kind > TRAX_STEP_INT_MUL) {
      break;
    }
    used.kinds |= 1u << (kind >> 1);
    used.fetch_banks |= (uint64_t)1 << (step >> TRAX_STEP_FETCH_SHIFT);
  }
  tm->busy &= ~((uint64_t)!tm->busy_registers[number] << number);
  if (t == begin)
    return false;
  tm->heads.check_at[number] = (uint8_t)at; /* if it is still busy or uncertain */
  tm->stats->icache_hits += t - begin;
  tm->stats->dcache_hits += hits;
  pass_arbiters(tm, number, &used);
  trax_fast_set_load(tm, number, load);
  trax_fast_set_head(&tm->heads, number, at);
  tm->now = t - 1;
  tm->next_cycle = t;
  return true;
}
