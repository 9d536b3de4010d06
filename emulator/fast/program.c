#include "fast/fast.h"

/* A load of global memory, unless its address says otherwise; global stores never run ahead. */
static uint16_t asks_of(const struct trax_decoded *decoded) {
  switch ((trax_ask)decoded->ask) {
  case TRAX_ASK_FP_ADD:
    return TRAX_ASKS_FP_ADD;
  case TRAX_ASK_FP_MUL:
    return TRAX_ASKS_FP_MUL;
  case TRAX_ASK_INT_MUL:
    return TRAX_ASKS_INT_MUL;
  case TRAX_ASK_SPECIAL:
    return TRAX_ASKS_SPECIAL;
  case TRAX_ASK_MEMORY:
    return decoded->is_store ? 0 : TRAX_ASKS_BANK;
  default:
    return 0;
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

_Static_assert(sizeof(struct trax_fast_step) == 16, "four to a line of the host's cache");
_Static_assert(sizeof(struct trax_fast_inst) == 32, "two to a line of the host's cache");

static struct trax_fast_inst predecode(const struct trax_decoded *decoded, uint32_t index, uint32_t line) {
  const bool slow = decoded->ask != TRAX_ASK_MEMORY && decoded->latency > 1;
  return (struct trax_fast_inst){
      .step = {.waits = (1u << decoded->wait_ra | 1u << decoded->wait_rb | 1u << decoded->wait_rd) & ~1u,
               .index = index,
               .line = (uint16_t)(line < TRAX_FAST_LINES ? line : TRAX_FAST_LINES - 1),
               .asks = (uint16_t)(asks_of(decoded) | (slow ? TRAX_ASKS_SLOWLY : 0)),
               .bank = decoded->bank},
      .op = stops_burst(decoded) ? TRAX_OP_ILLEGAL : decoded->op,
      .rd = decoded->rd,
      .ra = decoded->ra,
      .rb = decoded->rb,
      .imm = decoded->imm,
      .decoded = decoded,
  };
}

trax_status trax_fast_program_create(struct trax_fast_program *program, const struct trax_text *text,
                                     const struct trax_config *config, trax_error *error) {
  const uint32_t line_bytes = config->icache.line_bytes;
  size_t total = 1;
  for (size_t i = 0; i < text->count; i++)
    total += (text->sections[i].end - text->sections[i].begin) / 4 + 1;
  program->inst_count = total;
  if (total >= (size_t)1 << 24)
    return trax_fail(error, "%zu instructions are too many for the fast engine", total);
  program->sections = calloc(text->count ? text->count : 1, sizeof *program->sections);
  program->inst = malloc(total * sizeof *program->inst);
  program->pc = malloc(total * sizeof *program->pc);
  if (!program->sections || !program->inst || !program->pc)
    return trax_fail(error, "out of memory for %zu instructions", total);
  uint32_t index = 0, lines = 0;
  for (size_t i = 0; i < text->count; i++) {
    const struct trax_text_section *section = &text->sections[i];
    const uint32_t words = (section->end - section->begin) / 4, first_line = section->begin / line_bytes;
    program->sections[program->count++] =
        (struct trax_fast_section){section->begin, words * 4, first_line, (uint16_t)lines, program->inst + index};
    for (uint32_t word = 0; word <= words; word++, index++) {
      const uint32_t pc = section->begin + word * 4;
      program->inst[index] = predecode(&section->decoded[word], index, lines + pc / line_bytes - first_line);
      program->pc[index] = pc;
    }
    lines += section->end / line_bytes - first_line + 1;
    lines = lines < TRAX_FAST_LINES ? lines : TRAX_FAST_LINES - 1;
  }
  program->lines = lines;
  program->outside = &program->inst[index];
  *program->outside = predecode(trax_text_at(text, 1), index, TRAX_FAST_LINES); /* none is at an odd address */
  program->pc[index] = 0;
  return TRAX_OK;
}

void trax_fast_program_destroy(struct trax_fast_program *program) {
  free(program->sections);
  free(program->inst);
  free(program->pc);
}
