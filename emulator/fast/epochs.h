/* The fast engine on several threads of the host, or on one, whose caches then keep what belongs to a TM. Each TM runs
   ahead of the others for an epoch of cycles so short that nothing it requests from memory in the epoch can come back
   in it; what it does to memory meanwhile it keeps to itself (fast/store_buffer.h). At the epoch's end the stores take
   effect in the order of cycles and TMs, and the controller serves the requests of the epoch cycle by cycle. So
   everything is as if the TMs had gone from cycle to cycle together, unless one of them has read what another one wrote
   in the same epoch, or did something that cannot be kept: then all go back to where they were some epochs before, do
   the epochs up to this one again, which gives the same, and go on from there cycle by cycle until that is past.
 */
#ifndef TRAX_FAST_EPOCHS_H
#define TRAX_FAST_EPOCHS_H

#include "trax/emulator.h"

#include <stdbool.h>
#include <stdint.h>

struct trax_chip;
struct trax_epochs;

/* Into chip->epochs, if there is something to gain; else that stays NULL. `threads` of the host, 0:
   trax_host_processors. */
trax_status trax_epochs_create(struct trax_chip *chip, unsigned threads, trax_error *error);
void trax_epochs_destroy(struct trax_epochs *epochs);

/* All cycles before *t are over. Runs an epoch that ends in cycle `until` at the latest, and sets *t to the cycle from
   which the run goes on: an earlier one if it had to go back. False: the next cycle is to be run by itself. */
bool trax_epochs_advance(struct trax_epochs *epochs, uint64_t *t, uint64_t until);

/* Never goes back behind the current cycle: somebody has looked at the machine. */
void trax_epochs_commit(struct trax_epochs *epochs);

#endif
