/* Series: for each interval of cycles, rows of the counters' increases, for the chip and for each TM. Those for a file
   are written at once. Those for the page are kept, and when there are too many, pairs of them become one and the
   interval twice as long. */
#include "explain/page.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { PAGE_INTERVALS = 256, PAGE_FIRST_INTERVAL = 64 }; /* the most intervals; their cycles at first */

/* The increases of one interval. */
struct interval {
  uint64_t begin, end;
  struct trax_memory_stats memory;
  struct trax_tm_stats *tms; /* [tms] */
  uint32_t *queued;          /* [tms]: requests in the memory queue at the end */
};

struct series {
  struct trax_reader reader;
  struct trax_watch watch;
  uint64_t length;                /* cycles of an interval */
  uint64_t begin;                 /* of the next interval */
  struct trax_tm_stats *previous; /* [tms] */
  struct trax_memory_stats previous_memory;
  struct interval *intervals; /* [PAGE_INTERVALS]; of a file only the first, the latest one */
  size_t count;               /* kept for the page */
};

/* --- rows --- */

static void put_number(FILE *out, uint64_t value) {
  putc_unlocked(',', out);
  trax_page_decimal(out, value);
}

/* memory: the chip's; NULL for a TM. */
static void put_row(FILE *out, const struct interval *interval, const char *tm, const struct trax_tm_stats *stats,
                    const struct trax_memory_stats *memory, uint32_t queue) {
  fprintf(out, "%" PRIu64 ",%" PRIu64 ",%s", interval->begin, interval->end, tm);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    put_number(out, stats->cycles[cause]);
#define COUNT(ID, NAME, UNIT, MEANING)                                                                                 \
  if (strcmp(NAME, "memory.queue_peak") != 0)                                                                          \
    put_number(out, stats->ID);
  TRAX_TM_COUNTERS(COUNT)
#undef COUNT
#define COUNT(ID, NAME, UNIT, MEANING) memory ? put_number(out, memory->ID) : (void)fputc(',', out);
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

/* The rows of an interval: the chip, then its TMs. */
static void put_interval(const struct series *series, const struct interval *interval, FILE *out) {
  const uint32_t tms = series->reader.explain->machine->config.chip.tms;
  struct trax_tm_stats total = {0};
  uint32_t queued = 0;
  for (uint32_t tm = 0; tm < tms; tm++) {
    trax_counters_add(&total, &interval->tms[tm], sizeof total, 1);
    queued += interval->queued[tm];
  }
  put_row(out, interval, "all", &total, &interval->memory, queued);
  for (uint32_t tm = 0; tm < tms; tm++) {
    char name[16];
    snprintf(name, sizeof name, "%u", tm);
    put_row(out, interval, name, &interval->tms[tm], NULL, interval->queued[tm]);
  }
}

/* --- intervals --- */

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

static void end_interval(struct series *series, struct interval *interval, const struct trax_run *run, uint64_t end) {
  const struct trax_machine *machine = series->reader.explain->machine;
  interval->begin = series->begin;
  interval->end = end;
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++) {
    struct trax_tm_stats counted = counts_of(machine, tm);
    if (run) /* after the run, the derived counters are complete */
      trax_stats_derive(&counted, &machine->config);
    interval->tms[tm] = counted;
    trax_counters_add(&interval->tms[tm], &series->previous[tm], sizeof counted, -1);
    series->previous[tm] = counted;
    interval->queued[tm] = run ? trax_run_queued(run, tm, end) : 0;
  }
  interval->memory = machine->stats.memory;
  trax_counters_add(&interval->memory, &series->previous_memory, sizeof interval->memory, -1);
  series->previous_memory = machine->stats.memory;
  series->begin = end;
}

/* Makes one interval of each two. */
static void join_pairs(struct series *series) {
  const uint32_t tms = series->reader.explain->machine->config.chip.tms;
  for (size_t i = 0; i < PAGE_INTERVALS / 2; i++) {
    struct interval *first = &series->intervals[2 * i], *second = first + 1;
    for (uint32_t tm = 0; tm < tms; tm++) {
      trax_counters_add(&first->tms[tm], &second->tms[tm], sizeof *first->tms, 1);
      first->queued[tm] = second->queued[tm];
    }
    trax_counters_add(&first->memory, &second->memory, sizeof first->memory, 1);
    first->end = second->end;
    const struct interval joined = *first;
    *first = series->intervals[i]; /* so that no array is lost */
    series->intervals[i] = joined;
  }
  series->count = PAGE_INTERVALS / 2;
  series->length *= 2;
}

static void next_interval(struct series *series, const struct trax_run *run, uint64_t end) {
  if (series->reader.out) {
    end_interval(series, &series->intervals[0], run, end);
    put_interval(series, &series->intervals[0], series->reader.out);
    return;
  }
  end_interval(series, &series->intervals[series->count++], run, end);
  if (series->count == PAGE_INTERVALS) /* at once, so that all intervals stay equally long */
    join_pairs(series);
}

static trax_status inspect(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct series *series = watch->context;
  trax_run_settle(run, t);
  next_interval(series, run, t);
  watch->next = t + series->length;
  return TRAX_OK;
}

/* --- creation and end --- */

static trax_status open_series(void *self, trax_error *error) {
  struct series *series = self;
  struct trax_machine *machine = series->reader.explain->machine;
  const uint64_t length = series->reader.explain->options.series_interval;
  const uint32_t tms = machine->config.chip.tms;
  const size_t count = series->reader.out ? 1 : PAGE_INTERVALS;
  series->length = !series->reader.out ? PAGE_FIRST_INTERVAL : length ? length : TRAX_SERIES_INTERVAL;
  if (!(series->previous = trax_explain_array(tms, sizeof *series->previous, error)) ||
      !(series->intervals = trax_explain_array(PAGE_INTERVALS, sizeof *series->intervals, error)))
    return TRAX_ERROR;
  for (size_t i = 0; i < count; i++)
    if (!(series->intervals[i].tms = trax_explain_array(tms, sizeof *series->intervals[i].tms, error)) ||
        !(series->intervals[i].queued = trax_explain_array(tms, sizeof *series->intervals[i].queued, error)))
      return TRAX_ERROR;
  if (series->reader.out)
    put_head(series->reader.out);
  series->watch = (struct trax_watch){.next = series->length, .inspect = inspect, .context = series};
  trax_machine_watch(machine, &series->watch);
  return TRAX_OK;
}

static trax_status end_series(void *self, trax_error *error) {
  struct series *series = self;
  (void)error;
  if (series->reader.explain->machine->stats.cycles > series->begin)
    next_interval(series, NULL, series->reader.explain->machine->stats.cycles);
  return TRAX_OK;
}

static trax_status put_rows(void *self, FILE *out, trax_error *error) {
  const struct series *series = self;
  (void)error;
  put_head(out);
  for (size_t i = 0; i < series->count; i++)
    put_interval(series, &series->intervals[i], out);
  return TRAX_OK;
}

static void close_series(void *self) {
  struct series *series = self;
  trax_machine_unwatch(series->reader.explain->machine, &series->watch);
  for (size_t i = 0; series->intervals && i < PAGE_INTERVALS; i++) {
    free(series->intervals[i].tms);
    free(series->intervals[i].queued);
  }
  free(series->intervals);
  free(series->previous);
}

const struct trax_reader_kind trax_series_reader = {.bytes = sizeof(struct series),
                                                    .files = {{.path = TRAX_EXPLAIN_PATH(series)}},
                                                    .open = open_series,
                                                    .end = end_series,
                                                    .close = close_series};

const struct trax_reader_kind trax_page_series_reader = {.bytes = sizeof(struct series),
                                                         .files = {{.put = put_rows, .member = "series"}},
                                                         .in_page = true,
                                                         .open = open_series,
                                                         .end = end_series,
                                                         .close = close_series};
