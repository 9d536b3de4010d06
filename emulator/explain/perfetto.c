/* The window as JSON trace events for Perfetto: TMs are processes. Each TP has two threads, one for the causes of its
   cycles and one for its functions. A cycle is shown as a microsecond. */
#include "explain/places.h"
#include "explain/span.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FRAMES = 64, COUNTERS_IN_WINDOW = 1000 };

struct thread {
  trax_cause cause; /* of the open slice */
  uint64_t since, until;
  uint32_t frames[MAX_FRAMES]; /* names of the open functions, outermost first */
  uint32_t frame_count;
};

struct counters {
  uint64_t issued, misses; /* in the current interval */
};

struct perfetto {
  struct trax_reader reader;
  struct thread *threads; /* [threads] */
  struct counters *tms;   /* [tms] */
  uint64_t interval, counted_from;
  bool any; /* an event has been written */
};

static uint64_t clip(const struct trax_explain_options *options, uint64_t cycle) {
  if (cycle < options->window_begin)
    return options->window_begin;
  return cycle < options->window_end ? cycle : options->window_end;
}

static bool shows(const struct perfetto *perfetto, uint32_t tm) {
  const uint64_t tms = perfetto->reader.explain->options.window_tms;
  return !tms || tms >> tm & 1;
}

/* Writes an event up to its name. The caller writes the rest. */
static FILE *begin_event(struct perfetto *perfetto, const char *phase, uint32_t tm, uint32_t thread, uint64_t cycle,
                         const char *name) {
  FILE *out = perfetto->reader.out;
  char *quoted = NULL;
  json_t *string = json_stringn_nocheck(name, strlen(name));
  quoted = string ? json_dumps(string, JSON_ENCODE_ANY | JSON_ENSURE_ASCII) : NULL;
  fprintf(out, "%s\n{\"ph\":\"%s\",\"pid\":%u,\"tid\":%u,\"ts\":%" PRIu64 ",\"name\":%s", perfetto->any ? "," : "",
          phase, tm, thread, cycle, quoted ? quoted : "\"?\""); /* names need not be UTF-8 */
  perfetto->any = true;
  free(quoted);
  json_decref(string);
  return out;
}

static void close_slice(struct perfetto *perfetto, uint32_t tm, uint32_t tp, struct thread *thread) {
  if (thread->until > thread->since)
    fprintf(begin_event(perfetto, "X", tm, 2 * tp, thread->since, trax_cause_names[thread->cause]),
            ",\"dur\":%" PRIu64 "}", thread->until - thread->since);
  thread->since = thread->until;
}

static void add_charge(struct perfetto *perfetto, uint32_t tm, uint32_t tp, struct thread *thread, trax_cause cause,
                       uint64_t since, uint64_t cycles) {
  const struct trax_explain_options *options = &perfetto->reader.explain->options;
  const uint64_t begin = clip(options, since), end = clip(options, since + cycles);
  if (begin == end)
    return;
  if (cause != thread->cause || begin != thread->until) {
    close_slice(perfetto, tm, tp, thread);
    thread->cause = cause;
    thread->since = begin;
  }
  thread->until = end;
}

static void leave_frames(struct perfetto *perfetto, uint32_t tm, uint32_t tp, struct thread *thread, uint32_t keep,
                         uint64_t cycle) {
  while (thread->frame_count > keep) {
    const uint32_t name = thread->frames[--thread->frame_count];
    fputc('}',
          begin_event(perfetto, "E", tm, 2 * tp + 1, cycle, trax_places_name(perfetto->reader.explain->places, name)));
  }
}

/* Opens and closes functions, since the TP is at the instruction `index` from `cycle` on. */
static void enter_frames(struct perfetto *perfetto, uint32_t tm, uint32_t tp, struct thread *thread, uint32_t index,
                         uint64_t cycle) {
  struct trax_places *places = perfetto->reader.explain->places;
  const struct trax_place *place = trax_places_at(places, index);
  const uint32_t count = place->frame_count < MAX_FRAMES ? place->frame_count : MAX_FRAMES;
  uint32_t common = 0;
  while (common < count && common < thread->frame_count &&
         thread->frames[common] == place->frames[place->frame_count - 1 - common].function)
    common++;
  leave_frames(perfetto, tm, tp, thread, common, cycle);
  for (; thread->frame_count < count; thread->frame_count++) {
    const uint32_t name = place->frames[place->frame_count - 1 - thread->frame_count].function;
    thread->frames[thread->frame_count] = name;
    fputc('}', begin_event(perfetto, "B", tm, 2 * tp + 1, cycle, trax_places_name(places, name)));
  }
}

static void put_counters(struct perfetto *perfetto, uint64_t end) {
  for (uint32_t tm = 0; tm < perfetto->reader.explain->machine->config.chip.tms; tm++) {
    if (!shows(perfetto, tm))
      continue;
    struct counters *counters = &perfetto->tms[tm];
    const double cycles = (double)(end - perfetto->counted_from);
    fprintf(begin_event(perfetto, "C", tm, 0, perfetto->counted_from, "instructions per cycle"),
            ",\"args\":{\"value\":%.6g}}", (double)counters->issued / cycles);
    fprintf(begin_event(perfetto, "C", tm, 0, perfetto->counted_from, "data-cache misses per cycle"),
            ",\"args\":{\"value\":%.6g}}", (double)counters->misses / cycles);
    *counters = (struct counters){0};
  }
  perfetto->counted_from = end;
}

static void count(struct perfetto *perfetto, const struct trax_issue *issue) {
  const struct trax_explain_options *options = &perfetto->reader.explain->options;
  while (issue->cycle >= perfetto->counted_from + perfetto->interval && perfetto->counted_from < options->window_end)
    put_counters(perfetto, clip(options, perfetto->counted_from + perfetto->interval));
  if (issue->cycle < options->window_begin || issue->cycle >= options->window_end)
    return;
  perfetto->tms[issue->tm].issued++;
  perfetto->tms[issue->tm].misses += (issue->outcome & TRAX_OUTCOME_MISS) != 0;
}

static void add_span(void *self, const struct trax_span *span) {
  struct perfetto *perfetto = self;
  const struct trax_explain_options *options = &perfetto->reader.explain->options;
  struct thread *thread = &perfetto->threads[span->thread];
  if (span->issue)
    count(perfetto, span->issue);
  const uint64_t end = span->issue ? span->issue->cycle + 1 : perfetto->reader.explain->machine->stats.cycles;
  if (!trax_window_has(options, span->tm, span->tp, span->begin, end))
    return;
  const bool halts = span->count && span->charges[span->count - 1].cause == TRAX_CAUSE_HALTED;
  const bool bubble = span->count && span->charges[0].cause == TRAX_CAUSE_BRANCH; /* belongs to the branch before */
  const uint64_t entered = span->begin + (bubble ? span->charges[0].cycles : 0);
  if (entered < options->window_end && !(halts && span->count == 1))
    enter_frames(perfetto, span->tm, span->tp, thread, span->index, clip(options, entered));
  for (size_t i = 0; i < span->count; i++)
    add_charge(perfetto, span->tm, span->tp, thread, span->charges[i].cause, span->charges[i].since,
               span->charges[i].cycles);
  if (span->issue)
    add_charge(perfetto, span->tm, span->tp, thread, TRAX_CAUSE_ISSUED, span->issue->cycle, 1);
  if (halts)
    leave_frames(perfetto, span->tm, span->tp, thread, 0, clip(options, span->charges[span->count - 1].since));
}

static void put_names(struct perfetto *perfetto) {
  const struct trax_config *config = &perfetto->reader.explain->machine->config;
  const struct trax_explain_options *options = &perfetto->reader.explain->options;
  for (uint32_t tm = 0; tm < config->chip.tms; tm++) {
    if (!shows(perfetto, tm))
      continue;
    fprintf(begin_event(perfetto, "M", tm, 0, 0, "process_name"), ",\"args\":{\"name\":\"TM %u\"}}", tm);
    for (uint32_t tp = 0; tp < config->chip.tps_per_tm; tp++) {
      if (options->window_tps && !(options->window_tps >> tp & 1))
        continue;
      fprintf(begin_event(perfetto, "M", tm, 2 * tp, 0, "thread_name"), ",\"args\":{\"name\":\"TP %u\"}}", tp);
      fprintf(begin_event(perfetto, "M", tm, 2 * tp + 1, 0, "thread_name"), ",\"args\":{\"name\":\"TP %u functions\"}}",
              tp);
    }
  }
}

static trax_status end_perfetto(void *self, trax_error *error) {
  struct perfetto *perfetto = self;
  const trax_machine *machine = perfetto->reader.explain->machine;
  const uint64_t cycles = machine->stats.cycles;
  const uint64_t end = clip(&perfetto->reader.explain->options, cycles);
  while (perfetto->counted_from < end && cycles > perfetto->counted_from)
    put_counters(perfetto,
                 end < perfetto->counted_from + perfetto->interval ? end : perfetto->counted_from + perfetto->interval);
  for (uint32_t i = 0; i < machine->stats.threads; i++) {
    const uint32_t tm = i / machine->config.chip.tps_per_tm, tp = i % machine->config.chip.tps_per_tm;
    struct thread *thread = &perfetto->threads[i];
    close_slice(perfetto, tm, tp, thread);
    leave_frames(perfetto, tm, tp, thread, 0, thread->until);
  }
  (void)error;
  fprintf(perfetto->reader.out, "\n]}\n");
  return TRAX_OK;
}

static trax_status open_perfetto(void *self, trax_error *error) {
  struct perfetto *perfetto = self;
  const trax_machine *machine = perfetto->reader.explain->machine;
  const struct trax_explain_options *options = &perfetto->reader.explain->options;
  if (!options->window_end)
    return trax_fail(error, "a time line for Perfetto needs a window of cycles");
  if (!(perfetto->threads = trax_explain_array(machine->stats.threads, sizeof *perfetto->threads, error)) ||
      !(perfetto->tms = trax_explain_array(machine->config.chip.tms, sizeof *perfetto->tms, error)))
    return TRAX_ERROR;
  perfetto->counted_from = options->window_begin;
  perfetto->interval = (options->window_end - options->window_begin + COUNTERS_IN_WINDOW - 1) / COUNTERS_IN_WINDOW;
  if (perfetto->interval < 16)
    perfetto->interval = 16;
  fprintf(perfetto->reader.out,
          "{\"displayTimeUnit\":\"ns\",\"otherData\":{\"time\":\"a cycle is shown as a microsecond\",\"clock_mhz\":%u},"
          "\"traceEvents\":[",
          machine->config.chip.clock_mhz);
  put_names(perfetto);
  return TRAX_OK;
}

static void close_perfetto(void *self) {
  struct perfetto *perfetto = self;
  free(perfetto->threads);
  free(perfetto->tms);
}

const struct trax_reader_kind trax_perfetto_reader = {.bytes = sizeof(struct perfetto),
                                                      .files = {{.path = TRAX_EXPLAIN_PATH(perfetto)}},
                                                      .open = open_perfetto,
                                                      .span = add_span,
                                                      .end = end_perfetto,
                                                      .close = close_perfetto};
