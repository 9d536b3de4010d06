#include "machine/text.h"

#include "machine/machine.h"
#include "machine/timing.h"

#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(struct trax_decoded) <= 20,
               "decoded instructions should stay small: they are the host's hot data");

static const struct trax_decoded no_text = {.resource = TRAX_RESOURCE_NO_TEXT, .rd = TRAX_NO_REGISTER};

static trax_resource resource_of(const trax_inst *inst, const struct trax_timing *timing) {
  const trax_op_info *info = &trax_op_table[inst->op];
  if (inst->op == TRAX_OP_ILLEGAL)
    return TRAX_RESOURCE_ILLEGAL;
  if (inst->op == TRAX_OP_HALT || (inst->op == TRAX_OP_TRAP && inst->imm == TRAX_TRAP_EXIT))
    return TRAX_RESOURCE_END;
  if (inst->op == TRAX_OP_FENCE)
    return TRAX_RESOURCE_FENCE;
  if (info->unit == TRAX_UNIT_MEMORY)
    return TRAX_RESOURCE_MEMORY;
  return timing->unit == TRAX_SHARED_NONE ? TRAX_RESOURCE_NONE : TRAX_RESOURCE_UNIT;
}

static struct trax_decoded decode(uint32_t word, uint32_t pc, const struct trax_config *config) {
  trax_inst inst = trax_decode(word);
  if (trax_lacks_unit(inst.op, config))
    inst = (trax_inst){.op = TRAX_OP_ILLEGAL};
  const unsigned flags = trax_op_table[inst.op].flags;
  const struct trax_timing timing = trax_timing_of(inst.op, config);
  return (struct trax_decoded){
      .op = (uint8_t)inst.op,
      .resource = (uint8_t)resource_of(&inst, &timing),
      .unit = (uint8_t)timing.unit,
      .rd = flags & TRAX_WRITES_RD && inst.rd ? inst.rd : TRAX_NO_REGISTER,
      .ra = inst.ra,
      .rb = inst.rb,
      .wait_ra = flags & TRAX_READS_RA ? inst.ra : 0,
      .wait_rb = flags & TRAX_READS_RB ? inst.rb : 0,
      .wait_rd = flags & (TRAX_WRITES_RD | TRAX_READS_RD) ? inst.rd : 0,
      .more_ra = flags & TRAX_READS_RA ? (trax_group_a(flags) - 1) & 15 : 0,
      .more_rb = flags & TRAX_READS_RB ? (trax_group_b(flags) - 1) & 15 : 0,
      .bytes = (uint8_t)trax_op_table[inst.op].access_bytes,
      .bank = (uint8_t)(pc / 4 % config->icache.banks),
      .cause = (uint8_t)timing.cause,
      .is_store = (flags & TRAX_IS_STORE) != 0,
      .is_atomic = (flags & TRAX_IS_ATOMIC) != 0,
      .is_nontemporal = (flags & TRAX_IS_NONTEMPORAL) != 0,
      .latency = (uint16_t)timing.latency,
      .imm = inst.imm,
  };
}

trax_status trax_text_create(struct trax_text *text, const struct trax_space *space, const struct trax_config *config,
                             trax_error *error) {
  memset(text, 0, sizeof *text);
  text->segments = calloc(space->segment_count ? space->segment_count : 1, sizeof *text->segments);
  if (!text->segments)
    return trax_fail(error, "out of memory");
  for (size_t i = 0; i < space->segment_count; i++) {
    const struct trax_segment *segment = &space->segments[i];
    if (!(segment->permissions & TRAX_PERMIT_EXECUTE))
      continue;
    const uint32_t words = segment->bytes / 4;
    struct trax_decoded *decoded = malloc(((size_t)words + 1) * sizeof *decoded);
    if (!decoded) {
      trax_text_destroy(text);
      return trax_fail(error, "out of memory for %u instructions", words);
    }
    for (uint32_t word = 0; word < words; word++) {
      const uint32_t pc = segment->address + word * 4;
      uint32_t bits;
      memcpy(&bits, space->bytes + pc, sizeof bits);
      decoded[word] = decode(bits, pc, config);
    }
    decoded[words] = no_text;
    text->segments[text->count++] = (struct trax_text_segment){segment->address, segment->address + words * 4, decoded};
  }
  return TRAX_OK;
}

void trax_text_destroy(struct trax_text *text) {
  for (size_t i = 0; i < text->count; i++)
    free(text->segments[i].decoded);
  free(text->segments);
  memset(text, 0, sizeof *text);
}

const struct trax_decoded *trax_text_at(const struct trax_text *text, uint32_t pc) {
  if (pc % 4 == 0)
    for (size_t i = 0; i < text->count; i++)
      if (pc >= text->segments[i].begin && pc < text->segments[i].end)
        return text->segments[i].decoded + (pc - text->segments[i].begin) / 4;
  return &no_text;
}

trax_fault_kind trax_access_check(const struct trax_decoded *inst, const struct trax_space *space, uint32_t address) {
  if (address >= TRAX_LOCAL_BASE && !inst->is_atomic)
    return address & (inst->bytes - 1u) ? TRAX_FAULT_MISALIGNED : TRAX_FAULT_NONE;
  return trax_space_check(space, address, inst->bytes, inst->is_store || inst->is_atomic);
}

void trax_fault_record(struct trax_fault *fault, const struct trax_space *space, const struct trax_decoded *inst,
                       trax_fault_kind kind, uint32_t pc, uint32_t address) {
  *fault = (struct trax_fault){
      .kind = kind, .address = address, .bytes = inst->bytes, .write = inst->is_store || inst->is_atomic, .pc = pc};
  if (inst->resource != TRAX_RESOURCE_NO_TEXT)
    memcpy(&fault->word, space->bytes + pc, sizeof fault->word);
}
