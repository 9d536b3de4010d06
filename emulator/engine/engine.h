/* What an engine is: a way to run a machine's program, as a table of operations. engine/run.c drives every engine with
   one loop; host/engines.c lists them by name. */
#ifndef TRAX_ENGINE_ENGINE_H
#define TRAX_ENGINE_ENGINE_H

#include "machine/machine.h"
#include "machine/section.h"

struct trax_run;

/* How a call of `advance` ended. */
enum trax_advance {
  TRAX_GOES_ON,
  TRAX_HAS_ENDED,     /* every thread has ended, and the last transfer is over */
  TRAX_HAS_FAULTED,   /* in the cycle before *t */
  TRAX_AT_INSTRUCTION /* of an engine without time: a thread has executed as many instructions as it may */
};

/* A thread as others see it. What the pointers lead to may be changed before import_state. */
struct trax_thread {
  uint32_t *reg;  /* [TRAX_NUM_REGISTERS] */
  uint8_t *local; /* [TRAX_LOCAL_SIZE] */
  uint32_t pc;    /* of its next instruction */
  bool ended;
};

struct trax_engine {
  const char *name;          /* of --engine */
  const char *meaning;       /* in a few words, for help */
  bool (*is_possible)(void); /* on this host; NULL: on each */
  bool is_timed;             /* it has cycles; without, a run is 0 cycles long and only `end` of watches is called */
  bool is_observed;          /* it tells an observer (machine/observer.h) */

  /* Into run->chip, which destroy releases even if create failed. */
  trax_status (*create)(struct trax_run *run, trax_error *error);
  void (*destroy)(void *chip); /* which may be NULL */

  /* Goes on from cycle *t, at most to `until`, which is later, and not for long; *t receives the next cycle. An engine
     may go back, to run some cycles again with the same results. */
  enum trax_advance (*advance)(void *chip, uint64_t *t, uint64_t until);
  /* Somebody has looked at the machine: the engine does not go back behind this cycle. NULL: it never goes back. */
  void (*commit)(void *chip);

  /* Brings the TMs' counts of instructions up to date, for progress; NULL: they always are. */
  void (*collect)(void *chip);
  /* Completes the machine's statistics and charges for the cycles before t, which are over, and hands it the fault. */
  void (*settle)(void *chip, uint64_t t);

  /* Between cycles: brings all that the rest of the run depends on to where `thread` and `visit` find it, and takes it
     from there before cycle t. NULL: it is always there. */
  void (*export_state)(void *chip);
  void (*import_state)(void *chip, uint64_t t);
  struct trax_thread (*thread)(void *chip, uint32_t thread);
  /* The thread goes on at pc, which is text: what it has fetched is of no use. After export_state. */
  void (*set_pc)(void *chip, uint32_t thread, uint32_t pc);

  /* The cycle after the latest trap or halt of any thread, as far as the engine remembers. */
  uint64_t (*progressed)(void *chip);
  /* How many places of a TM's memory queue are taken when all cycles before t are over. */
  uint32_t (*queued)(const void *chip, uint32_t tm, uint64_t t);

  /* Checkpoints; NULL: the engine has none. visit: all that the rest of the run depends on besides global memory, and
     all that was counted, in sections whose sizes and order depend on the configuration alone. After export_state; to
     read it also after settle. check: whether a state that may have come from anywhere can be taken up before cycle t;
     NULL if so, else what is wrong, in `text`. import_state follows. */
  void (*visit)(void *chip, trax_section_visitor *visit, void *context);
  const char *(*check)(void *chip, uint64_t t, char text[128]);
};

#endif
