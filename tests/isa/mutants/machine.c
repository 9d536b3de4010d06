/* Mutants of the rest of the machine: access checks, faults, fetch, reset, atomic increments. They stand between the
   files of emulator/reference (the linker's --wrap). */
#include "mutants.h"
#include "order.h"
#include "reference/reference.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum kind {
  /* of an instruction that accesses memory */
  MISALIGNED_ALLOWED,
  HALF_ALIGNED,
  NULL_ALLOWED,
  NULL_END,
  END_ALLOWED,
  UNMAPPED_ALLOWED,
  STACK_IS_UNMAPPED,
  UNMAPPED_IS_STACK,
  READ_ONLY_ALLOWED,
  READ_ONLY_LOADS,
  LOCAL_ALLOWED,
  LOCAL_FAULTS,
  MISALIGNED_FIRST,
  MISALIGNED_BEHIND_READ_ONLY,
  MISALIGNED_BEHIND_LOCAL,
  STORED_BEFORE_FAULT,
  /* of a kind of fault */
  FAULT_PC_NEXT,
  FAULT_PC_ENTRY,
  FAULT_ADDRESS_ZERO,
  FAULT_ADDRESS_WORD,
  FAULT_ADDRESS_NEXT,
  /* of fetching */
  PC_LOW_BITS,
  PC_BIT_1,
  PC_KIND,
  PC_PRIORITY,
  DATA_EXECUTES,
  FETCH_NULL,
  /* at reset */
  REGISTER_SET,
  LOCAL_SET,
  REGISTER_THREAD,
  /* of ainc */
  ADDS_NOTHING,
  ADDS_TWO,
  NEW_VALUE,
  CARRY_8,
  CARRY_16,
  SATURATES,
  R0_ADDS_NOTHING,
  TWICE_THE_SAME,
  OLD_VALUE_LOST
} kind;

static const char *const texts[] = {
    [MISALIGNED_ALLOWED] = "a misaligned access is allowed",
    [HALF_ALIGNED] = "multiples of 2 are aligned",
    [NULL_ALLOWED] = "the null page is memory",
    [NULL_END] = "the null page ends a word early",
    [END_ALLOWED] = "memory ends an access late",
    [UNMAPPED_ALLOWED] = "what lies behind memory reads as zero and swallows stores",
    [STACK_IS_UNMAPPED] = "below local memory is unmapped",
    [UNMAPPED_IS_STACK] = "all behind memory is a stack overflow",
    [READ_ONLY_ALLOWED] = "read-only memory can be written",
    [READ_ONLY_LOADS] = "read-only memory cannot be read",
    [LOCAL_ALLOWED] = "local memory is allowed",
    [LOCAL_FAULTS] = "local memory is not allowed",
    [MISALIGNED_FIRST] = "misalignment comes before all else",
    [MISALIGNED_BEHIND_READ_ONLY] = "a misaligned access to read-only memory is readonly",
    [MISALIGNED_BEHIND_LOCAL] = "a misaligned access to local memory is local",
    [STORED_BEFORE_FAULT] = "a misaligned store is performed, then faults",
    [FAULT_PC_NEXT] = "the fault's pc is the next instruction's",
    [FAULT_PC_ENTRY] = "the fault's pc is the entry point",
    [FAULT_ADDRESS_ZERO] = "the fault's address is 0",
    [FAULT_ADDRESS_WORD] = "the fault's address is the word's",
    [FAULT_ADDRESS_NEXT] = "the fault's address is 4 more",
    [PC_LOW_BITS] = "the lowest two bits of the pc are not looked at",
    [PC_BIT_1] = "bit 1 of the pc is not looked at",
    [PC_KIND] = "a misaligned pc is a fetch fault",
    [PC_PRIORITY] = "a misaligned pc outside the text is a fetch fault",
    [DATA_EXECUTES] = "all global memory can be executed",
    [FETCH_NULL] = "a fetch outside the text executes a halt",
    [REGISTER_SET] = "is not 0 at reset",
    [LOCAL_SET] = "of local memory is not 0 at reset",
    [REGISTER_THREAD] = "a0 is the thread's number at reset",
    [ADDS_NOTHING] = "adds nothing",
    [ADDS_TWO] = "adds two",
    [NEW_VALUE] = "gives the new value",
    [CARRY_8] = "adds to the lowest byte only",
    [CARRY_16] = "adds to the lower half only",
    [SATURATES] = "stops at 0xFFFFFFFF",
    [R0_ADDS_NOTHING] = "adds nothing if rd is r0",
    [TWICE_THE_SAME] = "every fourth increment gives a number a second time",
    [OLD_VALUE_LOST] = "rd is not written",
};

typedef struct wrong {
  kind kind;
  unsigned what; /* operation, kind of fault, register, place in local memory */
} wrong;

static wrong mutants[1024];
static unsigned count;

static void add(kind kind, unsigned what) {
  assert(count < sizeof mutants / sizeof *mutants);
  mutants[count++] = (wrong){kind, what};
}

static void add_accesses(unsigned op) {
  const trax_op_info *info = &trax_op_table[op];
  const bool global_only = info->flags & TRAX_IS_ATOMIC;
  const bool writes = info->flags & (TRAX_IS_STORE | TRAX_IS_ATOMIC);
  if (info->access_bytes > 1) {
    add(MISALIGNED_ALLOWED, op);
    add(MISALIGNED_FIRST, op);
    if (writes)
      add(MISALIGNED_BEHIND_READ_ONLY, op);
    if (global_only)
      add(MISALIGNED_BEHIND_LOCAL, op);
    if (info->flags & TRAX_IS_STORE)
      add(STORED_BEFORE_FAULT, op);
  }
  if (info->access_bytes > 2)
    add(HALF_ALIGNED, op);
  add(NULL_ALLOWED, op);
  add(NULL_END, op);
  add(END_ALLOWED, op);
  add(UNMAPPED_ALLOWED, op);
  add(STACK_IS_UNMAPPED, op);
  add(UNMAPPED_IS_STACK, op);
  add(writes ? READ_ONLY_ALLOWED : READ_ONLY_LOADS, op);
  add(global_only ? LOCAL_ALLOWED : LOCAL_FAULTS, op);
}

unsigned trax_machine_mutants(void) {
  if (count)
    return count;
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++)
    if (trax_op_table[op].access_bytes)
      add_accesses(op);
  for (unsigned fault = 1; fault < TRAX_FAULT_COUNT; fault++)
    for (kind kind = FAULT_PC_NEXT; kind <= FAULT_ADDRESS_NEXT; kind++)
      if (kind != (fault == TRAX_FAULT_ILLEGAL ? FAULT_ADDRESS_ZERO : FAULT_ADDRESS_NEXT))
        add(kind, fault);
  for (kind kind = PC_LOW_BITS; kind <= FETCH_NULL; kind++)
    add(kind, 0);
  for (unsigned i = 1; i < TRAX_NUM_REGISTERS; i++)
    add(REGISTER_SET, i);
  for (unsigned i = 0; i < TRAX_LOCAL_SIZE; i += TRAX_LOCAL_SIZE - 1)
    add(LOCAL_SET, i);
  for (kind kind = REGISTER_THREAD; kind <= OLD_VALUE_LOST; kind++)
    add(kind, 0);
  return count;
}

void trax_machine_mutant(unsigned index, struct trax_mutant_text *text) {
  const wrong *mutant = &mutants[index];
  char subject[48] = "";
  text->mnemonic[0] = 0;
  if (mutant->kind <= STORED_BEFORE_FAULT)
    snprintf(text->mnemonic, sizeof text->mnemonic, "%s", trax_op_table[mutant->what].mnemonic);
  else if (mutant->kind <= FAULT_ADDRESS_NEXT)
    snprintf(subject, sizeof subject, "%s: ", trax_fault_name((trax_fault_kind)mutant->what));
  else if (mutant->kind == REGISTER_SET)
    snprintf(subject, sizeof subject, "r%u ", mutant->what);
  else if (mutant->kind == LOCAL_SET)
    snprintf(subject, sizeof subject, "byte %u ", mutant->what);
  else if (mutant->kind >= ADDS_NOTHING)
    snprintf(text->mnemonic, sizeof text->mnemonic, "ainc");
  snprintf(text->what, sizeof text->what, "%s%s", subject, texts[mutant->kind]);
}

/* The one in force; NULL: another sort's, or none. */
static const wrong *current(void) {
  const int index = trax_mutant_index(trax_statement_mutants() + trax_arithmetic_mutants() + trax_decoding_mutants(),
                                      trax_machine_mutants());
  return index < 0 ? NULL : &mutants[index];
}

static bool is(kind kind) {
  return current() && current()->kind == kind;
}

/* --- accesses --- */

trax_fault_kind __real_trax_ref_check_access(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp);
trax_fault_kind __wrap_trax_ref_check_access(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp);
void __real_trax_ref_fault(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_fault_kind kind,
                           uint32_t address);
void __wrap_trax_ref_fault(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_fault_kind kind,
                           uint32_t address);
trax_fault_kind __real_trax_ref_text(const struct trax_ref_tm *tm, uint32_t pc, uint32_t *word);
trax_fault_kind __wrap_trax_ref_text(const struct trax_ref_tm *tm, uint32_t pc, uint32_t *word);
void __real_trax_ref_fetch(struct trax_ref_tm *tm, uint64_t t);
void __wrap_trax_ref_fetch(struct trax_ref_tm *tm, uint64_t t);
void __real_trax_ref_result(struct trax_ref_tp *tp, uint64_t cycle, trax_cause cause);
void __wrap_trax_ref_result(struct trax_ref_tp *tp, uint64_t cycle, trax_cause cause);
void __real_trax_ref_notify_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic, uint64_t t);
void __wrap_trax_ref_notify_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic, uint64_t t);
void __real_trax_ref_notify_issue(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint32_t pc, uint64_t t);
void __wrap_trax_ref_notify_issue(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint32_t pc, uint64_t t);

static bool is_read_only(const struct trax_ref_tm *tm, uint32_t address) {
  const struct trax_space *space = &tm->machine->space;
  return address >= TRAX_NULL_END && address < space->size &&
         (space->restrictions[address / TRAX_GRANULE] & TRAX_RESTRICT_WRITE);
}

/* An access that the mutant allows, though there is nothing: the instruction becomes one without effect. */
static trax_fault_kind ignore(const struct trax_ref_tp *tp) {
  ((struct trax_ref_tp *)tp)->inst = (trax_inst){.op = TRAX_OP_ADDI, .rd = tp->inst.rd};
  return TRAX_FAULT_NONE;
}

static void store_anyway(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  if (tp->address >= TRAX_NULL_END && tp->address < tm->machine->space.size - 4)
    memcpy(tm->machine->space.bytes + tp->address, &tp->reg[tp->inst.rb], trax_ref_info(tp)->access_bytes);
}

trax_fault_kind __wrap_trax_ref_check_access(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  const trax_fault_kind right = __real_trax_ref_check_access(tm, tp);
  if (!right)
    trax_order_before(tm, tp);
  const wrong *mutant = current();
  if (!mutant || mutant->kind > STORED_BEFORE_FAULT || mutant->what != tp->inst.op)
    return right;
  const uint32_t address = tp->address, bytes = trax_ref_info(tp)->access_bytes;
  const bool misaligned = address % bytes != 0, local = address >= TRAX_LOCAL_BASE;
  switch (mutant->kind) {
  case MISALIGNED_ALLOWED:
    return right == TRAX_FAULT_MISALIGNED ? (local ? ignore(tp) : TRAX_FAULT_NONE) : right;
  case HALF_ALIGNED:
    return right == TRAX_FAULT_MISALIGNED && address % 2 == 0 ? (local ? ignore(tp) : TRAX_FAULT_NONE) : right;
  case NULL_ALLOWED:
    return right == TRAX_FAULT_NULL_PAGE ? TRAX_FAULT_NONE : right;
  case NULL_END:
    return right == TRAX_FAULT_NULL_PAGE && address >= TRAX_NULL_END - 4 ? TRAX_FAULT_NONE : right;
  case END_ALLOWED:
    return right == TRAX_FAULT_UNMAPPED && address < tm->machine->space.size + bytes ? ignore(tp) : right;
  case UNMAPPED_ALLOWED:
    return right == TRAX_FAULT_UNMAPPED ? ignore(tp) : right;
  case STACK_IS_UNMAPPED:
    return right == TRAX_FAULT_STACK_OVERFLOW && address >= tm->machine->space.size ? TRAX_FAULT_UNMAPPED : right;
  case UNMAPPED_IS_STACK:
    return right == TRAX_FAULT_UNMAPPED ? TRAX_FAULT_STACK_OVERFLOW : right;
  case READ_ONLY_ALLOWED:
    return right == TRAX_FAULT_READ_ONLY ? TRAX_FAULT_NONE : right;
  case READ_ONLY_LOADS:
    return !right && is_read_only(tm, address) ? TRAX_FAULT_READ_ONLY : right;
  case LOCAL_ALLOWED:
    return right == TRAX_FAULT_NOT_GLOBAL ? ignore(tp) : right;
  case LOCAL_FAULTS:
    return !right && local ? TRAX_FAULT_NOT_GLOBAL : right;
  case MISALIGNED_FIRST:
    return right && misaligned ? TRAX_FAULT_MISALIGNED : right;
  case MISALIGNED_BEHIND_READ_ONLY:
    return right == TRAX_FAULT_MISALIGNED && is_read_only(tm, address) ? TRAX_FAULT_READ_ONLY : right;
  case MISALIGNED_BEHIND_LOCAL:
    return right == TRAX_FAULT_MISALIGNED && local ? TRAX_FAULT_NOT_GLOBAL : right;
  case STORED_BEFORE_FAULT:
    if (right == TRAX_FAULT_MISALIGNED)
      store_anyway(tm, tp);
    return right;
  default:
    return right;
  }
}

/* --- faults --- */

void __wrap_trax_ref_fault(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_fault_kind kind,
                           uint32_t address) {
  __real_trax_ref_fault(tm, tp, t, kind, address);
  trax_order_fault(tm);
  struct trax_fault *fault = &tm->machine->fault;
  const wrong *mutant = current();
  if (!mutant || mutant->kind < FAULT_PC_NEXT || mutant->kind > FAULT_ADDRESS_NEXT || mutant->what != fault->kind)
    return;
  switch (mutant->kind) {
  case FAULT_PC_NEXT:
    fault->pc = tp->pc + 4;
    break;
  case FAULT_PC_ENTRY:
    fault->pc = tm->machine->entry;
    break;
  case FAULT_ADDRESS_ZERO:
    fault->address = 0;
    break;
  case FAULT_ADDRESS_WORD:
    fault->address = address & ~3u;
    break;
  default:
    fault->address = address + 4;
  }
}

/* --- fetch --- */

trax_fault_kind __wrap_trax_ref_text(const struct trax_ref_tm *tm, uint32_t pc, uint32_t *word) {
  const trax_fault_kind right = __real_trax_ref_text(tm, pc, word);
  const struct trax_space *space = &tm->machine->space;
  if (is(PC_LOW_BITS) && right == TRAX_FAULT_MISALIGNED_PC)
    return __real_trax_ref_text(tm, pc & ~3u, word);
  if (is(PC_BIT_1) && right == TRAX_FAULT_MISALIGNED_PC && pc % 4 == 2)
    return __real_trax_ref_text(tm, pc & ~3u, word);
  if (is(PC_KIND) && right == TRAX_FAULT_MISALIGNED_PC)
    return TRAX_FAULT_EXECUTE;
  if (is(PC_PRIORITY) && right == TRAX_FAULT_MISALIGNED_PC && __real_trax_ref_text(tm, pc & ~3u, word))
    return TRAX_FAULT_EXECUTE;
  if (is(DATA_EXECUTES) && right == TRAX_FAULT_EXECUTE && pc >= TRAX_NULL_END && pc < space->size) {
    memcpy(word, space->bytes + pc, sizeof *word);
    return TRAX_FAULT_NONE;
  }
  if (is(FETCH_NULL) && right == TRAX_FAULT_EXECUTE) {
    *word = trax_encode((trax_inst){.op = TRAX_OP_HALT});
    return TRAX_FAULT_NONE;
  }
  return right;
}

/* --- reset --- */

static struct trax_machine *machine; /* for __wrap_trax_ref_result */

void __wrap_trax_ref_fetch(struct trax_ref_tm *tm, uint64_t t) {
  machine = tm->machine;
  trax_order_cycle(tm, t);
  const wrong *mutant = current();
  for (uint32_t i = 0; t == 0 && mutant && i < tm->tps; i++) {
    if (mutant->kind == REGISTER_SET)
      tm->tp[i].reg[mutant->what] = 1;
    else if (mutant->kind == LOCAL_SET)
      tm->tp[i].local[mutant->what] = 1;
    else if (mutant->kind == REGISTER_THREAD)
      tm->tp[i].reg[4] = tm->number * tm->tps + i;
  }
  __real_trax_ref_fetch(tm, t);
}

/* --- atomic increments --- */

static void add_to_word(uint32_t address, uint32_t amount) {
  uint32_t word;
  memcpy(&word, machine->space.bytes + address, sizeof word);
  word += amount;
  memcpy(machine->space.bytes + address, &word, sizeof word);
}

/* A requested increment is performed later. The word is changed now by the difference of the wrong sum. */
void __wrap_trax_ref_result(struct trax_ref_tp *tp, uint64_t cycle, trax_cause cause) {
  __real_trax_ref_result(tp, cycle, cause);
  const wrong *mutant = current();
  if (!mutant || mutant->kind < ADDS_NOTHING || tp->inst.op != TRAX_OP_AINC)
    return;
  uint32_t word;
  memcpy(&word, machine->space.bytes + tp->address, sizeof word);
  if (mutant->kind == ADDS_NOTHING || (mutant->kind == R0_ADDS_NOTHING && tp->inst.rd == 0) ||
      (mutant->kind == SATURATES && word == ~0u))
    add_to_word(tp->address, ~0u);
  else if (mutant->kind == ADDS_TWO)
    add_to_word(tp->address, 1);
  else if (mutant->kind == CARRY_8 && (word & 0xFF) == 0xFF)
    add_to_word(tp->address, ~0xFFu);
  else if (mutant->kind == CARRY_16 && (word & 0xFFFF) == 0xFFFF)
    add_to_word(tp->address, ~0xFFFFu);
}

void __wrap_trax_ref_notify_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic, uint64_t t) {
  static unsigned arrivals;
  uint32_t *const rd = (uint32_t *)&tm->tp[atomic->tp].reg[atomic->rd];
  if (is(NEW_VALUE))
    ++*rd;
  else if (is(TWICE_THE_SAME) && ++arrivals % 4 == 0)
    --*rd;
  else if (is(OLD_VALUE_LOST))
    *rd = 0;
  trax_order_arrival(tm, atomic);
  __real_trax_ref_notify_arrival(tm, atomic, t);
}

/* --- r0, for statements.py --- */

void trax_keep_r0(const uint32_t *registers, uint32_t value);

static const uint32_t *kept_in;
static uint32_t kept;

void trax_keep_r0(const uint32_t *registers, uint32_t value) {
  kept_in = registers;
  kept = value;
}

void __wrap_trax_ref_notify_issue(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint32_t pc, uint64_t t) {
  if (kept_in == tp->reg) {
    ((struct trax_ref_tp *)tp)->reg[0] = kept;
    kept_in = NULL;
  }
  trax_order_behind(tm, (struct trax_ref_tp *)tp, t);
  __real_trax_ref_notify_issue(tm, tp, pc, t);
}
