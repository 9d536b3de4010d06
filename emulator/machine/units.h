/* The units that execute instructions, and their latencies (docs/timing.md, "Units"), declared once: decoding, both
   timed engines, causes, counters, figures, energy and the page's tables follow from these rows. In their expressions,
   C is the configuration, a const struct trax_config *. */
#ifndef TRAX_MACHINE_UNITS_H
#define TRAX_MACHINE_UNITS_H

/* Units that the TPs of a TM share, a row U(X, ...) for each kind, in the order of the statistics:
     identifier; name, from which the names of its statistics are made
     TPs of a group; units of a group (0: instructions that need one are illegal)
     mm2 of a unit at 65 nm, 0 if the fit of area_mm2 includes it
     descriptions: a unit; the cause of a refusal, short and long; the counter of operations; the utilisation
   A new row needs keys in config_keys.h and a class below that uses the unit, and no other change of the emulator. The
   fast engine has special code for the first four (fast/time/grant.h); no instruction may take one of the first three
   for more than a cycle. */
/* clang-format off */
#define TRAX_SHARED_UNITS(U, X)                                                                                                            \
  U(X, FP_ADD, fp_add, C->fpu.tps_per_cluster, C->fpu.adders_per_cluster, 0, "adder",                                                      \
    "add-c", "another TP of the cluster had the adder", "operations the adders accepted",                                                  \
    "share of cycles in which an adder accepted an operation")                                                                             \
  U(X, FP_MUL, fp_mul, trax_or(C->fpu.mul_tps_per_cluster, C->fpu.tps_per_cluster), C->fpu.multipliers_per_cluster, 0, "multiplier",       \
    "mul-c", "another TP of the cluster had the multiplier", "operations the multipliers accepted",                                        \
    "share of cycles in which a multiplier accepted an operation")                                                                         \
  U(X, INT_MUL, int_mul, C->int_mul.tps_per_unit, C->int_mul.units_per_group, 0, "integer multiplier",                                     \
    "imul-c", "another TP had the integer multiplier", "operations the integer multipliers accepted",                                      \
    "share of cycles in which an integer multiplier accepted an operation")                                                                \
  U(X, SPECIAL, special, C->chip.tps_per_tm, C->special.units_per_tm, 0, "FPDIV/iSQRT unit",                                               \
    "div-c", "the FPDIV/iSQRT units were busy or given to other TPs", "operations the FPDIV/iSQRT units accepted",                         \
    "share of cycles in which an FPDIV/iSQRT unit was taken")                                                                              \
  /* 6 adders, 6 multipliers, 13 comparators and a divider (docs/results/ray-unit.md) */                                                   \
  U(X, RAY, ray, C->ray.tps_per_group, C->ray.units_per_group, 0.238386, "ray unit",                                                       \
    "ray-c", "the group's ray units were busy or given to other TPs", "operations the ray units accepted",                                 \
    "share of cycles in which a ray unit was taken")

/* Classes of instructions that execute on more than the TP's integer unit and sequencer:
     identifier; unit and flag of the ISA's records (isa/include/trax/isa.h; 0: any flag); the first row that matches counts
     the shared unit that it needs: a TRAX_SHARED_... or TRAX_SHARED_NONE, and its description
     latency; cycles for which it takes its unit; cause of a wait for the result
     nJ of an operation, and the member of TRAX_ENERGIES that it is added to (report/energy.c names the figures' sources) */
#define TRAX_CLASSES(X)                                                                                                                    \
  X(INT_MUL, INT_MUL, 0, TRAX_SHARED_INT_MUL, "integer multiplier", C->int_mul.latency_cycles, 1, DATA_OTHER, 0.0177, int_mul)             \
  X(FP_ADD, FP_ADD, TRAX_IS_FLOP, TRAX_SHARED_FP_ADD, "adder", C->fpu.add_latency_cycles, 1, DATA_OTHER, 0.0074, fp_add)                   \
  X(FP_COMPARE, FP_ADD, TRAX_IS_COMPARE, C->fpu.compare_units ? TRAX_SHARED_NONE : TRAX_SHARED_FP_ADD,                                     \
    "adder; the TP's own if `fpu.compare_units`", C->fpu.compare_latency_cycles, 1, DATA_OTHER, 0.000536, fp_other)                        \
  X(CONVERSION, FP_ADD, TRAX_IS_CONVERSION, C->fpu.compare_units ? TRAX_SHARED_NONE : TRAX_SHARED_FP_ADD,                                  \
    "adder; the TP's own if `fpu.compare_units`", C->fpu.convert_latency_cycles, 1, DATA_OTHER, 0.001, fp_other)                           \
  X(FP_MUL, FP_MUL, 0, TRAX_SHARED_FP_MUL, "multiplier", C->fpu.mul_latency_cycles, 1, DATA_OTHER, 0.0142, fp_mul)                         \
  X(ROOT, SPECIAL, TRAX_IS_ROOT, TRAX_SHARED_SPECIAL, "FPDIV/iSQRT unit",                                                                  \
    trax_or(C->special.rsqrt_latency_cycles, C->special.latency_cycles),                                                                   \
    C->special.pipelined ? 1 : trax_or(C->special.rsqrt_latency_cycles, C->special.latency_cycles), DATA_SPECIAL, 0.1563, special)         \
  X(DIVISION, SPECIAL, 0, TRAX_SHARED_SPECIAL, "FPDIV/iSQRT unit", C->special.latency_cycles,                                              \
    C->special.pipelined ? 1 : C->special.latency_cycles, DATA_SPECIAL, 0.1563, special)                                                   \
  X(RAY_BOX, RAY_BOX, 0, TRAX_SHARED_RAY, "ray unit", C->ray.box_latency_cycles, C->ray.box_interval_cycles, DATA_OTHER, 0.136568, ray)    \
  X(RAY_TRIANGLE, RAY_TRIANGLE, 0, TRAX_SHARED_RAY, "ray unit", C->ray.triangle_latency_cycles, C->ray.triangle_interval_cycles,           \
    DATA_OTHER, 0.67738, ray)

/* The consumers of energy, a row E(X, ...) each: identifier, meaning. */
#define TRAX_ENERGIES(E, X)                                                                                                                \
  E(X, fp_add, "adders: additions and subtractions")                                                                                       \
  E(X, fp_mul, "multipliers")                                                                                                              \
  E(X, fp_other, "comparisons, minima, maxima, conversions")                                                                               \
  E(X, int_mul, "integer multipliers")                                                                                                     \
  E(X, special, "FPDIV/iSQRT units")                                                                                                       \
  E(X, ray, "ray units")                                                                                                                   \
  E(X, integer, "the TPs' integer units: instructions, addresses, branches")                                                               \
  E(X, registers, "register files: an access for each operand and each result")                                                            \
  E(X, local_memory, "local memories")                                                                                                     \
  E(X, icache, "instruction caches: fetches, and lines that arrive")                                                                       \
  E(X, dcache, "data caches: loads, stores through them, and lines that arrive")                                                           \
  E(X, l2, "second-level cache: requests, and lines that arrive")
/* clang-format on */

typedef enum trax_shared {
#define TRAX_SHARED_ENUM(X, ID, ...) TRAX_SHARED_##ID,
  TRAX_SHARED_UNITS(TRAX_SHARED_ENUM, )
#undef TRAX_SHARED_ENUM
      TRAX_SHARED_COUNT,
  TRAX_SHARED_NONE = TRAX_SHARED_COUNT /* the TP's own units */
} trax_shared;

typedef enum trax_class {
#define TRAX_CLASS_ENUM(ID, ...) TRAX_CLASS_##ID,
  TRAX_CLASSES(TRAX_CLASS_ENUM)
#undef TRAX_CLASS_ENUM
      TRAX_CLASS_OWN, /* all others */
  TRAX_CLASS_COUNT
} trax_class;

#endif
