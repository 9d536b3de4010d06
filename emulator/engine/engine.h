/* The interface of an engine: a table of operations that run a machine's program. engine/run.c drives every engine with
   one loop; control/engines.c lists the engines by name. */
#ifndef TRAX_ENGINE_ENGINE_H
#define TRAX_ENGINE_ENGINE_H

#include "machine/machine.h"
#include "machine/section.h"

struct trax_run;

/* How a call of `advance` ended. */
enum trax_advance {
  TRAX_GOES_ON,
  TRAX_HAS_ENDED,   /* every thread has ended, and the last transfer is over */
  TRAX_HAS_FAULTED, /* a fault happened in the cycle before *t */
  TRAX_AT_LIMIT     /* only an engine without time: a thread has reached the limit of instructions */
};

/* The registers, memory and pc of a thread. They may be changed through the pointers before import_state. */
struct trax_thread {
  uint32_t *reg;  /* [TRAX_NUM_REGISTERS] */
  uint8_t *local; /* [TRAX_LOCAL_SIZE] */
  uint32_t pc;    /* of its next instruction */
  bool ended;
};

struct trax_engine {
  const char *name;    /* the value of --engine */
  const char *meaning; /* a few words for help */
  bool is_timed;       /* it simulates cycles; else a run has 0 cycles, and only `end` of watches is called */
  bool is_observed;    /* it notifies an observer (machine/observer.h) */
  bool has_warps;      /* it runs machines with simt.width > 1 */
  bool counts_rays;    /* it counts the cycles of rays (machine/ray_cycles.h) */

  /* Creates run->chip, which destroy releases even if create has failed. */
  trax_status (*create)(struct trax_run *run, trax_error *error);
  void (*destroy)(void *chip); /* chip may be NULL */

  /* Simulates some cycles from *t on, at most up to `until`, which is later than *t; *t receives the next cycle. It
     returns often enough for polling. An engine may roll back and simulate some cycles again with the same
     results: *t is then an earlier cycle. */
  enum trax_advance (*advance)(void *chip, uint64_t *t, uint64_t until);
  /* A watch has seen the machine's state: the engine never rolls back beyond this cycle. NULL: it never rolls back. */
  void (*commit)(void *chip);

  /* Brings the TMs' counts of instructions up to date, for progress; NULL: they always are. */
  void (*collect)(void *chip);
  /* Completes the machine's statistics and charges for all cycles before t, and records the fault, if any. */
  void (*settle)(void *chip, uint64_t t);
  /* Tells an observer of stretches, after `settle`, what it has not been told of the cycles before. */
  void (*tell)(void *chip);

  /* Between cycles. export_state writes all that the rest of the run depends on to the structures that `thread` and
     `visit` access; import_state reads it from there before cycle t. NULL: the engine keeps its state in them. */
  void (*export_state)(void *chip);
  void (*import_state)(void *chip, uint64_t t);
  struct trax_thread (*thread)(void *chip, uint32_t thread);
  /* Moves the thread to pc, which must be text, and discards its fetched instruction. Called after export_state. */
  void (*set_pc)(void *chip, uint32_t thread, uint32_t pc);

  /* Returns the cycle after the latest trap or halt of any thread that the engine remembers. */
  uint64_t (*progressed)(void *chip);
  /* Returns how many places of a TM's memory queue are taken when all cycles before t are over. */
  uint32_t (*queued)(const void *chip, uint32_t tm, uint64_t t);

  /* Checkpoints; NULL: the engine has none.
     visit: visits all that the rest of the run depends on besides global memory, and all counters, in sections whose
     sizes and order depend on the configuration alone. export_state precedes it, and also settle if the state is read.
     check: checks a state from an untrusted file before import_state. Returns NULL if the run can continue with it
     before cycle t, else the reason, in `text`. */
  void (*visit)(void *chip, trax_section_visitor *visit, void *context);
  const char *(*check)(void *chip, uint64_t t, char text[128]);
};

#endif
