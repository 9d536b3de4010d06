/* The kinds of faults, and the record of a fault (docs/timing.md, "Faults"). */
#ifndef TRAX_MACHINE_FAULT_H
#define TRAX_MACHINE_FAULT_H

#include "trax/abi.h"

#include <stdbool.h>
#include <stdint.h>

/* identifier, name in a signature (docs/isa.md, "Faults"), description */
#define TRAX_FAULTS(X)                                                                                                 \
  X(NONE, "none", "no fault")                                                                                          \
  X(NULL_PAGE, "null", "access to the null page")                                                                      \
  X(STACK_OVERFLOW, "stack", "stack overflow")                                                                         \
  X(UNMAPPED, "unmapped", "access to an address that is neither global nor local memory")                              \
  X(MISALIGNED, "misaligned", "misaligned access")                                                                     \
  X(READ_ONLY, "readonly", "write to read-only memory")                                                                \
  X(NOT_GLOBAL, "local", "atomic increment of local memory")                                                           \
  X(EXECUTE, "fetch", "execution outside the program's text")                                                          \
  X(MISALIGNED_PC, "misaligned-pc", "jump to an address that is not a multiple of 4")                                  \
  X(ILLEGAL, "illegal", "illegal instruction")                                                                         \
  X(ABORT, "abort", "abort")

typedef enum trax_fault_kind {
#define TRAX_FAULT_ENUM(ID, NAME, TEXT) TRAX_FAULT_##ID,
  TRAX_FAULTS(TRAX_FAULT_ENUM)
#undef TRAX_FAULT_ENUM
      TRAX_FAULT_COUNT
} trax_fault_kind;

struct trax_fault {
  trax_fault_kind kind;
  uint32_t address; /* the data address; EXECUTE and MISALIGNED_PC: the pc; ABORT: the message's address; else 0 */
  uint32_t bytes;   /* size of the access; 0 if none */
  bool write;       /* the access was a store or an atomic increment */
  uint32_t pc;
  uint32_t word; /* the instruction; 0 if it could not be fetched */
  uint32_t thread, tm, tp;
  uint64_t cycle;
  uint32_t registers[TRAX_NUM_REGISTERS]; /* before the instruction */
  uint8_t local[TRAX_LOCAL_SIZE];         /* the thread's memory */
};

const char *trax_fault_text(trax_fault_kind kind); /* the description, "access to the null page" */
const char *trax_fault_name(trax_fault_kind kind); /* the name in a signature, "null" */

#endif
