/* The program's text, decoded once before the run. */
#ifndef TRAX_MACHINE_TEXT_H
#define TRAX_MACHINE_TEXT_H

#include "machine/address_space.h"
#include "machine/config.h"

#include <stddef.h>
#include <stdint.h>

/* What an instruction asks for when its operands are usable (docs/timing.md, "Units"). */
typedef enum trax_ask {
  TRAX_ASK_NOTHING, /* it executes on the TP's own units */
  TRAX_ASK_UNIT,    /* a shared one */
  TRAX_ASK_MEMORY,  /* by its address: local memory, a data-cache bank, or the memory queue */
  TRAX_ASK_END,     /* halt and the exit trap: a place for what the write-combining buffer holds */
  TRAX_ASK_FENCE,   /* the same, and that its TP's requests have completed */
  TRAX_ASK_ILLEGAL, /* faults */
  TRAX_ASK_OUTSIDE, /* not text: cannot be fetched */
  TRAX_ASK_COUNT
} trax_ask;

enum { TRAX_NO_REGISTER = 32 }; /* where results for r0 go; never read */

struct trax_decoded {
  uint8_t op;   /* trax_op */
  uint8_t ask;  /* trax_ask */
  uint8_t unit; /* trax_shared, of TRAX_ASK_UNIT */
  uint8_t rd;   /* destination; TRAX_NO_REGISTER if there is none or it is r0 */
  uint8_t ra, rb;
  uint8_t wait_ra, wait_rb, wait_rd; /* registers that must be usable; 0 where there is nothing to wait for */
  uint8_t bytes;                     /* of a memory access */
  uint8_t bank;                      /* of the instruction cache */
  uint8_t cause;                     /* trax_cause of a wait for the result, unless memory decides */
  uint8_t is_store : 1, is_atomic : 1, is_nontemporal : 1;
  uint16_t latency;
  int32_t imm;
};

struct trax_text_section {
  uint32_t begin, end;
  struct trax_decoded *decoded; /* [(end - begin) / 4 + 1]; the last is outside */
};

struct trax_text {
  struct trax_text_section *sections;
  size_t count;
};

/* Decodes all executable segments. A last, incomplete word of a segment is outside. */
trax_status trax_text_create(struct trax_text *text, const struct trax_space *space, const struct trax_config *config,
                             trax_error *error);
void trax_text_destroy(struct trax_text *text);

/* Whether the access of an instruction to its address is allowed. */
trax_fault_kind trax_access_check(const struct trax_decoded *inst, const struct trax_space *space, uint32_t address);

/* Notes the fault of an instruction; who and when, registers and local memory are left to the engine. */
void trax_fault_record(struct trax_fault *fault, const struct trax_space *space, const struct trax_decoded *inst,
                       trax_fault_kind kind, uint32_t pc, uint32_t address);

/* The instruction at pc; one that is TRAX_ASK_OUTSIDE if there is none. Following it up to the first one outside is
   allowed: consecutive instructions are consecutive in memory. */
const struct trax_decoded *trax_text_at(const struct trax_text *text, uint32_t pc);

#endif
