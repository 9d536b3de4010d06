#include "machine/timing.h"

static uint32_t trax_or(uint32_t value, uint32_t if_zero) {
  return value ? value : if_zero;
}

trax_class trax_class_of(trax_op op) {
  const trax_op_info *info = &trax_op_table[op];
#define CLASS(ID, UNIT, FLAG, ...)                                                                                     \
  if (info->unit == TRAX_UNIT_##UNIT && ((FLAG) == 0 || (info->flags & (FLAG)) != 0))                                  \
    return TRAX_CLASS_##ID;
  TRAX_CLASSES(CLASS)
#undef CLASS
  return TRAX_CLASS_OWN;
}

struct trax_timing trax_timing_of(trax_op op, const struct trax_config *C) {
  switch (trax_class_of(op)) {
#define CLASS(ID, UNIT, FLAG, ASKS, WORDS, LATENCY, INTERVAL, CAUSE, ...)                                              \
  case TRAX_CLASS_##ID:                                                                                                \
    return (struct trax_timing){ASKS, LATENCY, INTERVAL, TRAX_CAUSE_##CAUSE};
    TRAX_CLASSES(CLASS)
#undef CLASS
  default:
    return (struct trax_timing){TRAX_SHARED_NONE, C->tp.int_latency_cycles, 1, TRAX_CAUSE_DATA_OTHER};
  }
}

bool trax_lacks_unit(trax_op op, const struct trax_config *config) {
  const trax_shared unit = trax_timing_of(op, config).unit;
  return unit != TRAX_SHARED_NONE && trax_shared_kind(unit, config).per_group == 0;
}

bool trax_always_free(trax_shared unit, const struct trax_config *config) {
  for (trax_op op = 0; op < TRAX_OP_COUNT; op++) {
    const struct trax_timing timing = trax_timing_of(op, config);
    if (timing.unit == unit && timing.interval > 1)
      return false;
  }
  return true;
}

static uint32_t groups(const struct trax_config *config, uint32_t size) {
  return (config->chip.tps_per_tm + size - 1) / size;
}

struct trax_shared_kind trax_shared_kind(trax_shared unit, const struct trax_config *C) {
  struct trax_shared_kind kind = {0};
  switch (unit) {
#define UNIT(X, ID, NAME, SIZE, COUNT, AREA, ...)                                                                      \
  case TRAX_SHARED_##ID:                                                                                               \
    kind = (struct trax_shared_kind){SIZE, groups(C, SIZE), COUNT, TRAX_CAUSE_##ID, AREA};                             \
    break;
    TRAX_SHARED_UNITS(UNIT, )
#undef UNIT
  case TRAX_SHARED_COUNT:
    break;
  }
  return kind;
}

const char *trax_shared_words(trax_shared unit) {
  static const char *const words[] = {
#define UNIT(X, ID, NAME, SIZE, COUNT, AREA, WORDS, ...) WORDS,
      TRAX_SHARED_UNITS(UNIT, )
#undef UNIT
  };
  return words[unit];
}

uint32_t trax_shared_units(trax_shared unit, const struct trax_config *config) {
  const struct trax_shared_kind kind = trax_shared_kind(unit, config);
  return kind.groups * kind.per_group;
}

double trax_shared_cycles(trax_shared unit, const struct trax_config *config, const struct trax_tm_stats *stats,
                          uint64_t operations) {
  if (trax_always_free(unit, config))
    return (double)operations;
  double cycles = 0;
  for (trax_op op = 0; op < TRAX_OP_COUNT; op++) {
    const struct trax_timing timing = trax_timing_of(op, config);
    if (timing.unit == unit)
      cycles += (double)stats->instructions[op] * timing.interval;
  }
  return cycles;
}

double trax_shared_area(const struct trax_config *config) {
  double area = 0;
  for (trax_shared unit = 0; unit < TRAX_SHARED_COUNT; unit++)
    area += trax_shared_units(unit, config) * trax_shared_kind(unit, config).area;
  return area;
}
