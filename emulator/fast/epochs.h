/* Epochs: each TM simulates some cycles alone, so that the TMs can run on several threads of the host. On one thread,
   too, this is faster, since the host's caches hold the data of one TM at a time. An epoch consists of quanta. They are
   so short that no request made in one can complete before the quantum that may begin without its result. The TM's
   stores and requests go to its store buffer (fast/store_buffer.h). When all TMs have simulated a quantum, any thread
   serves its requests cycle by cycle (fast/merge.h), while others are a quantum ahead. At the end of the epoch the
   stores take effect. The result is that of simulating the TMs cycle by cycle, unless there is a conflict: a TM has
   read what another one wrote in the epoch, or has done something that a store buffer cannot hold. Then the chip rolls
   back to the snapshot, repeats the epochs up to this one with the same results, and simulates the cycles of this one
   one by one. */
#ifndef TRAX_FAST_EPOCHS_H
#define TRAX_FAST_EPOCHS_H

#include "trax/emulator.h"

#include <stdbool.h>
#include <stdint.h>

struct trax_chip;
struct trax_run;
struct trax_epochs;

/* Creates chip->epochs, which stays NULL for one TM, with an observer that cannot go back, and if epochs would be too
   short. The threads are the run's. */
trax_status trax_epochs_create(struct trax_chip *chip, struct trax_run *run, trax_error *error);
void trax_epochs_destroy(struct trax_epochs *epochs);

/* Simulates an epoch from cycle *t on that ends in cycle `until` at the latest. Sets *t to the next cycle, which is an
   earlier one after a roll back. False: the next cycle must be simulated without an epoch. */
bool trax_epochs_advance(struct trax_epochs *epochs, uint64_t *t, uint64_t until);

/* Gives up the snapshot: the chip never rolls back beyond the current cycle, whose state a watch has seen. */
void trax_epochs_commit(struct trax_epochs *epochs);

#endif
