#include "core/state.h"

#include "core/l2.h"

struct visitor {
  void (*visit)(void *context, void *bytes, size_t size);
  void *context;
};

#define VISIT(LVALUE) visitor->visit(visitor->context, &(LVALUE), sizeof(LVALUE))
#define VISIT_ARRAY(POINTER, COUNT) visitor->visit(visitor->context, POINTER, (COUNT) * sizeof *(POINTER))

static void visit_tags(const struct visitor *visitor, struct trax_cache_tags *tags) {
  const size_t sets = (size_t)tags->set_mask + 1;
  VISIT_ARRAY(tags->lines, sets * tags->ways);
  VISIT_ARRAY(tags->next, sets);
}

static void visit_queue(const struct visitor *visitor, struct trax_queue *queue) {
  VISIT_ARRAY(queue->requests, queue->depth);
  if (queue->heap) {
    VISIT_ARRAY(queue->heap, queue->depth);
    VISIT_ARRAY(queue->places, queue->depth);
  }
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
  VISIT(tm->fp_add.turn);
  VISIT(tm->fp_mul.turn);
  VISIT(tm->int_mul.turn);
  VISIT(tm->special.free_from);
  VISIT(tm->special.turn);
  VISIT(tm->queue_turn);
  visit_queue(visitor, &tm->queue);
  for (uint32_t i = 0; i < tm->icaches; i++) {
    visit_tags(visitor, &tm->icache[i].tags);
    VISIT(tm->icache[i].bank);
    VISIT_ARRAY(tm->icache[i].pending, tm->tps);
    VISIT(tm->icache[i].pending_count);
  }
  visit_tags(visitor, &tm->dcache.tags);
  VISIT(tm->dcache.bank);
  VISIT_ARRAY(tm->dcache.mshr, tm->dcache.mshr_limit);
  VISIT(tm->dcache.mshr_count);
  VISIT_ARRAY(tm->dcache.next_waiter, (size_t)tm->tps * TRAX_NUM_REGISTERS);
  for (uint32_t i = 0; i < tm->tps; i++)
    visit_tp(visitor, &tm->tp[i]);
  VISIT(*tm->stats);
  VISIT_ARRAY(tm->tp_stats, tm->tps);
  VISIT_ARRAY(tm->exit_statuses, tm->tps);
}

static void visit_l2(const struct visitor *visitor, struct trax_l2 *l2) {
  visit_tags(visitor, &l2->tags);
  VISIT(l2->waiting);
  VISIT_ARRAY(l2->bank, l2->banks);
  VISIT_ARRAY(l2->mshr, l2->mshr_limit);
  VISIT_ARRAY(l2->line, l2->mshr_limit);
  VISIT_ARRAY(l2->used, l2->mshr_limit);
  VISIT(l2->used_count);
  VISIT(l2->coming);
  VISIT(l2->next_arrival);
}

static void visit_memory(const struct visitor *visitor, struct trax_memory *memory) {
  for (uint32_t i = 0; i < memory->channels; i++) {
    VISIT(memory->channel[i].free_from);
    VISIT(memory->channel[i].passed);
    if (memory->channel[i].waiting)
      VISIT(*memory->channel[i].waiting);
  }
  VISIT(memory->turn);
  VISIT(memory->tms);
  VISIT(memory->waiting);
  VISIT(*memory->stats);
  if (memory->l2)
    visit_l2(visitor, memory->l2);
}

void trax_state_visit(struct trax_chip *chip, void (*visit)(void *context, void *bytes, size_t size), void *context) {
  const struct visitor visitor = {visit, context};
  for (uint32_t i = 0; i < chip->tms; i++)
    visit_tm(&visitor, &chip->tm[i]);
  visit_memory(&visitor, &chip->memory);
}

void trax_state_taken(struct trax_chip *chip, uint64_t t) {
  for (uint32_t i = 0; i < chip->tms; i++)
    for (uint32_t tp = 0; tp < chip->tm[i].tps; tp++)
      chip->tm[i].tp[tp].inst = trax_text_at(&chip->text, chip->tm[i].tp[tp].pc);
  trax_chip_scatter(chip, t);
  chip->begin = t;
}
