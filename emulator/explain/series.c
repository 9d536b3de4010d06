/* Series: for each interval of cycles, rows of the counters' increases, for the chip and for each TM. */
#include "explain/span.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct series {
  struct trax_watch watch;
  struct trax_explain *explain;
  trax_output output;
  uint64_t begin;                 /* of the next row */
  struct trax_tm_stats *previous; /* [tms] */
  struct trax_memory_stats previous_memory;
};

/* Writes a row. memory: the chip's; NULL for a TM. */
static void put_row(struct series *series, const char *tm, uint64_t end, const struct trax_tm_stats *stats,
                    const struct trax_memory_stats *memory, uint32_t queue) {
  FILE *out = series->output.file;
  fprintf(out, "%" PRIu64 ",%" PRIu64 ",%s", series->begin, end, tm);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, ",%" PRIu64, stats->cycles[cause]);
#define COUNT(ID, NAME, UNIT, MEANING)                                                                                 \
  if (strcmp(NAME, "memory.queue_peak") != 0)                                                                          \
    fprintf(out, ",%" PRIu64, stats->ID);
  TRAX_TM_COUNTERS(COUNT)
#undef COUNT
#define COUNT(ID, NAME, UNIT, MEANING) memory ? fprintf(out, ",%" PRIu64, memory->ID) : fputc(',', out);
  TRAX_MEMORY_COUNTERS(COUNT)
#undef COUNT
  fprintf(out, ",%u\n", queue);
}

static void put_head(FILE *out) {
  fprintf(out, "begin,end,tm");
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, ",%s", trax_cause_names[cause]);
#define HEAD(ID, NAME, UNIT, MEANING)                                                                                  \
  if (strcmp(NAME, "memory.queue_peak") != 0)                                                                          \
    fprintf(out, "," NAME);
  TRAX_TM_COUNTERS(HEAD)
#undef HEAD
#define HEAD(ID, NAME, UNIT, MEANING) fprintf(out, "," NAME);
  TRAX_MEMORY_COUNTERS(HEAD)
#undef HEAD
  fprintf(out, ",memory.queue\n");
}

/* Returns the counters of a TM so far, with the TPs' charges added up. */
static struct trax_tm_stats counts_of(const struct trax_machine *machine, uint32_t tm) {
  struct trax_tm_stats stats = machine->tm_stats[tm];
  const uint32_t tps = machine->config.chip.tps_per_tm;
  memset(stats.cycles, 0, sizeof stats.cycles);
  for (uint32_t tp = 0; tp < tps; tp++)
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      stats.cycles[cause] += machine->tp_stats[(size_t)tm * tps + tp].cycles[cause];
  return stats;
}

/* Subtracts structures of 64-bit counters. */
static void subtract(void *from, const void *stats, size_t bytes) {
  uint64_t *to = from;
  const uint64_t *terms = stats;
  for (size_t i = 0; i < bytes / sizeof *to; i++)
    to[i] -= terms[i];
}

static void put_rows(struct series *series, const struct trax_run *run, uint64_t end) {
  const struct trax_machine *machine = series->explain->machine;
  struct trax_tm_stats total = {0}, *rows = calloc(machine->config.chip.tms, sizeof *rows);
  uint32_t queued = 0;
  if (!rows) {
    series->explain->out_of_memory = true;
    return;
  }
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++) {
    const struct trax_tm_stats now = counts_of(machine, tm);
    rows[tm] = now;
    if (run) /* after the run, the derived counters are complete */
      trax_stats_derive(&rows[tm], &machine->config);
    const struct trax_tm_stats counted = rows[tm];
    subtract(&rows[tm], &series->previous[tm], sizeof rows[tm]);
    series->previous[tm] = counted;
    for (size_t i = 0; i < sizeof total / sizeof(uint64_t); i++)
      ((uint64_t *)&total)[i] += ((const uint64_t *)&rows[tm])[i];
    queued += run ? trax_run_queued(run, tm, end) : 0;
  }
  struct trax_memory_stats memory = machine->stats.memory;
  subtract(&memory, &series->previous_memory, sizeof memory);
  series->previous_memory = machine->stats.memory;
  put_row(series, "all", end, &total, &memory, queued);
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++) {
    char name[16];
    snprintf(name, sizeof name, "%u", tm);
    put_row(series, name, end, &rows[tm], NULL, run ? trax_run_queued(run, tm, end) : 0);
  }
  series->begin = end;
  free(rows);
}

static trax_status inspect(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct series *series = watch->context;
  trax_run_settle(run, t);
  put_rows(series, run, t);
  watch->next = t + series->explain->options.series_interval;
  return TRAX_OK;
}

trax_status trax_series_create(struct trax_explain *explain, trax_error *error) {
  struct series *series = calloc(1, sizeof *series);
  if (!series)
    return trax_fail(error, "out of memory");
  explain->series = &series->watch;
  if (!explain->options.series_interval)
    explain->options.series_interval = TRAX_SERIES_INTERVAL;
  series->explain = explain;
  series->previous = calloc(explain->machine->config.chip.tms, sizeof *series->previous);
  if (!series->previous)
    return trax_fail(error, "out of memory for the series");
  if (trax_output_open(&series->output, explain->options.series, error) != TRAX_OK)
    return TRAX_ERROR;
  put_head(series->output.file);
  series->watch = (struct trax_watch){.next = explain->options.series_interval, .inspect = inspect, .context = series};
  trax_machine_watch(explain->machine, &series->watch);
  return TRAX_OK;
}

trax_status trax_series_finish(struct trax_explain *explain, trax_error *error) {
  struct series *series = (struct series *)explain->series;
  if (explain->machine->stats.cycles > series->begin)
    put_rows(series, NULL, explain->machine->stats.cycles);
  if (explain->out_of_memory)
    return trax_fail(error, "out of memory for the series");
  return trax_output_commit(&series->output, error);
}

void trax_series_destroy(struct trax_explain *explain) {
  struct series *series = (struct series *)explain->series;
  if (!series)
    return;
  trax_machine_unwatch(explain->machine, &series->watch);
  trax_output_discard(&series->output);
  free(series->previous);
  free(series);
  explain->series = NULL;
}
