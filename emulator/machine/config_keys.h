/* Every configuration value, declared once: the struct, the defaults, the ranges, the files' keys and the documentation
   come from this table; docs/timing.md says what each value does.

   BEGIN(component) and END(component) enclose the keys of a component. A key is declared by its kind:
     COUNT   uint32_t
     POWER   uint32_t, a power of two, or 0 if the least value is 0
     FLAG    bool (the range is 0 to 1)
     REAL    double, a multiple of 0.001
     POLICY  uint32_t, an enum trax_replacement
     MODEL   uint32_t, an enum trax_memory_model
     MAPPING double, a mapping of addresses (machine/dram_mapping.h)
   with component, key, default, least, greatest, unit, origin of the default (PAPER, or OURS where the paper is silent)
   and meaning. */
#ifndef TRAX_MACHINE_CONFIG_KEYS_H
#define TRAX_MACHINE_CONFIG_KEYS_H

#include "machine/dram_mapping.h"
#include "machine/replacement.h"

#define TRAX_MAX_TMS 64
#define TRAX_MAX_TPS_PER_TM 64 /* the TPs of a TM are the bits of one uint64_t */
#define TRAX_MAX_CHANNELS 16

/* clang-format off */
#define TRAX_CONFIG_KEYS(BEGIN, COUNT, POWER, FLAG, REAL, POLICY, MODEL, MAPPING, END)                                                     \
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
  BEGIN(simt)                                                                                                                              \
  COUNT(simt, width, 1, 1, TRAX_MAX_TPS_PER_TM, "TPs", PAPER, "neighbouring TPs of a warp, which execute together; 1: every TP by itself") \
  COUNT(simt, patience, 65536, 1, 1000000, "instructions", OURS, "that a warp issues without a lane before the lane has its turn")          \
  END(simt)                                                                                                                                \
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
  BEGIN(ray)                                                                                                                               \
  COUNT(ray, units_per_group, 0, 0, 64, "units", OURS, "ray units that TPs share; 0: fbox and ftri are illegal")                           \
  COUNT(ray, tps_per_group, 8, 1, 64, "TPs", OURS, "TPs that share them")                                                                  \
  COUNT(ray, box_latency_cycles, 13, 1, 1000, "cycles", OURS, "latency of a box, the transport of its operands included")                  \
  COUNT(ray, box_interval_cycles, 1, 1, 1000, "cycles", OURS, "time for which a box takes a unit")                                         \
  COUNT(ray, triangle_latency_cycles, 26, 1, 1000, "cycles", OURS, "latency of a triangle, likewise")                                      \
  COUNT(ray, triangle_interval_cycles, 4, 1, 1000, "cycles", OURS, "time for which a triangle takes a unit")                               \
  END(ray)                                                                                                                                 \
  BEGIN(dcache)                                                                                                                            \
  POWER(dcache, bytes, 16384, 64, 1u << 24, "bytes", PAPER, "size of a TM's data cache")                                                   \
  POWER(dcache, line_bytes, 64, 4, 4096, "bytes", OURS, "line of the data cache")                                                          \
  POWER(dcache, ways, 1, 1, 64, "ways", OURS, "associativity; 1 is direct mapped")                                                         \
  POLICY(dcache, replacement, TRAX_REPLACE_FIFO, 0, TRAX_REPLACEMENT_COUNT - 1, "", OURS, "which place of its set an arriving line takes") \
  COUNT(dcache, tps_per_bank, 8, 1, 64, "TPs", PAPER, "the cache has ceil(chip.tps_per_tm / this) banks")                                  \
  COUNT(dcache, hit_latency_cycles, 1, 1, 1000, "cycles", OURS, "latency of a load that hits")                                             \
  COUNT(dcache, mshrs, 64, 1, 1024, "lines", OURS, "lines on their way to the cache at once")                                              \
  COUNT(dcache, fill_cycles, 0, 0, 64, "cycles", OURS, "for which an arriving line takes the banks of its words; 0: none")                 \
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
  MODEL(memory, model, TRAX_MEMORY_LIMIT, 0, TRAX_MEMORY_MODEL_COUNT - 1, "", OURS, "what off-chip memory is: limit or dram")              \
  REAL(memory, bandwidth_gbps, 8, 0.001, 1e6, "GB/s", PAPER, "off-chip bandwidth of the whole chip (1 GB is 1e9 bytes)")                   \
  COUNT(memory, channels, 1, 1, TRAX_MAX_CHANNELS, "channels", OURS, "channels with equal shares of the bandwidth")                        \
  POWER(memory, interleave_bytes, 256, 64, 1u << 20, "bytes", OURS, "bytes in one channel before the next one's follow")                   \
  COUNT(memory, latency_cycles, 100, 0, 100000, "cycles", OURS, "added to every transfer")                                                 \
  COUNT(memory, queue_depth, 128, 1, 4096, "requests", OURS, "requests of one TM under way")                                               \
  COUNT(memory, size_mib, 1024, 1, 4095, "MiB", OURS, "end of global memory")                                                              \
  COUNT(memory, min_transfer_bytes, 1, 1, 4096, "bytes", OURS, "a shorter transfer costs as much as this")                                 \
  COUNT(memory, atomic_bytes, 8, 1, 4096, "bytes", OURS, "cost of an atomic increment: a word read and written")                           \
  COUNT(memory, atomic_latency_cycles, 0, 0, 100000, "cycles", OURS, "added to every atomic increment")                                    \
  COUNT(memory, atomic_interval_cycles, 0, 0, 100000, "cycles", OURS, "between the atomic increments of a channel")                        \
  FLAG(memory, write_combining, true, 0, 1, "", OURS, "adjacent stores of a TP become one transfer")                                       \
  END(memory)                                                                                                                              \
  BEGIN(dram)                                                                                                                              \
  COUNT(dram, mtps, 1600, 1, 100000, "10^6/s", OURS, "bits a second of each wire of the bus; a tick is two of them")                       \
  POWER(dram, bus_bits, 32, 8, 512, "bits", OURS, "width of a channel's data bus")                                                        \
  POWER(dram, burst_length, 8, 2, 64, "beats", OURS, "beats of a burst: words of the bus")                                                  \
  POWER(dram, ranks, 1, 1, TRAX_DRAM_MAX_RANKS, "ranks", OURS, "ranks of a channel")                                                       \
  POWER(dram, banks, 8, 1, TRAX_DRAM_MAX_BANKS, "banks", OURS, "banks of a rank")                                                          \
  POWER(dram, row_bytes, 4096, 64, 65536, "bytes", OURS, "row of a bank")                                                                  \
  MAPPING(dram, mapping, TRAX_DRAM_DEFAULT_MAPPING, 0, 9007199254740991.0, "", OURS, "fields of an address, the highest bits first")       \
  COUNT(dram, trcd, 15, 1, 1000, "ticks", OURS, "from the activation of a row to a read or write")                                         \
  COUNT(dram, trp, 15, 1, 1000, "ticks", OURS, "from the precharge of a bank to an activation")                                            \
  COUNT(dram, tcl, 12, 1, 1000, "ticks", OURS, "from a read to its data")                                                                  \
  COUNT(dram, tcwl, 6, 1, 1000, "ticks", OURS, "from a write to its data")                                                                 \
  COUNT(dram, tras, 34, 1, 1000, "ticks", OURS, "from an activation to the precharge")                                                     \
  COUNT(dram, trrd, 8, 1, 1000, "ticks", OURS, "between activations of a rank")                                                            \
  COUNT(dram, tfaw, 40, 1, 1000, "ticks", OURS, "window of at most four activations of a rank")                                            \
  COUNT(dram, twtr, 6, 1, 1000, "ticks", OURS, "from the end of written data to a read of the rank")                                       \
  COUNT(dram, twr, 12, 1, 1000, "ticks", OURS, "from the end of written data to the precharge")                                            \
  COUNT(dram, trtp, 6, 1, 1000, "ticks", OURS, "from a read to the precharge")                                                             \
  COUNT(dram, tturn, 2, 0, 1000, "ticks", OURS, "between data in different directions or of different ranks")                              \
  COUNT(dram, trefi, 3120, 0, 1000000, "ticks", OURS, "between refreshes of a rank, more than dram.trfc; 0: there are none")                                    \
  COUNT(dram, trfc, 104, 1, 10000, "ticks", OURS, "duration of a refresh")                                                                 \
  COUNT(dram, reads, 32, 1, TRAX_DRAM_MAX_QUEUE, "requests", OURS, "reads that a channel chooses from")                                    \
  COUNT(dram, writes, 32, 1, TRAX_DRAM_MAX_QUEUE, "requests", OURS, "writes that a channel collects")                                      \
  COUNT(dram, batch_from, 24, 1, TRAX_DRAM_MAX_QUEUE, "requests", OURS, "collected writes that begin a batch")                             \
  COUNT(dram, batch_to, 8, 0, TRAX_DRAM_MAX_QUEUE, "requests", OURS, "collected writes that a batch leaves")                               \
  COUNT(dram, write_wait, 4000, 0, 1000000, "ticks", OURS, "for which a write waits behind reads at most")                                 \
  COUNT(dram, cap, 16, 0, 1000000, "requests", OURS, "that overtake the oldest one at most; 0: first come, first served")                  \
  REAL(dram, activate_nj, 2.4, 0, 1e6, "nJ", OURS, "energy of an activation and its precharge")                                            \
  REAL(dram, read_nj, 1.6, 0, 1e6, "nJ", OURS, "energy of a burst that is read")                                                           \
  REAL(dram, write_nj, 1.6, 0, 1e6, "nJ", OURS, "energy of a burst that is written")                                                       \
  REAL(dram, refresh_nj, 20, 0, 1e6, "nJ", OURS, "energy of a refresh of a rank")                                                          \
  REAL(dram, background_mw, 50, 0, 1e6, "mW", OURS, "power of a rank without these")                                                       \
  END(dram)
/* clang-format on */

#endif
