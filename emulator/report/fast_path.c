#include "report/statistics.h"

#include "machine/machine.h"

#include <inttypes.h>

struct table {
  FILE *out;
  bool any;
};

/* Prints a row: `part` of `whole` left the fast path, for `reason`. Prints nothing if `part` is 0. */
static void row(struct table *table, const char *name, uint64_t part, uint64_t whole, const char *of,
                const char *reason) {
  if (!part)
    return;
  table->any = true;
  fprintf(table->out, "  %-30s%20" PRIu64 " %6.2f %% of the %s: %s\n", name, part,
          whole ? 100 * (double)part / (double)whole : 0, of, reason);
}

static const char *fetch_reason(const struct trax_config *config) {
  return config->icache.ports_per_bank > 1    ? "icache.ports_per_bank is above 1"
         : config->icache.banks > 16          ? "icache.banks is above 16"
         : config->icache.tps_per_cache != 16 ? "icache.tps_per_cache is not 16"
                                              : "";
}

static const char *hit_reason(const struct trax_config *config) {
  return config->dcache.hit_latency_cycles > 1 ? "dcache.hit_latency_cycles is above 1" : "dcache.replacement";
}

/* Epochs are as long as the least time after which a request affects another TM: of the second-level cache, if there is
   one, else of memory. */
static const char *epochs_reason(const struct trax_config *config) {
  return config->l2.bytes ? "the second-level cache's latency is too short for epochs (l2.latency_cycles)"
                          : "the memory latency is too short for epochs (memory.latency_cycles)";
}

void trax_fast_path_print(const struct trax_machine *machine, FILE *out) {
  const struct trax_fast_path *path = &machine->fast_path;
  const struct trax_config *config = &machine->config;
  const struct trax_tm_stats *total = &machine->stats.total;
  const uint64_t cycles = machine->stats.cycles, instructions = machine->stats.instructions;
  struct table table = {.out = out};
  if (!path->known || machine->stats.sampling.is_sampled)
    return;
  char lines[96];
  if (path->text_lines > TRAX_KNOWN_LINES)
    snprintf(lines, sizeof lines, "the program has more than %d lines of instructions", TRAX_KNOWN_LINES);
  else
    snprintf(lines, sizeof lines, "a line of the burst was not resident when the burst began, or a line was evicted");
  char conflicts[160];
  snprintf(conflicts, sizeof conflicts,
           "conflicts of TMs in memory (%" PRIu64 "), checkpoints and other stops close together (%" PRIu64
           " cycles), and ends of runs",
           path->conflicts, path->short_epochs);
  fprintf(out, "\nSlow paths of the fast engine, which cost time on the host and change no result\n");
  row(&table, "observed", path->observed ? cycles : 0, cycles, "cycles", "an observer follows every instruction");
  row(&table, "TMs cycle by cycle", path->single_cycles, cycles, "cycles",
      path->observed    ? "an observer follows every instruction"
      : path->no_epochs ? epochs_reason(config)
                        : conflicts);
  row(&table, "fetches bank by bank", path->general_fetch ? cycles : 0, cycles, "cycles", fetch_reason(config));
  row(&table, "adders group by group", path->uneven_units ? cycles : 0, cycles, "cycles",
      "the groups do not have one adder and one multiplier each, or differ in size");
  row(&table, "data banks by fours", path->many_data_banks ? cycles : 0, cycles, "cycles",
      "dcache.tps_per_bank makes more than 8 banks");
  row(&table, "lines looked up", path->looked_up, total->icache_hits, "fetches", lines);
  row(&table, "hits one by one", path->single_hits, total->dcache_hits, "hits", hit_reason(config));
  row(&table, "executed at issue", path->at_issue, instructions, "instructions",
      "stores, increments, traps, loads past the cache, loads of words that TMs share");
  if (!table.any)
    fprintf(out, "  none\n");
}
