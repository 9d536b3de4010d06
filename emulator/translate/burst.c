/* Translated bursts: the code that records their steps, and their execution. The first instructions of a sequence
   record all of its steps at once. An exit ends the record by the number of the burst's steps. */
#include "translate/internal.h"

#include <string.h>

static void emit_member(struct trax_translation *t, const char *operation, size_t bytes, size_t member) {
  trax_emit(t, operation, bytes);
  trax_emit_word(t, (uint32_t)member);
}

/* An operation whose operand is at a distance from the code. */
static void emit_near(struct trax_translation *t, const char *operation, size_t bytes, const void *operand) {
  trax_emit(t, operation, bytes);
  trax_emit_distance(t, operand);
}

const uint8_t *trax_emit_record(struct trax_translation *t, size_t begin, size_t count) {
  const uint8_t *const full = t->at;
  uint64_t lines = 0;
  for (size_t i = begin; i < begin + count; i++)
    lines |= (uint64_t)1 << t->bursts->line[i] % 64;
  trax_emit_byte(t, 0xB8); /* mov eax, begin */
  trax_emit_word(t, (uint32_t)begin);
  emit_near(t, "\xE9", 1, t->leave); /* jmp leave */
  const uint8_t *const entry = t->at;
  trax_emit(t, "\x41\x81\xFF", 3); /* cmp r15d, TRAX_BURST - count */
  trax_emit_word(t, (uint32_t)(TRAX_BURST - count));
  emit_near(t, "\x0F\x8F", 2, full); /* jg full */
  if (t->count > TRAX_REACH) {       /* mov eax, begin + reach; sub eax, [r14 + ...]; cmp eax, 2 reach; ja full */
    trax_emit_byte(t, 0xB8);
    trax_emit_word(t, (uint32_t)begin + TRAX_REACH);
    emit_member(t, "\x41\x2B\x86", 3, offsetof(struct trax_burst, first));
    emit_member(t, "\x3D", 1, 2 * TRAX_REACH);
    emit_near(t, "\x0F\x87", 2, full);
  }
  for (size_t i = 0; i < count; i += 8) {
    emit_near(t, "\x0F\x10\x05", 3, t->step + begin + i);   /* movups xmm0, [step] */
    emit_near(t, "\x0F\x10\x0D", 3, t->number + begin + i); /* movups xmm1, [number] */
    emit_member(t, "\x43\x0F\x11\x84\x7E", 5,               /* movups [r14 + 2 r15 + ...], xmm0 */
                offsetof(struct trax_burst, step) + i * sizeof *t->step);
    emit_member(t, "\x43\x0F\x11\x8C\x7E", 5, /* movups [r14 + 2 r15 + ...], xmm1 */
                offsetof(struct trax_burst, index) + i * sizeof *t->number);
  }
  trax_emit(t, "\x48\xB8", 2); /* mov rax, lines */
  trax_emit(t, &lines, sizeof lines);
  emit_member(t, "\x49\x09\x86", 3, offsetof(struct trax_burst, lines)); /* or [r14 + ...], rax */
  return entry;
}

void trax_emit_taken(struct trax_translation *t, size_t end, const size_t *target) {
  if (t->bursts->slow_jump) {
    emit_member(t, "\x43\x80\x8C\x7E", 4,
                offsetof(struct trax_burst, step) - sizeof *t->step); /* or byte [last], ... */
    trax_emit_byte(t, t->bursts->slow_jump);
  }
  emit_member(t, "\x41\xFF\x86", 3, offsetof(struct trax_burst, jumps));       /* inc dword [r14 + ...] */
  emit_member(t, "\x48\x8B\x93", 3, offsetof(struct trax_translated, deltas)); /* mov rdx, [rbx + ...] */
  emit_member(t, "\x48\xFF\x8A", 3, end * sizeof(int64_t));                    /* dec qword [rdx + ...] */
  if (target)
    emit_member(t, "\x48\xFF\x82", 3, *target * sizeof(int64_t)); /* inc qword [rdx + ...] */
  else
    trax_emit(t, "\x48\xFF\x04\x4A", 4); /* inc qword [rdx + 2 rcx] */
}

unsigned trax_translation_burst(struct trax_translation *t, size_t index, struct trax_translated_burst *run) {
  struct trax_translated *const state = t->state[run->tm];
  uint32_t (*enter)(struct trax_translated *, const uint8_t *, int64_t, struct trax_burst *);
  memcpy(&enter, &t->enter, sizeof enter);
  memcpy(state->reg, run->reg, TRAX_NUM_REGISTERS * sizeof *state->reg);
  state->local = run->local;
  state->deltas = run->deltas;
  state->input_bytes = run->input_bytes;
  run->burst->load_count = run->burst->jumps = 0;
  run->burst->undo_begin = TRAX_BURST + 1;
  run->burst->first = (uint32_t)index;
  run->burst->lines = 0;
  const uint32_t next = enter(state, t->entry[index], 0, run->burst);
  memcpy(run->reg + 1, state->reg + 1, (TRAX_NUM_REGISTERS - 1) * sizeof *state->reg);
  run->pc = state->pc;
  run->index = (next & ~TRAX_IS_SLOW) != TRAX_ANYWHERE ? next & ~TRAX_IS_SLOW
               : next & TRAX_IS_SLOW                   ? TRAX_NO_INDEX
                                                       : (state->pc - state->begin) / 4;
  return (unsigned)state->left;
}
