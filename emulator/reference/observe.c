/* Notifies an observer of the run (machine/observer.h). */
#include "reference/reference.h"

void trax_ref_notify_charge(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint64_t t, trax_cause cause,
                            unsigned rd) {
  const struct trax_observer *observer = tm->machine->observer;
  if (observer->charge && cause != TRAX_CAUSE_ISSUED)
    observer->charge(observer->context, tm->number, tp->number, cause, rd, t, 1);
}

/* Returns the value that the instruction wrote to its register or to memory, or passed to a trap. */
static uint32_t result_of(const struct trax_ref_tp *tp) {
  if (trax_ref_is(tp, TRAX_IS_STORE)) {
    const uint32_t bits = 8 * trax_ref_info(tp)->access_bytes, value = tp->reg[tp->inst.rb];
    return bits < 32 ? value & ((1u << bits) - 1) : value;
  }
  if (tp->inst.op == TRAX_OP_TRAP)
    return tp->reg[tp->inst.ra];
  return trax_ref_is(tp, TRAX_WRITES_RD) ? tp->reg[tp->inst.rd] : 0;
}

void trax_ref_notify_issue(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint32_t pc, uint64_t t) {
  const struct trax_observer *observer = tm->machine->observer;
  if (!observer || !observer->issue)
    return;
  struct trax_issue issue = {.cycle = t,
                             .tm = tm->number,
                             .tp = tp->number,
                             .pc = pc,
                             .next_pc = tp->pc,
                             .result = result_of(tp),
                             .address = trax_ref_accesses_memory(tp) ? tp->address : 0,
                             .outcome = tp->outcome};
  trax_ref_text(tm, pc, &issue.word);
  observer->issue(observer->context, &issue);
}

void trax_ref_notify_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic, uint64_t t) {
  const struct trax_observer *observer = tm->machine->observer;
  if (observer && observer->arrival)
    observer->arrival(observer->context,
                      &(struct trax_arrival){t, tm->number, atomic->tp, atomic->rd, atomic->old_value});
}

static void notify_transfer(const struct trax_ref_chip *chip, struct trax_transfer transfer) {
  const struct trax_transfers *transfers = chip->machine->transfers;
  if (transfers)
    transfers->transfer(transfers->context, &transfer);
}

void trax_ref_notify_request(const struct trax_ref_chip *chip, const struct trax_ref_request *request, uint64_t t) {
  static const uint8_t kinds[] = {[INSTRUCTION_LINE] = TRAX_TRANSFER_INSTRUCTION_LINE,
                                  [DATA_LINE] = TRAX_TRANSFER_DATA_LINE,
                                  [LOAD_PAST_CACHE] = TRAX_TRANSFER_LOAD,
                                  [WRITE] = TRAX_TRANSFER_WRITE,
                                  [ATOMIC] = TRAX_TRANSFER_ATOMIC};
  notify_transfer(chip, (struct trax_transfer){.cycle = t,
                                               .address = request->address,
                                               .bytes = request->bytes,
                                               .tm = (int16_t)request->tm,
                                               .kind = kinds[request->kind],
                                               .channel = (uint8_t)request->channel});
}

void trax_ref_notify_miss(const struct trax_ref_chip *chip, const struct trax_ref_miss *miss, uint64_t t) {
  notify_transfer(chip, (struct trax_transfer){.cycle = t,
                                               .address = miss->line * chip->config->l2.line_bytes,
                                               .bytes = trax_ref_l2_line_cost(chip->config),
                                               .tm = TRAX_TRANSFER_NO_TM,
                                               .kind = TRAX_TRANSFER_L2_LINE,
                                               .channel = (uint8_t)miss->channel});
}
