/* The program's text, decoded once before the run. */
#ifndef TRAX_MACHINE_TEXT_H
#define TRAX_MACHINE_TEXT_H

#include "machine/address_space.h"
#include "machine/config.h"
#include "trax/isa.h"

#include <stddef.h>
#include <stdint.h>

/* The resource that an instruction needs once its operands are usable (docs/timing.md, "Units"). */
typedef enum trax_resource {
  TRAX_RESOURCE_NONE,    /* none: it executes on the TP's own units */
  TRAX_RESOURCE_UNIT,    /* a shared unit */
  TRAX_RESOURCE_MEMORY,  /* local memory, a data-cache bank or the memory queue, by its address */
  TRAX_RESOURCE_END,     /* halt and the exit trap: a queue place, unless the write-combining buffer is empty */
  TRAX_RESOURCE_FENCE,   /* the same, and it waits for its TP's requests */
  TRAX_RESOURCE_ILLEGAL, /* none: it faults */
  TRAX_RESOURCE_NO_TEXT, /* none: the pc is not in the text, and the fetch faults */
  TRAX_RESOURCE_COUNT
} trax_resource;

enum { TRAX_NO_REGISTER = 32 }; /* the destination of results for r0; never read */

struct trax_decoded {
  uint8_t op;       /* trax_op */
  uint8_t resource; /* trax_resource */
  uint8_t unit;     /* TRAX_RESOURCE_UNIT: trax_shared */
  uint8_t rd;       /* destination; TRAX_NO_REGISTER if there is none or it is r0 */
  uint8_t ra, rb;
  uint8_t wait_ra, wait_rb, wait_rd; /* registers that must be usable before issue; 0: none */
  uint8_t more_ra : 4, more_rb : 4;  /* the number of registers behind ra and rb that must be, too */
  uint8_t bytes;                     /* of a memory access */
  uint8_t bank;                      /* of the instruction cache */
  uint8_t cause;                     /* trax_cause of a wait for the result, unless it comes from memory */
  uint8_t is_store : 1, is_atomic : 1, is_nontemporal : 1;
  uint16_t latency;
  int32_t imm;
};

enum { TRAX_STACK_POINTER = 2 };

/* Whether it is a call, perhaps a return, or writes the stack pointer. */
static inline bool trax_changes_stack(const struct trax_decoded *decoded) {
  return decoded->op == TRAX_OP_JALR || (decoded->op == TRAX_OP_JAL && decoded->rd != TRAX_NO_REGISTER) ||
         (decoded->rd == TRAX_STACK_POINTER && trax_op_table[decoded->op].flags & TRAX_WRITES_RD);
}

struct trax_text_segment {
  uint32_t begin, end;
  struct trax_decoded *decoded; /* [(end - begin) / 4 + 1]; the last one is TRAX_RESOURCE_NO_TEXT */
};

struct trax_text {
  struct trax_text_segment *segments;
  size_t count;
};

/* Decodes all executable segments. An incomplete last word of a segment is TRAX_RESOURCE_NO_TEXT. */
trax_status trax_text_create(struct trax_text *text, const struct trax_space *space, const struct trax_config *config,
                             trax_error *error);
void trax_text_destroy(struct trax_text *text);

/* Checks an instruction's access to its address. TRAX_FAULT_NONE: it is allowed. */
trax_fault_kind trax_access_check(const struct trax_decoded *inst, const struct trax_space *space, uint32_t address);

/* Fills in the record of an instruction's fault, except for thread, cycle, registers and local memory, which the engine
   adds. */
void trax_fault_record(struct trax_fault *fault, const struct trax_space *space, const struct trax_decoded *inst,
                       trax_fault_kind kind, uint32_t pc, uint32_t address);

/* Returns the instruction at pc, or one that is TRAX_RESOURCE_NO_TEXT if pc is not in the text. Consecutive
   instructions are consecutive in memory, up to and including the first one that is TRAX_RESOURCE_NO_TEXT. */
const struct trax_decoded *trax_text_at(const struct trax_text *text, uint32_t pc);

#endif
