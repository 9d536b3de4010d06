/* The run of a machine's program by an engine: one loop for all engines, and what watches may read and change between
   its cycles. */
#ifndef TRAX_ENGINE_RUN_H
#define TRAX_ENGINE_RUN_H

#include "engine/engine.h"
#include "engine/poll.h"
#include "machine/text.h"
#include "machine/watch.h"

struct trax_run {
  struct trax_machine *machine;
  const struct trax_engine *engine;
  const struct trax_run_options *options;
  void *chip;             /* the engine's */
  struct trax_text text;  /* the program, decoded */
  struct trax_pool *pool; /* NULL: nobody has asked for it */
  uint64_t begin;         /* the first cycle; not 0 if the run resumes another one */

  bool complete; /* it resumes a run whose program had ended: there is nothing to simulate */
  bool begun, ended;
  uint64_t t;          /* the next cycle; after the end, the length of the run */
  uint64_t limit;      /* of cycles */
  uint64_t next_watch; /* the next cycle in which a watch is due */
  struct trax_poll poll;
};

/* The run must be destroyed even after an error. */
trax_status trax_run_create(struct trax_run *run, struct trax_machine *machine, const struct trax_engine *engine,
                            const struct trax_run_options *options, trax_error *error);
void trax_run_destroy(struct trax_run *run);
/* The threads of the host that the run may use, which the engine and the observer share (trax/pool.h): at most one for
   each TM, or TRAX_RUN_THREADS. NULL: an error. */
enum { TRAX_RUN_THREADS = 4 /* with one TM: of the observer */ };
struct trax_pool *trax_run_pool(struct trax_run *run, trax_error *error);

/* Runs until the program ends or faults, an interrupt, the limit of cycles, or the end by a watch: then `ended` is set,
   and `end` of the watches has been called. Or it stops before cycle `until` (TRAX_NEVER: does not), after which the
   run can be continued. An engine without time runs to its end. */
trax_status trax_run_advance(struct trax_run *run, uint64_t until);

/* --- between cycles --- */

void trax_run_settle(struct trax_run *run, uint64_t t);
/* export_state of the engine, which trax_run_thread needs. The run can be continued. */
void trax_run_export(struct trax_run *run);
/* import_state of the engine: the run goes on before cycle t with the state as changed since the export. */
void trax_run_import(struct trax_run *run, uint64_t t);
/* After trax_run_export, or after the run. */
struct trax_thread trax_run_thread(const struct trax_run *run, uint32_t thread);
uint64_t trax_run_progressed(const struct trax_run *run);
uint32_t trax_run_queued(const struct trax_run *run, uint32_t tm, uint64_t t);

#endif
