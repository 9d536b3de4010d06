/* How often a run left the fast path, and why. */
#include "fast/chip.h"

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

void trax_fast_report(const struct trax_chip *chip, uint64_t cycles) {
  static const char observed[] = "an observer follows every instruction";
  const struct trax_config *config = &chip->machine->config;
  const struct trax_tm *first = &chip->tm[0]; /* all TMs are configured alike */
  struct trax_slow_paths *paths = &chip->machine->slow_paths;
  struct trax_slow_path *path = paths->path;
  uint64_t looked_up = 0, hits = 0, at_issue = 0;
  char conflicts[160];
  for (uint32_t i = 0; i < chip->tms; i++) {
    looked_up += chip->tm[i].looked_up;
    hits += chip->tm[i].stats->dcache_hits;
    at_issue += chip->tm[i].at_issue;
  }
  snprintf(conflicts, sizeof conflicts,
           "conflicts of TMs in memory (%" PRIu64 "), checkpoints and other stops close together (%" PRIu64
           " cycles), and ends of runs",
           chip->conflicts, chip->short_epochs);
#define ROW(NAME, PART, OF, REASON)                                                                                    \
  (path->name = (NAME), path->part = (PART), path->of = (OF),                                                          \
   snprintf(path->reason, sizeof path->reason, "%s", (REASON)), path++)
  ROW("observed", chip->burst == 1 ? cycles : 0, TRAX_OF_CYCLES, observed);
  ROW("TMs cycle by cycle", chip->single_cycles, TRAX_OF_CYCLES,
      chip->epochs                                                   ? conflicts
      : chip->machine->observer && !chip->machine->observer->go_back ? observed
                                                                     : epochs_reason(config));
  ROW("fetches bank by bank", first->simple_fetch ? 0 : cycles, TRAX_OF_CYCLES, fetch_reason(config));
  ROW("adders group by group", first->fp.even ? 0 : cycles, TRAX_OF_CYCLES,
      "the groups do not have one adder and one multiplier each, or differ in size");
  ROW("data banks one by one", first->dcache.banks > TRAX_FAST_BANKS ? cycles : 0, TRAX_OF_CYCLES,
      "dcache.tps_per_bank makes more than 8 banks");
  ROW("lines looked up", looked_up, TRAX_OF_FETCHES,
      chip->program.lines == TRAX_FAST_LINES
          ? "the program has more than 1023 lines of instructions"
          : "a line of the burst was not resident when the burst began, or a line was evicted");
  ROW("hits one by one", first->serial_hits ? hits : 0, TRAX_OF_HITS,
      config->dcache.hit_latency_cycles > 1 ? "dcache.hit_latency_cycles is above 1" : "dcache.replacement");
  ROW("executed at issue", at_issue, TRAX_OF_INSTRUCTIONS,
      "stores, increments, traps, loads past the cache, loads of words that TMs share");
#undef ROW
  paths->known = true;
}
