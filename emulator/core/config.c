#include "core/config.h"

#include "core/machine.h"

#include <math.h>

static bool is_power_of_two(uint32_t value) {
  return value && !(value & (value - 1));
}

static trax_status check_range(const char *key, uint32_t value, uint32_t least, uint32_t most, trax_error *error) {
  if (value < least || value > most)
    return trax_fail(error, "%s is %u; allowed are %u to %u", key, value, least, most);
  return TRAX_OK;
}

static trax_status check_power(const char *key, uint32_t value, uint32_t least, uint32_t most, trax_error *error) {
  if (!is_power_of_two(value) || value < least || value > most)
    return trax_fail(error, "%s is %u; allowed are the powers of two from %u to %u", key, value, least, most);
  return TRAX_OK;
}

static trax_status check_cache(const char *name, uint32_t bytes, uint32_t line_bytes, uint32_t ways,
                               trax_error *error) {
  if ((uint64_t)line_bytes * ways > bytes)
    return trax_fail(error, "%s.bytes is %u; it must hold %s.ways = %u lines of %s.line_bytes = %u", name, bytes, name,
                     ways, name, line_bytes);
  return TRAX_OK;
}

trax_status trax_config_validate(const struct trax_config *config, trax_error *error) {
#define RANGE(SECTION, KEY, LEAST, MOST)                                                                               \
  if (check_range(#SECTION "." #KEY, config->SECTION.KEY, LEAST, MOST, error))                                         \
  return TRAX_ERROR
#define POWER(SECTION, KEY, LEAST, MOST)                                                                               \
  if (check_power(#SECTION "." #KEY, config->SECTION.KEY, LEAST, MOST, error))                                         \
  return TRAX_ERROR
  RANGE(chip, tms, 1, TRAX_MAX_TMS);
  RANGE(chip, tps_per_tm, 1, TRAX_MAX_TPS_PER_TM);
  RANGE(chip, clock_mhz, 1, 100000);
  RANGE(tp, int_latency_cycles, 1, 1000);
  RANGE(tp, local_latency_cycles, 1, 1000);
  RANGE(tp, branch_bubble_cycles, 0, 1000);
  POWER(icache, bytes, 64, 1u << 24);
  POWER(icache, line_bytes, 4, 4096);
  POWER(icache, ways, 1, 64);
  RANGE(icache, banks, 1, 64);
  RANGE(icache, ports_per_bank, 1, 64);
  RANGE(icache, tps_per_cache, 1, 64);
  RANGE(fpu, tps_per_cluster, 1, 64);
  RANGE(fpu, add_latency_cycles, 1, 1000);
  RANGE(fpu, mul_latency_cycles, 1, 1000);
  RANGE(fpu, compare_latency_cycles, 1, 1000);
  RANGE(int_mul, tps_per_unit, 1, 64);
  RANGE(int_mul, latency_cycles, 1, 1000);
  RANGE(special, units_per_tm, 1, 64);
  RANGE(special, latency_cycles, 1, 1000);
  RANGE(special, precision_bits, 1, 24);
  POWER(dcache, bytes, 64, 1u << 24);
  POWER(dcache, line_bytes, 4, 4096);
  POWER(dcache, ways, 1, 64);
  RANGE(dcache, tps_per_bank, 1, 64);
  RANGE(dcache, hit_latency_cycles, 1, 1000);
  RANGE(dcache, mshrs, 1, 1024);
  RANGE(memory, latency_cycles, 0, 100000);
  RANGE(memory, queue_depth, 1, 4096);
  RANGE(memory, size_mib, 1, 4095);
  RANGE(memory, min_transfer_bytes, 1, 4096);
  RANGE(memory, atomic_bytes, 1, 4096);
#undef RANGE
#undef POWER
  if (check_cache("icache", config->icache.bytes, config->icache.line_bytes, config->icache.ways, error) ||
      check_cache("dcache", config->dcache.bytes, config->dcache.line_bytes, config->dcache.ways, error))
    return TRAX_ERROR;
  const double gbps = config->memory.bandwidth_gbps;
  if (!(gbps >= 0.001 && gbps <= 1e6)) /* NaN too */
    return trax_fail(error, "memory.bandwidth_gbps is %g; allowed are 0.001 to 1000000", gbps);
  if (fabs(gbps * 1000 - round(gbps * 1000)) > 1e-6 * gbps * 1000)
    return trax_fail(error, "memory.bandwidth_gbps is %.9g; it must be a multiple of 0.001", gbps);
  return TRAX_OK;
}
