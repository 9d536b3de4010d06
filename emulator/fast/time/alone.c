/* Cycles in which one TP of a TM is awake. Nobody else wants what it needs, so it issues a step in each cycle, as long
   as the steps are quick or stores, their operands usable, and their loads hit, until it makes a request. A single
   thread spends most of its time so. */
#include "fast/time/head.h"

/* The kinds of units, and the banks, that the TP has used: their round robins go on behind it. */
struct used {
  uint64_t fetch_banks, data_banks;
  unsigned kinds; /* bits TRAX_STEP_KIND */
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

static void pass_fetch_bank(struct trax_tm *tm, unsigned number, unsigned bank) {
  const uint32_t icache = tm->icache_of[number];
  if (tm->simple_fetch)
    tm->fetch_rr_masks16[bank << (1 + tm->wide) | icache] = (uint16_t)(~(uint64_t)1 << number % 16);
  else
    trax_arbiter_to_back(&tm->fetch_arbiters[icache * tm->config->icache.banks + bank], number);
}

static void pass_arbiters(struct trax_tm *tm, unsigned number, const struct used *used) {
  for (uint64_t rest = used->fetch_banks; rest; rest &= rest - 1)
    pass_fetch_bank(tm, number, trax_first(rest));
  for (uint64_t rest = used->data_banks; rest; rest &= rest - 1)
    tm->data_bank_rr_masks[trax_first(rest)] = ~(uint64_t)1 << number;
  for (trax_shared unit = TRAX_SHARED_FP_ADD; unit <= TRAX_SHARED_INT_MUL; unit++)
    if (used->kinds >> (TRAX_STEP_FP_ADD + 2 * unit) & 1)
      pass_unit(tm, unit, number);
}

/* Serves a slow step if it is a store, unless it needs a place in the memory queue and gets none. */
static bool store(struct trax_tm *tm, unsigned number, unsigned at, unsigned load, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_fast_timing *timing = &tm->chip->program.timing[trax_fast_index(tp, at)];
  if (!timing->decoded->is_store || !trax_queue_has_place(&tm->queue) ||
      (trax_tp_stores(tp, load) && !trax_fast_store(tm, number, load, timing->decoded->bytes, t)))
    return false;
  tp->inst = timing->decoded;
  tp->pc = timing->pc;
  tp->address = tp->burst.access[load].address;
  tm->now = t; /* of a request */
  trax_tm_serve(tm, number, t);
  return true;
}

/* Whether step `at`, which is not the first one, is not the instruction behind the step before. */
static inline bool is_behind_jump(const struct trax_burst *burst, unsigned at) {
  return (uint16_t)(burst->index[at] - burst->index[at - 1]) != 1;
}

/* Whether the operands of step `at` are usable. */
static bool has_operands(struct trax_tm *tm, unsigned number, uint32_t waits, uint64_t t) {
  for (uint32_t rest = waits & tm->busy_registers[number]; rest; rest &= rest - 1)
    if (tm->tp[number].usable[trax_first(rest)] > t)
      return false;
  tm->busy_registers[number] &= ~waits;
  return true;
}

/* Issues quick steps that need no bank of the data cache, at most so many. Returns how many there are. */
static unsigned issue_quick(const uint16_t *steps, unsigned most, struct used *used) {
  uint64_t fetch_banks = 0;
  unsigned kinds = 0, count = 0;
  for (; count < most; count++) {
    const unsigned step = steps[count], kind = step & TRAX_STEP_KIND;
    if ((step & TRAX_STEP_SLOW) || kind > TRAX_STEP_INT_MUL)
      break;
    kinds |= 1u << kind;
    fetch_banks |= (uint64_t)1 << (step >> TRAX_STEP_FETCH_SHIFT);
  }
  used->kinds |= kinds;
  used->fetch_banks |= fetch_banks;
  return count;
}

bool trax_fast_run_alone(struct trax_tm *tm, uint64_t t, uint64_t end) {
  const uint64_t begin = t, requests = tm->stats->memory_requests;
  const unsigned number = trax_first(tm->awake), first = tm->heads.at[number], last = tm->heads.last[number];
  struct trax_tp *tp = &tm->tp[number];
  if (((tm->holding | tm->executes_at_issue) >> number & 1) || tm->recheck || tm->serial_hits || tm->observer ||
      tm->dcache.all_fills_end > t || tm->ended >> number & 1)
    return false;
  end = trax_tm_quiet_until(tm, t, end);
  const bool busy = tm->busy >> number & 1, uncertain = tm->uncertain >> number & 1;
  const struct trax_cache_tags *const tags = &tm->dcache.tags;
  struct trax_icache *const icache = &tm->icache[tm->icache_of[number]];
  const uint32_t line_bytes = tm->config->icache.line_bytes;
  unsigned at = first, load = tm->heads.load[number], next_line = first;
  uint64_t hits = 0;
  struct used used = {0};
  while (t < end && at < last && tm->stats->memory_requests == requests) {
    const unsigned step = tp->burst.step[at];
    const bool enters_line = uncertain && (at == next_line || is_behind_jump(&tp->burst, at));
    if (busy || enters_line) {
      const struct trax_fast_timing *timing = &tm->chip->program.timing[trax_fast_index(tp, at)];
      if (enters_line && !trax_cache_tags_have(&icache->tags, trax_line_of(&icache->tags, timing->pc))) {
        used.fetch_banks |= (uint64_t)1 << (step >> TRAX_STEP_FETCH_SHIFT);
        tp->pc = timing->pc;
        tm->now = t;
        trax_icache_miss(icache, tm, number, t++);
        break;
      }
      if (enters_line)
        next_line = at + (line_bytes - timing->pc % line_bytes) / 4;
      if (busy && !has_operands(tm, number, timing->waits, t))
        break;
    }
    unsigned issued = 1;
    if ((step & TRAX_STEP_KIND) == TRAX_STEP_BANK) {
      if (step & TRAX_STEP_SLOW ? !store(tm, number, at, load, t)
                                : !trax_cache_tags_have(tags, trax_line_of(tags, tp->burst.access[load].address)))
        break;
      hits += !(step & TRAX_STEP_SLOW);
      load++;
      used.data_banks |= (uint64_t)1 << (step >> TRAX_STEP_BANK_SHIFT & 63);
      used.fetch_banks |= (uint64_t)1 << (step >> TRAX_STEP_FETCH_SHIFT);
    } else {
      const unsigned most = end - t < last - at ? (unsigned)(end - t) : last - at;
      issued = issue_quick(&tp->burst.step[at], busy || uncertain ? 1 : most, &used);
      if (!issued)
        break;
    }
    t += issued;
    at += issued;
  }
  tm->busy &= ~((uint64_t)!tm->busy_registers[number] << number);
  if (t == begin)
    return false;
  tm->stats->icache_hits += at - first;
  tm->stats->dcache_hits += hits;
  pass_arbiters(tm, number, &used);
  trax_fast_set_load(tm, number, load);
  trax_fast_set_head(&tm->heads, number, at);
  tm->now = t - 1;
  tm->next_cycle = t;
  return true;
}
