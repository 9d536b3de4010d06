/* A run as steps: what a thread did from the issue of one instruction to that of the next. Readers get the steps of all
   threads in the order of the issues that end them, which does not depend on the engine. */
#ifndef TRAX_EXPLAIN_STEP_H
#define TRAX_EXPLAIN_STEP_H

#include "engine/run.h"
#include "explain/explain.h"
#include "program/program.h"
#include "report/statistics.h"
#include "trax/output.h"

struct trax_stretch {
  trax_cause cause; /* differs from the next one's, or there is an issue in between */
  uint64_t since, cycles;
};

struct trax_step {
  uint32_t tm, tp, thread;
  uint32_t pc;          /* of the instruction */
  uint32_t index;       /* of it in the places */
  uint32_t previous_pc; /* of the thread's instruction before it, whose a branch bubble is; pc if there was none */
  uint64_t begin;       /* the cycle from which on it is told here */
  const struct trax_stretch *stretches;
  size_t count;
  const struct trax_issue *issue; /* NULL: the run ended before it was issued, or the thread has halted */
  trax_inst inst;                 /* the instruction; what is not text is illegal */
};

struct trax_reader {
  void *self;
  void (*step)(void *self, const struct trax_step *step);
  /* In the order of (cycle, TM) with the issues, before those of its cycle in its TM; may be NULL. */
  void (*arrival)(void *self, const struct trax_arrival *arrival);
  /* After the last step: writes its files. */
  trax_status (*finish)(void *self, trax_error *error);
  void (*destroy)(void *self);
};

struct trax_explain {
  trax_machine *machine;
  struct trax_explain_options options;
  struct trax_observer observer;
  struct trax_steps *steps; /* [threads] */
  struct trax_places *places;
  struct trax_reader readers[8];
  unsigned reader_count;
  struct trax_arrival *arrivals; /* that came before issues of other TMs, and wait for their turn */
  size_t arrival_count, arrival_capacity;
  struct trax_watch *series; /* NULL: none */
  bool out_of_memory;        /* some of what was told could not be kept */
};

/* Whether the window has the TP's cycles from begin to end (not included), or part of them. */
bool trax_window_has(const struct trax_explain_options *options, uint32_t tm, uint32_t tp, uint64_t begin,
                     uint64_t end);

/* --- readers: each makes what the options want of it --- */
trax_status trax_profile_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_trace_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_konata_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_perfetto_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_heat_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_items_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_order_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);
trax_status trax_lockstep_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error);

/* --- series.c: a watch, not a reader --- */
trax_status trax_series_create(struct trax_explain *explain, trax_error *error);
trax_status trax_series_finish(struct trax_explain *explain, trax_error *error);
void trax_series_destroy(struct trax_explain *explain);

#endif
