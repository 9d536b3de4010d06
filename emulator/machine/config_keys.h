/* Every configuration value, declared once: the struct, the defaults, the ranges, the files' keys and the documentation
   come from this table; docs/timing.md says what each value does.

   BEGIN(section) and END(section) enclose the keys of a section. A key is declared by its kind:
     COUNT   uint32_t
     POWER   uint32_t, a power of two, or 0 if the least value is 0
     FLAG    bool (the range is 0 to 1)
     REAL    double, in steps of 0.001
     POLICY  uint32_t, an enum trax_replacement
   with section, key, default, least, greatest, unit, origin of the default (PAPER, or OURS where the paper is silent)
   and meaning. */
#ifndef TRAX_MACHINE_CONFIG_KEYS_H
#define TRAX_MACHINE_CONFIG_KEYS_H

#include "machine/replacement.h"

#define TRAX_MAX_TMS 64
#define TRAX_MAX_TPS_PER_TM 64 /* the TPs of a TM are the bits of one uint64_t */
#define TRAX_MAX_CHANNELS 16

/* clang-format off */
#define TRAX_CONFIG_KEYS(BEGIN, COUNT, POWER, FLAG, REAL, POLICY, END)                                                                     \
  BEGIN(chip)                                                                                                                              \
  COUNT(chip, tms, 1, 1, TRAX_MAX_TMS, "TMs", OURS,  "thread multiprocessors of the chip (paper: 1, 2, 4, 6, 8)")                          \
  COUNT(chip, tps_per_tm, 1, 1, TRAX_MAX_TPS_PER_TM, "TPs", OURS,  "thread processors of a TM (paper: 32, 48, 64)")                        \
  COUNT(chip, clock_mhz, 500, 1, 100000, "MHz", PAPER, "clock of the chip")                                                                \
  END(chip)                                                                                                                                \
  BEGIN(tp)                                                                                                                                \
  COUNT(tp, int_latency_cycles, 1, 1, 1000, "cycles", PAPER, "latency of the integer unit and the sequencer (jal's link, rdsr)")           \
  COUNT(tp, local_latency_cycles, 1, 1, 1000, "cycles", OURS, "latency of a load from local memory")                                       \
  COUNT(tp, branch_bubble_cycles, 0, 0, 1000, "cycles", OURS, "lost after a taken branch")                                                 \
  END(tp)                                                                                                                                  \
  BEGIN(icache)                                                                                                                            \
  POWER(icache, bytes, 4096, 64, 1u << 24, "bytes", PAPER, "size of an instruction cache")                                                 \
  POWER(icache, line_bytes, 64, 4, 4096, "bytes", OURS, "line of an instruction cache")                                                    \
  POWER(icache, ways, 1, 1, 64, "ways", OURS, "associativity; 1 is direct mapped")                                                         \
  COUNT(icache, banks, 16, 1, 64, "banks", PAPER, "banks of an instruction cache")                                                         \
  COUNT(icache, ports_per_bank, 1, 1, 64, "fetches/cycle", OURS, "fetches a bank serves in a cycle")                                       \
  COUNT(icache, tps_per_cache, 16, 1, 64, "TPs", PAPER, "TPs that share an instruction cache")                                             \
  END(icache)                                                                                                                              \
  BEGIN(fpu)                                                                                                                               \
  COUNT(fpu, tps_per_cluster, 8, 1, 64, "TPs", PAPER, "TPs that share adders, and multipliers (but see fpu.mul_tps_per_cluster)")          \
  COUNT(fpu, adders_per_cluster, 1, 1, 64, "adders", PAPER, "adders that they share")                                                      \
  COUNT(fpu, multipliers_per_cluster, 1, 1, 64, "multipliers", PAPER, "multipliers that they share")                                       \
  COUNT(fpu, mul_tps_per_cluster, 0, 0, 64, "TPs", OURS, "TPs that share multipliers; 0: as fpu.tps_per_cluster")                          \
  COUNT(fpu, add_latency_cycles, 1, 1, 1000, "cycles", PAPER, "latency of addition and subtraction")                                       \
  COUNT(fpu, mul_latency_cycles, 1, 1, 1000, "cycles", PAPER, "latency of multiplication")                                                 \
  FLAG(fpu, compare_units, false, 0, 1, "", OURS, "comparison, min, max and conversion on units of the TP's own; false: on the adder")     \
  COUNT(fpu, compare_latency_cycles, 1, 1, 1000, "cycles", OURS, "latency of comparison, min and max, wherever they execute")              \
  COUNT(fpu, convert_latency_cycles, 1, 1, 1000, "cycles", OURS, "latency of conversion, wherever it executes")                            \
  END(fpu)                                                                                                                                 \
  BEGIN(int_mul)                                                                                                                           \
  COUNT(int_mul, tps_per_unit, 16, 1, 64, "TPs", OURS, "TPs that share integer multipliers")                                               \
  COUNT(int_mul, units_per_group, 1, 1, 64, "units", OURS, "integer multipliers that they share")                                          \
  COUNT(int_mul, latency_cycles, 1, 1, 1000, "cycles", OURS, "latency of integer multiplication")                                          \
  END(int_mul)                                                                                                                             \
  BEGIN(special)                                                                                                                           \
  COUNT(special, units_per_tm, 1, 1, 64, "units", PAPER, "FPDIV/iSQRT units of a TM")                                                      \
  COUNT(special, latency_cycles, 8, 1, 1000, "cycles", PAPER, "latency of FPDIV, and of iSQRT (but see special.rsqrt_latency_cycles)")     \
  COUNT(special, rsqrt_latency_cycles, 0, 0, 1000, "cycles", OURS, "latency of iSQRT; 0: as special.latency_cycles")                       \
  FLAG(special, pipelined, true, 0, 1, "", PAPER, "a unit accepts an operation every cycle; false: it is busy for its latency")            \
  COUNT(special, precision_bits, 24, 1, 24, "bits", OURS, "significant bits of a result, the leading one included; 24 is exact")           \
  END(special)                                                                                                                             \
  BEGIN(dcache)                                                                                                                            \
  POWER(dcache, bytes, 16384, 64, 1u << 24, "bytes", PAPER, "size of a TM's data cache")                                                   \
  POWER(dcache, line_bytes, 64, 4, 4096, "bytes", OURS, "line of the data cache")                                                          \
  POWER(dcache, ways, 1, 1, 64, "ways", OURS, "associativity; 1 is direct mapped")                                                         \
  POLICY(dcache, replacement, TRAX_REPLACE_FIFO, 0, TRAX_REPLACEMENT_COUNT - 1, "", OURS, "which place of its set an arriving line takes") \
  COUNT(dcache, tps_per_bank, 8, 1, 64, "TPs", PAPER, "the cache has ceil(chip.tps_per_tm / this) banks")                                  \
  COUNT(dcache, hit_latency_cycles, 1, 1, 1000, "cycles", OURS, "latency of a load that hits")                                             \
  COUNT(dcache, mshrs, 64, 1, 1024, "lines", OURS, "lines on their way to the cache at once")                                              \
  END(dcache)                                                                                                                              \
  BEGIN(l2)                                                                                                                                \
  POWER(l2, bytes, 0, 0, 1u << 28, "bytes", OURS, "size of the second-level cache that the TMs share; 0: there is none")                   \
  POWER(l2, line_bytes, 64, 4, 4096, "bytes", OURS, "its line, at least as long as those of the other caches")                             \
  POWER(l2, ways, 8, 1, 64, "ways", OURS, "associativity; 1 is direct mapped")                                                             \
  POLICY(l2, replacement, TRAX_REPLACE_LRU, 0, TRAX_REPLACEMENT_COUNT - 1, "", OURS, "which place of its set an arriving line takes")      \
  COUNT(l2, banks, 8, 1, 64, "banks", OURS, "banks, each of which takes one request per cycle")                                            \
  COUNT(l2, latency_cycles, 20, 1, 1000, "cycles", OURS, "latency of a hit; added to what comes from memory")                              \
  COUNT(l2, mshrs, 256, 1, 4096, "lines", OURS, "lines on their way to the cache at once")                                                 \
  END(l2)                                                                                                                                  \
  BEGIN(memory)                                                                                                                            \
  REAL(memory, bandwidth_gbps, 8, 0.001, 1e6, "GB/s", PAPER, "off-chip bandwidth of the whole chip (1 GB is 1e9 bytes)")                   \
  COUNT(memory, channels, 1, 1, TRAX_MAX_CHANNELS, "channels", OURS, "channels with equal shares of the bandwidth")                        \
  POWER(memory, interleave_bytes, 256, 64, 1u << 20, "bytes", OURS, "bytes in one channel before the next one's follow")                   \
  COUNT(memory, latency_cycles, 100, 0, 100000, "cycles", OURS, "added to every transfer")                                                 \
  COUNT(memory, queue_depth, 128, 1, 4096, "requests", OURS, "requests of one TM under way")                                               \
  COUNT(memory, size_mib, 1024, 1, 4095, "MiB", OURS, "end of global memory")                                                              \
  COUNT(memory, min_transfer_bytes, 1, 1, 4096, "bytes", OURS, "a shorter transfer costs as much as this")                                 \
  COUNT(memory, atomic_bytes, 8, 1, 4096, "bytes", OURS, "cost of an atomic increment: a word read and written")                           \
  COUNT(memory, atomic_latency_cycles, 0, 0, 100000, "cycles", OURS, "added to every atomic increment")                                    \
  FLAG(memory, write_combining, true, 0, 1, "", OURS, "adjacent stores of a TP become one transfer")                                       \
  END(memory)
/* clang-format on */

#endif
