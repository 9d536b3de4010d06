/* The functions that the manual's semantics call. */
#include "oracle.h"
#include "semantics.h"

#include <string.h>

/* --- integers --- */

static uint32_t as_signed(struct model_execution *execution, const uint32_t *argument) {
  (void)execution;
  return argument[0]; /* the type of the result says the rest */
}

static uint32_t shift_right_arithmetic(struct model_execution *execution, const uint32_t *argument) {
  uint32_t value = argument[0];
  if (argument[1] > 31)
    execution->undefined = "an arithmetic shift by more than 31";
  for (uint32_t i = 0; i < argument[1] && i < 32; i++)
    value = value / 2 + (value & 0x80000000u);
  return value;
}

static uint32_t extend(uint32_t value, uint32_t sign) {
  const uint32_t low = value & (2 * sign - 1);
  return low & sign ? low | ~(2 * sign - 1) : low;
}

static uint32_t sign_extend_8(struct model_execution *execution, const uint32_t *argument) {
  (void)execution;
  return extend(argument[0], 0x80);
}

static uint32_t sign_extend_16(struct model_execution *execution, const uint32_t *argument) {
  (void)execution;
  return extend(argument[0], 0x8000);
}

/* The unsigned product's high word, less what the sign bits' weight of -2^31 instead of 2^31 changes in it. */
static uint32_t multiply_high(struct model_execution *execution, const uint32_t *argument) {
  (void)execution;
  const uint64_t product = (uint64_t)argument[0] * argument[1];
  uint32_t high = (uint32_t)(product >> 32);
  if (argument[0] >> 31)
    high -= argument[1];
  if (argument[1] >> 31)
    high -= argument[0];
  return high;
}

/* --- binary32 --- */

#define BINARY(X) X(fadd) X(fsub) X(fmul) X(fmin) X(fmax) X(feq) X(flt) X(fle)
#define UNARY(X) X(fcvt_w_s) X(fcvt_wu_s) X(fcvt_s_w) X(fcvt_s_wu)

#define CALL(NAME)                                                                                                     \
  static uint32_t call_##NAME(struct model_execution *execution, const uint32_t *argument) {                           \
    (void)execution;                                                                                                   \
    return oracle_##NAME(argument[0], argument[1]);                                                                    \
  }
BINARY(CALL)
#undef CALL
#define CALL(NAME)                                                                                                     \
  static uint32_t call_##NAME(struct model_execution *execution, const uint32_t *argument) {                           \
    (void)execution;                                                                                                   \
    return oracle_##NAME(argument[0]);                                                                                 \
  }
UNARY(CALL)
#undef CALL

static uint32_t divide(struct model_execution *execution, const uint32_t *argument) {
  return oracle_reduce(oracle_fdiv(argument[0], argument[1]), execution->machine->precision);
}

static uint32_t reciprocal_root(struct model_execution *execution, const uint32_t *argument) {
  return oracle_reduce(oracle_frsqrt(argument[0]), execution->machine->precision);
}

/* --- groups of registers --- */

static uint32_t of_group(struct model_execution *execution, enum model_field field, uint32_t number) {
  return execution->thread->registers[(execution->operand[field] + number) % MODEL_REGISTERS];
}

static uint32_t group_a(struct model_execution *execution, const uint32_t *argument) {
  return of_group(execution, MODEL_FIELD_RA, argument[0]);
}

static uint32_t group_b(struct model_execution *execution, const uint32_t *argument) {
  return of_group(execution, MODEL_FIELD_RB, argument[0]);
}

/* --- memory --- */

static bool may(struct model_execution *execution, uint32_t address, uint32_t bytes, enum model_access access) {
  if (execution->fault)
    return false;
  execution->fault = model_check(execution->machine, address, bytes, access);
  execution->fault_address = address;
  return !execution->fault;
}

static uint32_t load(struct model_execution *execution, uint32_t address, uint32_t bytes, bool past_cache) {
  return may(execution, address, bytes, MODEL_LOAD)
             ? model_load(execution->machine, execution->thread, address, bytes, past_cache)
             : 0;
}

static uint32_t store(struct model_execution *execution, uint32_t address, uint32_t value, uint32_t bytes,
                      bool past_cache) {
  if (may(execution, address, bytes, MODEL_STORE))
    model_store(execution->machine, execution->thread, address, value, bytes, past_cache);
  return 0;
}

#define LOAD(NAME, BYTES, PAST_CACHE)                                                                                  \
  static uint32_t NAME(struct model_execution *execution, const uint32_t *argument) {                                  \
    return load(execution, argument[0], BYTES, PAST_CACHE);                                                            \
  }
#define STORE(NAME, BYTES, PAST_CACHE)                                                                                 \
  static uint32_t NAME(struct model_execution *execution, const uint32_t *argument) {                                  \
    return store(execution, argument[0], argument[1], BYTES, PAST_CACHE);                                              \
  }
LOAD(load_8, 1, false)
LOAD(load_16, 2, false)
LOAD(load_32, 4, false)
LOAD(load_32_nontemporal, 4, true)
STORE(store_8, 1, false)
STORE(store_16, 2, false)
STORE(store_32, 4, false)
STORE(store_32_nontemporal, 4, true)

static uint32_t atomic_increment(struct model_execution *execution, const uint32_t *argument) {
  return may(execution, argument[0], 4, MODEL_INCREMENT)
             ? model_increment(execution->machine, execution->thread, argument[0])
             : 0;
}

static uint32_t fence(struct model_execution *execution, const uint32_t *argument) {
  if (argument[0] - MODEL_FENCE_R > MODEL_FENCE_RW - MODEL_FENCE_R)
    execution->fault = MODEL_FAULT_ILLEGAL;
  else
    model_fence(execution->machine, execution->thread, (enum model_fence)argument[0]);
  return 0;
}

/* --- docs/isa.md: special registers and traps --- */

static uint32_t special_register(struct model_execution *execution, const uint32_t *argument) {
  const struct model_thread *thread = execution->thread;
  switch (argument[0]) {
  case 0:
    return thread->number;
  case 1:
    return thread->tm;
  case 2:
    return thread->tp;
  case 3:
    return execution->machine->thread_count;
  case 4:
    return (uint32_t)execution->machine->turns;
  case 5:
    return (uint32_t)(execution->machine->turns >> 32);
  }
  execution->fault = MODEL_FAULT_ILLEGAL;
  return 0;
}

static void end_thread(struct model_thread *thread, uint32_t status) {
  thread->ended = true;
  thread->status = status;
}

/* Nothing is printed of a string that does not end. */
static void put_string(struct model_execution *execution, uint32_t address) {
  struct model_machine *machine = execution->machine;
  const bool is_local = address >= MODEL_LOCAL_BASE;
  const uint64_t end = is_local ? UINT64_C(1) << 32 : machine->size;
  uint64_t nul = address;
  if (!may(execution, address, 1, MODEL_LOAD))
    return;
  while (nul < end && model_load(machine, execution->thread, (uint32_t)nul, 1, false))
    nul++;
  if (nul == end)
    execution->fault = MODEL_FAULT_UNMAPPED;
  else if (machine->output)
    for (uint64_t i = address; i < nul; i++)
      fputc((int)model_load(machine, execution->thread, (uint32_t)i, 1, false), machine->output);
}

/* There are no calls here: the answer is -38, as for an unknown number. */
static void host_call(struct model_execution *execution, uint32_t address) {
  const uint32_t last = address + 20;
  if (may(execution, address, 4, MODEL_STORE) && (last < address || !may(execution, last, 4, MODEL_STORE)))
    execution->fault = execution->fault && last >= address ? execution->fault : MODEL_FAULT_UNMAPPED;
  else if (!execution->fault)
    store(execution, address, (uint32_t)-38, 4, false);
  execution->fault_address = address;
}

static uint32_t trap(struct model_execution *execution, const uint32_t *argument) {
  const uint32_t value = argument[0];
  switch (argument[1]) {
  case 0: /* exit */
    end_thread(execution->thread, value);
    break;
  case 1: /* putc */
    if (execution->machine->output)
      fputc((int)(value & 0xFF), execution->machine->output);
    break;
  case 2: /* abort */
    execution->fault = MODEL_FAULT_ABORT;
    execution->fault_address = value;
    break;
  case 3:  /* rays */
  case 4:  /* items */
    break; /* counters of the host */
  case 5:  /* puts */
    put_string(execution, value);
    break;
  case 6: /* kinds */
    break;
  case 7: /* host: there is no call */
    host_call(execution, value);
    break;
  default:
    execution->fault = MODEL_FAULT_ILLEGAL;
  }
  return 0;
}

static uint32_t halt(struct model_execution *execution, const uint32_t *argument) {
  (void)argument;
  end_thread(execution->thread, 0);
  return 0;
}

static const struct model_function functions[] = {
    {"trax_signed", 1, MODEL_S32, as_signed},
    {"trax_sra", 2, MODEL_U32, shift_right_arithmetic},
    {"trax_sext8", 1, MODEL_U32, sign_extend_8},
    {"trax_sext16", 1, MODEL_U32, sign_extend_16},
    {"trax_mulh", 2, MODEL_U32, multiply_high},
#define ENTRY(NAME) {"trax_" #NAME, 2, MODEL_U32, call_##NAME},
    BINARY(ENTRY)
#undef ENTRY
#define ENTRY(NAME) {"trax_" #NAME, 1, MODEL_U32, call_##NAME},
        UNARY(ENTRY)
#undef ENTRY
            {"FPDIV", 2, MODEL_U32, divide},
    {"ISQRT", 1, MODEL_U32, reciprocal_root},
    {"GROUP_A", 1, MODEL_U32, group_a},
    {"GROUP_B", 1, MODEL_U32, group_b},
    {"LOAD8", 1, MODEL_U32, load_8},
    {"LOAD16", 1, MODEL_U32, load_16},
    {"LOAD32", 1, MODEL_U32, load_32},
    {"LOAD32_NONTEMPORAL", 1, MODEL_U32, load_32_nontemporal},
    {"STORE8", 2, MODEL_VOID, store_8},
    {"STORE16", 2, MODEL_VOID, store_16},
    {"STORE32", 2, MODEL_VOID, store_32},
    {"STORE32_NONTEMPORAL", 2, MODEL_VOID, store_32_nontemporal},
    {"ATOMIC_INC", 1, MODEL_U32, atomic_increment},
    {"FENCE", 1, MODEL_VOID, fence},
    {"SPECIAL_REGISTER", 1, MODEL_U32, special_register},
    {"TRAP", 2, MODEL_VOID, trap},
    {"HALT", 0, MODEL_VOID, halt},
};

const struct model_function *model_find_function(const char *name, size_t length) {
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
    if (strlen(functions[i].name) == length && memcmp(functions[i].name, name, length) == 0)
      return &functions[i];
  return NULL;
}
