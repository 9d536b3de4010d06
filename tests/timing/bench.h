/* A bench for programs of a few instructions: assemble, run, look at issue cycles, charges and memory. */
#ifndef TRAX_TIMING_BENCH_H
#define TRAX_TIMING_BENCH_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "machine/machine.h"
#include "machine/text.h"
#include "trax/isa.h"

#define TEXT 0x1000u
#define DATA 0x10000u /* what `lui rd, 1` gives */
#define DATA_BYTES 0x10000u
#define RODATA 0x30000u /* 64 read-only bytes */

/* Instructions by format. */
#define R(OP, RD, RA, RB) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, RB, 0})
#define R1(OP, RD, RA) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, 0, 0})
#define I(OP, RD, RA, IMM) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, 0, IMM})
#define U(OP, RD, IMM) trax_encode((trax_inst){TRAX_OP_##OP, RD, 0, 0, IMM})
#define S(OP, RB, RA, IMM) trax_encode((trax_inst){TRAX_OP_##OP, 0, RA, RB, IMM})
#define B(OP, RA, RB, OFFSET) trax_encode((trax_inst){TRAX_OP_##OP, 0, RA, RB, OFFSET})
#define J(RD, OFFSET) trax_encode((trax_inst){TRAX_OP_JAL, RD, 0, 0, OFFSET})
#define T(RA, CODE) trax_encode((trax_inst){TRAX_OP_TRAP, 0, RA, 0, CODE})
#define FENCE(KIND) trax_encode((trax_inst){.op = TRAX_OP_FENCE, .imm = TRAX_FENCE_##KIND})
#define NOP I(ADDI, 0, 0, 0)
#define HALT trax_encode((trax_inst){.op = TRAX_OP_HALT})

struct bench_issues {
  struct trax_issue *issue;
  size_t count, capacity;
};

/* The reports to a thread's observer. */
struct bench_told {
  uint64_t until; /* all cycles before it */
  uint64_t cycles[TRAX_CAUSE_COUNT];
  uint64_t waits[TRAX_NUM_REGISTERS]; /* for each register */
  uint64_t causes;                    /* a hash of the cause of each cycle, in order */
};

struct bench {
  struct trax_machine *machine;
  struct bench_issues issues; /* in the order of issue */
  struct bench_told *told;    /* [threads] */
  trax_error error;
  trax_status status;
};

/* Memory is next to the chip: any request completes in the cycle after it was made, if those of one cycle together
   have at most 2,000,000 bytes. The only instruction line holds the first 256 instructions. */
struct trax_config bench_near(uint32_t tms, uint32_t tps);
/* The default memory: a line takes 4 cycles and 100 more. Instruction banks have ports for all TPs. */
struct trax_config bench_far(uint32_t tms, uint32_t tps);

/* Loads the words at TEXT, with writable DATA and read-only RODATA, and runs; max_cycles 0 is no limit. The caller
   looks at bench.machine and calls bench_end. */
struct bench bench_begin(const struct trax_config *config, const uint32_t *words, size_t count);
void bench_run(struct bench *bench, uint64_t max_cycles);
/* Runs with an observer, who must be told of every cycle of every thread once, and in order. */
extern bool bench_stretches; /* the next observer takes stretches */
void bench_run_observed(struct bench *bench, const trax_run_options *options);
void bench_end(struct bench *bench);

#define BENCH(CONFIG, ...)                                                                                             \
  bench_of(&(CONFIG), (const uint32_t[]){__VA_ARGS__}, sizeof((const uint32_t[]){__VA_ARGS__}) / 4)
/* Begins and runs without limit; the run must end well. */
struct bench bench_of(const struct trax_config *config, const uint32_t *words, size_t count);

uint64_t bench_cycles(const struct bench *bench);
uint64_t bench_charge(const struct bench *bench, unsigned thread, trax_cause cause);
uint64_t bench_total(const struct bench *bench, trax_cause cause);
uint32_t bench_word(const struct bench *bench, uint32_t address);

/* Thread's issue cycles must be exactly these. */
#define ISSUES(BENCH, THREAD, ...)                                                                                     \
  bench_expect_issues(BENCH, THREAD, (const uint64_t[]){__VA_ARGS__}, sizeof((const uint64_t[]){__VA_ARGS__}) / 8,     \
                      __FILE__, __LINE__)
void bench_expect_issues(const struct bench *bench, unsigned thread, const uint64_t *cycles, size_t count,
                         const char *file, int line);

/* The causes of a thread other than ISSUED and HALTED must be exactly these pairs of cause and cycles. */
#define CHARGES(BENCH, THREAD, ...)                                                                                    \
  bench_expect_charges(BENCH, THREAD, (const uint64_t[]){__VA_ARGS__}, sizeof((const uint64_t[]){__VA_ARGS__}) / 8,    \
                       __FILE__, __LINE__)
void bench_expect_charges(const struct bench *bench, unsigned thread, const uint64_t *pairs, size_t count,
                          const char *file, int line);

#endif
