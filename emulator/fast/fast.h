/* The fast engine: the machine of docs/timing.md, and of emulator/reference, to the cycle, the count and the byte.

   It differs in two ways. Function runs ahead of time: a TP executes a burst of instructions at once, up to the first
   whose effect or value depends on time, and timing then consumes them one by one (burst.c, head.c). Timing works on
   masks of a TM's TPs: what will be asked for is noted when an instruction becomes its TP's next one, the head, and
   stays until it is granted (cycle.c, issue.c).

   Everything rare is the core's: arrivals, misses, requests, faults, traps, and the execution of instructions that
   must not run ahead, in the core's own structures. A TM touches nothing of another one but through blocks.c and
   the memory controller. */
#ifndef TRAX_FAST_FAST_H
#define TRAX_FAST_FAST_H

#ifdef TRAX_FAST_V3 /* the second of two compilations (engine.h) */
#define trax_fast_program_create trax_fast_program_create_v3
#define trax_fast_program_destroy trax_fast_program_destroy_v3
#define trax_fast_burst trax_fast_burst_v3
#define trax_fast_advance trax_fast_advance_v3
#define trax_fast_refill trax_fast_refill_v3
#define trax_fast_show trax_fast_show_v3
#define trax_fast_close trax_fast_close_v3
#define trax_fast_line_arrives trax_fast_line_arrives_v3
#define trax_fast_tell trax_fast_tell_v3
#define trax_fast_cycle trax_fast_cycle_v3
#define trax_fast_count_log trax_fast_count_log_v3
#define trax_fast_issue trax_fast_issue_v3
#define trax_fast_blocks_create trax_fast_blocks_create_v3
#define trax_fast_blocks_destroy trax_fast_blocks_destroy_v3
#define trax_fast_block_written trax_fast_block_written_v3
#define trax_fast_come_back trax_fast_come_back_v3
#define trax_fast_gather trax_fast_gather_v3
#define trax_fast_scatter trax_fast_scatter_v3
#endif

#include "core/chip.h"
#include "fast/engine.h"
#include "fast/masks.h"

enum {
  TRAX_BURST = 128,      /* most instructions of a burst */
  TRAX_FAST_LINES = 1024 /* lines of the program that `resident` knows; the last entry stands for all others */
};

/* What a head asks for after its operands: bits of trax_fast_step.asks. Nothing: the TP's own units. */
enum {
  TRAX_ASKS_SLOWLY = 1, /* its issue has more to do: the last of a burst, a longer latency, a bubble behind it */
  TRAX_ASKS_FP_ADD = 2,
  TRAX_ASKS_FP_MUL = 4,
  TRAX_ASKS_INT_MUL = 8,
  TRAX_ASKS_SPECIAL = 16,
  TRAX_ASKS_BANK = 32,     /* of the data cache */
  TRAX_ASKS_QUEUE = 64,    /* the memory queue without a bank */
  TRAX_ASKS_BANK_SHIFT = 8 /* which bank */
};

/* What timing needs of an instruction that has been executed. */
struct trax_fast_step {
  uint32_t waits;      /* mask of registers that must be usable */
  uint32_t index : 24; /* of the instruction, in trax_fast_program.inst */
  uint32_t bank : 8;   /* of the instruction cache */
  uint32_t address;    /* of a memory access, else 0 */
  uint16_t line;       /* of the program, for `resident` */
  uint16_t asks;
};

/* An instruction, for both function and timing. */
struct trax_fast_inst {
  struct trax_fast_step step; /* as a burst notes it */
  int32_t imm;
  uint8_t op; /* trax_op; TRAX_OP_ILLEGAL where a burst must stop: then only `decoded` knows */
  uint8_t rd, ra, rb;
  const struct trax_decoded *decoded;
};

struct trax_fast_section {
  uint32_t begin, bytes;
  uint32_t first_line;         /* as the cache numbers them */
  uint16_t line;               /* its index in `resident` */
  struct trax_fast_inst *inst; /* [bytes / 4 + 1]; the last is outside */
};

struct trax_fast_program {
  struct trax_fast_section *sections; /* [count], in one array of instructions */
  size_t count, inst_count;
  uint32_t lines; /* that `resident` knows */
  struct trax_fast_inst *inst;
  uint32_t *pc;                   /* [inst_count] */
  struct trax_fast_inst *outside; /* the last */
};

struct trax_fast_undo {
  uint32_t offset, word; /* what a word of local memory was */
};

struct trax_fast_tp {
  struct trax_fast_step only;
  const struct trax_fast_step *last; /* after it comes the next burst */
  uint32_t resume_pc;
  const struct trax_fast_inst *resume; /* where the next burst begins: at resume_pc */
  uint64_t atomics;                    /* registers that an atomic increment under way will write */

  /* Of the bursts that are over: how much of them was issued. */
  uint64_t issued, jumps;
  uint32_t burst_jumps; /* of the current burst, its last step included */
  uint64_t burst_lines; /* bit line % 64: in which lines of the program its steps are */

  struct trax_fast_step steps[TRAX_BURST];
  /* How to get back to the burst's beginning (blocks.c). */
  const struct trax_fast_inst *begin;
  uint32_t begin_pc;
  uint32_t undo_count;
  uint32_t reg[TRAX_NUM_REGISTERS + 1];
  struct trax_fast_undo undo[TRAX_BURST];
};

struct trax_fast_tm {
  struct trax_tm *tm;
  struct trax_fast *fast;
  struct trax_fast_tp *tp; /* [tps] */
  /* How often each instruction was executed since that was collected: the sum of this up to it, in its section. */
  int64_t *changes; /* [inst_count + 1] */
  /* What most issues need of a TP: its head, one of trax_fast_tp.steps or `only` if it is deferred; the banks of its
     instruction cache, in asking or asking16; its bit there. */
  const struct trax_fast_step *head[TRAX_MAX_TPS_PER_TM];
  union {
    uint64_t *asking_of[TRAX_MAX_TPS_PER_TM];
    uint16_t *asking16_of[TRAX_MAX_TPS_PER_TM];
  };
  uint16_t bit16[TRAX_MAX_TPS_PER_TM];
  /* Registers that may not be usable yet: who writes one sets its bit, unless the result can be used in the next cycle;
     it goes when the register has been looked at and found usable. trax_tp.usable counts only where it is set. */
  uint32_t busy_registers[TRAX_MAX_TPS_PER_TM];
  _Alignas(32) uint16_t asks[TRAX_MAX_TPS_PER_TM]; /* of the heads; a deferred one's once its operands are usable */

  /* Masks of TPs. */
  uint64_t ready;    /* have an instruction and usable operands and lack a unit, a bank or a place */
  uint64_t deferred; /* the head executes at issue */
  uint64_t smooth;  /* the head's operands will be usable in the first cycle in which it can be fetched, and its line is
                       there */
  uint64_t outside; /* the head cannot be fetched */
  uint64_t busy;    /* busy_registers is not 0 */
  uint64_t uncertain; /* a line of the burst may not be there */
  uint64_t taken_up;  /* hold an instruction since before the run was taken up: its operands are looked at again */

  /* The banks of all instruction caches, one cache's after another's, each beginning a vector: the TPs that ask, and
     those behind the latest winner. If no more than 16 TPs share a cache, the arrays of 16 bits are used, and a bit is
     a TP of the cache. */
  bool narrow;
  bool simple_fetch; /* that, and one vector to a cache, one fetch of a bank in a cycle */
  uint32_t vectors;  /* of a cache */
  uint32_t tps_per_icache;
  trax_fast_lanes *asking, *behind;
  trax_fast_lanes16 *asking16, *behind16;
  uint32_t data_banks, data_bank_bits;
  bool hits_in_turn;                    /* a hit of the data cache needs more than counting: latency, or order of use */
  uint8_t (*resident)[TRAX_FAST_LINES]; /* [tm->icaches] */
  uint64_t *resident_lines;             /* [tm->icaches]: the same, bit by line, of programs of 64 lines; else 0 */
  uint8_t icache_of[TRAX_MAX_TPS_PER_TM];

  struct trax_fast_units fp;      /* adders, multipliers */
  struct trax_fast_units int_mul; /* integer multipliers, nothing */
  trax_fast_lanes data_bank_behind[TRAX_MAX_TPS_PER_TM / TRAX_FAST_LANES];
  struct trax_fast_tally tally;
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
  unsigned burst;          /* most instructions of a burst; 1 for an observer, so that results are there at issue */
  struct trax_fast_blocks blocks;
};

/* In busy_registers. */
static inline uint32_t trax_fast_register_bit(unsigned rd) {
  return (uint32_t)((uint64_t)1 << rd); /* 0 of TRAX_NO_REGISTER */
}

static inline void trax_fast_set_busy(struct trax_fast_tm *ftm, unsigned tp, unsigned rd) {
  ftm->busy_registers[tp] |= trax_fast_register_bit(rd);
  ftm->busy |= (uint64_t)1 << tp;
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
/* The core's view of the head: inst, pc, address. */
void trax_fast_show(struct trax_fast_tm *ftm, unsigned tp);
/* The first `issued` steps of the TP's burst are over, and no others will be. */
void trax_fast_close(struct trax_fast_tm *ftm, unsigned tp, unsigned issued);
/* A line arrives in an instruction cache. */
void trax_fast_line_arrives(struct trax_fast_tm *ftm, unsigned icache, uint32_t line);

/* --- fast.c --- */
/* Tells an observer who was refused something in the current cycle. */
void trax_fast_tell(const struct trax_fast_tm *ftm, const struct trax_fast_lost *lost);

/* --- cycle.c --- */
void trax_fast_cycle(struct trax_fast *fast, uint32_t tm, uint64_t t);

/* --- issue.c --- */
/* Step 5; the heads of the `slow` ones are marked with TRAX_ASKS_SLOWLY. */
void trax_fast_issue(struct trax_fast_tm *ftm, uint64_t quick, uint64_t slow, uint64_t t);

/* --- blocks.c --- */
/* Several TMs may note what they have loaded at the same time; what is written is noted when none of them runs. */
static inline uint8_t trax_fast_block_state(const struct trax_fast *fast, uint32_t address) {
  return __atomic_load_n(&fast->blocks.state[address >> TRAX_BLOCK_SHIFT], __ATOMIC_RELAXED);
}

static inline void trax_fast_block_loaded(struct trax_fast *fast, uint32_t address) {
  if (trax_fast_block_state(fast, address) != TRAX_BLOCK_LOADED)
    __atomic_store_n(&fast->blocks.state[address >> TRAX_BLOCK_SHIFT], TRAX_BLOCK_LOADED, __ATOMIC_RELAXED);
}

trax_status trax_fast_blocks_create(struct trax_fast_blocks *blocks, uint64_t memory_bytes, trax_error *error);
void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks);
/* A store or atomic increment is about to write to a global address. */
void trax_fast_block_written(struct trax_fast *fast, uint32_t address);
/* Every TP goes back to what it has issued, and is deferred. */
void trax_fast_come_back(struct trax_fast *fast);

/* --- state.c: trax_fast_engine's functions of these names --- */
void trax_fast_gather(struct trax_fast *fast);
void trax_fast_scatter(struct trax_fast *fast, uint64_t t);

#endif
