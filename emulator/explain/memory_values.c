/* The shadow of results: the bits that depend on memory that was never written, and the object to which a pointer
   belongs. The bits are those of Seward and Nethercote, "Using Valgrind to detect undefined value errors with
   bit-precision", USENIX 2005. */
#include "explain/memory_check.h"

typedef struct trax_memory_value value;

/* The bits from the lowest one on. */
static uint32_t upwards(uint32_t bits) {
  return bits | -bits;
}

static uint32_t least(value a) {
  return a.bits & ~a.undefined;
}

static uint32_t greatest(value a) {
  return a.bits | a.undefined;
}

static value signed_order(value a) {
  a.bits ^= 0x80000000u;
  return a;
}

static bool order_is_undefined(value a, value b) {
  return (a.undefined || b.undefined) && greatest(a) >= least(b) && least(a) < greatest(b);
}

static bool equality_is_undefined(value a, value b) {
  const uint32_t undefined = a.undefined | b.undefined;
  return undefined && !((a.bits ^ b.bits) & ~undefined);
}

bool trax_memory_branch_is_undefined(const struct trax_memory_thread *thread, trax_inst inst) {
  const value a = thread->reg[inst.ra], b = thread->reg[inst.rb];
  switch (inst.op) {
  case TRAX_OP_BEQ:
  case TRAX_OP_BNE:
    return equality_is_undefined(a, b);
  case TRAX_OP_BLT:
  case TRAX_OP_BGE:
    return order_is_undefined(signed_order(a), signed_order(b));
  default:
    return order_is_undefined(a, b);
  }
}

/* The undefined bits of the smaller or greater one of a and b, which may be known. */
static uint32_t chosen_is_undefined(trax_op op, value a, value b) {
  const bool is_signed = op == TRAX_OP_MIN || op == TRAX_OP_MAX,
             least_is_wanted = op == TRAX_OP_MIN || op == TRAX_OP_MINU;
  const value first = is_signed ? signed_order(a) : a, second = is_signed ? signed_order(b) : b;
  if (order_is_undefined(first, second))
    return a.undefined | b.undefined | (a.bits ^ b.bits);
  return (first.bits < second.bits) == least_is_wanted ? a.undefined : b.undefined;
}

static uint32_t shifted(trax_op op, uint32_t bits, uint32_t by) {
  if (op == TRAX_OP_SLL || op == TRAX_OP_SLLI)
    return bits << by;
  if (op == TRAX_OP_SRL || op == TRAX_OP_SRLI)
    return bits >> by;
  return (bits >> by) | (bits & 0x80000000u && by ? ~0u << (32 - by) : 0);
}

static uint32_t undefined_of(trax_inst inst, value a, value b, value old) {
  const uint32_t either = a.undefined | b.undefined;
  switch (inst.op) {
  case TRAX_OP_CMOVNZ: /* a is the value, b the condition */
  case TRAX_OP_CMOVZ:
    if (b.undefined && !(b.bits & ~b.undefined))
      return a.undefined | old.undefined | (a.bits ^ old.bits);
    return (b.bits != 0) == (inst.op == TRAX_OP_CMOVNZ) ? a.undefined : old.undefined;
  case TRAX_OP_FTRI: /* groups of registers are counted by the caller in a; rd may be kept */
  case TRAX_OP_FBOX:
    return either | old.undefined ? ~0u : 0;
  default:
    break;
  }
  if (!either)
    return 0;
  switch (inst.op) {
  case TRAX_OP_ADD:
  case TRAX_OP_ADDI:
    return ((least(a) + least(b)) ^ (greatest(a) + greatest(b))) | either;
  case TRAX_OP_SUB:
    return ((least(a) - greatest(b)) ^ (greatest(a) - least(b))) | either;
  case TRAX_OP_AND:
  case TRAX_OP_ANDI:
    return either & greatest(a) & greatest(b);
  case TRAX_OP_OR:
  case TRAX_OP_ORI:
    return either & ~(least(a) | least(b));
  case TRAX_OP_XOR:
  case TRAX_OP_XORI:
    return inst.ra == inst.rb && inst.op == TRAX_OP_XOR ? 0 : either;
  case TRAX_OP_SLL:
  case TRAX_OP_SRL:
  case TRAX_OP_SRA:
  case TRAX_OP_SLLI:
  case TRAX_OP_SRLI:
  case TRAX_OP_SRAI:
    return b.undefined & 31 ? ~0u : shifted(inst.op, a.undefined, b.bits & 31);
  case TRAX_OP_SLT:
  case TRAX_OP_SLTI:
    return order_is_undefined(signed_order(a), signed_order(b));
  case TRAX_OP_SLTU:
  case TRAX_OP_SLTIU:
    return order_is_undefined(a, b);
  case TRAX_OP_FEQ:
  case TRAX_OP_FLT:
  case TRAX_OP_FLE:
    return 1;
  case TRAX_OP_MIN:
  case TRAX_OP_MAX:
  case TRAX_OP_MINU:
  case TRAX_OP_MAXU:
    return chosen_is_undefined(inst.op, a, b);
  case TRAX_OP_MUL:
    return (a.bits | a.undefined) && (b.bits | b.undefined) ? upwards(either) : 0;
  default:
    return ~0u;
  }
}

/* --- pointers --- */

static bool is_inside(const struct trax_memory_check *check, uint32_t tag, uint32_t bits) {
  const struct trax_memory_object *object = &check->objects[tag];
  return object->kind != MEMORY_HALF && bits - object->begin <= object->end - object->begin;
}

static uint32_t tag_of_sum(const struct trax_memory_check *check, uint32_t a, uint32_t b) {
  if (!a || !b)
    return a | b;
  if (a == MEMORY_MIXED || b == MEMORY_MIXED)
    return MEMORY_MIXED;
  /* A constant that looks like an address may be a number; a block's address is none. */
  const bool block_a = check->objects[a].kind == MEMORY_BLOCK, block_b = check->objects[b].kind == MEMORY_BLOCK;
  return block_a == block_b ? MEMORY_MIXED : block_a ? a : b;
}

static uint32_t tag_of(struct trax_memory_check *check, const struct trax_span *span, value a, value b, value old) {
  const trax_inst inst = span->inst;
  const uint32_t result = span->issue->result;
  switch (inst.op) {
  case TRAX_OP_LUI:
    return trax_memory_tag_of_half(check, result);
  case TRAX_OP_ADDI:
    if (a.tag >= MEMORY_FIRST_OBJECT && check->objects[a.tag].kind == MEMORY_HALF)
      return trax_memory_tag_of_address(check, check->objects[a.tag].begin + (uint32_t)inst.imm);
    if ((inst.ra == 2 || inst.ra == 3) && inst.rd != 2)
      return trax_memory_tag_of_frame(check, span->pc, inst.ra, inst.imm, result);
    return a.tag;
  case TRAX_OP_ADD:
    if (inst.ra == 2 || inst.rb == 2 || inst.ra == 3 || inst.rb == 3)
      return MEMORY_NO_TAG; /* a large distance in a frame */
    return tag_of_sum(check, a.tag, b.tag);
  case TRAX_OP_SUB:
    return a.tag == b.tag && a.tag >= MEMORY_FIRST_OBJECT ? MEMORY_NO_TAG : b.tag ? MEMORY_MIXED : a.tag;
  case TRAX_OP_AND:
  case TRAX_OP_OR:
  case TRAX_OP_ANDI:
  case TRAX_OP_ORI:
    if (!a.tag || !b.tag) {
      const uint32_t tag = a.tag | b.tag;
      return tag >= MEMORY_FIRST_OBJECT && is_inside(check, tag, result) ? tag : MEMORY_NO_TAG;
    }
    return MEMORY_MIXED;
  case TRAX_OP_CMOVNZ:
  case TRAX_OP_CMOVZ:
    return (b.bits != 0) == (inst.op == TRAX_OP_CMOVNZ) ? a.tag : old.tag;
  case TRAX_OP_MIN:
  case TRAX_OP_MAX:
  case TRAX_OP_MINU:
  case TRAX_OP_MAXU:
    return result == a.bits ? a.tag : b.tag;
  default:
    return MEMORY_NO_TAG;
  }
}

struct trax_memory_value trax_memory_result(struct trax_memory_check *check, const struct trax_memory_thread *thread,
                                            const struct trax_span *span) {
  const trax_inst inst = span->inst;
  const unsigned flags = trax_op_table[inst.op].flags;
  const value old = thread->reg[inst.rd];
  value a = flags & TRAX_READS_RA ? thread->reg[inst.ra] : (value){0};
  value b = flags & TRAX_READS_RB ? thread->reg[inst.rb] : (value){.bits = (uint32_t)inst.imm};
  for (unsigned i = 1; i < trax_group_a(flags); i++)
    a.undefined |= thread->reg[(inst.ra + i) % TRAX_NUM_REGISTERS].undefined;
  for (unsigned i = 1; i < trax_group_b(flags); i++)
    b.undefined |= thread->reg[(inst.rb + i) % TRAX_NUM_REGISTERS].undefined;
  value result = {.bits = span->issue->result};
  result.undefined = undefined_of(inst, a, b, old);
  if (result.undefined)
    result.from = a.undefined ? a.from : b.undefined ? b.from : old.from;
  result.tag = tag_of(check, span, a, b, old);
  return result;
}
