/* Every statistic, declared once: identifier, JSON name, unit, meaning. The counters of the engines, the reports and
   the documentation come from these tables; names are stable. */
#ifndef TRAX_MACHINE_STATS_H
#define TRAX_MACHINE_STATS_H

#include "machine/config.h"
#include "machine/units.h"
#include "trax/abi.h"
#include "trax/isa.h"

#include <stdint.h>

/* The causes to which thread-cycles are charged (docs/timing.md, "Accounting"): identifier, name, name for narrow
   columns, meaning. Every thread is charged to exactly one cause in every cycle, so that the causes add up to
   threads x cycles. ISSUED comes first, HALTED last. Their unit is thread-cycles. */
#define TRAX_CAUSES(X)                                                                                                 \
  X(ISSUED, "issued", "issued", "an instruction was issued")                                                           \
  X(ICACHE_BANK, "icache_bank_conflict", "i-bank", "another TP had the instruction-cache bank")                        \
  X(ICACHE_MISS, "icache_miss", "i-miss", "the instruction's line was on its way")                                     \
  X(DATA_LOCAL, "wait_local", "local", "an operand was being loaded from local memory")                                \
  X(DATA_HIT, "wait_dcache_hit", "d-hit", "an operand was being loaded from the data cache")                           \
  X(DATA_MISS, "wait_memory", "memory", "an operand was being loaded from off-chip memory")                            \
  X(DATA_SPECIAL, "wait_special", "div", "an operand was in the FPDIV/iSQRT unit")                                     \
  X(DATA_ATOMIC, "wait_atomic", "atomic", "an operand was the result of an atomic increment")                          \
  X(DATA_OTHER, "wait_other", "other", "an operand was in a unit whose latency is configured above one cycle")         \
  TRAX_SHARED_UNITS(TRAX_SHARED_CAUSE, X)                                                                              \
  X(DCACHE_BANK, "dcache_bank_conflict", "d-bank", "another TP had the data-cache bank")                               \
  X(MEMORY_QUEUE, "memory_queue_full", "queue", "no miss register or no place in the TM's memory queue was free")      \
  X(BRANCH, "branch_bubble", "bubble", "the bubble after a taken branch")                                              \
  X(LOCKSTEP, "lockstep", "step", "it waited for other lanes of its group")                                            \
  X(DIVERGENCE, "divergence", "diverg", "another group of its warp had been chosen")                                   \
  X(HALTED, "halted", "halted", "the thread had ended")
#define TRAX_SHARED_CAUSE(X, ID, NAME, SIZE, COUNT, AREA, UNIT, HEAD, REFUSED, ...)                                    \
  X(ID, #NAME "_conflict", HEAD, REFUSED)

typedef enum trax_cause {
#define TRAX_CAUSE_ENUM(ID, ...) TRAX_CAUSE_##ID,
  TRAX_CAUSES(TRAX_CAUSE_ENUM)
#undef TRAX_CAUSE_ENUM
      TRAX_CAUSE_COUNT
} trax_cause;

/* Whether a thread that is charged to the cause waits for a register. */
static inline bool trax_is_wait(trax_cause cause) {
  return cause >= TRAX_CAUSE_DATA_LOCAL && cause <= TRAX_CAUSE_DATA_OTHER;
}

/* Counters of each TM; the chip's figure is the sum: identifier, name, unit, meaning. */
#define TRAX_TM_COUNTERS(X)                                                                                            \
  X(rays, "rays", "rays", "rays the program reported with the traps rays and kinds")                                   \
  TRAX_RAY_KINDS(TRAX_KIND_COUNTER, X)                                                                                 \
  X(items, "items", "items", "items (pixels) the program reported with the items trap")                                \
  X(flops, "flops", "operations", "floating-point adds, subtractions and multiplications")                             \
  X(taken_branches, "taken_branches", "instructions", "branches and jumps that did not go to the next instruction")    \
  TRAX_SHARED_UNITS(TRAX_SHARED_COUNTER, X)                                                                            \
  X(icache_hits, "icache.hits", "lookups", "instruction fetches that found their line")                                \
  X(icache_misses, "icache.misses", "lookups", "instruction fetches that requested their line")                        \
  X(icache_merged, "icache.merged", "lookups", "instruction fetches whose line was already on its way")                \
  X(dcache_hits, "dcache.hits", "lookups", "cached loads that found their line")                                       \
  X(dcache_misses, "dcache.misses", "lookups", "cached loads that requested their line")                               \
  X(dcache_merged, "dcache.merged", "lookups", "cached loads whose line was already on its way")                       \
  X(broadcast_loads, "dcache.broadcast", "lookups", "of these, those that shared another lane's access to a bank")     \
  X(store_hits, "dcache.store_hits", "stores", "cached stores that updated a line in place")                           \
  X(store_misses, "dcache.store_misses", "stores", "cached stores that found no line to update")                       \
  X(dropped_lines, "dcache.dropped", "lines", "lines in the data cache that fences dropped")                           \
  X(local_loads, "local.loads", "instructions", "loads from local memory")                                             \
  X(local_stores, "local.stores", "instructions", "stores to local memory")                                            \
  X(nontemporal_loads, "nontemporal.loads", "instructions", "loads past the data cache")                               \
  X(nontemporal_stores, "nontemporal.stores", "instructions", "stores past the data cache")                            \
  X(combined_stores, "stores.combined", "stores", "stores that joined the TP's earlier one, at no cost of their own")  \
  X(atomics, "atomics", "instructions", "atomic increments")                                                           \
  X(fences, "fences", "instructions", "fences")                                                                        \
  X(data_read_bytes, "memory.data_read_bytes", "bytes", "lines read into the data cache")                              \
  X(instruction_read_bytes, "memory.instruction_read_bytes", "bytes", "lines read into the instruction caches")        \
  X(nontemporal_read_bytes, "memory.nontemporal_read_bytes", "bytes", "transfers of loads past the data cache")        \
  X(written_bytes, "memory.written_bytes", "bytes", "transfers of stores, after combining")                            \
  X(atomic_bytes, "memory.atomic_bytes", "bytes", "transfers of atomic increments")                                    \
  X(write_requests, "memory.write_requests", "requests", "transfers of stores, after combining")                       \
  X(memory_requests, "memory.requests", "requests", "requests to off-chip memory of any kind")                         \
  X(queue_peak, "memory.queue_peak", "requests", "most requests of one TM under way at once; for the chip, the sum")

#define TRAX_KIND_COUNTER(X, ID, NAME, NUMBER, MEANING)                                                                \
  X(rays_##NAME, "rays_by_kind." #NAME, "rays", "of these " MEANING)
#define TRAX_SHARED_COUNTER(X, ID, NAME, SIZE, COUNT, AREA, UNIT, HEAD, REFUSED, OPERATIONS, ...)                      \
  X(NAME##_ops, #NAME ".operations", "operations", OPERATIONS)

/* Counters of the second-level cache and the memory controller: identifier, name, unit, meaning. */
#define TRAX_MEMORY_COUNTERS(X)                                                                                        \
  X(bytes, "memory.bytes", "bytes", "moved to and from off-chip memory")                                               \
  X(transfers, "memory.transfers", "transfers", "transfers to and from off-chip memory")                               \
  X(l2_hits, "l2.hits", "requests", "reads that found their line in the second-level cache")                           \
  X(l2_misses, "l2.misses", "requests", "reads of lines that the second-level cache requested")                        \
  X(l2_merged, "l2.merged", "requests", "reads whose line was already on its way to the second-level cache")           \
  X(l2_passed, "l2.passed", "requests", "loads past the data cache that found no line in the second-level cache")      \
  X(l2_store_hits, "l2.store_hits", "requests", "writes and atomic increments that updated a line in place")           \
  X(l2_store_misses, "l2.store_misses", "requests", "writes and atomic increments that found no line to update")       \
  X(l2_refused, "l2.refused", "cycles", "cycles in which a bank refused for want of a miss register; sum of all")      \
  X(l2_served_bytes, "l2.served_bytes", "bytes", "read by the TMs through hits and merged reads")                      \
  X(l2_read_bytes, "l2.read_bytes", "bytes", "lines read into the second-level cache from off-chip memory")

/* Counters of the DRAM, if memory.model is dram: identifier, name, unit, meaning. */
#define TRAX_DRAM_COUNTERS(X)                                                                                          \
  X(activates, "dram.activates", "commands", "activations of rows")                                                    \
  X(conflicts, "dram.conflicts", "commands", "precharges of banks whose open row was another one")                     \
  X(row_hits, "dram.row_hits", "requests", "requests that found their row open")                                       \
  X(reads, "dram.reads", "bursts", "bursts that were read")                                                            \
  X(writes, "dram.writes", "bursts", "bursts that were written")                                                       \
  X(refreshes, "dram.refreshes", "commands", "refreshes of ranks")

struct trax_channel_stats {
  uint64_t transfers, bytes;
};

#define TRAX_COUNTER_FIELD(ID, NAME, UNIT, MEANING) uint64_t ID;

struct trax_dram_stats {
  TRAX_DRAM_COUNTERS(TRAX_COUNTER_FIELD)
};

struct trax_memory_stats {
  TRAX_MEMORY_COUNTERS(TRAX_COUNTER_FIELD)
  struct trax_channel_stats channel[TRAX_MAX_CHANNELS];
  struct trax_dram_stats dram;
};

struct trax_tp_stats {
  uint64_t cycles[TRAX_CAUSE_COUNT]; /* thread-cycles */
};

struct trax_tm_stats {
  uint64_t cycles[TRAX_CAUSE_COUNT];    /* thread-cycles: the sum over the TPs, filled in when the run ends */
  uint64_t instructions[TRAX_OP_COUNT]; /* issued, by operation */
  TRAX_TM_COUNTERS(TRAX_COUNTER_FIELD)
};

#undef TRAX_COUNTER_FIELD

/* The number of lookups in instruction caches. */
static inline uint64_t trax_fetches(const struct trax_tm_stats *stats) {
  return stats->icache_hits + stats->icache_misses + stats->icache_merged;
}

/* How a sampled run was sampled, and its confidence interval (sampling/). */
struct trax_sampling_stats {
  bool is_sampled;
  trax_slot_sampling asked;
  uint64_t windows; /* ranges of slots that were measured */
  double low, high; /* bounds of the 95 % confidence interval of the cycles */
  uint64_t detailed_cycles, detailed_instructions, detailed_slots; /* simulated */
  double predicted;                                                /* sum of the predicted costs; 0: there were none */
};

struct trax_stats {
  uint64_t cycles;       /* length of the run */
  uint64_t threads;      /* tms * tps_per_tm */
  uint64_t instructions; /* issued, all threads */
  double host_seconds;   /* wall time of trax_machine_run */
  struct trax_tm_stats total;
  struct trax_memory_stats memory;
  struct trax_sampling_stats sampling;
};

/* Figures that the reports compute from the counts: identifier, JSON name, unit, meaning, and a C expression over S
   (const struct trax_stats *) and C (const struct trax_config *). 0/0 is reported as 0. machine/timing.h and
   report/energy.h have the functions that the expressions call. */
#define TRAX_FIGURES(X)                                                                                                \
  X(cycles, "cycles", "cycles",                                                                                        \
    "length of the run: from cycle 0 until every thread has ended and the last transfer "                              \
    "is done",                                                                                                         \
    S->cycles)                                                                                                         \
  X(threads, "threads", "threads", "threads the chip runs", S->threads)                                                \
  X(thread_cycles, "thread_cycles", "thread-cycles", "threads times cycles: what the causes add up to",                \
    (double)S->threads *(double)S->cycles)                                                                             \
  X(instructions, "instructions", "instructions", "instructions issued by all threads", S->instructions)               \
  X(seconds, "seconds", "s", "simulated time", TRAX_SECONDS(S, C))                                                     \
  X(host_seconds, "host_seconds", "s", "wall time of the simulation", S->host_seconds)                                 \
  X(instructions_per_host_second, "instructions_per_host_second", "instructions/s", "speed of the simulation",         \
    S->instructions / S->host_seconds)                                                                                 \
  X(ipc, "instructions_per_cycle", "instructions/cycle", "whole chip", (double)S->instructions / S->cycles)            \
  X(mrps, "mrps", "million rays/s", "simulated rays per simulated second", S->total.rays / TRAX_SECONDS(S, C) / 1e6)   \
  X(gflops, "gflops", "10^9 operations/s", "adds, subtractions and multiplications per simulated second",              \
    S->total.flops / TRAX_SECONDS(S, C) / 1e9)                                                                         \
  X(peak_gflops, "peak_gflops", "10^9 operations/s", "an operation per adder, per multiplier and cycle",               \
    (double)(trax_shared_units(TRAX_SHARED_FP_ADD, C) + trax_shared_units(TRAX_SHARED_FP_MUL, C)) * C->chip.tms *      \
        C->chip.clock_mhz / 1e3)                                                                                       \
  X(area_mm2, "area_mm2", "mm2 at 65 nm",                                                                              \
    "fit of the paper's Table 1: 0.64 for a TM and 0.63 for each 16 TPs; of its caches and units",                     \
    C->chip.tms * (0.64 + 0.63 * C->chip.tps_per_tm / 16.0 + trax_shared_area(C)))                                     \
  TRAX_SHARED_UNITS(TRAX_SHARED_FIGURE, X)                                                                             \
  X(issue_utilisation, "issue.utilisation", "fraction", "share of thread-cycles that issued an instruction",           \
    (double)S->instructions / S->cycles / S->threads)                                                                  \
  X(simt_groups, "simt.groups", "instructions", "instructions fetched: once for all lanes of a group",                 \
    trax_fetches(&S->total))                                                                                           \
  X(simt_lanes, "simt.lanes_per_group", "lanes/instruction", "instructions issued per instruction fetched",            \
    (double)S->instructions / trax_fetches(&S->total))                                                                 \
  X(simt_efficiency, "simt.efficiency", "fraction", "the same per lane of a warp",                                     \
    (double)S->instructions / trax_fetches(&S->total) / C->simt.width)                                                 \
  X(icache_hit_rate, "icache.hit_rate", "fraction", "hits per instruction-cache lookup",                               \
    (double)S->total.icache_hits / trax_fetches(&S->total))                                                            \
  X(dcache_hit_rate, "dcache.hit_rate", "fraction", "hits per load that looked in the data cache",                     \
    (double)S->total.dcache_hits / (S->total.dcache_hits + S->total.dcache_misses + S->total.dcache_merged))           \
  X(l2_hit_rate, "l2.hit_rate", "fraction", "hits per read that the second-level cache looked up",                     \
    (double)S->memory.l2_hits / (S->memory.l2_hits + S->memory.l2_misses + S->memory.l2_merged + S->memory.l2_passed)) \
  X(memory_gbps, "memory.bandwidth_gbps", "GB/s", "off-chip bandwidth used",                                           \
    S->memory.bytes / TRAX_SECONDS(S, C) / 1e9)                                                                        \
  X(memory_utilisation, "memory.utilisation", "fraction", "share of the off-chip bandwidth used",                      \
    S->memory.bytes / TRAX_SECONDS(S, C) / 1e9 / trax_memory_gbps(C))                                                  \
  TRAX_ENERGIES(TRAX_ENERGY_FIGURE, X)                                                                                 \
  X(energy_total, "energy.total", "J",                                                                                 \
    "the sum of these: the chip's dynamic energy at 65 nm, without leakage and clock", trax_energy_of(S, C).total)     \
  X(energy_per_ray, "energy.per_ray", "J/ray", "the same for each ray", trax_energy_of(S, C).total / S->total.rays)    \
  X(energy_power, "energy.average_power", "W", "the same for each simulated second",                                   \
    trax_energy_of(S, C).total / TRAX_SECONDS(S, C))                                                                   \
  X(energy_off_chip, "energy.off_chip", "J", "off-chip memory, which is not in the sum", trax_energy_of(S, C).off_chip)

#define TRAX_SHARED_FIGURE(X, ID, NAME, SIZE, COUNT, AREA, UNIT, HEAD, REFUSED, OPERATIONS, UTILISATION)               \
  X(NAME##_utilisation, #NAME ".utilisation", "fraction", UTILISATION,                                                 \
    trax_shared_cycles(TRAX_SHARED_##ID, C, &S->total, S->total.NAME##_ops) / S->cycles /                              \
        (trax_shared_units(TRAX_SHARED_##ID, C) * C->chip.tms))
#define TRAX_ENERGY_FIGURE(X, ID, MEANING) X(energy_##ID, "energy." #ID, "J", MEANING, trax_energy_of(S, C).ID)
#define TRAX_SECONDS(S, C) ((double)(S)->cycles / ((C)->chip.clock_mhz * 1e6))
#endif
