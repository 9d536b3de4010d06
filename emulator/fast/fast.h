/* The fast engine: the machine of docs/timing.md, and of emulator/reference, to the cycle, the count and the byte.

   It differs in two ways. Function runs ahead of time: a TP executes a burst of instructions at once, up to the first
   whose effect or value depends on time, and timing then consumes them one by one (burst.c, head.c). Timing works on
   masks of a TM's TPs: what will be asked for is noted when an instruction becomes its TP's next one, the head, and
   stays until it is granted (cycle.c, issue.c).

   Everything rare is done by tm.c, tp.c and the files of caches and memory: arrivals, misses, requests, faults, traps, and the execution of instructions that
   must not run ahead, in structures of their own. A TM touches nothing of another one but through blocks.c and
   the memory controller. */
#ifndef TRAX_FAST_FAST_H
#define TRAX_FAST_FAST_H

#ifdef TRAX_FAST_VARIANT /* one of several compilations (variant.h): _v3 */
#define TRAX_FAST_JOIN(NAME, VARIANT) NAME##VARIANT
#define TRAX_FAST_NAME(NAME, VARIANT) TRAX_FAST_JOIN(NAME, VARIANT)
#define trax_fast_program_create TRAX_FAST_NAME(trax_fast_program_create, TRAX_FAST_VARIANT)
#define trax_fast_program_destroy TRAX_FAST_NAME(trax_fast_program_destroy, TRAX_FAST_VARIANT)
#define trax_fast_burst TRAX_FAST_NAME(trax_fast_burst, TRAX_FAST_VARIANT)
#define trax_fast_operations TRAX_FAST_NAME(trax_fast_operations, TRAX_FAST_VARIANT)
#define trax_fast_advance TRAX_FAST_NAME(trax_fast_advance, TRAX_FAST_VARIANT)
#define trax_fast_refill TRAX_FAST_NAME(trax_fast_refill, TRAX_FAST_VARIANT)
#define trax_fast_export_head TRAX_FAST_NAME(trax_fast_export_head, TRAX_FAST_VARIANT)
#define trax_fast_end_burst TRAX_FAST_NAME(trax_fast_end_burst, TRAX_FAST_VARIANT)
#define trax_fast_line_arrived TRAX_FAST_NAME(trax_fast_line_arrived, TRAX_FAST_VARIANT)
#define trax_fast_notify_refusals TRAX_FAST_NAME(trax_fast_notify_refusals, TRAX_FAST_VARIANT)
#define trax_fast_run_ahead TRAX_FAST_NAME(trax_fast_run_ahead, TRAX_FAST_VARIANT)
#define trax_fast_cycle TRAX_FAST_NAME(trax_fast_cycle, TRAX_FAST_VARIANT)
#define trax_fast_count_log TRAX_FAST_NAME(trax_fast_count_log, TRAX_FAST_VARIANT)
#define trax_fast_issue TRAX_FAST_NAME(trax_fast_issue, TRAX_FAST_VARIANT)
#define trax_fast_blocks_create TRAX_FAST_NAME(trax_fast_blocks_create, TRAX_FAST_VARIANT)
#define trax_fast_blocks_destroy TRAX_FAST_NAME(trax_fast_blocks_destroy, TRAX_FAST_VARIANT)
#define trax_fast_block_written TRAX_FAST_NAME(trax_fast_block_written, TRAX_FAST_VARIANT)
#define trax_fast_roll_back TRAX_FAST_NAME(trax_fast_roll_back, TRAX_FAST_VARIANT)
#define trax_fast_schedule_check TRAX_FAST_NAME(trax_fast_schedule_check, TRAX_FAST_VARIANT)
#define trax_fast_export TRAX_FAST_NAME(trax_fast_export, TRAX_FAST_VARIANT)
#define trax_fast_import TRAX_FAST_NAME(trax_fast_import, TRAX_FAST_VARIANT)
#endif

#include "fast/chip.h"
#include "fast/heads.h"
#include "fast/masks.h"
#include "fast/variant.h"

enum {
  TRAX_BURST = 224,  /* most instructions of a burst; fits in trax_fast_heads.at */
  TRAX_CHUNK = 32,   /* instructions of the program whose steps are noted at once: those from a multiple of it on */
  TRAX_FAST_LINES = TRAX_KNOWN_LINES + 1 /* that `resident` knows; the last entry stands for all others */
};

/* The first of the shared units without a place of its own among what a step asks for. */
#define TRAX_FAST_FURTHER ((unsigned)TRAX_SHARED_SPECIAL + 1)

/* An instruction, what its function needs: four to a line of the host's cache. */
struct trax_fast_inst {
  const void *operation; /* where burst.c executes it; for the first of a chunk, where the chunk is noted */
  int32_t imm;
  uint8_t op; /* trax_op; TRAX_OP_ILLEGAL where a burst must stop: then only `decoded` knows */
  uint8_t rd, ra, rb;
};

/* What its timing needs. */
struct trax_fast_timing {
  const struct trax_decoded *decoded;
  uint32_t waits; /* mask of registers that must be usable */
  uint32_t pc;
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
  uint32_t lines;              /* TRAX_FAST_LINES: or more */
  struct trax_fast_inst *inst; /* [inst_count] */
  struct trax_fast_timing *timing; /* [inst_count] */
  uint16_t *line;              /* [inst_count]: of the program, for `resident` */
  uint16_t *step;              /* [inst_count + TRAX_CHUNK]: of a step, unless its address says more */
  uint64_t *lines_ahead;       /* [inst_count]: bit line % 64 of the lines from here to a jump or the chunk's end */
  struct trax_fast_inst *no_text; /* the last */
};

struct trax_fast_undo {
  uint32_t offset, word; /* what a word of local memory was */
};

struct trax_fast_tp {
  uint32_t resume_pc;
  const struct trax_fast_inst *resume; /* where the next burst begins: at resume_pc */
  uint64_t atomics;                    /* registers that an atomic increment under way will write */

  /* Of the bursts that are over: how much of them was issued. */
  uint64_t issued, jumps;
  uint32_t burst_jumps; /* of the current burst, its last step included */
  uint64_t burst_lines; /* bit line % 64: in which lines of the program its steps are, and perhaps in more */

  /* The steps of the burst, what timing needs of instructions that have been executed; or only the executes_at_issue
     head. Behind the last one there may be more. */
  _Alignas(64) uint16_t step[TRAX_BURST + TRAX_CHUNK];
  uint8_t segment[TRAX_BURST + TRAX_CHUNK]; /* of the burst: trax_fast_index */
  uint32_t address[TRAX_BURST];            /* of the loads of global memory, one after the other */
  uint32_t origin[TRAX_BURST + 1];         /* [segment]: the index of its first instruction minus the number of its step */

  /* How to get back to the burst's beginning (blocks.c). */
  const struct trax_fast_inst *begin;
  uint32_t undo_count;
  uint32_t reg[TRAX_NUM_REGISTERS + 1];
  struct trax_fast_undo undo[TRAX_BURST];
};

struct trax_fast_tm {
  struct trax_tm *tm;
  struct trax_fast *fast;
  struct trax_fast_tp *tp; /* [tps] */
  /* How often each instruction was executed since that was collected: the sum of this up to it, in its section. */
  int64_t *count_deltas; /* [inst_count + 1] */
  struct trax_fast_heads heads;
  bool wide;                                       /* more than 32 TPs */
  const uint32_t *address_of[TRAX_MAX_TPS_PER_TM]; /* trax_fast_tp.address; of those that do not exist, TP 0's */
  /* Registers that may not be usable yet: who writes one sets its bit, unless the result can be used in the next cycle;
     it goes when the register has been looked at and found usable. trax_tp.usable counts only where it is set. */
  uint32_t busy_registers[TRAX_MAX_TPS_PER_TM];

  /* Masks of TPs. */
  uint64_t ready;     /* have an instruction and usable operands and lack a unit, a bank or a place */
  uint64_t executes_at_issue; /* the head executes at issue */
  uint64_t no_text;           /* the head cannot be fetched */
  uint64_t busy;      /* busy_registers is not 0 */
  uint64_t uncertain; /* a line of the burst may not be there */
  uint64_t recheck;   /* hold an instruction since before the run was taken up: its operands are looked at again */

  /* For each bank of the instruction caches, the TPs behind the latest winner. `simple_fetch`: 16 TPs share a cache of
     at most 16 banks that let one into each; then the TPs of all caches are handled together (heads.h). Else the banks
     of one cache after another's, each beginning a vector. */
  bool simple_fetch;
  uint32_t vectors; /* of a cache */
  struct trax_fast_banks16 fetch_rr_masks16;
  trax_fast_lanes *fetch_rr_masks;
  uint32_t data_banks, data_bank_bits;
  bool serial_hits;                     /* a hit of the data cache needs more than counting: latency, or order of use */
  uint8_t (*resident)[TRAX_FAST_LINES]; /* [tm->icaches] */
  uint64_t *resident_lines;             /* [tm->icaches]: the same, bit by line, of programs of 64 lines; else 0 */
  uint8_t icache_of[TRAX_MAX_TPS_PER_TM];

  struct trax_fast_units fp;      /* adders, multipliers */
  struct trax_fast_units int_mul; /* integer multipliers, nothing */
  trax_fast_lanes data_bank_rr_masks[TRAX_MAX_TPS_PER_TM / TRAX_FAST_LANES];
  struct trax_fast_refusal_counts refusal_counts;

  /* What took a slow way (machine/fast_path.h): fetches that were looked up, hits of the data cache that were served
     one by one, instructions that executed at issue. */
  uint64_t looked_up, single_hits, at_issue;
};

/* What has happened to each small block of global memory during the run (blocks.c). */
enum { TRAX_BLOCK_SHIFT = 4, TRAX_BLOCK_LOADED = 1, TRAX_BLOCK_WRITTEN = 2 };

struct trax_fast_blocks {
  /* [block]: LOADED by someone who ran ahead, or then or at once WRITTEN. Several TMs may note what they have loaded at
     the same time; what is written is noted when none of them runs. */
  uint8_t *state;
  size_t bytes;
  uint32_t input, input_bytes; /* trax_space.input while nobody has written there: all of it counts as loaded */
};

static inline bool trax_fast_is_loaded(const struct trax_fast_blocks *blocks, uint32_t address) {
  return blocks->state[address >> TRAX_BLOCK_SHIFT] == TRAX_BLOCK_LOADED ||
         address - blocks->input < blocks->input_bytes;
}

/* Nobody has loaded the block, or everybody has come back. */
static inline void trax_fast_set_written(struct trax_fast_blocks *blocks, uint32_t address) {
  blocks->state[address >> TRAX_BLOCK_SHIFT] = TRAX_BLOCK_WRITTEN;
  if (address - blocks->input < blocks->input_bytes)
    blocks->input_bytes = 0;
}

struct trax_fast {
  struct trax_chip *chip;
  struct trax_fast_program program;
  struct trax_fast_tm *tm; /* [tms] */
  unsigned burst;          /* most instructions of a burst; 1 for an observer, so that results are there at issue */
  struct trax_fast_blocks blocks;
};

/* The index of a step's instruction, in trax_fast_program.inst. */
static inline uint32_t trax_fast_index(const struct trax_fast_tp *ftp, unsigned step) {
  return ftp->origin[ftp->segment[step]] + step;
}

/* Of the TP's head. */
static inline uint32_t trax_fast_head(const struct trax_fast_tm *ftm, unsigned tp) {
  return trax_fast_index(&ftm->tp[tp], ftm->heads.at[tp]);
}

static inline const struct trax_fast_timing *trax_fast_head_timing(const struct trax_fast_tm *ftm, unsigned tp) {
  return &ftm->fast->program.timing[trax_fast_head(ftm, tp)];
}

/* In busy_registers. */
static inline uint32_t trax_fast_register_bit(unsigned rd) {
  return (uint32_t)((uint64_t)1 << rd); /* 0 of TRAX_NO_REGISTER */
}

/* --- head.c --- */
/* Finds the next head that must be looked at: it needs a register of busy_registers or, if the TP is among `uncertain`,
   lies in another line than this one. `fetched`: this one has been looked at and fetched in this cycle; else a head
   that was to be looked at before stays so, since lines may have gone. */
void trax_fast_schedule_check(struct trax_fast_tm *ftm, unsigned tp, bool fetched);

static inline void trax_fast_set_busy(struct trax_fast_tm *ftm, unsigned tp, unsigned rd) {
  ftm->busy_registers[tp] |= trax_fast_register_bit(rd);
  ftm->busy |= (uint64_t)1 << tp;
  trax_fast_schedule_check(ftm, tp, false);
}

/* --- program.c --- */
trax_status trax_fast_program_create(struct trax_fast_program *program, const struct trax_text *text,
                                     const struct trax_config *config, trax_error *error);
void trax_fast_program_destroy(struct trax_fast_program *program);

static inline const struct trax_fast_inst *trax_fast_inst_at(const struct trax_fast_program *program, uint32_t pc) {
  for (size_t i = 0; i < program->count && pc % 4 == 0; i++)
    if (pc - program->sections[i].begin < program->sections[i].bytes)
      return program->sections[i].inst + (pc - program->sections[i].begin) / 4;
  return program->no_text;
}

/* --- burst.c --- */
/* Executes instructions from resume on, as steps 0...; returns how many: `limit` at most, and as many if that is less
   than TRAX_BURST and nothing stops it. */
unsigned trax_fast_burst(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned tp, unsigned limit);

/* Where each trax_op is executed, TRAX_OP_ILLEGAL stops, and, at TRAX_OP_COUNT, where a chunk is noted. */
const void *const *trax_fast_operations(void);

/* --- head.c --- */
/* All steps are used up: the next burst. If nothing can run ahead, the head is executes_at_issue. */
void trax_fast_refill(struct trax_fast_tm *ftm, unsigned tp);
/* Brings the head to where tm.c and tp.c find it: inst, pc, address. */
void trax_fast_export_head(struct trax_fast_tm *ftm, unsigned tp);
/* The first `issued` of the `executed` steps of the TP's burst are over, and no others will be. */
void trax_fast_end_burst(struct trax_fast_tm *ftm, unsigned tp, unsigned executed, unsigned issued);
/* A line has arrived in an instruction cache, and perhaps another one has gone. */
void trax_fast_line_arrived(struct trax_fast_tm *ftm, unsigned icache, uint32_t line);

/* --- fast.c --- */
/* Tells an observer who was refused something in the current cycle. */
void trax_fast_notify_refusals(const struct trax_fast_tm *ftm, const struct trax_fast_refused *refused);

/* --- cycle.c --- */
void trax_fast_cycle(struct trax_fast *fast, uint32_t tm, uint64_t t);
void trax_fast_run_ahead(struct trax_fast *fast, uint32_t first, uint32_t count, uint64_t end);

/* --- issue.c --- */
/* Step 5; the heads of the `slow` ones are marked with TRAX_STEP_SLOW. */
void trax_fast_issue(struct trax_fast_tm *ftm, uint64_t quick, uint64_t slow, uint64_t t);

/* --- blocks.c --- */
trax_status trax_fast_blocks_create(struct trax_fast_blocks *blocks, const struct trax_space *space, trax_error *error);
void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks);
/* A store or atomic increment is about to write to a global address. */
void trax_fast_block_written(struct trax_fast *fast, uint32_t address);
/* Every TP goes back to what it has issued, and is executes_at_issue. */
void trax_fast_roll_back(struct trax_fast *fast);

/* --- transfer.c: trax_fast_variant's functions of these names --- */
void trax_fast_export(struct trax_fast *fast);
void trax_fast_import(struct trax_fast *fast, uint64_t t);

#endif
