/* The fast engine (docs/fast-engine.md has its words): it gives the cycles, counts and bytes of emulator/reference.

   Instructions are executed before their time: a TP executes a burst at once, up to the first instruction whose effect
   or result depends on time, and the timing of the burst's steps follows one by one (burst.c, head.c). Timing works on
   masks of a TM's TPs: the resources that an instruction needs are recorded when it becomes its TP's head (cycle.c,
   issue.c).

   Rare events are simulated one by one in plain structures, by tm.c, tp.c and the files of caches and memory: arrivals,
   misses, requests, faults, traps, and instructions that execute at issue. A TM accesses data of another TM only
   through blocks.c and the memory controller. */
#ifndef TRAX_FAST_FAST_H
#define TRAX_FAST_FAST_H

#include "fast/chip.h"
#include "fast/heads.h"
#include "fast/masks.h"

enum {
  TRAX_BURST = 224,                      /* limit of a burst's instructions; fits in trax_fast_heads.at */
  TRAX_CHUNK = 32,                       /* instructions of a chunk, which begins at a multiple of it */
  TRAX_FAST_LINES = TRAX_KNOWN_LINES + 1 /* entries of `resident`; the last one stands for all further lines */
};

/* The first kind of shared units that TRAX_STEP_FURTHER encodes. */
#define TRAX_FAST_FURTHER ((unsigned)TRAX_SHARED_SPECIAL + 1)

/* What the execution of an instruction needs: four to a line of the host's cache. */
struct trax_fast_inst {
  const void *operation; /* the label in burst_steps.h that executes it; of a chunk's first, the one that records it */
  int32_t imm;
  uint8_t op; /* trax_op; TRAX_OP_ILLEGAL if a burst must end before it: then only `decoded` has the operation */
  uint8_t rd, ra, rb;
};

/* What the timing of an instruction needs. */
struct trax_fast_timing {
  const struct trax_decoded *decoded;
  uint32_t waits; /* mask of registers that must be usable */
  uint32_t pc;
};

struct trax_fast_section {
  uint32_t begin, bytes;
  uint32_t first_line;         /* the number of its first line in the cache */
  uint16_t line;               /* the index of that line in `resident` */
  struct trax_fast_inst *inst; /* [bytes / 4 + 1]; the last one is no text */
};

struct trax_fast_program {
  struct trax_fast_section *sections; /* [count]; their instructions are in one array */
  size_t count, inst_count;
  uint32_t lines;                  /* lines of instructions; TRAX_FAST_LINES: or more */
  struct trax_fast_inst *inst;     /* [inst_count] */
  struct trax_fast_timing *timing; /* [inst_count] */
  uint16_t *line;                  /* [inst_count]: the index of its line in `resident` */
  uint16_t *step;                  /* [inst_count + TRAX_CHUNK]: its step, unless an address decides it */
  uint64_t *chunk_lines;           /* [inst_count]: bit line % 64 of the lines up to a jump or the chunk's end */
  struct trax_fast_inst *no_text;  /* the last instruction, for every pc that is no text */
};

struct trax_fast_undo {
  uint32_t offset, word; /* a word of local memory before a store */
};

struct trax_fast_tp {
  uint32_t resume_pc;
  const struct trax_fast_inst *resume; /* the first instruction of the next burst, at resume_pc */
  uint64_t atomics;                    /* mask of registers that atomic increments under way will write */

  uint64_t issued, jumps; /* instructions and taken jumps that were issued in earlier bursts */
  uint32_t load_count;    /* loads of global memory of the current burst */
  uint32_t burst_jumps;   /* taken jumps of the current burst, that of its last step included */
  uint64_t burst_lines;   /* bit line % 64: a superset of the lines of the burst's steps */

  /* The steps of the burst, or the step of a head that executes at issue. The last step may be followed by others that
     are not part of the burst. */
  _Alignas(64) uint16_t step[TRAX_BURST + TRAX_CHUNK];
  uint8_t segment[TRAX_BURST + TRAX_CHUNK]; /* [step]: the number of its segment */
  uint32_t address[TRAX_BURST];             /* the addresses of the burst's loads of global memory, in order */
  uint32_t origin[TRAX_BURST + 1];          /* [segment]: its first instruction's index minus its first step */

  /* The state at the beginning of the burst, for a roll back (blocks.c). */
  const struct trax_fast_inst *begin;
  uint32_t undo_count;
  uint32_t reg[TRAX_NUM_REGISTERS + 1];
  struct trax_fast_undo undo[TRAX_BURST];
};

struct trax_fast_tm {
  struct trax_tm *tm;
  struct trax_fast *fast;
  struct trax_fast_tp *tp; /* [tps] */
  /* The number of executions of each instruction since the latest collect(), as differences: that of instruction i is
     the sum of [0] to [i]. So a segment costs two additions. */
  int64_t *count_deltas; /* [inst_count + 1] */
  struct trax_fast_heads heads;
  bool wide;                                       /* more than 32 TPs */
  const uint32_t *address_of[TRAX_MAX_TPS_PER_TM]; /* trax_fast_tp.address; of TPs that do not exist, TP 0's */
  /* Masks of registers that may not be usable yet: an issue sets the bit of its destination unless the result is usable
     in the next cycle, and a check that finds the register usable clears it. trax_tp.usable is only valid for registers
     whose bit is set. */
  uint32_t busy_registers[TRAX_MAX_TPS_PER_TM];

  /* Masks of TPs. */
  uint64_t ready; /* holds an instruction with usable operands, which lacks a unit, a bank or a queue place */
  uint64_t executes_at_issue;
  uint64_t no_text;   /* the head is no text: its fetch faults */
  uint64_t busy;      /* busy_registers is not 0 */
  uint64_t uncertain; /* a line of the burst may not be resident */
  uint64_t recheck;   /* held an instruction at the import, whose operands must be checked in the first cycle */

  /* Round-robin masks of the instruction caches' banks. `simple_fetch`: 16 TPs share a cache, which has at most 16
     banks of one port; then fetch_rr_masks16 is used, and all caches are arbitrated together (masks.h). Otherwise
     fetch_rr_masks has `vectors` vectors for each cache. */
  bool simple_fetch;
  uint32_t vectors;
  struct trax_fast_banks16 fetch_rr_masks16;
  trax_fast_lanes *fetch_rr_masks;
  uint32_t data_banks, data_bank_bits;
  bool serial_hits; /* data-cache hits are served one by one: they update the scoreboard or the LRU order */
  uint8_t (*resident)[TRAX_FAST_LINES]; /* [tm->icaches]: whether the cache holds each line of the program */
  uint64_t *resident_lines;             /* [tm->icaches]: the same as bits, for programs of at most 64 lines; else 0 */
  uint8_t icache_of[TRAX_MAX_TPS_PER_TM];

  struct trax_fast_units fp;      /* adders, multipliers */
  struct trax_fast_units int_mul; /* integer multipliers; the second kind is not used */
  trax_fast_lanes data_bank_rr_masks[TRAX_MAX_TPS_PER_TM / TRAX_FAST_LANES];
  struct trax_fast_refusal_counts refusal_counts;

  /* [TP]: the words of WRITTEN blocks from which its burst has loaded, as bits of trax_fast_word_bit; 0: none. */
  _Alignas(64) uint64_t watched[TRAX_MAX_TPS_PER_TM];

  uint64_t looked_up, single_hits, at_issue; /* counters of machine/fast_path.h */
};

/* The state of a block of global memory in the run (blocks.c). */
enum { TRAX_BLOCK_SHIFT = 4, TRAX_BLOCK_LOADED = 1, TRAX_BLOCK_WRITTEN, TRAX_BLOCK_SHARED, TRAX_BLOCK_HOLE };

struct trax_fast_blocks {
  /* [block]: 0, then LOADED by a burst, then WRITTEN, then SHARED; or a later one at once. Several TMs may set LOADED
     at the same time. The others are only set while no TM runs. Loads from SHARED blocks and from HOLEs end bursts. */
  uint8_t *state;
  size_t bytes;
  unsigned roll_backs;         /* of all TPs, for the first write of a LOADED block */
  uint32_t input, input_bytes; /* trax_space.input until a first write there: all of it counts as LOADED */
};

static inline bool trax_fast_is_loaded(const struct trax_fast_blocks *blocks, uint32_t address) {
  return blocks->state[address >> TRAX_BLOCK_SHIFT] == TRAX_BLOCK_LOADED ||
         address - blocks->input < blocks->input_bytes;
}

/* Requires that the block is not LOADED, or that all TPs have rolled back. state: WRITTEN or SHARED. */
static inline void trax_fast_set_written(struct trax_fast_blocks *blocks, uint32_t address, uint8_t state) {
  uint8_t *const block = &blocks->state[address >> TRAX_BLOCK_SHIFT];
  *block = *block < state ? state : *block;
  if (address - blocks->input < blocks->input_bytes)
    blocks->input_bytes = 0;
}

/* Returns the bit of a word in trax_fast_tm.watched. */
static inline uint64_t trax_fast_word_bit(uint32_t address) {
  return (uint64_t)1 << ((address >> 2) * 0x9E3779B1u >> 26);
}

struct trax_fast {
  struct trax_chip *chip;
  struct trax_fast_program program;
  struct trax_fast_tm *tm; /* [tms] */
  unsigned burst; /* limit of a burst's instructions; 1 with an observer, which must see the state at each issue */
  struct trax_fast_blocks blocks;
};

/* Returns the index of a step's instruction in trax_fast_program.inst. */
static inline uint32_t trax_fast_index(const struct trax_fast_tp *ftp, unsigned step) {
  return ftp->origin[ftp->segment[step]] + step;
}

/* Returns the index of the TP's head. */
static inline uint32_t trax_fast_head(const struct trax_fast_tm *ftm, unsigned tp) {
  return trax_fast_index(&ftm->tp[tp], ftm->heads.at[tp]);
}

static inline const struct trax_fast_timing *trax_fast_head_timing(const struct trax_fast_tm *ftm, unsigned tp) {
  return &ftm->fast->program.timing[trax_fast_head(ftm, tp)];
}

/* Returns the bit of a register in busy_registers. */
static inline uint32_t trax_fast_register_bit(unsigned rd) {
  return (uint32_t)((uint64_t)1 << rd); /* 0 for TRAX_NO_REGISTER */
}

/* --- head.c --- */
/* Sets the next step that must be checked when it becomes the head: one that needs a register of busy_registers or, if
   the TP is uncertain, is in another line than this head. `fetched`: this head has been checked and fetched in this
   cycle; otherwise an earlier check stays scheduled, since lines may have been evicted. */
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
/* Executes instructions from `resume` on, as steps from 0 on, and returns their number: at most `limit`; exactly
   `limit` if that is less than TRAX_BURST and no instruction ends the burst. */
unsigned trax_fast_burst(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned tp, unsigned limit);

/* Returns the labels of all operations, by trax_op; TRAX_OP_ILLEGAL: the end of a burst; TRAX_OP_COUNT: the label that
   records a chunk. */
const void *const *trax_fast_operations(void);

/* --- head.c --- */
/* Executes the next burst. If its first instruction cannot be executed before its issue, the head executes at issue. */
void trax_fast_refill(struct trax_fast_tm *ftm, unsigned tp);
/* Writes the head to the TP's structure, which tm.c and tp.c use: inst, pc, address. */
void trax_fast_export_head(struct trax_fast_tm *ftm, unsigned tp);
/* Ends the TP's burst of `executed` steps, of which the first `issued` were issued; the others count as not executed.
 */
void trax_fast_end_burst(struct trax_fast_tm *ftm, unsigned tp, unsigned executed, unsigned issued);
/* Updates the resident lines after a line has arrived in an instruction cache, and perhaps evicted another one. */
void trax_fast_line_arrived(struct trax_fast_tm *ftm, unsigned icache, uint32_t line);

/* --- fast.c --- */
/* Creates chip->fast. */
trax_status trax_fast_create(struct trax_chip *chip, trax_error *error);
void trax_fast_destroy(struct trax_fast *fast); /* fast may be NULL */
/* Adds the instructions executed since the latest call to the TMs' statistics, with those that have not been issued. */
void trax_fast_collect(struct trax_fast *fast);
/* Completes statistics and charges for the cycles that are over. */
void trax_fast_settle(struct trax_fast *fast);
/* Notifies an observer of the refusals of the current cycle. */
void trax_fast_notify_refusals(const struct trax_fast_tm *ftm, const struct trax_fast_refused *refused);

/* --- blocks.c --- */
trax_status trax_fast_blocks_create(struct trax_fast_blocks *blocks, const struct trax_space *space, trax_error *error);
void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks);
/* To be called outside epochs before a store (WRITTEN) or atomic increment (SHARED) writes to a global address, and
   when the increment is issued: rolls back all TPs whose bursts may have loaded the word. */
void trax_fast_word_written(struct trax_fast *fast, uint32_t address, uint8_t state);
/* The same before an atomic increment of the memory controller; `fast` is a struct trax_fast. */
void trax_fast_increment_outside(void *fast, uint32_t address);
/* The same for a range, before a host call writes it. */
void trax_fast_range_written(void *fast, uint32_t address, uint32_t bytes);
/* Rolls back the TPs of a TM whose bursts have loaded the word from a WRITTEN block: in an epoch, before the TM stores
   to it. */
void trax_fast_roll_back_readers(struct trax_fast_tm *ftm, uint32_t address);
/* Records the loads of all bursts from WRITTEN blocks in the TM's store buffer, at the beginning of an epoch. */
void trax_fast_record_readers(struct trax_fast_tm *ftm);
/* Rolls every TP back to what it has issued; all heads execute at issue then. */
void trax_fast_roll_back(struct trax_fast *fast);

/* --- transfer.c --- */
/* Between cycles: rolls every TP back to what it has issued, so that the structures of tm.h and tp.h hold all that the
   run depends on. The run can be continued. */
void trax_fast_export(struct trax_fast *fast);
/* Continues the run before cycle t with the state in those structures. */
void trax_fast_import(struct trax_fast *fast, uint64_t t);

#endif
