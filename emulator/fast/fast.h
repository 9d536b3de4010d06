/* The fast engine: the same machine as emulator/core, to the cycle, the count and the byte (docs/timing.md).

   It differs in two ways. Function runs ahead of time: a TP executes a burst of instructions at once, up to the first
   whose effect or value depends on time, and timing then consumes them one by one (burst.c, head.c). Timing works on
   masks of a TM's TPs: who asks for what is a bit that is set when an instruction becomes its TP's next one, the head,
   and stays until it is granted (cycle.c, issue.c).

   Everything rare is the reference's: arrivals, misses, requests, faults, traps, and the execution of instructions that
   must not run ahead, in the reference's own structures. A TM touches nothing of another one but through blocks.c and
   the memory controller. */
#ifndef TRAX_FAST_FAST_H
#define TRAX_FAST_FAST_H

#include "core/chip.h"

/* What a head asks for after its operands; the classes are the index of trax_fast_tm.want. */
typedef enum trax_fast_class {
  TRAX_CLASS_OWN, /* nothing: the TP's own units */
  TRAX_CLASS_FP_ADD,
  TRAX_CLASS_FP_MUL,
  TRAX_CLASS_INT_MUL,
  TRAX_CLASS_SPECIAL,
  TRAX_CLASS_BANK,       /* a data-cache bank; as a predecoded class, a load */
  TRAX_CLASS_LOCAL_LOAD, /* follows BANK: a load becomes one by its address */
  TRAX_CLASS_LOCAL_STORE,
  TRAX_CLASS_QUEUE,    /* the memory queue without a bank */
  TRAX_CLASS_DEFERRED, /* not executed yet; class known when its operands are usable */
  TRAX_CLASS_COUNT
} trax_fast_class;

/* An instruction, for both function and timing. */
struct trax_fast_inst {
  uint8_t op; /* trax_op; TRAX_OP_ILLEGAL where a burst must stop: then only `decoded` knows */
  uint8_t rd, ra, rb;
  int32_t imm;
  uint32_t waits; /* mask of registers that must be usable */
  uint8_t class;  /* trax_fast_class */
  uint8_t bank;   /* of the instruction cache */
  uint8_t cause;
  bool starts_line; /* of the instruction cache */
  uint16_t latency; /* unless memory decides */
  uint32_t pc;
  const struct trax_decoded *decoded;
};

struct trax_fast_section {
  uint32_t begin, bytes;
  struct trax_fast_inst *inst; /* [bytes / 4 + 1]; the last is outside */
};

struct trax_fast_program {
  struct trax_fast_section *sections; /* [count], in one array of instructions */
  size_t count;
  struct trax_fast_inst *inst;
  const struct trax_fast_inst *outside;
};

enum { TRAX_BURST = 64 }; /* most instructions of a burst */

struct trax_fast_step {
  const struct trax_fast_inst *inst;
  uint32_t address; /* of a memory access, else 0 */
  uint8_t class;    /* trax_fast_class */
  uint8_t rd;       /* whose latency is noted at issue: not that of a load from global memory */
};

struct trax_fast_undo {
  uint32_t offset, word; /* what a word of local memory was */
};

/* What most issues need of a TP, apart so that a TM's fit into few of the host's cache lines. */
struct trax_fast_slot {
  const struct trax_fast_step *step; /* the head: one of trax_fast_tp.steps, or its `only` if it is deferred */
  const struct trax_fast_step *last; /* after it comes the next burst */
  struct trax_fast_icache *icache;
  /* Registers that may not be usable yet: who writes one sets its bit, unless the result can be used in the next cycle;
     it goes when the register has been looked at and found usable. trax_tp.usable counts only where it is set. */
  uint32_t busy;
};

struct trax_fast_tp {
  struct trax_fast_step only;
  uint32_t resume_pc;
  const struct trax_fast_inst *resume; /* where the next burst begins: at resume_pc */
  uint64_t atomics;                    /* registers that an atomic increment under way will write */

  struct trax_fast_step steps[TRAX_BURST];
  /* How to get back to the burst's beginning (blocks.c). */
  const struct trax_fast_inst *begin;
  uint32_t undo_count;
  uint32_t reg[TRAX_NUM_REGISTERS + 1];
  struct trax_fast_undo undo[TRAX_BURST];
};

/* A counter per TP, bit-sliced: planes[k] holds bit k of all of them, so that a cycle is charged to a mask of TPs at
 * once. */
struct trax_fast_tally {
  uint64_t planes[64];
};

static inline void trax_fast_count(struct trax_fast_tally *tally, uint64_t tps) {
  for (uint64_t *plane = tally->planes; tps; plane++) {
    const uint64_t carry = *plane & tps;
    *plane ^= tps;
    tps = carry;
  }
}

/* The same where many TPs are counted in every cycle: the low bits without a branch. */
static inline void trax_fast_count_many(struct trax_fast_tally *tally, uint64_t tps) {
  for (unsigned i = 0; i < 6; i++) {
    const uint64_t carry = tally->planes[i] & tps;
    tally->planes[i] ^= tps;
    tps = carry;
  }
  for (uint64_t *plane = tally->planes + 6; tps; plane++) {
    const uint64_t carry = *plane & tps;
    *plane ^= tps;
    tps = carry;
  }
}

/* An arbiter of masks: `last` is the bit of the latest winner, which says what the reference's pointer says. Takes the
   first of the askers behind it, or else the first of all; 0 of 0. */
static inline uint64_t trax_fast_first_after(uint64_t last, uint64_t askers) {
  const uint64_t behind = askers & ~((last << 1) - 1);
  const uint64_t among = behind ? behind : askers;
  return among & -among;
}

/* Most banks are asked by one TP, who is served: then nothing is left to be done in the cycle of the fetch, and
   `asking` becomes the latest winner. */
struct trax_fast_bank {
  uint64_t asking; /* if nobody asks: the latest winner */
  uint64_t last;   /* if somebody asks: the latest winner */
};

struct trax_fast_icache {
  uint64_t banks;     /* those that are asked */
  uint64_t conflicts; /* those that more than one TP asks */
  const struct trax_cache_tags *tags;
  struct trax_fast_bank bank[64];
};

/* Shared units of one kind. */
struct trax_fast_unit {
  uint32_t groups;
  uint64_t group[64], last[64];
};

struct trax_fast_tm {
  struct trax_tm *tm;
  struct trax_fast *fast;
  struct trax_fast_tp *tp; /* [tps] */
  struct trax_fast_slot slot[TRAX_MAX_TPS_PER_TM];

  /* Masks of TPs. `ready` have an instruction and usable operands and lack a unit, a bank or a place. */
  uint64_t want[TRAX_CLASS_COUNT]; /* by the head's class, fetched or not */
  uint64_t ready;
  uint64_t deferred;  /* the head executes at issue, as the reference would */
  uint64_t clear;     /* the head's operands will be usable in the first cycle in which it can be fetched */
  uint64_t same_line; /* the head's line is where the TP fetched last, and no line has come since */
  uint64_t outside;   /* the head cannot be fetched */

  struct trax_fast_icache icache[TRAX_MAX_TPS_PER_TM];
  uint8_t icache_of[TRAX_MAX_TPS_PER_TM];
  struct trax_fast_unit fp_add, fp_mul, int_mul;
  uint64_t data_bank_last[TRAX_MAX_TPS_PER_TM]; /* latest winners */
  struct trax_fast_tally tally[TRAX_CAUSE_COUNT];
};

/* What has happened to each small block of global memory during the run (blocks.c). */
enum { TRAX_BLOCK_SHIFT = 4, TRAX_BLOCK_LOADED = 1, TRAX_BLOCK_WRITTEN = 2 };

struct trax_fast_blocks {
  uint8_t *state; /* [block]: LOADED by someone who ran ahead, or then or at once WRITTEN */
  size_t bytes;
};

struct trax_fast {
  struct trax_chip *chip;
  struct trax_fast_program program;
  struct trax_fast_tm *tm; /* [tms] */
  unsigned burst;          /* most instructions of a burst; 1 if issues are traced, so that results are there */
  struct trax_fast_blocks blocks;
};

trax_status trax_fast_create(struct trax_chip *chip, trax_error *error);
void trax_fast_destroy(struct trax_fast *fast);
/* Arrivals and the five steps of a TM; sets its next_cycle. */
void trax_fast_cycle(struct trax_fast *fast, uint32_t tm, uint64_t t);
/* Adds the tallies to the TPs' charges. */
void trax_fast_settle(struct trax_fast *fast);

/* In trax_fast_slot.busy. */
static inline uint32_t trax_fast_register_bit(unsigned rd) {
  return (uint32_t)((uint64_t)1 << rd); /* 0 of TRAX_NO_REGISTER */
}

/* --- program.c --- */
trax_status trax_fast_program_create(struct trax_fast_program *program, const struct trax_text *text,
                                     const struct trax_config *config, trax_error *error);
void trax_fast_program_destroy(struct trax_fast_program *program);

static inline const struct trax_fast_inst *trax_fast_inst_at(const struct trax_fast_program *program, uint32_t pc) {
  for (size_t i = 0; i < program->count && pc % 4 == 0; i++)
    if (pc - program->sections[i].begin < program->sections[i].bytes)
      return program->sections[i].inst + (pc - program->sections[i].begin) / 4;
  return program->outside;
}

/* --- burst.c --- */
/* Executes up to `limit` instructions from resume on, as steps 0...; returns how many. */
unsigned trax_fast_burst(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned tp, unsigned limit);

/* --- head.c --- */
/* All steps are used up: the next burst. If nothing can run ahead, the head is deferred. */
void trax_fast_refill(struct trax_fast_tm *ftm, unsigned tp);
/* The reference's view of the head: inst, pc, address. */
void trax_fast_show(struct trax_fast_tm *ftm, unsigned tp);

/* --- issue.c --- */
void trax_fast_issue(struct trax_fast_tm *ftm, uint64_t granted, uint64_t t);

/* --- blocks.c --- */
trax_status trax_fast_blocks_create(struct trax_fast_blocks *blocks, uint64_t memory_bytes, trax_error *error);
void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks);
/* A store or atomic increment is about to write to a global address. */
void trax_fast_block_written(struct trax_fast *fast, uint32_t address);

#endif
