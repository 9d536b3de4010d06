#include "machine/ray_cycles.h"

#include "report/statistics.h"
#include "trax/output.h"

#include <inttypes.h>

static void write_rows(FILE *out, const char *part, double weight, trax_ray_counts counts, const uint64_t *rays) {
  for (unsigned kind = 0; kind < TRAX_RAY_ROWS; kind++) {
    uint64_t sum = 0;
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      sum += counts[kind][cause];
    fprintf(out, "%s,%.9g,%s,%" PRIu64 ",%" PRIu64, part, weight, trax_ray_kind_names[kind],
            kind != TRAX_NO_RAY ? rays[kind] : 0, sum);
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      fprintf(out, ",%" PRIu64, counts[kind][cause]);
    fputc('\n', out);
  }
}

trax_status trax_ray_cycles_write(const trax_machine *machine, const char *path, trax_error *error) {
  const struct trax_ray_cycles *rays = machine->ray_cycles;
  trax_output output;
  if (!rays)
    return trax_fail(error, "the run did not count the cycles of rays");
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_ray_counts sum;
  trax_ray_cycles_sum(machine, sum);
  fprintf(output.file, "part,weight,kind,rays,thread_cycles");
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(output.file, ",%s", trax_stats_cause(cause));
  fputc('\n', output.file);
  write_rows(output.file, "all", 1, sum, &machine->stats.total.rays_primary);
  for (size_t i = 0; i < rays->part_count; i++)
    write_rows(output.file, i == 0 ? "exact" : "draw", rays->parts[i].weight, rays->parts[i].counts,
               rays->parts[i].rays);
  return trax_output_commit(&output, error);
}
