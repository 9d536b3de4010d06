#include "explain/memory_trace.h"
#include "explain/page.h"
#include "explain/places.h"
#include "explain/span.h"
#include "explain/table.h"

#include <stdlib.h>
#include <string.h>

/* The charges of a thread since its latest issue. */
struct trax_open_span {
  struct trax_charge *charges;
  size_t count, capacity;
  uint64_t begin;
  uint32_t pc, previous_pc;
};

static void add_charge(void *context, uint32_t tm, uint32_t tp, trax_cause cause, uint64_t since, uint64_t cycles) {
  struct trax_explain *explain = context;
  struct trax_open_span *open = &explain->open_spans[tm * explain->machine->config.chip.tps_per_tm + tp];
  if (open->count && open->charges[open->count - 1].cause == cause) {
    open->charges[open->count - 1].cycles += cycles;
    return;
  }
  if (!trax_grow((void **)&open->charges, open->count, &open->capacity, sizeof *open->charges)) {
    explain->out_of_memory = true;
    return;
  }
  open->charges[open->count++] = (struct trax_charge){cause, since, cycles};
}

static void notify_span(struct trax_explain *explain, uint32_t tm, uint32_t tp, const struct trax_issue *issue) {
  const uint32_t thread = tm * explain->machine->config.chip.tps_per_tm + tp;
  struct trax_open_span *open = &explain->open_spans[thread];
  const uint32_t pc = issue ? issue->pc : open->pc; /* a debugger may have moved the thread since its latest issue */
  const uint32_t index = trax_places_index(explain->places, pc);
  const struct trax_span span = {.tm = tm,
                                 .tp = tp,
                                 .thread = thread,
                                 .pc = pc,
                                 .previous_pc = open->previous_pc,
                                 .begin = open->begin,
                                 .charges = open->charges,
                                 .count = open->count,
                                 .issue = issue,
                                 .index = index,
                                 .inst = *trax_places_inst(explain->places, index)};
  for (unsigned i = 0; i < explain->reader_count; i++)
    explain->readers[i].span(explain->readers[i].self, &span);
  open->count = 0;
  if (issue) {
    open->begin = issue->cycle + 1;
    open->previous_pc = issue->pc;
    open->pc = issue->next_pc;
  }
}

/* Notifies the readers of the arrivals that precede the issues of a TM in a cycle. */
static void notify_arrivals(struct trax_explain *explain, uint64_t cycle, uint32_t tm) {
  size_t notified = 0;
  for (; notified < explain->arrival_count; notified++) {
    const struct trax_arrival *arrival = &explain->arrivals[notified];
    if (arrival->cycle > cycle || (arrival->cycle == cycle && arrival->tm > tm))
      break;
    for (unsigned i = 0; i < explain->reader_count; i++)
      if (explain->readers[i].arrival)
        explain->readers[i].arrival(explain->readers[i].self, arrival);
  }
  explain->arrival_count -= notified;
  if (notified)
    memmove(explain->arrivals, explain->arrivals + notified, explain->arrival_count * sizeof *explain->arrivals);
}

static void add_issue(void *context, const struct trax_issue *issue) {
  notify_arrivals(context, issue->cycle, issue->tm);
  notify_span(context, issue->tm, issue->tp, issue);
}

static void add_arrival(void *context, const struct trax_arrival *arrival) {
  struct trax_explain *explain = context;
  if (!trax_grow((void **)&explain->arrivals, explain->arrival_count, &explain->arrival_capacity,
                 sizeof *explain->arrivals))
    explain->out_of_memory = true;
  else
    explain->arrivals[explain->arrival_count++] = *arrival;
}

bool trax_window_has(const struct trax_explain_options *options, uint32_t tm, uint32_t tp, uint64_t begin,
                     uint64_t end) {
  return begin < (options->window_end ? options->window_end : UINT64_MAX) && end > options->window_begin &&
         (!options->window_tms || options->window_tms >> tm & 1) &&
         (!options->window_tps || options->window_tps >> tp & 1);
}

/* --- creation and end --- */

static const struct {
  size_t file, other_file, third_file; /* offsets in the options; the reader is created if one of the files is given */
  bool in_page;                         /* also if the page is wanted */
  trax_status (*create)(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
} kinds[] = {
#define FILE_OF(MEMBER) offsetof(struct trax_explain_options, MEMBER)
    {FILE_OF(profile), FILE_OF(folded), FILE_OF(sample), true, trax_profile_create},
    {FILE_OF(trace), FILE_OF(trace), FILE_OF(trace), false, trax_trace_create},
    {FILE_OF(konata), FILE_OF(konata), FILE_OF(konata), false, trax_konata_create},
    {FILE_OF(perfetto), FILE_OF(perfetto), FILE_OF(perfetto), false, trax_perfetto_create},
    {FILE_OF(heat), FILE_OF(heat_lines), FILE_OF(heat), true, trax_heat_create},
    {FILE_OF(items), FILE_OF(item_buffer), FILE_OF(items), false, trax_items_create},
    {FILE_OF(ray_kinds), FILE_OF(ray_kinds), FILE_OF(ray_kinds), true, trax_ray_kinds_create},
    {FILE_OF(lockstep), FILE_OF(lockstep), FILE_OF(lockstep), false, trax_lockstep_create},
    {FILE_OF(lockstep_rays), FILE_OF(lockstep_rays), FILE_OF(lockstep_rays), false, trax_lockstep_rays_create},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static const char *file_at(const struct trax_explain_options *options, size_t offset) {
  return *(const char *const *)((const char *)options + offset);
}

static bool is_wanted(const struct trax_explain_options *options, unsigned kind) {
  return file_at(options, kinds[kind].file) || file_at(options, kinds[kind].other_file) ||
         file_at(options, kinds[kind].third_file) || (options->explore && kinds[kind].in_page);
}

bool trax_explain_wanted(const struct trax_explain_options *options) {
  bool wanted = options->series != NULL || options->memory_trace != NULL || options->check_order;
  for (unsigned i = 0; i < KINDS; i++)
    wanted |= is_wanted(options, i);
  return wanted;
}

static trax_status create(struct trax_explain *explain, trax_error *error) {
  const size_t threads = explain->machine->stats.threads;
  explain->open_spans = calloc(threads, sizeof *explain->open_spans);
  explain->places = trax_places_create(explain->machine);
  if (!explain->open_spans || !explain->places)
    return trax_fail(error, "out of memory for the explanation of %zu threads", threads);
  for (size_t i = 0; i < threads; i++)
    explain->open_spans[i].pc = explain->open_spans[i].previous_pc = trax_machine_entry_of(explain->machine, (uint32_t)i);
  for (unsigned i = 0; i < KINDS; i++)
    if (is_wanted(&explain->options, i)) {
      struct trax_reader *reader = &explain->readers[explain->reader_count];
      if (kinds[i].create(explain, reader, error) != TRAX_OK)
        return TRAX_ERROR;
      explain->reader_count++;
    }
  if (explain->options.check_order) {
    if (trax_order_create(explain, &explain->readers[explain->reader_count], error) != TRAX_OK)
      return TRAX_ERROR;
    explain->reader_count++;
  }
  if (explain->options.series &&
      trax_series_create(&explain->series, explain, explain->options.series, error) != TRAX_OK)
    return TRAX_ERROR;
  if (explain->options.memory_trace && trax_memory_trace_create(&explain->memory_trace, explain, error) != TRAX_OK)
    return TRAX_ERROR;
  return explain->options.explore ? trax_series_create(&explain->page_series, explain, NULL, error) : TRAX_OK;
}

static trax_status check_window(const struct trax_explain *explain, trax_error *error) {
  const struct trax_explain_options *options = &explain->options;
  const uint32_t tms = explain->machine->config.chip.tms, tps = explain->machine->config.chip.tps_per_tm;
  if (tms < 64 && options->window_tms >> tms)
    return trax_fail(error, "the window has TM %d, but the chip has %u", 63 - __builtin_clzll(options->window_tms),
                     tms);
  if (tps < 64 && options->window_tps >> tps)
    return trax_fail(error, "the window has TP %d, but a TM has %u", 63 - __builtin_clzll(options->window_tps), tps);
  return TRAX_OK;
}

trax_status trax_explain_begin(struct trax_explain **result, trax_machine *machine,
                               const struct trax_explain_options *options, trax_error *error) {
  *result = NULL;
  if (!trax_explain_wanted(options))
    return TRAX_OK;
  struct trax_explain *explain = calloc(1, sizeof *explain);
  if (!explain)
    return trax_fail(error, "out of memory");
  explain->machine = machine;
  explain->options = *options;
  if (check_window(explain, error) != TRAX_OK || create(explain, error) != TRAX_OK) {
    trax_explain_discard(explain);
    return TRAX_ERROR;
  }
  explain->observer =
      (struct trax_observer){.context = explain, .issue = add_issue, .charge = add_charge, .arrival = add_arrival};
  if (explain->reader_count) /* series and the trace of transfers need no observer */
    machine->observer = &explain->observer;
  *result = explain;
  return TRAX_OK;
}

trax_status trax_explain_end(struct trax_explain *explain, trax_error *error) {
  if (!explain)
    return TRAX_OK;
  const trax_machine *machine = explain->machine;
  const uint32_t tps = machine->config.chip.tps_per_tm;
  trax_status status = TRAX_OK;
  notify_arrivals(explain, UINT64_MAX, 0);
  for (uint32_t thread = 0; explain->reader_count && thread < machine->stats.threads; thread++)
    notify_span(explain, thread / tps, thread % tps, NULL);
  if (explain->out_of_memory)
    status = trax_fail(error, "out of memory: the explanation of the run is incomplete and not written");
  trax_error reason; /* after a failure the other files are still written; the first failure is reported */
  for (unsigned i = 0; i < explain->reader_count && !explain->out_of_memory; i++)
    if (explain->readers[i].finish(explain->readers[i].self, &reason) != TRAX_OK && status == TRAX_OK)
      status = trax_fail(error, "%s", reason.message);
  if (explain->series && trax_series_finish(explain->series, &reason) != TRAX_OK && status == TRAX_OK)
    status = trax_fail(error, "%s", reason.message);
  if (explain->memory_trace && trax_memory_trace_finish(explain->memory_trace, &reason) != TRAX_OK && status == TRAX_OK)
    status = trax_fail(error, "%s", reason.message);
  if (explain->options.explore && !explain->out_of_memory && trax_page_write(explain, &reason) != TRAX_OK &&
      status == TRAX_OK)
    status = trax_fail(error, "%s", reason.message);
  trax_explain_discard(explain);
  return status;
}

void trax_explain_picture(struct trax_explain *explain, const struct trax_explore_picture *picture) {
  if (explain)
    explain->picture = *picture;
}

void trax_explain_discard(struct trax_explain *explain) {
  if (!explain)
    return;
  explain->machine->observer = NULL;
  for (unsigned i = 0; i < explain->reader_count; i++)
    explain->readers[i].destroy(explain->readers[i].self);
  trax_series_destroy(explain->series);
  trax_series_destroy(explain->page_series);
  trax_memory_trace_destroy(explain->memory_trace);
  trax_pixels_destroy(explain->pixels);
  for (uint64_t i = 0; explain->open_spans && i < explain->machine->stats.threads; i++)
    free(explain->open_spans[i].charges);
  free(explain->open_spans);
  free(explain->arrivals);
  trax_places_destroy(explain->places);
  free(explain);
}
