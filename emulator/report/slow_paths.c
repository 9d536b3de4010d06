#include "report/statistics.h"

#include "machine/machine.h"

#include <inttypes.h>

static const char *fetch_reason(const struct trax_config *config) {
  return config->icache.ports_per_bank > 1 ? "icache.ports_per_bank is above 1"
         : config->icache.banks > 16       ? "icache.banks is above 16"
                                           : "icache.tps_per_cache is not 16";
}

/* Quanta are as long as the latency of what a request reaches first: the second-level cache, if there is one. */
static const char *epochs_reason(const struct trax_config *config) {
  return config->l2.bytes ? "the second-level cache's latency is too short for epochs (l2.latency_cycles)"
                          : "the memory latency is too short for epochs (memory.latency_cycles)";
}

void trax_slow_paths_print(const struct trax_machine *machine, FILE *out) {
  const struct trax_stats *stats = &machine->stats;
  const struct {
    const char *name;
    uint64_t count;
  } wholes[] = {[TRAX_OF_CYCLES] = {"cycles", stats->cycles},
                [TRAX_OF_FETCHES] = {"fetches", stats->total.icache_hits},
                [TRAX_OF_HITS] = {"hits", stats->total.dcache_hits},
                [TRAX_OF_INSTRUCTIONS] = {"instructions", stats->instructions}};
  static const char observed[] = "an observer follows every instruction";
  const struct trax_config *config = &machine->config;
  const struct trax_slow_paths *paths = &machine->slow_paths;
  char conflicts[160];
  snprintf(conflicts, sizeof conflicts,
           "conflicts of TMs in memory (%" PRIu64 "), checkpoints and other stops close together (%" PRIu64
           " cycles), and ends of runs",
           paths->conflicts, paths->short_epochs);
  const char *const reasons[] = {
      [TRAX_SLOW_OBSERVED] = observed,
      [TRAX_SLOW_SINGLE_CYCLES] = paths->has_epochs    ? conflicts
                                  : paths->is_observed ? observed
                                                       : epochs_reason(config),
      [TRAX_SLOW_FETCHES] = fetch_reason(config),
      [TRAX_SLOW_ADDERS] = "the groups do not have one adder and one multiplier each, or differ in size",
      [TRAX_SLOW_DATA_BANKS] = "dcache.tps_per_bank makes more than 8 banks",
      [TRAX_SLOW_LINES] = paths->has_many_lines
                              ? "the program has more than 1023 lines of instructions"
                              : "a line of the burst was not resident when the burst began, or a line was evicted",
      [TRAX_SLOW_HITS] =
          config->dcache.hit_latency_cycles > 1 ? "dcache.hit_latency_cycles is above 1" : "dcache.replacement",
      [TRAX_SLOW_AT_ISSUE] = "stores, increments, traps, loads past the cache, loads of words that TMs share"};
  static const struct {
    const char *name;
    enum trax_slow_path_of of;
  } rows[] = {
#define ROW(ID, NAME, OF) {NAME, TRAX_OF_##OF},
      TRAX_SLOW_PATHS(ROW)
#undef ROW
  };
  bool any = false;
  if (!paths->known || stats->sampling.is_sampled)
    return;
  fprintf(out, "\nSlow paths of the fast engine, which cost time on the host and change no result\n");
  for (unsigned i = 0; i < TRAX_SLOW_COUNT; i++) {
    const uint64_t part = paths->part[i], whole = wholes[rows[i].of].count;
    any |= part > 0;
    if (part)
      fprintf(out, "  %-30s%20" PRIu64 " %6.2f %% of the %s: %s\n", rows[i].name, part,
              whole ? 100 * (double)part / (double)whole : 0, wholes[rows[i].of].name, reasons[i]);
  }
  if (!any)
    fprintf(out, "  none\n");
}
