/* Spans and readers. A span is what a thread did from the issue of one instruction to the issue of the next. Readers
   are called for the spans of all threads in the order of the issues that end them, which does not depend on the
   engine. */
#ifndef TRAX_EXPLAIN_SPAN_H
#define TRAX_EXPLAIN_SPAN_H

#include "engine/run.h"
#include "trax/explain.h"
#include "program/program.h"
#include "report/statistics.h"
#include "trax/output.h"

/* Consecutive cycles that were charged to one cause. */
struct trax_charge {
  trax_cause cause;
  uint64_t since, cycles;
};

struct trax_span {
  uint32_t tm, tp, thread;
  uint32_t pc;          /* of the instruction that ends the span */
  uint32_t index;       /* its index in the places */
  uint32_t previous_pc; /* of the thread's last instruction, to which a branch bubble belongs; pc if there is none */
  uint64_t begin;       /* the first cycle of the span */
  const struct trax_charge *charges;
  size_t count;
  const struct trax_issue *issue; /* NULL: the run ended before the issue, or the thread has halted */
  trax_inst inst;                 /* the instruction; illegal if pc is no text */
};

struct trax_reader {
  void *self;
  void (*span)(void *self, const struct trax_span *span);
  /* Called in the order of (cycle, TM), before the spans that end with issues of the same cycle and TM; may be NULL. */
  void (*arrival)(void *self, const struct trax_arrival *arrival);
  /* Writes the reader's members of the page's data (explain/page.h); NULL: it has none. */
  trax_status (*put_members)(void *self, FILE *out, trax_error *error);
  /* Called after the last span: writes the reader's files. */
  trax_status (*finish)(void *self, trax_error *error);
  void (*destroy)(void *self);
};

struct trax_explain {
  trax_machine *machine;
  struct trax_explain_options options;
  struct trax_observer observer;
  struct trax_open_span *open_spans; /* [threads]: since the latest issue of each */
  struct trax_places *places;
  struct trax_reader readers[10];
  unsigned reader_count;
  struct trax_arrival *arrivals; /* those of which the readers have not been notified yet */
  size_t arrival_count, arrival_capacity;
  struct trax_series *series, *page_series; /* NULL: none */
  struct trax_memory_trace *memory_trace;   /* NULL: none */
  struct trax_explore_picture picture;      /* of the page; width 0: none */
  struct trax_pixels *pixels;               /* for it; NULL: items store to no buffer that is known */
  bool out_of_memory;        /* spans or arrivals were lost */
};

/* Whether the window contains a part of the TP's cycles begin <= t < end. */
bool trax_window_has(const struct trax_explain_options *options, uint32_t tm, uint32_t tp, uint64_t begin,
                     uint64_t end);

/* --- readers: each is created if the options name one of its files --- */
trax_status trax_profile_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_trace_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_konata_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_perfetto_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_heat_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_items_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_order_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_ray_kinds_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_lockstep_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_lockstep_rays_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);

/* --- series.c: a watch, not a reader --- */
/* path: the file of the rows; NULL: they are for the page, a limited number whatever the length of the run. */
trax_status trax_series_create(struct trax_series **series, struct trax_explain *explain, const char *path,
                               trax_error *error);
trax_status trax_series_finish(struct trax_series *series, trax_error *error);
/* Writes the rows that are for the page, after trax_series_finish. */
trax_status trax_series_put_members(struct trax_series *series, FILE *out, trax_error *error);
void trax_series_destroy(struct trax_series *series); /* which may be NULL */

#endif
