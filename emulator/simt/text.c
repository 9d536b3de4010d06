/* The program's text as the steps of a warp want it, decoded once. */
#include "simt/simt.h"

#include <stdlib.h>

/* Successive registers as a set. */
static uint32_t registers(unsigned first, unsigned count) {
  const uint64_t set = ((UINT64_C(1) << count) - 1) << first;
  return (uint32_t)(set | set >> TRAX_NUM_REGISTERS);
}

/* The registers that an instruction needs, as a set without r0, which is always usable. */
static uint32_t needs(const struct trax_decoded *inst) {
  if (inst->resource == TRAX_RESOURCE_FENCE)
    return ~1u;
  return (registers(inst->wait_ra, inst->more_ra + 1u) | registers(inst->wait_rb, inst->more_rb + 1u) |
          registers(inst->wait_rd, 1)) &
         ~1u;
}

/* Whether threads wait for others with it. */
static bool is_wait(const struct trax_decoded *inst) {
  return inst->resource == TRAX_RESOURCE_FENCE || inst->is_atomic || (inst->is_nontemporal && !inst->is_store);
}

/* Calls that it goes into, less those that it comes out of. */
static int8_t calls(const struct trax_decoded *inst) {
  enum { RA = 1 };
  if (inst->op == TRAX_OP_JAL || inst->op == TRAX_OP_JALR)
    return inst->rd == RA ? 1 : inst->op == TRAX_OP_JALR && inst->rd == TRAX_NO_REGISTER && inst->ra == RA ? -1 : 0;
  return 0;
}

static struct trax_simt_inst inst_of(const struct trax_decoded *decoded, uint32_t word) {
  return (struct trax_simt_inst){.decoded = decoded,
                                 .inst = trax_decode(word),
                                 .needs = needs(decoded),
                                 .calls = calls(decoded),
                                 .is_wait = is_wait(decoded)};
}

bool trax_simt_decode(struct trax_simt_chip *chip, const struct trax_text *text) {
  const uint32_t begin = text->count ? text->segments->begin : 0, end = text->count ? text->segments->end : 0;
  chip->inst = calloc((end - begin) / 4 + 1, sizeof *chip->inst);
  for (uint32_t pc = begin; chip->inst && pc < end; pc += 4) {
    uint32_t word = 0;
    trax_ref_text(chip->ref.tm, pc, &word);
    chip->inst[(pc - begin) / 4] = inst_of(&text->segments->decoded[(pc - begin) / 4], word);
  }
  for (uint32_t i = 0; chip->inst && i < chip->ref.tms; i++) {
    chip->tm[i].inst = chip->inst;
    chip->tm[i].inst_begin = begin;
    chip->tm[i].inst_count = (end - begin) / 4;
  }
  return chip->inst;
}

struct trax_simt_inst trax_simt_decode_at(const struct trax_simt_tm *tm, uint32_t pc) {
  uint32_t word = 0;
  trax_ref_text(tm->ref, pc, &word);
  return inst_of(trax_text_at(tm->text, pc), word);
}
