/* Predicts the pc after a thread's next instructions, by executing them on a copy of the thread. */
#include "gdb/stub.h"
#include "machine/text.h"
#include "machine/traps.h"
#include "trax/semantics.h"

#include <string.h>

struct predicted { /* the copy */
  uint32_t reg[TRAX_NUM_REGISTERS + 1], pc;
  uint8_t local[TRAX_LOCAL_SIZE];
};

/* Whether the instruction affects only its thread. Others are skipped. */
static bool is_harmless(const struct trax_gdb *gdb, const struct predicted *it, const struct trax_decoded *inst) {
  switch ((trax_resource)inst->resource) {
  case TRAX_RESOURCE_END:
  case TRAX_RESOURCE_FENCE:
  case TRAX_RESOURCE_ILLEGAL:
  case TRAX_RESOURCE_NO_TEXT:
    return false;
  case TRAX_RESOURCE_MEMORY: {
    const uint32_t address = it->reg[inst->ra] + (uint32_t)inst->imm;
    return !inst->is_atomic && trax_access_check(inst, &gdb->machine->space, address) == TRAX_FAULT_NONE &&
           (!inst->is_store || address >= TRAX_LOCAL_BASE);
  }
  default:
    return inst->op != TRAX_OP_TRAP;
  }
}

static uint32_t load(const struct trax_gdb *gdb, const struct predicted *it, uint32_t address, unsigned bytes) {
  uint32_t value = 0;
  memcpy(&value,
         address >= TRAX_LOCAL_BASE ? it->local + (address - TRAX_LOCAL_BASE) : gdb->machine->space.bytes + address,
         bytes);
  return value;
}

static void step(const struct trax_gdb *gdb, uint32_t thread, struct predicted *it) {
  const struct trax_decoded *inst = trax_text_at(&gdb->run->text, it->pc);
  uint32_t *const reg = it->reg;
  uint32_t next_pc = it->pc + 4, word;
  if (is_harmless(gdb, it, inst)) {
#include "machine/semantics_begin.h"
#define PC it->pc
#define PRECISION gdb->machine->config.special.precision_bits
#define LOAD(ADDRESS, BYTES) load(gdb, it, ADDRESS, BYTES)
#define STORE(ADDRESS, VALUE, BYTES) (word = (VALUE), memcpy(it->local + ((ADDRESS) - TRAX_LOCAL_BASE), &word, BYTES))
#define ATOMIC_INC(ADDRESS) ((void)(ADDRESS), 0u)
#define SPECIAL_REGISTER(NUMBER) trax_special_register(&gdb->machine->config, thread, NUMBER, gdb->cycle)
#define TRAP(VALUE, CODE) ((void)(VALUE))
#define FENCE(KIND) ((void)(KIND))
#define HALT() ((void)0)
#include "machine/semantics_switch.h"
  }
  it->pc = next_pc;
}

uint32_t trax_gdb_pc_after(const struct trax_gdb *gdb, uint32_t thread, unsigned instructions) {
  const struct trax_thread state = trax_run_thread(gdb->run, thread);
  struct predicted it = {.pc = state.pc};
  memcpy(it.reg, state.reg, sizeof it.reg - sizeof *it.reg);
  memcpy(it.local, state.local, sizeof it.local);
  while (instructions--)
    step(gdb, thread, &it);
  return it.pc;
}
