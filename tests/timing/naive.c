#include "naive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UNKNOWN UINT64_MAX
enum { MAX = 64 };

typedef enum kind { INSTRUCTION_LINE, DATA_LINE, WORD, WRITE } kind;

struct request {
  kind kind;
  uint32_t line; /* lines */
  int icache;
  int tp; /* WORD: whose */
  unsigned rd;
  uint32_t bytes;
  bool started, arrived;
  uint64_t completion;
};

struct tp {
  struct naive_thread *thread;
  size_t next; /* step */
  bool holds, waits_for_line, ended;
  uint64_t idle_until; /* the bubble */
  uint64_t usable[32];
  trax_cause cause[32];
  bool on_line[32]; /* the register waits for data line line_of[] */
  uint32_t line_of[32];
  uint32_t run_begin, run_end;
  bool granted;    /* in this cycle */
  bool asks_queue; /* in this cycle */
  bool charged;    /* in this cycle */
};

struct cache {
  uint32_t ways, sets, line_bytes;
  uint64_t *line; /* [sets][ways]: + 1 */
  uint32_t *pointer;
};

struct tm {
  struct tp tp[MAX];
  struct cache icache[MAX], dcache;
  int bank_pointer[MAX][MAX]; /* [icache][bank] */
  int add_pointer[MAX], mul_pointer[MAX], int_mul_pointer[MAX], special_pointer, dbank_pointer[MAX], queue_pointer;
  uint64_t special_free[MAX];
  struct request *requests; /* all ever made, oldest first */
  size_t made, room;
};

struct model {
  const struct trax_config *config;
  int tps;
  struct tm *tm;
  uint64_t numerator, denominator, bus_free; /* bus time in 1/numerator cycles */
  int bus_pointer;
  uint64_t bytes;
};

static void charge(struct tp *tp, trax_cause cause) {
  tp->thread->charged[cause]++;
  tp->charged = true;
}

static trax_inst current(const struct tp *tp) {
  return trax_decode(tp->thread->steps[tp->next].word);
}
static unsigned flags_of(const struct tp *tp) {
  return trax_op_table[current(tp).op].flags;
}
static uint32_t address_of(const struct tp *tp) {
  return tp->thread->steps[tp->next].address;
}

static bool ends_thread(const struct tp *tp) {
  const trax_inst inst = current(tp);
  return inst.op == TRAX_OP_HALT || (inst.op == TRAX_OP_TRAP && inst.imm == TRAX_TRAP_EXIT);
}

/* "Round robin": the winner among first .. first + n - 1, or -1; the pointer counts from first. */
static int pick(const bool *asks, int first, int n, int *pointer) {
  for (int i = 0; i < n; i++) {
    const int position = (*pointer + i) % n;
    if (asks[first + position]) {
      *pointer = (position + 1) % n;
      return first + position;
    }
  }
  return -1;
}

/* --- caches --- */

static void cache_create(struct cache *cache, uint32_t bytes, uint32_t line_bytes, uint32_t ways) {
  *cache = (struct cache){.ways = ways, .sets = bytes / (line_bytes * ways), .line_bytes = line_bytes};
  cache->line = calloc((size_t)cache->sets * ways, sizeof *cache->line);
  cache->pointer = calloc(cache->sets, sizeof *cache->pointer);
}

static bool cache_has(const struct cache *cache, uint32_t line) {
  for (uint32_t way = 0; way < cache->ways; way++)
    if (cache->line[(line % cache->sets) * cache->ways + way] == (uint64_t)line + 1)
      return true;
  return false;
}

static void cache_take(struct cache *cache, uint32_t line) {
  const uint32_t set = line % cache->sets;
  cache->line[set * cache->ways + cache->pointer[set]] = (uint64_t)line + 1;
  cache->pointer[set] = (cache->pointer[set] + 1) % cache->ways;
}

/* --- memory queue and controller --- */

static uint32_t places_taken(const struct tm *tm) {
  uint32_t taken = 0;
  for (size_t i = tm->made; i > 0 && !tm->requests[i - 1].arrived; i--)
    taken++;
  return taken;
}

static bool request(struct model *model, struct tm *tm, struct request wanted) {
  if (places_taken(tm) >= model->config->memory.queue_depth)
    return false;
  if (wanted.bytes < model->config->memory.min_transfer_bytes)
    wanted.bytes = model->config->memory.min_transfer_bytes;
  if (tm->made == tm->room)
    tm->requests = realloc(tm->requests, (tm->room = 2 * tm->room + 64) * sizeof *tm->requests);
  tm->requests[tm->made++] = wanted;
  model->bytes += wanted.bytes;
  return true;
}

static bool on_its_way(const struct tm *tm, kind kind, int icache, uint32_t line) {
  for (size_t i = tm->made; i > 0 && !tm->requests[i - 1].arrived; i--)
    if (tm->requests[i - 1].kind == kind && tm->requests[i - 1].icache == icache && tm->requests[i - 1].line == line)
      return true;
  return false;
}

static uint32_t data_lines_under_way(const struct tm *tm) {
  uint32_t lines = 0;
  for (size_t i = tm->made; i > 0 && !tm->requests[i - 1].arrived; i--)
    lines += tm->requests[i - 1].kind == DATA_LINE;
  return lines;
}

static struct request *oldest_waiting(struct tm *tm) {
  struct request *oldest = NULL;
  for (size_t i = tm->made; i > 0 && !tm->requests[i - 1].started; i--)
    oldest = &tm->requests[i - 1];
  return oldest;
}

static void controller(struct model *model, uint64_t t) {
  for (;;) {
    bool asks[MAX] = {false};
    for (uint32_t i = 0; i < model->config->chip.tms; i++)
      asks[i] = oldest_waiting(&model->tm[i]) != NULL;
    if (model->bus_free >= (t + 1) * model->numerator)
      return;
    const int winner = pick(asks, 0, (int)model->config->chip.tms, &model->bus_pointer);
    if (winner < 0)
      return;
    struct request *served = oldest_waiting(&model->tm[winner]);
    if (model->bus_free < t * model->numerator)
      model->bus_free = t * model->numerator;
    model->bus_free += served->bytes * model->denominator;
    served->started = true;
    served->completion =
        (model->bus_free + model->numerator - 1) / model->numerator + model->config->memory.latency_cycles;
  }
}

static void arrivals(struct model *model, struct tm *tm, uint64_t t) {
  size_t first = tm->made;
  while (first > 0 && !tm->requests[first - 1].arrived)
    first--;
  for (size_t i = first; i < tm->made && tm->requests[i].started && tm->requests[i].completion <= t; i++) {
    struct request *r = &tm->requests[i];
    r->arrived = true;
    if (r->kind == WORD) {
      tm->tp[r->tp].usable[r->rd] = t;
    } else if (r->kind == DATA_LINE) {
      cache_take(&tm->dcache, r->line);
      for (int tp = 0; tp < model->tps; tp++)
        for (unsigned reg = 1; reg < 32; reg++)
          if (tm->tp[tp].on_line[reg] && tm->tp[tp].line_of[reg] == r->line) {
            tm->tp[tp].on_line[reg] = false;
            tm->tp[tp].usable[reg] = t;
          }
    } else if (r->kind == INSTRUCTION_LINE) {
      cache_take(&tm->icache[r->icache], r->line);
      for (int i2 = 0; i2 < model->tps; i2++) {
        struct tp *tp = &tm->tp[i2];
        if (i2 / (int)model->config->icache.tps_per_cache == r->icache && tp->waits_for_line &&
            tp->thread->steps[tp->next].pc / model->config->icache.line_bytes == r->line) {
          tp->waits_for_line = false;
          tp->holds = true;
        }
      }
    }
  }
}

/* --- the steps of a TM --- */

static void fetch(struct model *model, struct tm *tm, uint64_t t) {
  const struct trax_config *config = model->config;
  const int size = (int)config->icache.tps_per_cache;
  for (int cache = 0; cache * size < model->tps; cache++) {
    bool won[MAX] = {false};
    for (uint32_t bank = 0; bank < config->icache.banks; bank++) {
      bool asks[MAX + MAX] = {false};
      for (int i = cache * size; i < model->tps && i < (cache + 1) * size; i++) {
        const struct tp *tp = &tm->tp[i];
        asks[i] = !tp->ended && t >= tp->idle_until && !tp->holds && !tp->waits_for_line &&
                  tp->thread->steps[tp->next].pc / 4 % config->icache.banks == bank;
      }
      for (uint32_t port = 0; port < config->icache.ports_per_bank; port++) {
        const int winner = pick(asks, cache * size, size, &tm->bank_pointer[cache][bank]);
        if (winner >= 0) {
          won[winner] = true;
          asks[winner] = false;
        }
      }
      for (int i = 0; i < model->tps; i++)
        if (asks[i])
          charge(&tm->tp[i], TRAX_CAUSE_ICACHE_BANK);
    }
    for (int i = 0; i < model->tps; i++) {
      if (!won[i])
        continue;
      struct tp *tp = &tm->tp[i];
      const uint32_t line = tp->thread->steps[tp->next].pc / config->icache.line_bytes;
      if (cache_has(&tm->icache[cache], line))
        tp->holds = true;
      else if (on_its_way(tm, INSTRUCTION_LINE, cache, line))
        tp->waits_for_line = true;
      else if (request(
                   model, tm,
                   (struct request){
                       .kind = INSTRUCTION_LINE, .icache = cache, .line = line, .bytes = config->icache.line_bytes}))
        tp->waits_for_line = true;
      else
        charge(tp, TRAX_CAUSE_MEMORY_QUEUE);
    }
  }
  for (int i = 0; i < model->tps; i++)
    if (tm->tp[i].waits_for_line)
      charge(&tm->tp[i], TRAX_CAUSE_ICACHE_MISS);
}

static void operands(struct model *model, struct tm *tm, uint64_t t) {
  for (int i = 0; i < model->tps; i++) {
    struct tp *tp = &tm->tp[i];
    if (!tp->holds || tp->charged)
      continue;
    const trax_inst inst = current(tp);
    const unsigned flags = flags_of(tp);
    const bool waits[3] = {flags & TRAX_READS_RA && tp->usable[inst.ra] > t,
                           flags & TRAX_READS_RB && tp->usable[inst.rb] > t,
                           flags & TRAX_WRITES_RD && tp->usable[inst.rd] > t};
    const unsigned registers[3] = {inst.ra, inst.rb, inst.rd};
    for (int k = 0; k < 3 && !tp->charged; k++)
      if (waits[k])
        charge(tp, tp->cause[registers[k]]);
  }
}

static bool wants(const struct model *model, const struct tp *tp, trax_unit unit) {
  if (!tp->holds || tp->charged || trax_op_table[current(tp).op].unit != unit)
    return false;
  return !(unit == TRAX_UNIT_FP_ADD && model->config->fpu.compare_units && !(flags_of(tp) & TRAX_IS_FLOP));
}

static void shared_unit(struct model *model, struct tm *tm, trax_unit unit, int size, int *pointers, trax_cause cause) {
  bool asks[MAX + MAX] = {false};
  for (int i = 0; i < model->tps; i++)
    asks[i] = wants(model, &tm->tp[i], unit);
  for (int group = 0; group * size < model->tps; group++) {
    const int winner = pick(asks, group * size, size, &pointers[group]);
    for (int i = group * size; i < (group + 1) * size; i++)
      if (asks[i] && i != winner)
        charge(&tm->tp[i], cause);
  }
}

static void special_unit(struct model *model, struct tm *tm, uint64_t t) {
  bool asks[MAX + MAX] = {false};
  for (int i = 0; i < model->tps; i++)
    asks[i] = wants(model, &tm->tp[i], TRAX_UNIT_SPECIAL);
  for (uint32_t unit = 0; unit < model->config->special.units_per_tm; unit++) {
    if (tm->special_free[unit] > t)
      continue;
    const int winner = pick(asks, 0, model->tps, &tm->special_pointer);
    if (winner < 0)
      continue;
    asks[winner] = false;
    tm->special_free[unit] = t + (model->config->special.pipelined ? 1 : model->config->special.latency_cycles);
  }
  for (int i = 0; i < model->tps; i++)
    if (asks[i])
      charge(&tm->tp[i], TRAX_CAUSE_SPECIAL);
}

static bool is_global(const struct tp *tp) {
  return address_of(tp) < TRAX_LOCAL_BASE;
}

static void data_banks(struct model *model, struct tm *tm) {
  const uint32_t banks =
      (uint32_t)(model->tps + (int)model->config->dcache.tps_per_bank - 1) / model->config->dcache.tps_per_bank;
  for (uint32_t bank = 0; bank < banks; bank++) {
    bool asks[MAX + MAX] = {false};
    for (int i = 0; i < model->tps; i++)
      asks[i] = wants(model, &tm->tp[i], TRAX_UNIT_MEMORY) && is_global(&tm->tp[i]) &&
                !(flags_of(&tm->tp[i]) & (TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC)) &&
                address_of(&tm->tp[i]) / 4 % banks == bank;
    const int winner = pick(asks, 0, model->tps, &tm->dbank_pointer[bank]);
    for (int i = 0; i < model->tps; i++)
      if (asks[i] && i != winner)
        charge(&tm->tp[i], TRAX_CAUSE_DCACHE_BANK);
  }
}

static void result(struct tp *tp, uint64_t cycle, trax_cause cause) {
  const unsigned rd = current(tp).rd;
  if (!rd)
    return;
  tp->usable[rd] = cycle;
  tp->cause[rd] = cause;
}

/* Serves a load, store or end in its turn; *took tells whether it took a place. */
static bool in_turn(struct model *model, struct tm *tm, int number, uint64_t t, bool *took) {
  const struct trax_config *config = model->config;
  struct tp *tp = &tm->tp[number];
  const trax_inst inst = current(tp);
  const unsigned flags = flags_of(tp);
  const uint32_t address = address_of(tp), bytes = trax_op_table[inst.op].access_bytes;

  if (ends_thread(tp) || flags & TRAX_IS_STORE) {
    const bool store = flags & TRAX_IS_STORE;
    if (store && !config->memory.write_combining)
      return *took = request(model, tm, (struct request){.kind = WRITE, .bytes = bytes});
    const bool filled = tp->run_end > tp->run_begin;
    if (store && filled && address / 64 == tp->run_begin / 64 && address <= tp->run_end &&
        address + bytes >= tp->run_begin) {
      tp->run_begin = address < tp->run_begin ? address : tp->run_begin;
      tp->run_end = address + bytes > tp->run_end ? address + bytes : tp->run_end;
      return true;
    }
    if (filled && !(*took = request(model, tm, (struct request){.kind = WRITE, .bytes = tp->run_end - tp->run_begin})))
      return false;
    tp->run_begin = store ? address : 0;
    tp->run_end = store ? address + bytes : 0;
    return true;
  }
  if (flags & (TRAX_IS_ATOMIC | TRAX_IS_NONTEMPORAL)) {
    const bool atomic = flags & TRAX_IS_ATOMIC;
    *took = request(
        model, tm,
        (struct request){.kind = WORD, .tp = number, .rd = inst.rd, .bytes = atomic ? config->memory.atomic_bytes : 4});
    if (*took)
      result(tp, UNKNOWN, atomic ? TRAX_CAUSE_DATA_ATOMIC : TRAX_CAUSE_DATA_MISS);
    return *took;
  }
  const uint32_t line = address / config->dcache.line_bytes;
  if (cache_has(&tm->dcache, line)) {
    result(tp, t + config->dcache.hit_latency_cycles, TRAX_CAUSE_DATA_HIT);
    return true;
  }
  if (!on_its_way(tm, DATA_LINE, 0, line)) {
    *took = data_lines_under_way(tm) < config->dcache.mshrs &&
            request(model, tm, (struct request){.kind = DATA_LINE, .line = line, .bytes = config->dcache.line_bytes});
    if (!*took)
      return false;
  }
  result(tp, UNKNOWN, TRAX_CAUSE_DATA_MISS);
  tp->on_line[inst.rd] = inst.rd != 0;
  tp->line_of[inst.rd] = line;
  return true;
}

static void memory_queue(struct model *model, struct tm *tm, uint64_t t) {
  const int start = tm->queue_pointer;
  for (int k = 0; k < model->tps; k++) {
    const int i = (start + k) % model->tps;
    struct tp *tp = &tm->tp[i];
    if (!tp->holds || tp->charged)
      continue;
    if (!ends_thread(tp) && !(wants(model, tp, TRAX_UNIT_MEMORY) && is_global(tp)))
      continue;
    bool took = false;
    if (!in_turn(model, tm, i, t, &took))
      charge(tp, TRAX_CAUSE_MEMORY_QUEUE);
    if (took)
      tm->queue_pointer = (i + 1) % model->tps;
  }
}

static void issue(struct model *model, struct tp *tp, uint64_t t) {
  const struct trax_config *config = model->config;
  const trax_inst inst = current(tp);
  const bool flop = flags_of(tp) & TRAX_IS_FLOP;
  switch (trax_op_table[inst.op].unit) {
  case TRAX_UNIT_FP_ADD:
    result(tp, t + (flop ? config->fpu.add_latency_cycles : config->fpu.compare_latency_cycles), TRAX_CAUSE_DATA_OTHER);
    break;
  case TRAX_UNIT_FP_MUL:
    result(tp, t + config->fpu.mul_latency_cycles, TRAX_CAUSE_DATA_OTHER);
    break;
  case TRAX_UNIT_INT_MUL:
    result(tp, t + config->int_mul.latency_cycles, TRAX_CAUSE_DATA_OTHER);
    break;
  case TRAX_UNIT_SPECIAL:
    result(tp, t + config->special.latency_cycles, TRAX_CAUSE_DATA_SPECIAL);
    break;
  case TRAX_UNIT_MEMORY:
    if (!is_global(tp) && flags_of(tp) & TRAX_IS_LOAD)
      result(tp, t + config->tp.local_latency_cycles, TRAX_CAUSE_DATA_LOCAL);
    break;
  default:
    if (flags_of(tp) & TRAX_WRITES_RD)
      result(tp, t + config->tp.int_latency_cycles, TRAX_CAUSE_DATA_OTHER);
    break;
  }
  charge(tp, TRAX_CAUSE_ISSUED);
  tp->thread->issued[tp->next] = t;
  tp->holds = false;
  const uint32_t pc = tp->thread->steps[tp->next].pc;
  if (++tp->next == tp->thread->count)
    tp->ended = true;
  else if (tp->thread->steps[tp->next].pc != pc + 4)
    tp->idle_until = t + 1 + config->tp.branch_bubble_cycles;
}

static void tm_cycle(struct model *model, struct tm *tm, uint64_t t) {
  const struct trax_config *config = model->config;
  for (int i = 0; i < model->tps; i++) {
    tm->tp[i].charged = false;
    if (tm->tp[i].ended)
      charge(&tm->tp[i], TRAX_CAUSE_HALTED);
    else if (t < tm->tp[i].idle_until)
      charge(&tm->tp[i], TRAX_CAUSE_BRANCH);
  }
  fetch(model, tm, t);
  operands(model, tm, t);
  shared_unit(model, tm, TRAX_UNIT_FP_ADD, (int)config->fpu.tps_per_cluster, tm->add_pointer, TRAX_CAUSE_FP_ADD);
  shared_unit(model, tm, TRAX_UNIT_FP_MUL, (int)config->fpu.tps_per_cluster, tm->mul_pointer, TRAX_CAUSE_FP_MUL);
  shared_unit(model, tm, TRAX_UNIT_INT_MUL, (int)config->int_mul.tps_per_unit, tm->int_mul_pointer, TRAX_CAUSE_INT_MUL);
  special_unit(model, tm, t);
  data_banks(model, tm);
  memory_queue(model, tm, t);
  for (int i = 0; i < model->tps; i++)
    if (tm->tp[i].holds && !tm->tp[i].charged)
      issue(model, &tm->tp[i], t);
}

static bool is_over(struct model *model, uint64_t t) {
  for (uint32_t i = 0; i < model->config->chip.tms; i++) {
    for (int tp = 0; tp < model->tps; tp++)
      if (!model->tm[i].tp[tp].ended)
        return false;
    if (oldest_waiting(&model->tm[i]))
      return false;
  }
  return model->bus_free <= t * model->numerator;
}

uint64_t naive_run(const struct trax_config *config, struct naive_thread *threads, uint64_t *bytes) {
  struct model model = {.config = config, .tps = (int)config->chip.tps_per_tm};
  model.numerator = (uint64_t)llround(config->memory.bandwidth_gbps * 1000);
  model.denominator = config->chip.clock_mhz;
  model.tm = calloc(config->chip.tms, sizeof *model.tm);
  for (uint32_t i = 0; i < config->chip.tms; i++) {
    for (int tp = 0; tp < model.tps; tp++) {
      struct naive_thread *thread = &threads[i * config->chip.tps_per_tm + (uint32_t)tp];
      memset(thread->charged, 0, sizeof thread->charged);
      model.tm[i].tp[tp].thread = thread;
    }
    for (int cache = 0; cache < MAX; cache++)
      cache_create(&model.tm[i].icache[cache], config->icache.bytes, config->icache.line_bytes, config->icache.ways);
    cache_create(&model.tm[i].dcache, config->dcache.bytes, config->dcache.line_bytes, config->dcache.ways);
  }

  uint64_t t = 0;
  for (; !is_over(&model, t); t++) {
    for (uint32_t i = 0; i < config->chip.tms; i++)
      arrivals(&model, &model.tm[i], t);
    for (uint32_t i = 0; i < config->chip.tms; i++)
      tm_cycle(&model, &model.tm[i], t);
    controller(&model, t);
  }

  *bytes = model.bytes;
  for (uint32_t i = 0; i < config->chip.tms; i++) {
    for (int cache = 0; cache < MAX; cache++) {
      free(model.tm[i].icache[cache].line);
      free(model.tm[i].icache[cache].pointer);
    }
    free(model.tm[i].dcache.line);
    free(model.tm[i].dcache.pointer);
    free(model.tm[i].requests);
  }
  free(model.tm);
  return t;
}
