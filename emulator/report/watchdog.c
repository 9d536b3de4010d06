#include "report/watchdog.h"

#include "engine/run.h"
#include "program/program.h"
#include "report/place.h"
#include "report/statistics.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct trax_watchdog {
  struct trax_machine *machine;
  struct trax_watch watch;
  uint64_t cycles;                   /* checks are made before the multiples of it */
  uint64_t last_okay;                /* cycle of the latest check that found progress */
  uint64_t ended;                    /* the cycle before which the watchdog ended the run */
  uint64_t progress, issued;         /* counts of the latest check */
  struct trax_tp_stats *charges;     /* [threads]: of the latest check; after the end, the charges since then */
  uint32_t *pc;                      /* [threads]: at the end of the run */
  trax_cause *cause;                 /* [threads]: the main one of the charges, for the report */
  const struct trax_symbol **symbol; /* [threads]: at pc; NULL: none */
  bool is_stuck;                     /* the watchdog has ended the run */
  bool asleep;                       /* and no instruction was issued since last_okay */
};

/* Counts the instructions that are progress, and all instructions. */
static void count(const struct trax_machine *machine, uint64_t *progress, uint64_t *issued) {
  *progress = *issued = 0;
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++)
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++) {
      const uint64_t instructions = machine->tm_stats[tm].instructions[op];
      *issued += instructions;
      *progress += op == TRAX_OP_TRAP || op == TRAX_OP_HALT ? instructions : 0;
    }
}

/* Returns the cause, other than ISSUED, to which a thread was charged most; ISSUED if it was charged to no other. */
static trax_cause main_cause(const uint64_t *cycles) {
  trax_cause most = TRAX_CAUSE_ISSUED;
  for (unsigned cause = 1; cause < TRAX_CAUSE_COUNT; cause++)
    if (cycles[cause] > (most == TRAX_CAUSE_ISSUED ? 0 : cycles[most]))
      most = (trax_cause)cause;
  return most;
}

static void record_threads(struct trax_watchdog *watchdog, struct trax_run *run) {
  const struct trax_loaded *loaded = trax_loaded_of(watchdog->machine);
  trax_run_export(run);
  for (uint32_t thread = 0; thread < run->machine->stats.threads; thread++) {
    watchdog->pc[thread] = trax_run_thread(run, thread).pc;
    watchdog->cause[thread] = main_cause(watchdog->charges[thread].cycles);
    watchdog->symbol[thread] = loaded ? trax_image_symbol_at(loaded->image, watchdog->pc[thread]) : NULL;
  }
}

static trax_status check(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct trax_watchdog *watchdog = watch->context;
  const struct trax_machine *machine = run->machine;
  const uint64_t cycles = watchdog->cycles, progress = watchdog->progress, issued = watchdog->issued;
  trax_run_settle(run, t);
  count(machine, &watchdog->progress, &watchdog->issued);
  /* A resumed run has not counted the progress before the checkpoint, but the engine knows its latest cycle. So it ends
     where the undisturbed run does, also if the checkpoint was written there. */
  const bool is_first = t == run->begin, is_due = t % cycles == 0 && t > cycles;
  watchdog->is_stuck = is_due && (is_first || watchdog->progress == progress) && trax_run_progressed(run) <= t - cycles;
  if (!watchdog->is_stuck) {
    memcpy(watchdog->charges, machine->tp_stats, machine->stats.threads * sizeof *watchdog->charges);
    watchdog->last_okay = t;
    watch->next = t - t % cycles + cycles;
    return TRAX_OK;
  }
  watchdog->ended = t;
  watchdog->asleep = !is_first && watchdog->issued == issued;
  if (is_first)
    watchdog->last_okay = t - cycles;
  for (uint64_t i = 0; i < machine->stats.threads; i++)
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      watchdog->charges[i].cycles[cause] = machine->tp_stats[i].cycles[cause] - watchdog->charges[i].cycles[cause];
  record_threads(watchdog, run);
  return TRAX_STUCK;
}

struct trax_watchdog *trax_watchdog_begin(trax_machine *machine, uint64_t cycles) {
  struct trax_watchdog *watchdog = calloc(1, sizeof *watchdog);
  if (!watchdog)
    return NULL;
  watchdog->machine = machine;
  watchdog->cycles = cycles;
  watchdog->charges = calloc(machine->stats.threads, sizeof *watchdog->charges);
  watchdog->pc = calloc(machine->stats.threads, sizeof *watchdog->pc);
  watchdog->cause = calloc(machine->stats.threads, sizeof *watchdog->cause);
  watchdog->symbol = calloc(machine->stats.threads, sizeof *watchdog->symbol);
  watchdog->watch = (struct trax_watch){.inspect = check, .context = watchdog};
  trax_machine_watch(machine, &watchdog->watch);
  if (watchdog->charges && watchdog->pc && watchdog->cause && watchdog->symbol)
    return watchdog;
  trax_watchdog_end(watchdog);
  return NULL;
}

/* --- the report --- */

static bool alike(const struct trax_watchdog *watchdog, uint64_t a, uint64_t b) {
  return watchdog->cause[a] == watchdog->cause[b] && watchdog->symbol[a] == watchdog->symbol[b];
}

static void print_threads(const struct trax_watchdog *watchdog, uint64_t first, FILE *out) {
  const struct trax_loaded *loaded = trax_loaded_of(watchdog->machine);
  const trax_cause cause = watchdog->cause[first];
  uint64_t threads = 0, issued = 0, waited = 0, all = 0;
  for (uint64_t i = first; i < watchdog->machine->stats.threads; i++)
    if (alike(watchdog, first, i)) {
      threads++;
      issued += watchdog->charges[i].cycles[TRAX_CAUSE_ISSUED];
      waited += cause == TRAX_CAUSE_ISSUED ? 0 : watchdog->charges[i].cycles[cause];
      for (unsigned k = 0; k < TRAX_CAUSE_COUNT; k++)
        all += watchdog->charges[i].cycles[k];
    }
  fprintf(out, "  %" PRIu64 " thread%s, as %" PRIu64 ": issued %.0f %%", threads, threads > 1 ? "s" : "", first,
          100 * (double)issued / (double)all);
  if (cause != TRAX_CAUSE_ISSUED)
    fprintf(out, ", %s %.0f %%", trax_cause_names[cause], 100 * (double)waited / (double)all);
  const struct trax_symbol *symbol = watchdog->symbol[first];
  fprintf(out, "; at 0x%08x", watchdog->pc[first]);
  if (symbol) {
    fprintf(out, " in ");
    trax_print_symbol(symbol, watchdog->pc[first], out);
  }
  struct trax_source_line line;
  if (loaded && trax_image_lines(loaded->image, watchdog->pc[first], &line, 1))
    fprintf(out, " at %s:%d", line.file, line.line);
  fprintf(out, "\n");
}

void trax_watchdog_print(const struct trax_watchdog *watchdog, FILE *out) {
  if (!watchdog->is_stuck)
    return;
  fprintf(out,
          "no thread has ended, and no ray, item or output was seen, between the cycles %" PRIu64 " and %" PRIu64
          "%s\n",
          watchdog->last_okay, watchdog->ended, watchdog->asleep ? "; no instruction was issued" : "");
  for (uint64_t i = 0; i < watchdog->machine->stats.threads; i++) {
    uint64_t before = 0;
    while (before < i && !alike(watchdog, before, i))
      before++;
    if (before == i)
      print_threads(watchdog, i, out);
  }
}

void trax_watchdog_end(struct trax_watchdog *watchdog) {
  if (!watchdog)
    return;
  trax_machine_unwatch(watchdog->machine, &watchdog->watch);
  free(watchdog->charges);
  free(watchdog->pc);
  free(watchdog->cause);
  free(watchdog->symbol);
  free(watchdog);
}
