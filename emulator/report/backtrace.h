/* Backtraces: the call chain of one thread, and of all threads, grouped by equal chains. */
#ifndef TRAX_REPORT_BACKTRACE_H
#define TRAX_REPORT_BACKTRACE_H

#include "engine/run.h"
#include "program/unwind.h"

/* The memory that a thread's addresses refer to. */
struct trax_thread_memory {
  const struct trax_space *space;
  const uint8_t *local; /* [TRAX_LOCAL_SIZE] */
};

/* Finds the places of the callers of *frame, innermost first, and returns their number, at most capacity. *frame
   becomes the frame of the last known caller, and *last says why it is the last: TRAX_UNWOUND if capacity ended the
   search. */
size_t trax_callers(const trax_image *image, struct trax_frame *frame, const struct trax_thread_memory *memory,
                    uint32_t *places, size_t capacity, enum trax_unwound *last);

/* Prints the call chain of a thread, one row a frame. After trax_run_export. */
void trax_print_backtrace(const struct trax_run *run, uint32_t thread, FILE *out);
/* Prints the call chains of all threads, the most frequent one first, with the numbers of its threads. */
void trax_print_threads(const struct trax_run *run, FILE *out);

/* --- post_mortem.c: the call chains of all threads at the end of a run --- */

struct trax_post_mortem;

/* To be called before the run. The text is made if `always`, or if SIGQUIT interrupted the run (*interrupt is SIGQUIT).
   NULL: out of memory. */
struct trax_post_mortem *trax_post_mortem_create(trax_machine *machine, const volatile int *interrupt, bool always,
                                                 trax_error *error);
/* The text; NULL if none was made. */
const char *trax_post_mortem_text(const struct trax_post_mortem *post_mortem);
void trax_post_mortem_destroy(struct trax_post_mortem *post_mortem);

#endif
