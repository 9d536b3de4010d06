#include "translate/internal.h"

#include <string.h>

static void add_stub(struct trax_translation *t, struct trax_stub stub) {
  t->stubs[t->stub_count++] = stub;
}

/* Copies a part of the template of the instruction `index`. Its hot part is at [hot, hot_end); cold: its cold part. */
static void emit_part(struct trax_translation *t, const struct trax_template_part *part, size_t index,
                      const uint8_t *hot, const uint8_t *hot_end) {
  uint8_t *const begin = t->at;
  trax_emit(t, part->code, part->bytes);
  for (unsigned i = 0; i < part->hole_count; i++) {
    const struct trax_template_hole hole = part->holes[i];
    uint8_t *const place = begin + hole.offset;
    uint32_t value = (uint32_t)hole.addend;
    switch ((enum trax_hole_kind)hole.kind) {
    case TRAX_HOLE_GOES_ON:
      value += (uint32_t)(hot_end - place);
      break;
    case TRAX_HOLE_JUMPS:
    case TRAX_HOLE_SLOW:
      add_stub(t, (struct trax_stub){hole.kind, place, NULL, NULL, index});
      break;
    case TRAX_HOLE_HOT:
      value += (uint32_t)(hot - place);
      break;
    case TRAX_HOLE_COLD: /* in the hot part: trax_emit_cold fills it in */
      value += (uint32_t)(begin - place);
      break;
    case TRAX_HOLE_POOL:
      value += (uint32_t)(t->pool - place);
      break;
    case TRAX_HOLE_IMM:
      value += (uint32_t)t->decoded[index]->imm;
      break;
    case TRAX_HOLE_PC:
      value += t->pc[index];
      break;
    case TRAX_HOLE_PRECISION:
      value += t->precision;
      break;
    case TRAX_HOLE_MINUS_INPUT:
      value -= t->space->input;
      break;
    case TRAX_HOLE_INPUT_BYTES:
      value += t->space->input_bytes;
      break;
    case TRAX_HOLE_STEP_AT:
      value += (uint32_t)(offsetof(struct trax_burst, step) + (index - t->begin) * sizeof(uint16_t));
      break;
    case TRAX_HOLE_STEP:
      value += t->bursts->step[index] | t->bursts->load_step;
      break;
    case TRAX_HOLE_BANK_MASK:
      value += t->bursts->bank_mask;
      break;
    case TRAX_HOLE_LOCAL_STEP:
      value += t->bursts->step[index] | t->bursts->slow_local;
      break;
    case TRAX_HOLES:
      break;
    }
    memcpy(place, &value, sizeof value);
  }
}

/* Returns the templates of an operation, [TRAX_VARIANTS]. */
static const struct trax_template *templates_of(const struct trax_translation *t, unsigned op) {
  return t->bursts && trax_burst_templates[op][0].hot.bytes ? trax_burst_templates[op] : trax_templates[op];
}

void trax_emit_template(struct trax_translation *t, const struct trax_template *template, size_t index) {
  uint8_t *const begin = t->at;
  emit_part(t, &template->hot, index, begin, begin + template->hot.bytes);
  if (template->cold.bytes)
    add_stub(t, (struct trax_stub){TRAX_HOLE_COLD, begin, t->at, template, index});
}

/* Copies the cold part of a template, and sets the jumps of its hot part to it. */
void trax_emit_cold(struct trax_translation *t, struct trax_stub stub) {
  const struct trax_template_part *const hot = &stub.template->hot;
  for (unsigned i = 0; i < hot->hole_count; i++)
    if (hot->holes[i].kind == TRAX_HOLE_COLD) {
      uint8_t *const place = stub.place + hot->holes[i].offset;
      const uint32_t value = (uint32_t)(t->at - place + hot->holes[i].addend);
      memcpy(place, &value, sizeof value);
    }
  emit_part(t, &stub.template->cold, stub.index, stub.place, stub.end);
}

/* The registers of a template's operands a, b and the earlier value of its result: ecx, edx and r8d, or xmm0, xmm1 and
   xmm2. The result is in ecx or xmm0. */
static const struct trax_place operands[2][3] = {{{TRAX_INT, 1}, {TRAX_INT, 2}, {TRAX_INT, 8}},
                                                 {{TRAX_FLOAT, 0}, {TRAX_FLOAT, 1}, {TRAX_FLOAT, 2}}};

/* The place from which the value of a register of the thread is moved to a register of the kind `is_float`: its own
   place, or the register of the previous instruction's result. */
static struct trax_place source(const struct trax_translation *t, unsigned n, bool is_float, struct trax_result last) {
  if (n == 0)
    return (struct trax_place){TRAX_ZERO, 0};
  return n == last.n && (last.is_float == is_float || t->place[n].kind == TRAX_IN_MEMORY) ? operands[last.is_float][0]
                                                                                          : t->place[n];
}

/* The cost of a move, in bytes. A move between the kinds of registers takes several cycles and costs more. */
static unsigned move_cost(struct trax_place from, bool is_float) {
  return from.kind == (is_float ? TRAX_INT : TRAX_FLOAT) ? 16 : 4;
}

/* The cost of the variant v of an instruction's template. */
static unsigned cost(const struct trax_translation *t, const struct trax_decoded *inst, unsigned v,
                     struct trax_result last) {
  const unsigned flags = trax_op_table[inst->op].flags;
  const bool a = v & TRAX_FLOAT_A, b = v & TRAX_FLOAT_B, d = v & TRAX_FLOAT_D;
  unsigned sum = templates_of(t, inst->op)[v].hot.bytes;
  if (flags & TRAX_READS_RA)
    sum += move_cost(source(t, inst->ra, a, last), a);
  if (flags & TRAX_READS_RB)
    sum += move_cost(source(t, inst->rb, b, last), b);
  if (flags & TRAX_READS_RD)
    sum += move_cost(source(t, inst->rd % TRAX_NO_REGISTER, d, last), d);
  if (flags & TRAX_WRITES_RD && inst->rd != TRAX_NO_REGISTER)
    sum += t->place[inst->rd].kind == (d ? TRAX_INT : TRAX_FLOAT) ? 8 : 4; /* nothing waits for it */
  return sum;
}

static unsigned least_cost(const struct trax_translation *t, const struct trax_decoded *inst, struct trax_result last) {
  unsigned least = UINT32_MAX;
  for (unsigned v = 0; v < TRAX_VARIANTS; v++) {
    const unsigned it = cost(t, inst, v, last);
    least = it < least ? it : least;
  }
  return least;
}

/* Returns the variant of the template of instruction `index` that costs least together with the next instruction. */
static unsigned variant_of(const struct trax_translation *t, size_t index) {
  const struct trax_decoded *const inst = t->decoded[index], *const next = t->decoded[index + 1];
  unsigned least[2] = {UINT32_MAX, UINT32_MAX}, best[2] = {0, 0}; /* by the kind of the result */
  for (unsigned v = 0; v < TRAX_VARIANTS; v++) {
    const bool d = v & TRAX_FLOAT_D;
    const unsigned it = cost(t, inst, v, t->last);
    if (it < least[d]) {
      least[d] = it;
      best[d] = v;
    }
  }
  if (inst->rd != TRAX_NO_REGISTER && trax_op_table[inst->op].flags & TRAX_WRITES_RD &&
      (next->ra == inst->rd || next->rb == inst->rd))
    for (unsigned d = 0; d < 2; d++)
      least[d] += least_cost(t, next, (struct trax_result){inst->rd, d});
  return best[least[1] < least[0]];
}

bool trax_is_always_slow(const struct trax_decoded *inst) {
  const struct trax_template *const template = &trax_templates[inst->op][0];
  const unsigned flags = trax_op_table[inst->op].flags;
  if (flags & TRAX_IS_BRANCH && flags & TRAX_WRITES_RD && template->goes_on)
    return true; /* a jump that may go on and has a result: there is none */
  return inst->resource == TRAX_RESOURCE_ILLEGAL || inst->resource == TRAX_RESOURCE_NO_TEXT ||
         (template->hot.bytes == 5 && template->hot.hole_count == 1 && template->hot.holes[0].kind == TRAX_HOLE_SLOW);
}

size_t trax_most_code(const struct trax_translation *t, const struct trax_decoded *inst) {
  size_t most = 0;
  for (unsigned v = 0; v < TRAX_VARIANTS; v++) {
    const struct trax_template *const template = &templates_of(t, inst->op)[v];
    const size_t bytes = (size_t)template->hot.bytes + template->cold.bytes;
    most = bytes > most ? bytes : most;
  }
  return most;
}

bool trax_goes_on(const struct trax_decoded *inst) {
  return !(trax_op_table[inst->op].flags & TRAX_IS_BRANCH) || trax_templates[inst->op][0].goes_on;
}

/* Copies `count` registers from n on to where the template finds them; a group of one is an operand. */
static void emit_group(struct trax_translation *t, unsigned n, unsigned count, unsigned at) {
  for (unsigned i = 0; i < count && count > 1; i++) {
    struct trax_place from = t->place[(n + i) % TRAX_NUM_REGISTERS];
    if (from.kind == TRAX_IN_MEMORY || from.kind == TRAX_ZERO) {
      trax_emit_move(t, operands[0][1], from);
      from = operands[0][1];
    }
    trax_emit_move(t, (struct trax_place){TRAX_IN_MEMORY, at + i}, from);
  }
}

void trax_emit_instruction(struct trax_translation *t, size_t index) {
  const struct trax_decoded *const inst = t->decoded[index];
  const unsigned flags = trax_op_table[inst->op].flags, v = variant_of(t, index);
  const bool a = v & TRAX_FLOAT_A, b = v & TRAX_FLOAT_B, d = v & TRAX_FLOAT_D;
  emit_group(t, inst->ra, trax_group_a(flags), TRAX_GROUP_A_AT);
  emit_group(t, inst->rb, trax_group_b(flags), TRAX_GROUP_B_AT);
  if (trax_group_a(flags) > 1 || trax_group_b(flags) > 1)
    trax_emit(t, "\x49\x89\xD9", 3); /* mov r9, rbx */
  /* The first operand comes last: the latest result is in its register. */
  if (flags & TRAX_READS_RB)
    trax_emit_move(t, operands[b][1], source(t, inst->rb, b, t->last));
  if (flags & TRAX_READS_RD)
    trax_emit_move(t, operands[d][2], source(t, inst->rd % TRAX_NO_REGISTER, d, t->last));
  if (flags & TRAX_READS_RA)
    trax_emit_move(t, operands[a][0], source(t, inst->ra, a, t->last));
  trax_emit_template(t, &templates_of(t, inst->op)[v], index);
  if (!trax_goes_on(inst))
    trax_set_distance(t->stubs[--t->stub_count].place, t->at);
  t->last = (struct trax_result){0, false};
  if (flags & TRAX_WRITES_RD && inst->rd != TRAX_NO_REGISTER) {
    trax_emit_move(t, t->place[inst->rd], operands[d][0]);
    t->last = (struct trax_result){inst->rd, d};
  }
}

void trax_add_weight(const struct trax_decoded *inst, uint64_t count, uint64_t weight[TRAX_NUM_REGISTERS + 1][2]) {
  const unsigned flags = trax_op_table[inst->op].flags;
  const struct {
    unsigned number, variant;
  } operand[3] = {{flags & TRAX_READS_RA ? inst->ra : 0, TRAX_FLOAT_A},
                  {flags & TRAX_READS_RB ? inst->rb : 0, TRAX_FLOAT_B},
                  {flags & TRAX_WRITES_RD ? inst->rd : 0, TRAX_FLOAT_D}};
  for (unsigned n = 0; n < 3; n++) {
    unsigned least[2] = {UINT32_MAX, UINT32_MAX}; /* bytes of a template, if the operand is an integer or a float */
    for (unsigned v = 0; v < TRAX_VARIANTS; v++) {
      unsigned *const it = &least[(v & operand[n].variant) != 0];
      *it = trax_templates[inst->op][v].hot.bytes < *it ? trax_templates[inst->op][v].hot.bytes : *it;
    }
    weight[operand[n].number][0] += least[0] <= least[1] ? count : 0;
    weight[operand[n].number][1] += least[1] <= least[0] ? count : 0;
  }
}
