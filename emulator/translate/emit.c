#include "translate/internal.h"

#include <string.h>

enum { RAX, RCX, RDX, RBX, RSP, RBP, RSI, RDI, R8, R9, R10, R11, R12, R13, R14, R15 };

/* Registers that the templates' calling convention keeps, except for rbx, the state, and r15, the instructions left.
   With bursts, r14 points to the trax_burst, and r15 is the number of its steps so far. */
static const uint8_t kept[2][10] = {{RBP, RSI, RDI, R12, R13, R14}, {6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};
static const unsigned kept_count[2] = {6, 10};

void trax_emit(struct trax_translation *t, const void *bytes, size_t count) {
  memcpy(t->at, bytes, count);
  t->at += count;
}
void trax_emit_byte(struct trax_translation *t, unsigned byte) {
  *t->at++ = (uint8_t)byte;
}
void trax_emit_word(struct trax_translation *t, uint32_t word) {
  trax_emit(t, &word, sizeof word);
}

void trax_set_distance(uint8_t *place, const uint8_t *to) {
  const int32_t distance = (int32_t)(to - place - 4);
  memcpy(place, &distance, sizeof distance);
}
void trax_emit_distance(struct trax_translation *t, const void *to) {
  trax_set_distance(t->at, to);
  t->at += 4;
}

/* An operation of a register and another one, or trax_translated.reg[number]. */
static void emit_operation(struct trax_translation *t, unsigned prefix, unsigned operation, unsigned reg,
                           struct trax_place of) {
  const bool in_memory = of.kind == TRAX_IN_MEMORY;
  const unsigned rm = in_memory ? (unsigned)RBX : of.number;
  if (prefix)
    trax_emit_byte(t, prefix);
  if (reg > 7 || rm > 7)
    trax_emit_byte(t, 0x40 | reg >> 3 << 2 | rm >> 3);
  if (operation > 0xFF)
    trax_emit_byte(t, operation >> 8);
  trax_emit_byte(t, operation & 0xFF);
  const bool is_near = of.number < 32; /* a distance of one byte */
  trax_emit_byte(t, (in_memory ? is_near ? 0x40 : 0x80 : 0xC0) | (reg & 7) << 3 | (rm & 7));
  if (in_memory && is_near)
    trax_emit_byte(t, of.number * 4);
  else if (in_memory)
    trax_emit_word(t, of.number * 4);
}

void trax_emit_move(struct trax_translation *t, struct trax_place to, struct trax_place from) {
  if (to.kind == from.kind && to.number == from.number)
    return;
  if (to.kind == TRAX_IN_MEMORY && from.kind == TRAX_INT)
    emit_operation(t, 0, 0x89, from.number, to); /* mov */
  else if (to.kind == TRAX_IN_MEMORY)
    emit_operation(t, 0xF3, 0x0F11, from.number, to); /* movss */
  else if (from.kind == TRAX_ZERO)
    emit_operation(t, 0, to.kind == TRAX_INT ? 0x31 : 0x0F57, to.number, to); /* xor, xorps */
  else if (to.kind == TRAX_INT && from.kind == TRAX_FLOAT)
    emit_operation(t, 0x66, 0x0F7E, from.number, to); /* movd */
  else if (to.kind == TRAX_INT)
    emit_operation(t, 0, 0x8B, to.number, from); /* mov */
  else if (from.kind == TRAX_INT)
    emit_operation(t, 0x66, 0x0F6E, to.number, from); /* movd */
  else if (from.kind == TRAX_FLOAT)
    emit_operation(t, 0, 0x0F28, to.number, from); /* movaps */
  else
    emit_operation(t, 0xF3, 0x0F10, to.number, from); /* movss */
}

void trax_set_places(struct trax_translation *t, uint64_t weight[TRAX_NUM_REGISTERS + 1][2]) {
  for (unsigned n = 0; n < TRAX_NUM_REGISTERS; n++)
    t->place[n] = (struct trax_place){n ? TRAX_IN_MEMORY : TRAX_ZERO, n};
  for (unsigned kind = 0; kind < 2; kind++)
    for (unsigned i = 0; i < kept_count[kind] - (t->bursts && !kind); i++) {
      unsigned best = 0;
      weight[0][kind] = 0;
      for (unsigned n = 1; n < TRAX_NUM_REGISTERS; n++)
        if (t->place[n].kind == TRAX_IN_MEMORY && weight[n][kind] > weight[n][!kind] &&
            weight[n][kind] > weight[best][kind])
          best = n;
      if (best)
        t->place[best] = (struct trax_place){kind ? TRAX_FLOAT : TRAX_INT, kept[kind][i]};
    }
}

static void emit_places(struct trax_translation *t, bool to_memory) {
  for (unsigned n = 1; n < TRAX_NUM_REGISTERS; n++) {
    const struct trax_place memory = {TRAX_IN_MEMORY, n};
    if (t->place[n].kind != TRAX_IN_MEMORY)
      trax_emit_move(t, to_memory ? memory : t->place[n], to_memory ? t->place[n] : memory);
  }
}

void trax_emit_frame(struct trax_translation *t) {
  t->enter = t->at;
  /* push rbx, rbp, r12 to r15; sub rsp, 48: the space that the templates' convention gives to a callee, and alignment
   */
  trax_emit(t, "\x53\x55\x41\x54\x41\x55\x41\x56\x41\x57\x48\x83\xEC\x30", 14);
  trax_emit(t, "\x48\x89\xFB\x49\x89\xD7\x48\x89\xF0", 9); /* mov rbx, rdi; mov r15, rdx; mov rax, rsi */
  if (t->bursts)
    trax_emit(t, "\x49\x89\xCE", 3); /* mov r14, rcx */
  emit_places(t, false);
  trax_emit(t, "\xFF\xE0", 2); /* jmp rax */
  t->leave = t->at;
  emit_places(t, true);
  trax_emit(t, "\x4C\x89\xBB", 3); /* mov [rbx + left], r15 */
  trax_emit_word(t, offsetof(struct trax_translated, left));
  /* add rsp, 48; pop r15 to r12, rbp, rbx; ret */
  trax_emit(t, "\x48\x83\xC4\x30\x41\x5F\x41\x5E\x41\x5D\x41\x5C\x5D\x5B\xC3", 15);
}
