#include "report/statistics.h"

#include "machine/machine.h"

#include <inttypes.h>

void trax_slow_paths_print(const struct trax_machine *machine, FILE *out) {
  const struct trax_stats *stats = &machine->stats;
  const struct {
    const char *name;
    uint64_t count;
  } wholes[] = {[TRAX_OF_CYCLES] = {"cycles", stats->cycles},
                [TRAX_OF_FETCHES] = {"fetches", stats->total.icache_hits},
                [TRAX_OF_HITS] = {"hits", stats->total.dcache_hits},
                [TRAX_OF_INSTRUCTIONS] = {"instructions", stats->instructions}};
  bool any = false;
  if (!machine->slow_paths.known || stats->sampling.is_sampled)
    return;
  fprintf(out, "\nSlow paths of the fast engine, which cost time on the host and change no result\n");
  for (unsigned i = 0; i < TRAX_SLOW_PATHS; i++) {
    const struct trax_slow_path *path = &machine->slow_paths.path[i];
    const uint64_t whole = wholes[path->of].count;
    any |= path->part > 0;
    if (path->part)
      fprintf(out, "  %-30s%20" PRIu64 " %6.2f %% of the %s: %s\n", path->name, path->part,
              whole ? 100 * (double)path->part / (double)whole : 0, wholes[path->of].name, path->reason);
  }
  if (!any)
    fprintf(out, "  none\n");
}
