/* Where threads are: the call chain of one, and all of them, those at the same place together. */
#ifndef TRAX_REPORT_BACKTRACE_H
#define TRAX_REPORT_BACKTRACE_H

#include "engine/run.h"
#include "program/unwind.h"

struct trax_host;

/* Rows of symbol and source line for a place in the text, as fault reports have them; nothing where nothing is known.
 */
void trax_print_place(const struct trax_host *host, const char *label, uint32_t pc, FILE *out);

/* What a thread's addresses mean. */
struct trax_thread_memory {
  const struct trax_space *space;
  const uint8_t *local; /* [TRAX_LOCAL_SIZE] */
};

/* The places of the callers of *frame, innermost first, at most capacity of them. *frame becomes the last one's that is
   known, and *last says why it is the last: TRAX_UNWOUND if capacity ended the search. */
size_t trax_callers(const trax_image *image, struct trax_frame *frame, const struct trax_thread_memory *memory,
                    uint32_t *places, size_t capacity, enum trax_unwound *last);

/* The chain of a thread, after trax_run_export, one row a frame. */
void trax_print_backtrace(const struct trax_run *run, uint32_t thread, FILE *out);
/* Of all threads: how many are where, most first, and which. */
void trax_print_threads(const struct trax_run *run, FILE *out);

/* --- post_mortem.c: the same when a run has ended --- */

struct trax_post_mortem;

/* Before the run. It is made up if `always`, or if the run was
   interrupted by SIGQUIT, which *interrupt then is. */
struct trax_post_mortem *trax_post_mortem_create(trax_machine *machine, const volatile int *interrupt, bool always,
                                                 trax_error *error);
/* NULL if none was made up. */
const char *trax_post_mortem_text(const struct trax_post_mortem *post_mortem);
void trax_post_mortem_destroy(struct trax_post_mortem *post_mortem);

#endif
