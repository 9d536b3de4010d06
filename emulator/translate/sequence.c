#include "translate/internal.h"

#include <assert.h>

/* Whether a relative jump leads to an instruction of its segment; *target receives its index. */
static bool is_plain_jump(const struct trax_translation *t, size_t index, size_t *target) {
  const int32_t imm = t->decoded[index]->imm;
  const int64_t to = (int64_t)index + imm / 4;
  if (imm % 4 || to < 0 || to >= (int64_t)t->count || t->pc[to] != t->pc[index] + (uint32_t)imm)
    return false;
  *target = (size_t)to;
  return t->decoded[to]->resource != TRAX_RESOURCE_NO_TEXT;
}

static void emit_leave(struct trax_translation *t) {
  trax_emit_byte(t, 0xE9);
  trax_emit_distance(t, t->leave);
}

/* Counts the execution of the instructions [begin, end), which leads to `next`. */
static void emit_exit(struct trax_translation *t, size_t begin, size_t end, uint32_t next) {
  trax_emit_byte(t, 0xB8); /* mov eax, next */
  trax_emit_word(t, next);
  trax_emit(t, "\x48\x83\x83", 3); /* add qword [rbx + executions[exit]], 1 */
  trax_emit_word(t, (uint32_t)(offsetof(struct trax_translated, executions) + sizeof(uint64_t) * t->exit_count));
  trax_emit_byte(t, 1);
  t->exits[t->exit_count++] = (struct trax_exit){(uint32_t)begin, (uint32_t)end};
  trax_emit(t, "\x49\x81\xEF", 3); /* sub r15, end - begin */
  trax_emit_word(t, (uint32_t)(end - begin));
}

/* A taken jump behind the instructions [begin, end) to an instruction. */
static void emit_jump(struct trax_translation *t, size_t begin, size_t end, size_t target) {
  emit_exit(t, begin, end, (uint32_t)target);
  trax_emit(t, "\x0F\x8E", 2); /* jle leave */
  trax_emit_distance(t, t->leave);
  if (t->entry[target] != t->leave) {
    trax_emit_byte(t, 0xE9); /* jmp entry */
    trax_emit_distance(t, t->entry[target]);
  } else {
    trax_emit(t, "\xFF\x25", 2); /* jmp [entry] */
    trax_emit_distance(t, &t->entry[target]);
  }
}

/* A jump to the pc in edx. */
static void emit_jump_to(struct trax_translation *t, size_t begin, size_t end) {
  trax_emit(t, "\x89\xD1", 2); /* mov ecx, edx */
  const unsigned first = t->stub_count;
  trax_emit_template(t, &trax_templates[TRAX_OP_LOOKUP][0], end - 1);
  emit_exit(t, begin, end, TRAX_ANYWHERE);
  trax_emit(t, "\x0F\x8E", 2); /* jle leave */
  trax_emit_distance(t, t->leave);
  trax_emit(t, "\x48\x8D\x15", 3); /* lea rdx, [entry] */
  trax_emit_distance(t, t->entry);
  trax_emit(t, "\xFF\x24\x4A", 3); /* jmp [rdx + rcx * 2] */
  /* If it is in another segment, or in none. */
  while (t->stub_count > first) {
    const struct trax_stub stub = t->stubs[--t->stub_count];
    if (stub.kind == TRAX_HOLE_COLD)
      trax_emit_cold(t, stub);
    else
      trax_set_distance(stub.place, t->at);
  }
  emit_exit(t, begin, end, TRAX_ANYWHERE);
  emit_leave(t);
}

/* Writes what follows the sequence that begins at `begin`. */
static void emit_stubs(struct trax_translation *t, size_t begin) {
  for (unsigned i = 0; i < t->stub_count; i++) {
    const struct trax_stub stub = t->stubs[i];
    size_t target;
    if (stub.kind == TRAX_HOLE_COLD) {
      trax_emit_cold(t, stub);
      continue;
    }
    trax_set_distance(stub.place, t->at);
    for (; i + 1 < t->stub_count && t->stubs[i + 1].index == stub.index && t->stubs[i + 1].kind == stub.kind; i++)
      trax_set_distance(t->stubs[i + 1].place, t->at);
    if (stub.kind == TRAX_HOLE_JUMPS && is_plain_jump(t, stub.index, &target)) {
      emit_jump(t, begin, stub.index + 1, target);
    } else {
      emit_exit(t, begin, stub.index, (uint32_t)stub.index | TRAX_IS_SLOW);
      emit_leave(t);
    }
  }
}

void trax_translate(struct trax_translation *t, size_t begin) {
  const uint8_t *const entry = t->at;
  size_t index = begin, target = 0, bytes = TRAX_MORE_CODE;
  bool goes_on = true;
  t->stub_count = 0;
  t->last = (struct trax_result){0, false};
  for (; goes_on; index++) {
    const struct trax_decoded *const inst = t->decoded[index];
    const bool is_relative = trax_op_table[inst->op].flags & TRAX_IS_RELATIVE;
    if (index > begin && t->entry[index] != t->leave) {
      emit_exit(t, begin, index, (uint32_t)index);
      trax_emit_byte(t, 0xE9);
      trax_emit_distance(t, t->entry[index]);
      break;
    }
    bytes += trax_most_code(inst) + TRAX_MORE_CODE;
    if (index - begin == TRAX_SEQUENCE || bytes > TRAX_SEQUENCE_CODE || trax_is_always_slow(inst) ||
        (is_relative && !is_plain_jump(t, index, &target))) {
      emit_exit(t, begin, index, (uint32_t)index | TRAX_IS_SLOW);
      emit_leave(t);
      break;
    }
    trax_emit_instruction(t, index);
    goes_on = trax_goes_on(inst);
    if (!goes_on && is_relative)
      emit_jump(t, begin, index + 1, target);
    else if (!goes_on)
      emit_jump_to(t, begin, index + 1);
  }
  emit_stubs(t, begin);
  assert(t->at - entry <= TRAX_SEQUENCE_CODE);
  t->entry[begin] = entry;
}
