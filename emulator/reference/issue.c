/* Step 5 of docs/timing.md, "A cycle": the effects of the instructions that were granted all they asked for. */
#include "reference/reference.h"

#include "machine/traps.h"
#include "trax/semantics.h"

#include <string.h>

static uint8_t *place(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint32_t address) {
  return address >= TRAX_LOCAL_BASE ? tp->local + (address - TRAX_LOCAL_BASE) : tm->machine->space.bytes + address;
}

static uint32_t load(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint32_t address, unsigned bytes) {
  uint32_t value = 0;
  memcpy(&value, place(tm, tp, address), bytes);
  return value;
}

static void store(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint32_t address, uint32_t value, unsigned bytes) {
  memcpy(place(tm, tp, address), &value, bytes);
}

static void end(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint32_t status) {
  tp->ended = true;
  tm->machine->exit_statuses[tm->number * tm->tps + tp->number] = (int32_t)status;
}

static trax_fault_kind trap(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint32_t value, uint32_t code) {
  if (code != TRAX_TRAP_EXIT)
    return trax_trap(tm->machine, tp->local, tm->stats, tm->output, value, (int32_t)code);
  end(tm, tp, value);
  return TRAX_FAULT_NONE;
}

/* Performs the instruction's effects: registers, memory, pc, traps. Returns the fault of a trap, which then had no
   effect. */
static trax_fault_kind execute(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  const trax_inst *const inst = &tp->inst;
  uint32_t *const reg = tp->reg;
  uint32_t next_pc = tp->pc + 4;
  trax_fault_kind fault = TRAX_FAULT_NONE;

#include "machine/semantics_begin.h"
#define PC tp->pc
#define PRECISION tm->config->special.precision_bits
#define LOAD(ADDRESS, BYTES) load(tm, tp, ADDRESS, BYTES)
#define STORE(ADDRESS, VALUE, BYTES) store(tm, tp, ADDRESS, VALUE, BYTES)
#define ATOMIC_INC(ADDRESS) ((void)(ADDRESS), RD) /* the controller increments, and the arrival sets the register */
#define SPECIAL_REGISTER(NUMBER) trax_special_register(tm->config, tm->number * tm->tps + tp->number, NUMBER, t)
#define TRAP(VALUE, CODE) fault = trap(tm, tp, VALUE, CODE)
#define FENCE(KIND) ((void)(KIND), trax_ref_fence(tm, tp))
#define HALT() end(tm, tp, 0)
  switch (inst->op) {
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  case TRAX_OP_##NAME:                                                                                                 \
    __VA_ARGS__                                                                                                        \
    break;
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
#include "machine/semantics_end.h"
  case TRAX_OP_ILLEGAL: /* has faulted in step 2 */
  case TRAX_OP_COUNT:
    break;
  }

  reg[0] = 0;
  if (!fault)
    tp->pc = next_pc;
  return fault;
}

/* Sets the cycle from which the result is usable. Step 4 has done so for loads that are not from local memory. */
static void note_result(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  if (!trax_ref_is(tp, TRAX_WRITES_RD))
    return;
  if (trax_ref_accesses_local(tp))
    trax_ref_result(tp, t + tm->config->tp.local_latency_cycles, TRAX_CAUSE_DATA_LOCAL);
  else if (!trax_ref_accesses_memory(tp)) {
    const struct trax_timing *timing = trax_ref_timing(tm, tp);
    trax_ref_result(tp, t + timing->latency, timing->cause);
  }
}

static void count(struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  tm->stats->instructions[tp->inst.op]++;
  if (trax_ref_accesses_local(tp))
    ++*(trax_ref_is(tp, TRAX_IS_STORE) ? &tm->stats->local_stores : &tm->stats->local_loads);
}

void trax_ref_issue_of(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  const uint32_t pc = tp->pc;
  const trax_fault_kind kind = execute(tm, tp, t);
  if (kind) {
    trax_ref_fault(tm, tp, t, kind, tp->reg[tp->inst.ra]);
    return;
  }
  trax_ref_charge(tm, tp, t, TRAX_CAUSE_ISSUED);
  count(tm, tp);
  note_result(tm, tp, t);
  tp->holds = false;
  if (tp->pc != pc + 4) {
    tm->stats->taken_branches++;
    tp->bubble_ends = t + 1 + tm->config->tp.branch_bubble_cycles;
  }
  trax_ref_notify_issue(tm, tp, pc, t);
  tp->outcome = 0;
}

void trax_ref_issue(struct trax_ref_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->tps; i++)
    if (trax_ref_active(&tm->tp[i]))
      trax_ref_issue_of(tm, &tm->tp[i], t);
}
