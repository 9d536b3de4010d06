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

/* Whether the interpreter must execute the instruction in every case. */
static bool is_slow(const struct trax_translation *t, size_t index) {
  size_t target;
  const struct trax_decoded *const inst = t->decoded[index];
  return trax_is_always_slow(inst) || (t->bursts && t->bursts->end_at_calls && trax_changes_stack(inst)) ||
         (trax_op_table[inst->op].flags & TRAX_IS_RELATIVE &&
          (!is_plain_jump(t, index, &target) || (t->bursts && inst->imm == 4))); /* bursts count no jump to the next */
}

/* Whether the sequence ends before this instruction: another one begins, or an interpreted instruction. */
static bool ends_before(const struct trax_translation *t, size_t index) {
  return (index > t->begin && t->entry[index] != t->leave) || is_slow(t, index) ||
         index - t->begin == (t->bursts ? TRAX_PIECE : TRAX_SEQUENCE);
}

static void emit_leave(struct trax_translation *t) {
  trax_emit_byte(t, 0xE9);
  trax_emit_distance(t, t->leave);
}

/* Counts the execution of the instructions [begin, end), which leads to `next`. */
static void emit_exit(struct trax_translation *t, size_t begin, size_t end, uint32_t next) {
  trax_emit_byte(t, 0xB8); /* mov eax, next */
  trax_emit_word(t, next);
  if (t->bursts) {
    trax_emit(t, "\x49\x83\xC7", 3); /* add r15, end - begin */
    trax_emit_byte(t, (unsigned)(end - begin));
    return;
  }
  trax_emit(t, "\x48\x83\x83", 3); /* add qword [rbx + executions[exit]], 1 */
  trax_emit_word(t, (uint32_t)(offsetof(struct trax_translated, executions) + sizeof(uint64_t) * t->exit_count));
  trax_emit_byte(t, 1);
  t->exits[t->exit_count++] = (struct trax_exit){(uint32_t)begin, (uint32_t)end};
  trax_emit(t, "\x49\x81\xEF", 3); /* sub r15, end - begin */
  trax_emit_word(t, (uint32_t)(end - begin));
}

/* Continues with the sequence that begins at `target`, or leaves: eax has its index. */
static void emit_go_to(struct trax_translation *t, size_t target) {
  if (t->entry[target] != t->leave) {
    trax_emit_byte(t, 0xE9); /* jmp entry */
    trax_emit_distance(t, t->entry[target]);
  } else {
    trax_emit(t, "\xFF\x25", 2); /* jmp [entry] */
    trax_emit_distance(t, &t->entry[target]);
  }
}

/* A taken jump behind the instructions [begin, end) to an instruction. */
static void emit_jump(struct trax_translation *t, size_t begin, size_t end, size_t target) {
  emit_exit(t, begin, end, (uint32_t)target);
  if (t->bursts) {
    trax_emit_taken(t, end, &target);
  } else {
    trax_emit(t, "\x0F\x8E", 2); /* jle leave */
    trax_emit_distance(t, t->leave);
  }
  emit_go_to(t, target);
}

/* A jump to the pc in edx. */
static void emit_jump_to(struct trax_translation *t, size_t begin, size_t end) {
  trax_emit(t, "\x89\xD1", 2); /* mov ecx, edx */
  const unsigned first = t->stub_count;
  trax_emit_template(t, &trax_templates[TRAX_OP_LOOKUP][0], end - 1);
  uint8_t *to_next = NULL;
  if (t->bursts) {
    trax_emit(t, "\x81\xF9", 2); /* cmp ecx, end: no jump then */
    trax_emit_word(t, (uint32_t)end * 4);
    trax_emit(t, "\x0F\x84\0\0\0", 6); /* je */
    to_next = t->at - 4;
  }
  emit_exit(t, begin, end, TRAX_ANYWHERE);
  if (t->bursts) {
    trax_emit_taken(t, end, NULL);
  } else {
    trax_emit(t, "\x0F\x8E", 2); /* jle leave */
    trax_emit_distance(t, t->leave);
  }
  trax_emit(t, "\x48\x8D\x15", 3); /* lea rdx, [entry] */
  trax_emit_distance(t, t->entry);
  trax_emit(t, "\xFF\x24\x4A", 3); /* jmp [rdx + rcx * 2] */
  if (to_next) {
    trax_set_distance(to_next, t->at);
    emit_exit(t, begin, end, (uint32_t)end);
    emit_leave(t);
  }
  /* If it is in another segment, or in none. */
  while (t->stub_count > first) {
    const struct trax_stub stub = t->stubs[--t->stub_count];
    if (stub.kind == TRAX_HOLE_COLD)
      trax_emit_cold(t, stub);
    else
      trax_set_distance(stub.place, t->at);
  }
  emit_exit(t, begin, end, TRAX_ANYWHERE | TRAX_IS_SLOW);
  emit_leave(t);
}

/* Writes the exits and cold parts of the sequence that begins at `begin`. */
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
  size_t index = begin, target = 0, bytes = TRAX_MORE_CODE, count = 0;
  bool goes_on = true;
  t->begin = begin;
  t->stub_count = 0;
  t->last = (struct trax_result){0, false};
  while (t->bursts && !ends_before(t, begin + count) && (!count || trax_goes_on(t->decoded[begin + count - 1])))
    count++;
  const uint8_t *const entry = t->bursts ? trax_emit_record(t, begin, count) : t->at;
  for (; goes_on; index++) {
    const struct trax_decoded *const inst = t->decoded[index];
    bytes += trax_most_code(t, inst) + TRAX_MORE_CODE;
    if (ends_before(t, index) || bytes > TRAX_SEQUENCE_CODE) {
      const bool slow = is_slow(t, index) || bytes > TRAX_SEQUENCE_CODE || (!t->bursts && t->entry[index] == t->leave);
      emit_exit(t, begin, index, (uint32_t)index | (slow ? TRAX_IS_SLOW : 0));
      if (slow)
        emit_leave(t);
      else
        emit_go_to(t, index);
      break;
    }
    trax_emit_instruction(t, index);
    goes_on = trax_goes_on(inst);
    if (!goes_on && trax_op_table[inst->op].flags & TRAX_IS_RELATIVE && is_plain_jump(t, index, &target))
      emit_jump(t, begin, index + 1, target);
    else if (!goes_on)
      emit_jump_to(t, begin, index + 1);
  }
  emit_stubs(t, begin);
  assert(t->at - entry <= TRAX_SEQUENCE_CODE);
  t->entry[begin] = entry;
  if (t->bursts) {
    for (size_t i = begin; i < index; i++)
      if (trax_op_table[t->decoded[i]->op].flags & TRAX_IS_RELATIVE && is_plain_jump(t, i, &target))
        trax_translation_add(t, target);
    if (goes_on && !is_slow(t, index))
      trax_translation_add(t, index);
  }
}
