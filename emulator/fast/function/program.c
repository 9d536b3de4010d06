#include "fast/function/burst.h"

#include <stdlib.h>

/* The resource that an instruction needs, as far as it does not depend on its address; 0 for memory accesses. */
static uint16_t step_of(const struct trax_decoded *decoded) {
  static const uint16_t own[] = {[TRAX_SHARED_FP_ADD] = TRAX_STEP_FP_ADD,
                                 [TRAX_SHARED_FP_MUL] = TRAX_STEP_FP_MUL,
                                 [TRAX_SHARED_INT_MUL] = TRAX_STEP_INT_MUL,
                                 [TRAX_SHARED_SPECIAL] = TRAX_STEP_SPECIAL};
  if (decoded->resource != TRAX_RESOURCE_UNIT)
    return 0;
  if (decoded->unit < TRAX_FAST_FURTHER)
    return own[decoded->unit];
  return (uint16_t)(TRAX_STEP_FURTHER | (decoded->unit - TRAX_FAST_FURTHER) << TRAX_STEP_BANK_SHIFT);
}

/* Whether an instruction always ends a burst: its result depends on time, or its effect is visible to other TPs. */
static bool stops_burst(const struct trax_decoded *decoded) {
  switch (decoded->op) {
  case TRAX_OP_RDSR:
    return decoded->imm == TRAX_SR_CYCLE || decoded->imm == TRAX_SR_CYCLEH;
  case TRAX_OP_TRAP:
  case TRAX_OP_HALT:
  case TRAX_OP_FENCE:
    return true;
  }
  return decoded->is_nontemporal || decoded->is_atomic;
}

/* Whether the relative jump at `word` of a segment of `words` leaves the segment, or goes to the next instruction or
   into the middle of one. burst_steps.h assumes that others do not. */
static bool jumps_oddly(const struct trax_decoded *decoded, uint32_t word, uint32_t words) {
  const int64_t target = word + (int64_t)decoded->imm / 4;
  return (trax_op_table[decoded->op].flags & TRAX_IS_RELATIVE) &&
         (decoded->imm % 4 || decoded->imm == 4 || target < 0 || target >= words);
}

/* Returns the mask of registers that must be usable before issue. A fence needs all of them. */
static uint32_t waits_for(const struct trax_decoded *decoded) {
  if (decoded->resource == TRAX_RESOURCE_FENCE)
    return ~1u;
  uint32_t mask = 1u << decoded->wait_rd;
  for (unsigned n = 0; n <= decoded->more_ra; n++)
    mask |= 1u << (decoded->wait_ra + n) % TRAX_NUM_REGISTERS;
  for (unsigned n = 0; n <= decoded->more_rb; n++)
    mask |= 1u << (decoded->wait_rb + n) % TRAX_NUM_REGISTERS;
  return mask & ~1u;
}

_Static_assert(sizeof(struct trax_fast_inst) == 16, "four to a line of the host's cache");

static void predecode(struct trax_fast_program *program, const struct trax_decoded *decoded, uint32_t index,
                      uint32_t pc, uint32_t line, bool stops) {
  const void *const *const operations = trax_fast_operations();
  const bool slow = decoded->resource != TRAX_RESOURCE_MEMORY && decoded->latency > 1;
  const uint8_t op = stops || stops_burst(decoded) ? TRAX_OP_ILLEGAL : decoded->op;
  program->inst[index] = (struct trax_fast_inst){.operation = operations[index % TRAX_CHUNK ? op : TRAX_OP_COUNT],
                                                 .op = op,
                                                 .rd = decoded->rd,
                                                 .ra = decoded->ra,
                                                 .rb = decoded->rb,
                                                 .imm = decoded->imm};
  program->timing[index] = (struct trax_fast_timing){.decoded = decoded, .waits = waits_for(decoded), .pc = pc};
  program->number[index] = (uint16_t)index;
  program->line[index] = (uint16_t)(line < TRAX_FAST_LINES ? line : TRAX_FAST_LINES - 1);
  program->step[index] =
      (uint16_t)(step_of(decoded) | (slow ? TRAX_STEP_SLOW : 0) | decoded->bank << TRAX_STEP_FETCH_SHIFT);
}

trax_status trax_fast_program_create(struct trax_fast_program *program, const struct trax_text *text,
                                     const struct trax_config *config, bool calls, trax_error *error) {
  const uint32_t line_bytes = config->icache.line_bytes;
  size_t total = 1;
  for (size_t i = 0; i < text->count; i++)
    total += (text->segments[i].end - text->segments[i].begin) / 4 + 1;
  program->inst_count = total;
  if (total >= (size_t)1 << 24)
    return trax_fail(error, "%zu instructions are too many for the fast engine", total);
  program->sections = calloc(text->count ? text->count : 1, sizeof *program->sections);
  program->inst = malloc(total * sizeof *program->inst);
  program->step = calloc(total + TRAX_CHUNK, sizeof *program->step);
  program->number = calloc(total + TRAX_CHUNK, sizeof *program->number);
  program->timing = malloc(total * sizeof *program->timing);
  program->line = malloc(total * sizeof *program->line);
  program->chunk_lines = calloc(total + 1, sizeof *program->chunk_lines);
  if (!program->sections || !program->inst || !program->timing || !program->line || !program->step ||
      !program->number || !program->chunk_lines)
    return trax_fail(error, "out of memory for %zu instructions", total);
  uint32_t index = 0, lines = 0;
  for (size_t i = 0; i < text->count; i++) {
    const struct trax_text_segment *section = &text->segments[i];
    const uint32_t words = (section->end - section->begin) / 4, first_line = section->begin / line_bytes;
    program->sections[program->count++] = (struct trax_fast_section){
        section->begin, words * 4, first_line, section->end / line_bytes, (uint16_t)lines, program->inst + index};
    for (uint32_t word = 0; word <= words; word++, index++) {
      const uint32_t pc = section->begin + word * 4;
      predecode(program, &section->decoded[word], index, pc, lines + pc / line_bytes - first_line,
                jumps_oddly(&section->decoded[word], word, words) ||
                    (calls && trax_changes_stack(&section->decoded[word])));
    }
    lines += section->end / line_bytes - first_line + 1;
    lines = lines < TRAX_FAST_LINES ? lines : TRAX_FAST_LINES;
  }
  program->lines = lines;
  program->no_text = &program->inst[index];
  predecode(program, trax_text_at(text, 1), index, 0, TRAX_FAST_LINES, true); /* an odd address is never text */
  for (size_t i = total; i-- > 0;) {
    const bool goes_on = (i + 1) % TRAX_CHUNK && program->inst[i].op != TRAX_OP_JAL; /* jalr may have no effect */
    program->chunk_lines[i] = (uint64_t)1 << program->line[i] % 64 | (goes_on ? program->chunk_lines[i + 1] : 0);
  }
  return TRAX_OK;
}

void trax_fast_program_destroy(struct trax_fast_program *program) {
  free(program->sections);
  free(program->inst);
  free(program->step);
  free(program->number);
  free(program->timing);
  free(program->line);
  free(program->chunk_lines);
}
