#include "machine/ray_cycles.h"

#include <stdlib.h>

const char *const trax_ray_kind_names[TRAX_RAY_ROWS] = {
#define NAME(X, ID, NAME, NUMBER, MEANING) [NUMBER] = #NAME,
    TRAX_RAY_KINDS(NAME, )
#undef NAME
        [TRAX_NO_RAY] = "none"};

trax_status trax_ray_cycles_create(struct trax_machine *machine, trax_error *error) {
  struct trax_ray_cycles *rays = machine->ray_cycles = calloc(1, sizeof *rays);
  if (rays) {
    rays->tms = calloc(machine->config.chip.tms, sizeof *rays->tms);
    rays->threads = calloc(machine->stats.threads, sizeof *rays->threads);
  }
  if (!rays || !rays->tms || !rays->threads)
    return trax_fail(error, "out of memory for the cycles of rays");
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++)
    rays->threads[thread].kind = TRAX_NO_RAY;
  return TRAX_OK;
}

void trax_ray_cycles_destroy(struct trax_ray_cycles *rays) {
  if (!rays)
    return;
  free(rays->tms);
  free(rays->threads);
  free(rays->parts);
  free(rays);
}

void trax_ray_cycles_sum(const struct trax_machine *machine, trax_ray_counts sum) {
  memset(sum, 0, sizeof(trax_ray_counts));
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++)
    for (unsigned kind = 0; kind < TRAX_RAY_ROWS; kind++)
      for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
        sum[kind][cause] += machine->ray_cycles->tms[tm][kind][cause];
}
