#include "fast/state.h"

#include "fast/l2.h"

#include <assert.h>
#include <string.h>

struct visitor {
  trax_state_visitor *visit;
  void *context;
};

#define VISIT(LVALUE) visitor->visit(visitor->context, #LVALUE, &(LVALUE), sizeof(LVALUE), 1)
#define VISIT_ARRAY(POINTER, COUNT) visitor->visit(visitor->context, #POINTER, POINTER, sizeof *(POINTER), COUNT)

/* Every structure is visited field by field, so that its padding is nowhere and its layout is what is visited. What a
   configuration has not got is visited as nothing, by the same names: the layout is that of all configurations. */

static void visit_request(const struct visitor *visitor, struct trax_request *request) {
  VISIT(request->kind);
  VISIT(request->tp);
  VISIT(request->rd);
  VISIT(request->icache);
  VISIT(request->line);
  VISIT(request->address);
  VISIT(request->bytes);
  VISIT(request->value);
  VISIT(request->next);
  VISIT(request->number);
  VISIT(request->completion);
}

static void visit_list(const struct visitor *visitor, struct trax_request_list *list) {
  VISIT(list->first);
  VISIT(list->last);
}

static void visit_waiting(const struct visitor *visitor, struct trax_waiting *waiting) {
  VISIT(waiting->tms);
  VISIT(waiting->turn);
  for (unsigned i = 0; i < TRAX_MAX_TMS; i++)
    visit_list(visitor, &waiting->of[i]);
}

static void visit_tags(const struct visitor *visitor, struct trax_cache_tags *tags) {
  const size_t sets = (size_t)tags->set_mask + 1;
  VISIT_ARRAY(tags->lines, sets * tags->ways);
  VISIT_ARRAY(tags->next, sets);
}

static void visit_queue(const struct visitor *visitor, struct trax_queue *queue) {
  for (uint32_t i = 0; i < queue->depth; i++)
    visit_request(visitor, &queue->requests[i]);
  VISIT_ARRAY(queue->heap, queue->heap ? queue->depth : 0);
  VISIT_ARRAY(queue->places, queue->heap ? queue->depth : 0);
  VISIT(queue->oldest);
  VISIT(queue->count);
  VISIT(queue->started);
  VISIT(queue->shown);
  VISIT(queue->peak);
  VISIT(queue->first_fresh);
  VISIT(queue->last_fresh);
  VISIT(queue->made);
}

static void visit_tp(const struct visitor *visitor, struct trax_tp *tp) {
  VISIT(tp->reg);
  VISIT(tp->pc);
  VISIT(tp->address);
  VISIT(tp->usable);
  VISIT(tp->usable_cause);
  VISIT(tp->run_begin);
  VISIT(tp->run_end);
  VISIT(tp->writes);
  VISIT(tp->increments);
  VISIT(tp->asleep_since);
  VISIT(tp->asleep_until);
  VISIT(tp->asleep_cause);
  VISIT(tp->local);
}

static void visit_tm_stats(const struct visitor *visitor, struct trax_tm_stats *stats) {
  VISIT(stats->cycles);
  VISIT(stats->instructions);
#define COUNTER(ID, NAME, UNIT, MEANING) VISIT(stats->ID);
  TRAX_TM_COUNTERS(COUNTER)
#undef COUNTER
}

static void visit_memory_stats(const struct visitor *visitor, struct trax_memory_stats *memory_stats) {
#define COUNTER(ID, NAME, UNIT, MEANING) VISIT(memory_stats->ID);
  TRAX_MEMORY_COUNTERS(COUNTER)
#undef COUNTER
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++) {
    VISIT(memory_stats->channel[i].transfers);
    VISIT(memory_stats->channel[i].bytes);
  }
}

static void visit_tm(const struct visitor *visitor, struct trax_tm *tm) {
  VISIT(tm->running);
  VISIT(tm->awake);
  VISIT(tm->holding);
  VISIT(tm->awaiting);
  VISIT(tm->ended);
  VISIT(tm->wheel);
  VISIT(tm->wheel_occupied);
  VISIT(tm->next_cycle);
  VISIT(tm->progressed);
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++) {
    VISIT(tm->unit[i].turn);
    VISIT_ARRAY(tm->unit[i].free_from, trax_shared_unit_count(&tm->unit[i]));
  }
  VISIT(tm->queue_turn);
  visit_queue(visitor, &tm->queue);
  for (uint32_t i = 0; i < tm->icaches; i++) {
    visit_tags(visitor, &tm->icache[i].tags);
    VISIT(tm->icache[i].bank);
    for (uint32_t j = 0; j < tm->tps; j++) {
      VISIT(tm->icache[i].pending[j].line);
      VISIT(tm->icache[i].pending[j].waiting);
    }
    VISIT(tm->icache[i].pending_count);
  }
  visit_tags(visitor, &tm->dcache.tags);
  VISIT(tm->dcache.bank);
  for (uint32_t i = 0; i < tm->dcache.mshr_limit; i++) {
    VISIT(tm->dcache.mshr[i].line);
    VISIT(tm->dcache.mshr[i].first_waiter);
    VISIT(tm->dcache.mshr[i].passing);
  }
  VISIT(tm->dcache.mshr_count);
  VISIT_ARRAY(tm->dcache.next_waiter, (size_t)tm->tps * TRAX_NUM_REGISTERS);
  for (uint32_t i = 0; i < tm->tps; i++)
    visit_tp(visitor, &tm->tp[i]);
  visit_tm_stats(visitor, tm->stats);
  for (uint32_t i = 0; i < tm->tps; i++)
    VISIT(tm->tp_stats[i].cycles);
  VISIT_ARRAY(tm->exit_statuses, tm->tps);
}

static void visit_l2(const struct visitor *visitor, struct trax_l2 *l2) {
  visit_tags(visitor, &l2->tags);
  VISIT(l2->waiting);
  for (uint32_t i = 0; i < l2->banks; i++)
    visit_waiting(visitor, &l2->bank[i]);
  for (uint32_t i = 0; i < l2->mshr_limit; i++) {
    visit_request(visitor, &l2->mshr[i].request);
    VISIT(l2->mshr[i].arrival);
    visit_list(visitor, &l2->mshr[i].waiters);
  }
  VISIT_ARRAY(l2->line, l2->mshr_limit);
  VISIT_ARRAY(l2->used, l2->mshr_limit);
  VISIT(l2->used_count);
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++)
    visit_list(visitor, &l2->coming[i]);
  VISIT(l2->next_arrival);
}

static void visit_no_l2(const struct visitor *visitor) {
  uint64_t line = 0;
  uint32_t next = 0, number = 0;
  uint16_t used = 0;
  struct trax_waiting bank = {0};
  struct trax_l2_mshr mshr = {0};
  struct trax_l2 nothing = {.tags = {.ways = 1, .lines = &line, .next = &next},
                            .banks = 1,
                            .bank = &bank,
                            .mshr = &mshr,
                            .line = &number,
                            .used = &used,
                            .mshr_limit = 1};
  visit_l2(visitor, &nothing);
}

static void visit_memory(const struct visitor *visitor, struct trax_memory *memory) {
  for (uint32_t i = 0; i < memory->channels; i++) {
    struct trax_waiting nothing = {0};
    VISIT(memory->channel[i].free_from.cycle);
    VISIT(memory->channel[i].free_from.units);
    visit_list(visitor, &memory->channel[i].passed);
    visit_waiting(visitor, memory->channel[i].waiting ? memory->channel[i].waiting : &nothing);
  }
  VISIT(memory->turn);
  VISIT(memory->tms);
  VISIT(memory->waiting);
  visit_memory_stats(visitor, memory->stats);
  if (memory->l2)
    visit_l2(visitor, memory->l2);
  else
    visit_no_l2(visitor);
}

void trax_state_visit(void *state, trax_state_visitor *visit, void *context) {
  struct trax_chip *chip = state;
  const struct visitor visitor = {visit, context};
  for (uint32_t i = 0; i < chip->tms; i++)
    visit_tm(&visitor, &chip->tm[i]);
  visit_memory(&visitor, &chip->memory);
}

/* --- layout --- */

enum { MOST_PIECES = 256 };

struct layout {
  const char *name[MOST_PIECES]; /* [count]: those that have been seen */
  size_t count;
  uint64_t hash;
};

/* FNV-1a. */
static void add_bytes(struct layout *layout, const void *bytes, size_t size) {
  for (const uint8_t *byte = bytes; size--; byte++)
    layout->hash = (layout->hash ^ *byte) * 0x100000001B3u;
}

static void add_text(struct layout *layout, const char *text) {
  add_bytes(layout, text, strlen(text) + 1);
}

/* Once, however many structures there are of the kind. */
static void add_piece(void *context, const char *name, void *bytes, size_t size, size_t count) {
  struct layout *layout = context;
  const uint64_t bits = size;
  size_t i = 0;
  (void)bytes;
  (void)count;
  while (i < layout->count && layout->name[i] != name && strcmp(layout->name[i], name) != 0)
    i++;
  if (i < layout->count)
    return;
  assert(i < MOST_PIECES);
  layout->name[layout->count++] = name;
  add_text(layout, name);
  add_bytes(layout, &bits, sizeof bits);
}

uint64_t trax_state_layout(void *chip) {
  struct layout layout = {.hash = 0xCBF29CE484222325u};
  trax_state_visit(chip, add_piece, &layout);
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++) /* what numbers mean */
    add_text(&layout, trax_op_table[op].mnemonic);
#define CAUSE(ID, NAME, ...) add_text(&layout, NAME);
  TRAX_CAUSES(CAUSE)
#undef CAUSE
  return layout.hash;
}
