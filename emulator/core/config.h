/* The machine's configuration: a plain struct of values, one member per key. The key of a value is its path in the
   struct
   ("memory.bandwidth_gbps"); emulator/host/config.c reads and prints keys, docs/timing.md says what each value does.
   "paper" marks what the paper fixes; every other default is ours. */
#ifndef TRAX_CORE_CONFIG_H
#define TRAX_CORE_CONFIG_H

#include "trax/emulator.h"

#include <stdbool.h>
#include <stdint.h>

#define TRAX_MAX_TMS 64
#define TRAX_MAX_TPS_PER_TM 64 /* the TPs of a TM are the bits of one uint64_t */
#define TRAX_MAX_THREADS (TRAX_MAX_TMS * TRAX_MAX_TPS_PER_TM)

struct trax_config {
  struct {
    uint32_t tms;        /* 1..64, default 1; paper: 1, 2, 4, 6, 8 */
    uint32_t tps_per_tm; /* 1..64, default 1; paper: 32, 48, 64 */
    uint32_t clock_mhz;  /* 1..100000, default 500 (paper) */
  } chip;
  struct {
    uint32_t int_latency_cycles; /* 1..1000, default 1 (paper); the integer unit and the sequencer (jal's link, rdsr) */
    uint32_t local_latency_cycles; /* 1..1000, default 1: a load from local memory */
    uint32_t branch_bubble_cycles; /* 0..1000, default 0: lost after a taken branch */
  } tp;
  struct {
    uint32_t bytes;          /* power of two, 64..16777216, default 4096 (paper) */
    uint32_t line_bytes;     /* power of two, 4..4096, default 64 */
    uint32_t ways;           /* power of two, 1..64, default 1: direct mapped */
    uint32_t banks;          /* 1..64, default 16 (paper) */
    uint32_t ports_per_bank; /* 1..64, default 1: fetches a bank serves in a cycle */
    uint32_t tps_per_cache;  /* 1..64, default 16 (paper) */
  } icache;
  struct {
    uint32_t tps_per_cluster;    /* 1..64, default 8 (paper): TPs that share one adder and one multiplier */
    uint32_t add_latency_cycles; /* 1..1000, default 1 (paper) */
    uint32_t mul_latency_cycles; /* 1..1000, default 1 (paper) */
    bool compare_units; /* default false: comparison, min, max and conversion use the adder; true: the TP's own */
    uint32_t compare_latency_cycles; /* 1..1000, default 1: of those operations, wherever they execute */
  } fpu;
  struct {
    uint32_t tps_per_unit;   /* 1..64, default 16: TPs that share one integer multiplier */
    uint32_t latency_cycles; /* 1..1000, default 1 */
  } int_mul;
  struct {
    uint32_t units_per_tm;   /* 1..64, default 1 (paper): FPDIV/iSQRT units */
    uint32_t latency_cycles; /* 1..1000, default 8 (paper) */
    bool pipelined;          /* default false: a unit is busy for its whole latency */
    uint32_t
        precision_bits; /* 1..24, default 24: significant bits of a result, the leading one included; 24 is exact */
  } special;
  struct {
    uint32_t bytes;              /* power of two, 64..16777216, default 16384 (paper) */
    uint32_t line_bytes;         /* power of two, 4..4096, default 64 */
    uint32_t ways;               /* power of two, 1..64, default 1: direct mapped */
    uint32_t tps_per_bank;       /* 1..64, default 8 (paper): the cache has ceil(tps_per_tm / tps_per_bank) banks */
    uint32_t hit_latency_cycles; /* 1..1000, default 1 */
    uint32_t mshrs;              /* 1..1024, default 64: lines on their way at once */
  } dcache;
  struct {
    double bandwidth_gbps;   /* GB/s (1e9), 0.001..1000000 to the nearest 0.001, default 8 (paper): the whole chip */
    uint32_t latency_cycles; /* 0..100000, default 100: added to every transfer */
    uint32_t queue_depth;    /* 1..4096, default 128: requests of one TM under way */
    uint32_t size_mib;       /* 1..4095, default 1024: end of global memory */
    uint32_t min_transfer_bytes; /* 1..4096, default 1: a shorter transfer costs as much as this */
    uint32_t atomic_bytes;       /* 1..4096, default 8: what an atomic increment costs, a word read and written */
    bool write_combining;        /* default true: adjacent stores of a TP become one transfer */
  } memory;
};

/* Initialiser with the defaults above: one TP, everything else as in the paper. */
#define TRAX_CONFIG_DEFAULT                                                                                            \
  {                                                                                                                    \
    .chip = {.tms = 1, .tps_per_tm = 1, .clock_mhz = 500},                                                             \
    .tp = {.int_latency_cycles = 1, .local_latency_cycles = 1, .branch_bubble_cycles = 0},                             \
    .icache = {.bytes = 4096, .line_bytes = 64, .ways = 1, .banks = 16, .ports_per_bank = 1, .tps_per_cache = 16},     \
    .fpu = {.tps_per_cluster = 8,                                                                                      \
            .add_latency_cycles = 1,                                                                                   \
            .mul_latency_cycles = 1,                                                                                   \
            .compare_units = false,                                                                                    \
            .compare_latency_cycles = 1},                                                                              \
    .int_mul = {.tps_per_unit = 16, .latency_cycles = 1},                                                              \
    .special = {.units_per_tm = 1, .latency_cycles = 8, .pipelined = false, .precision_bits = 24},                     \
    .dcache = {.bytes = 16384, .line_bytes = 64, .ways = 1, .tps_per_bank = 8, .hit_latency_cycles = 1, .mshrs = 64},  \
    .memory = {.bandwidth_gbps = 8,                                                                                    \
               .latency_cycles = 100,                                                                                  \
               .queue_depth = 128,                                                                                     \
               .size_mib = 1024,                                                                                       \
               .min_transfer_bytes = 1,                                                                                \
               .atomic_bytes = 8,                                                                                      \
               .write_combining = true},                                                                               \
  }

/* All the ranges above and the relations between keys, whatever way the struct was filled; the machine relies on
   nothing else. The message names the key and what is allowed. */
trax_status trax_config_validate(const struct trax_config *config, trax_error *error);

#endif
