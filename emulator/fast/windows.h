/* The fast engine on several threads of the host, or on one, whose caches then keep what belongs to a TM. Each TM runs
   ahead of the others for a window of cycles so short that nothing it requests from memory in the window can come back
   in it; what it does to memory meanwhile it keeps to itself (fast/ahead.h). At the window's end the stores take effect
   in the order of cycles and TMs, and the controller serves the requests of the window cycle by cycle. So everything is
   as if the TMs had gone from cycle to cycle together, unless one of them has read what another one wrote in the same
   window, or did something that cannot be kept: then all go back to where they were some windows before, do the windows
   up to this one again, which gives the same, and go on from there cycle by cycle until that is past.
 */
#ifndef TRAX_FAST_WINDOWS_H
#define TRAX_FAST_WINDOWS_H

#include "trax/emulator.h"

#include <stdbool.h>
#include <stdint.h>

struct trax_chip;
struct trax_windows;

/* Into chip->windows, if there is something to gain; else that stays NULL. `threads` of the host, 0:
   trax_host_processors. */
trax_status trax_windows_create(struct trax_chip *chip, unsigned threads, trax_error *error);
void trax_windows_destroy(struct trax_windows *windows);

/* All cycles before *t are over. Runs a window that ends in cycle `until` at the latest, and sets *t to the cycle from
   which the run goes on: an earlier one if it had to go back. False: the next cycle is to be run by itself. */
bool trax_windows_advance(struct trax_windows *windows, uint64_t *t, uint64_t until);

/* Never goes back behind the current cycle: somebody has looked at the machine. */
void trax_windows_forget(struct trax_windows *windows);

#endif
