#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "translate/translate.h"

#include <stdlib.h>
#include <string.h>

#ifdef TRAX_TRANSLATES
#include "translate/internal.h"

#include <sys/mman.h>

enum {
  HOT = 32,     /* a sequence is translated after it was interpreted so often, */
  FIRST = 4000, /* and after any sequences were: then the first ones to be translated show which registers matter */
  HOT_BURSTS = 8,
  FIRST_BURSTS = 4000,
  PAGE = 4096,
  POOL_BYTES = PAGE
};

bool trax_translation_has(struct trax_translation *t, size_t index) {
  if (t->entry[index] != t->leave && !t->is_broken)
    return true;
  __atomic_add_fetch(&t->interpreted, 1, __ATOMIC_RELAXED);
  if (__atomic_add_fetch(&t->heat[index], 1, __ATOMIC_RELAXED) == t->hot_after && !t->ends)
    t->hot[__atomic_fetch_add(&t->hot_count, 1, __ATOMIC_RELAXED)] = (uint32_t)index;
  return false;
}

void trax_translation_add(struct trax_translation *t, size_t index) {
  if (t->heat[index] < t->hot_after) {
    t->heat[index] = t->hot_after;
    t->hot[t->hot_count++] = (uint32_t)index;
  }
}

/* The first time: gives the host's registers to those that the hot sequences use most. */
static void begin_code(struct trax_translation *t) {
  uint64_t weight[TRAX_NUM_REGISTERS + 1][2] = {{0}};
  for (size_t i = 0; i < t->count; i++)
    for (size_t index = i; t->heat[i] && !trax_is_always_slow(t->decoded[index]); index++) {
      trax_add_weight(t->decoded[index], t->heat[i], weight);
      if (!trax_goes_on(t->decoded[index]))
        break;
    }
  trax_set_places(t, weight);
  trax_emit_frame(t);
  for (size_t i = 0; i < t->count; i++)
    t->entry[i] = t->leave;
  t->has_frame = true;
}

void trax_translation_extend(struct trax_translation *t) {
  if (!t->hot_count || t->interpreted < t->first)
    return;
  if (mprotect(t->code, TRAX_CODE, PROT_READ | PROT_WRITE) != 0) {
    t->ends = t->is_broken = true;
    return;
  }
  if (!t->has_frame)
    begin_code(t);
  while (t->hot_count && !t->ends) {
    trax_translate(t, t->hot[--t->hot_count]);
    t->ends =
        t->code + TRAX_CODE - t->at < TRAX_SEQUENCE_CODE || TRAX_EXITS - t->exit_count < TRAX_STUBS + TRAX_SEQUENCE;
  }
  t->hot_count = 0;
  if (mprotect(t->code, TRAX_CODE, PROT_READ | PROT_EXEC) != 0)
    t->ends = t->is_broken = true;
}

enum trax_translated_end trax_translation_run(struct trax_translation *t, size_t index,
                                              struct trax_translated_thread *thread) {
  struct trax_translated *const state = t->state[thread->tm];
  uint32_t (*enter)(struct trax_translated *, const uint8_t *, int64_t);
  memcpy(&enter, &t->enter, sizeof enter);
  memcpy(state->reg, thread->reg, TRAX_NUM_REGISTERS * sizeof *state->reg);
  state->local = thread->local;
  const uint32_t next = enter(state, t->entry[index], thread->left);
  memcpy(thread->reg + 1, state->reg + 1, (TRAX_NUM_REGISTERS - 1) * sizeof *state->reg);
  thread->left = state->left;
  thread->pc = next == TRAX_ANYWHERE ? state->pc : t->pc[next & ~TRAX_IS_SLOW];
  return next & TRAX_IS_SLOW ? TRAX_TRANSLATED_SLOW : TRAX_TRANSLATED_JUMPED;
}

void trax_translation_collect(struct trax_translation *t, uint32_t tm, int64_t *deltas) {
  for (unsigned i = 0; i < t->exit_count; i++) {
    deltas[t->exits[i].begin] += (int64_t)t->state[tm]->executions[i];
    deltas[t->exits[i].end] -= (int64_t)t->state[tm]->executions[i];
    t->state[tm]->executions[i] = 0;
  }
}

void trax_translation_destroy(struct trax_translation *t) {
  if (!t)
    return;
  for (uint32_t i = 0; t->state && i < t->tms; i++)
    free(t->state[i]);
  if (t->mapping)
    munmap(t->mapping, t->mapping_bytes);
  free(t->state);
  free(t->decoded);
  free(t->pc);
  free(t->heat);
  free(t->hot);
  free(t);
}

static bool fill(struct trax_translation *t, const struct trax_text *text, const struct trax_space *space) {
  size_t index = 0;
  for (size_t i = 0; i < text->count; i++)
    for (uint32_t pc = text->segments[i].begin; pc <= text->segments[i].end; pc += 4, index++) {
      t->pc[index] = pc;
      t->decoded[index] = &text->segments[i].decoded[(pc - text->segments[i].begin) / 4];
    }
  t->pc[index] = 1;
  t->decoded[index] = trax_text_at(text, 1);
  for (uint32_t i = 0; i < t->tms; i++) {
    const size_t exits = t->bursts ? 0 : TRAX_EXITS;
    struct trax_translated *const state = calloc(1, sizeof *state + exits * sizeof *state->executions);
    if (!state)
      return false;
    t->state[i] = state;
    state->global = space->bytes;
    state->restrictions = space->restrictions;
    state->accessible = space->size - TRAX_NULL_END;
    state->begin = text->count ? text->segments[0].begin : 0;
    state->bytes = text->count ? text->segments[0].end - state->begin : 0;
    state->blocks = t->bursts ? t->bursts->blocks : NULL;
  }
  return true;
}

struct trax_translation *trax_translation_create(const struct trax_text *text, const struct trax_space *space,
                                                 unsigned precision, uint32_t tms, bool at_once,
                                                 const struct trax_burst_facts *bursts) {
  struct trax_translation *const t = calloc(1, sizeof *t);
  if (!t)
    return NULL;
  t->space = space;
  t->bursts = bursts;
  t->precision = precision;
  t->hot_after = at_once ? 1 : bursts ? HOT_BURSTS : HOT;
  t->first = at_once ? 0 : bursts ? FIRST_BURSTS : FIRST;
  t->tms = tms;
  t->count = 1;
  for (size_t i = 0; i < text->count; i++)
    t->count += (text->segments[i].end - text->segments[i].begin) / 4 + 1;
  t->decoded = calloc(t->count, sizeof *t->decoded);
  t->pc = calloc(t->count, sizeof *t->pc);
  t->heat = calloc(t->count, sizeof *t->heat);
  t->hot = calloc(t->count, sizeof *t->hot);
  t->state = calloc(tms, sizeof *t->state);
  const size_t step_bytes = bursts ? 2 * (t->count + TRAX_PIECE) * sizeof *t->step : 0;
  const size_t table_bytes = (t->count * sizeof *t->entry + step_bytes + PAGE - 1) / PAGE * PAGE;
  t->mapping_bytes = table_bytes + POOL_BYTES + TRAX_CODE;
  void *const mapping = mmap(NULL, t->mapping_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  t->mapping = mapping == MAP_FAILED ? NULL : mapping;
  if (!t->decoded || !t->pc || !t->heat || !t->hot || !t->state || !t->mapping ||
      trax_template_pool_bytes > POOL_BYTES || !fill(t, text, space)) {
    trax_translation_destroy(t);
    return NULL;
  }
  t->entry = (const uint8_t **)t->mapping;
  t->step = (uint16_t *)(t->entry + t->count);
  t->number = t->step + t->count + TRAX_PIECE;
  for (size_t i = 0; bursts && i < t->count; i++) {
    t->step[i] = bursts->step[i];
    t->number[i] = (uint16_t)i;
  }
  t->pool = t->mapping + table_bytes;
  memcpy(t->mapping + table_bytes, trax_template_pool, trax_template_pool_bytes);
  t->code = t->at = t->mapping + table_bytes + POOL_BYTES;
  for (size_t i = bursts && at_once ? t->count : 0; i-- > 0;)
    trax_translation_add(t, i); /* a burst may begin anywhere */
  return t;
}

#else /* another host: nothing is translated */

struct trax_translation *trax_translation_create(const struct trax_text *text, const struct trax_space *space,
                                                 unsigned precision, uint32_t tms, bool at_once,
                                                 const struct trax_burst_facts *bursts) {
  (void)text, (void)space, (void)precision, (void)tms, (void)at_once, (void)bursts;
  return NULL;
}
void trax_translation_destroy(struct trax_translation *t) {
  (void)t;
}
bool trax_translation_has(struct trax_translation *t, size_t index) {
  (void)t, (void)index;
  return false;
}
void trax_translation_extend(struct trax_translation *t) {
  (void)t;
}
enum trax_translated_end trax_translation_run(struct trax_translation *t, size_t index,
                                              struct trax_translated_thread *thread) {
  (void)t, (void)index, (void)thread;
  return TRAX_TRANSLATED_SLOW;
}
unsigned trax_translation_burst(struct trax_translation *t, size_t index, struct trax_translated_burst *run) {
  (void)t, (void)index, (void)run;
  return 0;
}
void trax_translation_collect(struct trax_translation *t, uint32_t tm, int64_t *deltas) {
  (void)t, (void)tm, (void)deltas;
}

#endif
