/* docs/timing.md, "Operands": step 2. */
#include "reference/reference.h"

void trax_ref_result(struct trax_ref_tp *tp, uint64_t cycle, trax_cause cause) {
  if (trax_ref_is(tp, TRAX_WRITES_RD) && tp->inst.rd != 0) /* r0 is always usable */
    tp->scoreboard[tp->inst.rd] = (struct trax_ref_register){.usable = cycle, .cause = cause};
}

static unsigned wait_for_operands(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  const struct {
    unsigned count, first;
  } operands[] = {{trax_group_a(trax_ref_info(tp)->flags), tp->inst.ra},
                  {trax_group_b(trax_ref_info(tp)->flags), tp->inst.rb},
                  {trax_ref_is(tp, TRAX_READS_RD | TRAX_WRITES_RD), tp->inst.rd}};
  for (unsigned i = 0; i < 3; i++)
    for (unsigned n = 0; n < operands[i].count; n++) {
      const unsigned number = (operands[i].first + n) % TRAX_NUM_REGISTERS;
      if (tp->scoreboard[number].usable > t) {
        trax_ref_charge_wait(tm, tp, t, number);
        return number;
      }
    }
  return 0;
}

/* A fence needs all registers. */
static unsigned wait_for_all_registers(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  for (unsigned rd = 1; rd < TRAX_NUM_REGISTERS; rd++)
    if (tp->scoreboard[rd].usable > t) {
      trax_ref_charge_wait(tm, tp, t, rd);
      return rd;
    }
  return 0;
}

static bool is_illegal(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  return tp->inst.op == TRAX_OP_ILLEGAL || trax_lacks_unit(tp->inst.op, tm->config);
}

unsigned trax_ref_wait_for_registers(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  return (tp->inst.op == TRAX_OP_FENCE ? wait_for_all_registers : wait_for_operands)(tm, tp, t);
}

void trax_ref_find_address(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  tp->address = tp->reg[tp->inst.ra] + (uint32_t)tp->inst.imm;
  const trax_fault_kind kind = trax_ref_check_access(tm, tp);
  if (kind)
    trax_ref_fault(tm, tp, t, kind, tp->address);
}

void trax_ref_check_operands(struct trax_ref_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->tps; i++) {
    struct trax_ref_tp *tp = &tm->tp[i];
    if (trax_ref_active(tp) && is_illegal(tm, tp))
      trax_ref_fault(tm, tp, t, TRAX_FAULT_ILLEGAL, 0);
    if (trax_ref_active(tp))
      trax_ref_wait_for_registers(tm, tp, t);
    if (trax_ref_active(tp) && trax_ref_accesses_memory(tp))
      trax_ref_find_address(tm, tp, t);
  }
}
