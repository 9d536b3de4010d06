/* Checkpoints: files with the state of a run of the fast engine, from which the run can be resumed (docs/emulator.md,
   "Checkpoints"). */
#ifndef TRAX_HOST_CHECKPOINT_H
#define TRAX_HOST_CHECKPOINT_H

#include "machine/machine.h"

struct trax_checkpoint_options {
  const char *write;  /* the file to write; NULL: none */
  uint64_t at;        /* write it before this cycle; 0: not given */
  uint64_t every;     /* write it before each multiple of this number of cycles; 0: not given */
  const char *resume; /* the file to resume from; NULL: the run begins with cycle 0 */
};

struct trax_checkpoint;

/* To be called after the program has been loaded and the buffers bound, before the run. *checkpoint is NULL if the
   options want none. Errors: the file to resume from cannot be read, is damaged, or is of another version, program or
   machine. A failed write ends the run. An interrupted or stopped run also writes a checkpoint. */
trax_status trax_checkpoint_begin(struct trax_checkpoint **checkpoint, trax_machine *machine,
                                  const struct trax_checkpoint_options *options, trax_error *error);
/* To be called after the run. checkpoint may be NULL. TRAX_ERROR: a checkpoint could not be written. */
trax_status trax_checkpoint_end(struct trax_checkpoint *checkpoint, trax_error *error);

#endif
