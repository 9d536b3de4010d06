#include "fast/fast.h"

static trax_fast_class class_of(const struct trax_decoded *decoded) {
  switch ((trax_ask)decoded->ask) {
  case TRAX_ASK_NOTHING:
    return TRAX_CLASS_OWN;
  case TRAX_ASK_FP_ADD:
    return TRAX_CLASS_FP_ADD;
  case TRAX_ASK_FP_MUL:
    return TRAX_CLASS_FP_MUL;
  case TRAX_ASK_INT_MUL:
    return TRAX_CLASS_INT_MUL;
  case TRAX_ASK_SPECIAL:
    return TRAX_CLASS_SPECIAL;
  case TRAX_ASK_MEMORY: /* global stores never run ahead */
    return decoded->is_store ? TRAX_CLASS_LOCAL_STORE : TRAX_CLASS_BANK;
  default:
    return TRAX_CLASS_DEFERRED;
  }
}

/* What depends on time, or acts on anything outside the TP, whatever its operands. */
static bool stops_burst(const struct trax_decoded *decoded) {
  switch (decoded->op) {
  case TRAX_OP_RDSR:
    return decoded->imm == TRAX_SR_CYCLE || decoded->imm == TRAX_SR_CYCLEH;
  case TRAX_OP_TRAP:
  case TRAX_OP_HALT:
    return true;
  }
  return decoded->is_nontemporal || decoded->is_atomic;
}

_Static_assert(sizeof(struct trax_fast_inst) == 32, "two to a line of the host's cache");

static struct trax_fast_inst predecode(const struct trax_decoded *decoded, uint32_t pc,
                                       const struct trax_config *config) {
  const bool memory = decoded->ask == TRAX_ASK_MEMORY;
  return (struct trax_fast_inst){
      .op = stops_burst(decoded) ? TRAX_OP_ILLEGAL : decoded->op,
      .rd = decoded->rd,
      .ra = decoded->ra,
      .rb = decoded->rb,
      .imm = decoded->imm,
      .waits = (1u << decoded->wait_ra | 1u << decoded->wait_rb | 1u << decoded->wait_rd) & ~1u,
      .class = (uint8_t)class_of(decoded),
      .bank = decoded->bank,
      .cause = memory ? TRAX_CAUSE_DATA_LOCAL : decoded->cause,
      .latency = memory ? (uint16_t)config->tp.local_latency_cycles : decoded->latency,
      .starts_line = pc % config->icache.line_bytes == 0,
      .pc = pc,
      .decoded = decoded,
  };
}

trax_status trax_fast_program_create(struct trax_fast_program *program, const struct trax_text *text,
                                     const struct trax_config *config, trax_error *error) {
  size_t total = 1;
  for (size_t i = 0; i < text->count; i++)
    total += (text->sections[i].end - text->sections[i].begin) / 4 + 1;
  program->sections = calloc(text->count ? text->count : 1, sizeof *program->sections);
  program->inst = malloc(total * sizeof *program->inst);
  if (!program->sections || !program->inst)
    return trax_fail(error, "out of memory for %zu instructions", total);
  struct trax_fast_inst *inst = program->inst;
  for (size_t i = 0; i < text->count; i++) {
    const struct trax_text_section *section = &text->sections[i];
    const uint32_t words = (section->end - section->begin) / 4;
    program->sections[program->count++] = (struct trax_fast_section){section->begin, words * 4, inst};
    for (uint32_t word = 0; word <= words; word++)
      *inst++ = predecode(&section->decoded[word], section->begin + word * 4, config);
  }
  *inst = predecode(trax_text_at(text, 1), 0, config); /* no instruction is at an odd address */
  program->outside = inst;
  return TRAX_OK;
}

void trax_fast_program_destroy(struct trax_fast_program *program) {
  free(program->sections);
  free(program->inst);
}
