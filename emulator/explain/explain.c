#include "explain/page.h"
#include "explain/passages.h"
#include "explain/places.h"
#include "explain/span.h"
#include "explain/stories.h"
#include "machine/ray_cycles.h"
#include "trax/compare.h"
#include "trax/grow.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* The charges of a thread since its latest issue. */
struct trax_open_span {
  struct trax_charge *charges;
  size_t count, capacity;
  uint64_t begin;
  uint32_t pc, previous_pc;
};

static void add_charge(void *context, uint32_t tm, uint32_t tp, trax_cause cause, unsigned rd, uint64_t since,
                       uint64_t cycles) {
  struct trax_explain *explain = context;
  const uint32_t thread = tm * explain->machine->config.chip.tps_per_tm + tp;
  struct trax_open_span *open = &explain->open_spans[thread];
  if (explain->has_passages) {
    trax_log_charge(&explain->observer, &explain->observer.logs[thread], 0, cause, rd, cycles);
    explain->open_threads[thread].cycles[cause] += cycles;
    explain->by_issue = true;
  }
  if (!explain->has_spans)
    return;
  if (open->count && open->charges[open->count - 1].cause == cause && open->charges[open->count - 1].rd == rd) {
    open->charges[open->count - 1].cycles += cycles;
    return;
  }
  if (!trax_grow((void **)&open->charges, open->count, &open->capacity, sizeof *open->charges)) {
    explain->out_of_memory = true;
    return;
  }
  open->charges[open->count++] = (struct trax_charge){cause, (uint8_t)rd, since, cycles};
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
    if (explain->readers[i]->kind->span)
      explain->readers[i]->kind->span(explain->readers[i], &span);
  open->count = 0;
  if (issue) {
    open->begin = issue->cycle + 1;
    open->previous_pc = issue->pc;
    open->pc = issue->next_pc;
  }
}

static void notify_passage(const struct trax_explain *explain, struct trax_passage *passage) {
  for (unsigned i = 0; i < explain->reader_count; i++)
    if (explain->readers[i]->kind->follow)
      explain->readers[i]->kind->follow(explain->readers[i], passage);
  for (unsigned i = 0; i < explain->reader_count; i++)
    if (explain->readers[i]->kind->passage)
      explain->readers[i]->kind->passage(explain->readers[i], passage);
}

static void add_stretch(void *context, const struct trax_stretch *stretch) {
  struct trax_explain *explain = context;
  const uint32_t thread = stretch->tm * explain->machine->config.chip.tps_per_tm + stretch->tp;
  trax_passages_add(explain->passages, stretch, &explain->observer.logs[thread]);
}

static void *room(void *context, uint32_t tm) {
  const struct trax_explain *explain = context;
  return trax_passages_room(explain->passages, tm);
}

static void begin_run(void *context, struct trax_pool *pool) {
  struct trax_explain *explain = context;
  for (uint64_t i = 0; i < explain->machine->stats.threads && !explain->begun; i++)
    memcpy(explain->open_threads[i].begin_cycles,
           memcpy(explain->open_threads[i].cycles, explain->machine->tp_stats[i].cycles,
                  sizeof explain->open_threads[i].cycles),
           sizeof explain->open_threads[i].cycles);
  explain->begun = true;
  if (!explain->has_spans && !trax_passages_start(explain->passages, pool))
    explain->out_of_memory = true;
}

static void end_run(void *context) {
  struct trax_explain *explain = context;
  trax_passages_finish(explain->passages);
  for (uint64_t i = 0; i < explain->machine->stats.threads && !explain->by_issue; i++)
    memcpy(explain->open_threads[i].cycles, explain->machine->tp_stats[i].cycles,
           sizeof explain->open_threads[i].cycles);
}

static void keep(void *context, bool holds) {
  const struct trax_explain *explain = context;
  trax_passages_keep(explain->passages, holds);
}

static void go_back(void *context) {
  const struct trax_explain *explain = context;
  trax_passages_go_back(explain->passages);
}

/* Adds the charges of the thread after its last instruction. */
static void end_passages(struct trax_explain *explain, uint32_t thread) {
  struct trax_thread_log *log = &explain->observer.logs[thread];
  struct trax_open_thread *open = &explain->open_threads[thread];
  const uint32_t index = trax_places_index(explain->places, explain->end_pcs[thread]);
  for (size_t i = 0; i < log->charged_count; i++)
    log->charged[i].index = index;
  trax_counters_add(open->cycles, open->begin_cycles, sizeof open->cycles, -1);
  notify_passage(explain, &(struct trax_passage){.thread = thread,
                                                 .charged = log->charged,
                                                 .charged_count = (uint32_t)log->charged_count,
                                                 .kind = TRAX_NO_RAY,
                                                 .cycles = open->cycles});
}

/* Notifies the readers of the arrivals that precede the issues of a TM in a cycle. */
static void notify_arrivals(struct trax_explain *explain, uint64_t cycle, uint32_t tm) {
  size_t notified = 0;
  for (; notified < explain->arrival_count; notified++) {
    const struct trax_arrival *arrival = &explain->arrivals[notified];
    if (arrival->cycle > cycle || (arrival->cycle == cycle && arrival->tm > tm))
      break;
    for (unsigned i = 0; i < explain->reader_count; i++)
      if (explain->readers[i]->kind->arrival)
        explain->readers[i]->kind->arrival(explain->readers[i], arrival);
  }
  explain->arrival_count -= notified;
  if (notified)
    memmove(explain->arrivals, explain->arrivals + notified, explain->arrival_count * sizeof *explain->arrivals);
}

static void add_issue(void *context, const struct trax_issue *issue) {
  struct trax_explain *explain = context;
  notify_arrivals(explain, issue->cycle, issue->tm);
  if (explain->has_spans)
    notify_span(explain, issue->tm, issue->tp, issue);
  if (!explain->has_passages)
    return;
  const trax_inst *inst = trax_places_inst(explain->places, trax_places_index(explain->places, issue->pc));
  struct trax_accessed accessed = {.address = issue->address, .outcome = issue->outcome};
  const unsigned flags = trax_op_table[inst->op].flags;
  uint64_t *cycles = explain->open_threads[issue->tm * explain->machine->config.chip.tps_per_tm + issue->tp].cycles;
  cycles[TRAX_CAUSE_ISSUED]++;
  explain->by_issue = true;
  add_stretch(explain, &(struct trax_stretch){.cycle = issue->cycle,
                                              .tm = issue->tm,
                                              .tp = issue->tp,
                                              .count = 1,
                                              .piece = &(struct trax_piece){.pc = issue->pc, .count = 1},
                                              .pieces = 1,
                                              .accessed = &accessed,
                                              .accessed_count = trax_op_table[inst->op].access_bytes &&
                                                                issue->address < TRAX_LOCAL_BASE,
                                              .stores = flags & TRAX_IS_STORE,
                                              .misses = issue->outcome != TRAX_OUTCOME_HIT,
                                              .cycles = inst->op == TRAX_OP_TRAP ? cycles : NULL,
                                              .next_pc = issue->next_pc,
                                              .result = issue->result});
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

static const struct trax_reader_kind *const reader_kinds[] = {
#define ROW(ID) &trax_##ID##_reader,
    TRAX_READERS(ROW)
#undef ROW
};

/* Returns the path that is wanted for a reader's file; NULL: none. */
static const char *path_of(const struct trax_explain_options *options, const struct trax_reader_file *file) {
  return file->path ? *(const char *const *)((const char *)options + file->path - 1) : NULL;
}

static bool is_wanted(const struct trax_explain_options *options, const struct trax_reader_kind *kind) {
  bool wanted = (options->explore && kind->in_page) || (kind->is_wanted && kind->is_wanted(options));
  for (unsigned i = 0; i < TRAX_READER_FILES; i++)
    wanted |= path_of(options, &kind->files[i]) != NULL;
  return wanted;
}

bool trax_explain_wanted(const struct trax_explain_options *options) {
  bool wanted = false;
  for (unsigned i = 0; i < TRAX_READER_KINDS; i++)
    wanted |= is_wanted(options, reader_kinds[i]);
  return wanted;
}

void *trax_explain_array(size_t count, size_t size, trax_error *error) {
  void *array = calloc(count ? count : 1, size);
  if (!array)
    trax_fail(error, "out of memory for the explanation of the run");
  return array;
}

static trax_status open_reader(struct trax_explain *explain, const struct trax_reader_kind *kind, trax_error *error) {
  struct trax_reader *reader = trax_explain_array(1, kind->bytes, error);
  const char *path = kind->files[0].put ? NULL : path_of(&explain->options, &kind->files[0]);
  if (!reader)
    return TRAX_ERROR;
  explain->readers[explain->reader_count++] = reader;
  reader->kind = kind;
  reader->explain = explain;
  if (path && trax_output_open(&reader->output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  reader->out = reader->output.file;
  return kind->open ? kind->open(reader, error) : TRAX_OK;
}

static trax_status create(struct trax_explain *explain, trax_error *error) {
  const size_t threads = explain->machine->stats.threads;
  explain->open_spans = trax_explain_array(threads, sizeof *explain->open_spans, error);
  explain->observer.logs = trax_explain_array(threads, sizeof *explain->observer.logs, error);
  explain->places = trax_places_create(explain->machine);
  explain->open_threads = trax_explain_array(threads, sizeof *explain->open_threads, error);
  explain->end_pcs = trax_explain_array(threads, sizeof *explain->end_pcs, error);
  explain->passages = trax_passages_create(explain);
  if (!explain->open_spans || !explain->open_threads || !explain->end_pcs || !explain->observer.logs ||
      !explain->places || !explain->passages)
    return trax_fail(error, "out of memory for the explanation of %zu threads", threads);
  for (size_t i = 0; i < threads; i++)
    explain->open_spans[i].pc = explain->open_spans[i].previous_pc = explain->end_pcs[i] =
        trax_machine_entry_of(explain->machine, (uint32_t)i);
  if (trax_objects_list(&explain->objects, explain, error) != TRAX_OK)
    return TRAX_ERROR;
  for (unsigned i = 0; i < TRAX_READER_KINDS; i++)
    if (is_wanted(&explain->options, reader_kinds[i]) && open_reader(explain, reader_kinds[i], error) != TRAX_OK)
      return TRAX_ERROR;
  return trax_passages_start(explain->passages, NULL) ? TRAX_OK : trax_fail(error, "out of memory for the explanation");
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

trax_status trax_explain_check_against(const struct trax_explain_options *options, trax_error *error) {
  const char *end = options->explore ? strrchr(options->explore, '.') : NULL;
  struct stat status;
  if (!options->against)
    return TRAX_OK;
  if (!end || (strcasecmp(end, ".html") != 0 && strcasecmp(end, ".htm") != 0))
    return trax_fail(error, "--explore-against needs --explore FILE.html");
  if (stat(options->against, &status) != 0 || access(options->against, R_OK) != 0)
    return trax_fail(error, "%s: %s", options->against, strerror(errno));
  return S_ISDIR(status.st_mode) ? trax_fail(error, "%s: %s", options->against, strerror(EISDIR)) : TRAX_OK;
}

trax_status trax_explain_begin(struct trax_explain **result, trax_machine *machine,
                               const struct trax_explain_options *options, trax_error *error) {
  *result = NULL;
  if (trax_explain_check_against(options, error) != TRAX_OK)
    return TRAX_ERROR;
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
  for (unsigned i = 0; i < explain->reader_count; i++) {
    explain->has_spans |= explain->readers[i]->kind->span != NULL;
    explain->has_passages |= explain->readers[i]->kind->passage || explain->readers[i]->kind->counts;
  }
  explain->observer.context = explain;
  explain->observer.begin = begin_run;
  explain->observer.end = end_run;
  explain->observer.issue = add_issue;
  explain->observer.charge = add_charge;
  explain->observer.arrival = add_arrival;
  if (!explain->has_spans) {
    explain->observer.stretch = add_stretch;
    explain->observer.room = room;
    explain->observer.keep = keep;
    explain->observer.go_back = go_back;
  }
  if (explain->has_spans || explain->has_passages) /* other readers watch the machine or its transfers */
    machine->observer = &explain->observer;
  *result = explain;
  return TRAX_OK;
}

static trax_status write_file(struct trax_reader *reader, const struct trax_reader_file *file, trax_error *error) {
  const char *path = path_of(&reader->explain->options, file);
  if (!path)
    return TRAX_OK;
  if (!reader->output.file && trax_output_open(&reader->output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  if (!file->put || file->put(reader, reader->output.file, error) == TRAX_OK)
    return trax_output_commit(&reader->output, error);
  trax_output_discard(&reader->output);
  return TRAX_ERROR;
}

/* Keeps the first failure. */
static void note_failure(trax_status *status, trax_status part, const trax_error *reason, trax_error *error) {
  if (part != TRAX_OK && *status == TRAX_OK)
    *status = trax_fail(error, "%s", reason->message);
}

trax_status trax_explain_end(struct trax_explain *explain, trax_error *error) {
  if (!explain)
    return TRAX_OK;
  const trax_machine *machine = explain->machine;
  const uint32_t tps = machine->config.chip.tps_per_tm;
  trax_status status = TRAX_OK;
  trax_error reason;
  notify_arrivals(explain, UINT64_MAX, 0);
  trax_passages_finish(explain->passages);
  for (uint32_t thread = 0; thread < machine->stats.threads; thread++) {
    if (explain->has_spans)
      notify_span(explain, thread / tps, thread % tps, NULL);
    end_passages(explain, thread);
  }
  trax_passages_end(explain->passages);
  explain->out_of_memory |= explain->observer.lost;
  for (unsigned i = 0; i < explain->reader_count && !explain->out_of_memory; i++) {
    struct trax_reader *reader = explain->readers[i];
    const trax_status ended = reader->kind->end ? reader->kind->end(reader, &reason) : TRAX_OK;
    note_failure(&status, ended, &reason, error);
    for (unsigned k = 0; k < TRAX_READER_FILES && ended == TRAX_OK && !explain->out_of_memory; k++)
      note_failure(&status, write_file(reader, &reader->kind->files[k], &reason), &reason, error);
  }
  if (status == TRAX_OK && explain->options.explore && explain->options.against)
    status = trax_compare_add(explain->options.against, explain->options.explore, NULL, error);
  if (explain->out_of_memory && status == TRAX_OK)
    status = trax_fail(error, "out of memory: the explanation of the run is incomplete and not written");
  trax_explain_discard(explain);
  return status;
}

void trax_explain_picture(struct trax_explain *explain, const struct trax_explore_picture *picture) {
  if (explain)
    explain->picture = *picture;
}

bool trax_explain_has_rays(const struct trax_explain *explain, uint32_t place) {
  return explain && explain->pixel_rays &&
         (trax_pixel_rays_all(explain->pixel_rays) || trax_stories_have(explain->stories, place));
}

void trax_explain_discard(struct trax_explain *explain) {
  if (!explain)
    return;
  explain->machine->observer = NULL;
  trax_passages_destroy(explain->passages); /* before the readers */
  for (unsigned i = 0; i < explain->reader_count; i++) {
    struct trax_reader *reader = explain->readers[i];
    trax_output_discard(&reader->output);
    if (reader->kind->close)
      reader->kind->close(reader);
    free(reader);
  }
  trax_pixels_destroy(explain->pixels);
  trax_stories_destroy(explain->stories);
  trax_pixel_rays_destroy(explain->pixel_rays);
  for (uint64_t i = 0; explain->open_spans && i < explain->machine->stats.threads; i++)
    free(explain->open_spans[i].charges);
  for (uint64_t i = 0; explain->observer.logs && i < explain->machine->stats.threads; i++)
    free(explain->observer.logs[i].charged);
  free(explain->open_spans);
  free(explain->open_threads);
  free(explain->end_pcs);
  free(explain->observer.logs);
  free(explain->arrivals);
  trax_objects_release(&explain->objects);
  trax_places_destroy(explain->places);
  free(explain);
}
