/* Checkpoints: a run of the fast engine in a file, and taken up again from it (docs/emulator.md, "Checkpoints"). */
#ifndef TRAX_HOST_CHECKPOINT_H
#define TRAX_HOST_CHECKPOINT_H

#include "machine/machine.h"

struct trax_checkpoint_options {
  const char *write;  /* the file; NULL: none is written */
  uint64_t at;        /* before this cycle; 0: not given */
  uint64_t every;     /* before each multiple of so many cycles; 0: not given */
  const char *resume; /* the file from which the run goes on; NULL: it begins with cycle 0 */
};

struct trax_checkpoint;

/* After the program is loaded and the buffers are bound, before the run. *checkpoint is NULL if nothing is asked for.
   Errors: the file to resume from cannot be read, is damaged, or is of another version, program or machine. Errors in
   writing end the run. A run that is interrupted or stopped also writes a checkpoint. */
trax_status trax_checkpoint_begin(struct trax_checkpoint **checkpoint, trax_machine *machine,
                                  const struct trax_checkpoint_options *options, trax_error *error);
/* After the run; which may be NULL. TRAX_ERROR, with the reason, if a checkpoint could not be written. */
trax_status trax_checkpoint_end(struct trax_checkpoint *checkpoint, trax_error *error);

#endif
