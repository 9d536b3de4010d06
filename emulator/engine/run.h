/* The run of a machine's program by an engine: one loop for all of them, and what others may ask while it goes on. */
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
  void *chip;            /* the engine's */
  struct trax_text text; /* the program, decoded */
  uint64_t begin;        /* the first cycle; not 0 if the run goes on with another one's */

  bool begun, ended;
  uint64_t t;         /* the next cycle; the length of the run once it has ended */
  uint64_t limit;     /* of cycles */
  uint64_t looked_at; /* the cycle in which a watch looks next */
  struct trax_poll poll;
};

/* To be destroyed either way. */
trax_status trax_run_create(struct trax_run *run, struct trax_machine *machine, const struct trax_engine *engine,
                            const struct trax_run_options *options, trax_error *error);
void trax_run_destroy(struct trax_run *run);

/* Goes on to the end, a fault, an interrupt, the limit of cycles, or until a watch ends it: then `ended` is set, and
   the watches have been told. Or stops before cycle `until`, TRAX_NEVER if it is not to; then the run can go on. An
   engine without time runs to its end. */
trax_status trax_run_go(struct trax_run *run, uint64_t until);

/* --- between cycles --- */

void trax_run_settle(struct trax_run *run, uint64_t t);
/* See engine.h: everything is where trax_run_thread finds it. The run can go on. */
void trax_run_export(struct trax_run *run);
/* Goes on before cycle t with what was changed since. */
void trax_run_import(struct trax_run *run, uint64_t t);
/* After trax_run_export, or after the run. */
struct trax_thread trax_run_thread(const struct trax_run *run, uint32_t thread);
/* The cycle after the latest trap or halt of any thread, as far as the engine remembers. */
uint64_t trax_run_progressed(const struct trax_run *run);
uint32_t trax_run_queued(const struct trax_run *run, uint32_t tm, uint64_t t);

#endif
