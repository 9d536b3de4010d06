/* What is written about a run besides its statistics: profiles, traces, time lines, memory heat, cost of items, series
   (docs/emulator.md, "Explaining a run"). All of it is the same from run to run and from either timing engine.

     struct trax_explain *explain;
     trax_explain_begin(&explain, machine, &options, &error);   loaded and bound, not yet run
     trax_machine_run(machine, ...);
     trax_explain_end(explain, &error);                         also after a run that did not finish */
#ifndef TRAX_EXPLAIN_H
#define TRAX_EXPLAIN_H

#include "trax/emulator.h"

struct trax_explain;

struct trax_explain_options {
  /* Files to write; NULL: not wanted. "-" is standard output. */
  const char *profile;  /* thread-cycles by function and source line */
  const char *folded;   /* by call stack, for flame graphs */
  const char *annotate; /* by instruction */
  const char *trace;    /* every issue in the window */
  const char *konata;   /* the same as a pipeline, for Konata */
  const char *perfetto; /* the window as JSON trace events */
  const char *heat;     /* accesses to memory by object */
  const char *heat_lines;
  const char *items;    /* what each item cost */
  const char *lockstep; /* what the items would take on a SIMD machine */
  const char *series;
  bool check_order; /* tells standard error of the first load that may return an old value */

  uint64_t series_interval; /* cycles; 0: TRAX_SERIES_INTERVAL */
  /* The window of trace, konata and perfetto: cycles begin <= t < end (0: to the run's end), of the TMs and of the TPs
     in them whose bits are set (0: all). */
  uint64_t window_begin, window_end;
  uint64_t window_tms, window_tps;
  /* An item's place: that of its last store to this buffer, in units of item_bytes from the buffer's begin. */
  const char *item_buffer; /* NULL: none */
  uint32_t item_bytes;
};

enum { TRAX_SERIES_INTERVAL = 10000 };

/* Whether anything is wanted. */
bool trax_explain_wanted(const struct trax_explain_options *options);

/* options are copied, but not its strings. *explain is NULL if nothing is wanted, and on an error. */
trax_status trax_explain_begin(struct trax_explain **explain, trax_machine *machine,
                               const struct trax_explain_options *options, trax_error *error);
/* Writes what is not written yet and releases explain, which may be NULL. */
trax_status trax_explain_end(struct trax_explain *explain, trax_error *error);
/* Releases explain, which may be NULL; its files do not appear. */
void trax_explain_discard(struct trax_explain *explain);

/* What an item (docs/isa.md, "trap": items) cost: everything its thread was charged between two reports. */
struct trax_item_cost {
  uint32_t thread;
  uint32_t place;      /* TRAX_NO_PLACE: it stored nothing to the buffer */
  uint64_t begin, end; /* cycles */
  uint64_t instructions;
  const uint64_t *cycles; /* [TRAX_CAUSE_COUNT] */
};
#define TRAX_NO_PLACE UINT32_MAX

/* Hands over every item as it ends; called before the run. What belongs to no item comes in the end, by thread, with
   place TRAX_NO_PLACE and last set. */
void trax_explain_items(struct trax_explain *explain,
                        void (*item)(void *context, const struct trax_item_cost *cost, bool last), void *context);

#endif
