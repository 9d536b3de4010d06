/* Host calls of a program (docs/abi.md, "Host calls"): standard input and output, and files below the folders that the
   user allowed. All that a call answers follows from the program's calls and the contents of input and files, never
   from the time of the host. Contents of files are kept here; a file of the host changes only when the program has
   closed it, and is then replaced as a whole. */
#ifndef TRAX_CALLS_CALLS_H
#define TRAX_CALLS_CALLS_H

#include "trax/status.h"

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct trax_machine;
struct trax_calls;

/* The machine's, which are made by the first call. NULL: out of memory. */
struct trax_calls *trax_calls_of(struct trax_machine *machine);

/* Allows the folder, which the program sees as `name`. Errors: there is no such folder. */
trax_status trax_calls_allow(struct trax_machine *machine, const char *folder, const char *name, trax_error *error);

struct trax_calls_streams {
  FILE *input, *output, *errors; /* NULL: empty, discarded */
  const volatile int *interrupt; /* nonzero: stop waiting for input; may be NULL */
};
/* Before the run. */
trax_status trax_calls_begin(struct trax_machine *machine, const struct trax_calls_streams *streams, trax_error *error);
/* After the run. Files that the program left open are complete if it has ended by itself (`completed`). If it has not,
   nothing more is written. Error: a file cannot be written. */
trax_status trax_calls_end(struct trax_machine *machine, bool completed, trax_error *error);

/* --- checkpoints --- */

/* Keeps changes of files until trax_calls_commit, so that a run that is resumed finds the files as they were. */
void trax_calls_defer(struct trax_machine *machine);
/* Whether changes of files have been kept. */
bool trax_calls_pending(const struct trax_machine *machine);
/* Makes the changes that have been kept, but for files that are open. */
trax_status trax_calls_commit(struct trax_machine *machine, trax_error *error);
/* The state: names, descriptors, contents that the host's files do not have, how much of the input has been read.
 *bytes is from malloc; NULL and 0 if no call has been made. False: out of memory. */
bool trax_calls_save(const struct trax_machine *machine, uint8_t **bytes, size_t *size);
/* Errors: damaged; an input or a file that is not what it was. */
trax_status trax_calls_restore(struct trax_machine *machine, const uint8_t *bytes, size_t size, trax_error *error);

#endif
