/* The watchdog ends a run that makes no progress (docs/emulator.md, "Watchdog"). */
#ifndef TRAX_REPORT_WATCHDOG_H
#define TRAX_REPORT_WATCHDOG_H

#include "machine/machine.h"

struct trax_watchdog;

/* To be called before the run. Checks the machine every `cycles` cycles, and ends the run with TRAX_STUCK if since the
   latest check no thread has ended or executed a trap (a ray, an item, output). NULL: out of memory. */
struct trax_watchdog *trax_watchdog_begin(trax_machine *machine, uint64_t cycles);
/* If the watchdog has ended the run, prints what the threads did since the latest progress and where they are. Threads
   that did the same share a line. */
void trax_watchdog_print(const struct trax_watchdog *watchdog, FILE *out);
/* To be called after the run. watchdog may be NULL. */
void trax_watchdog_end(struct trax_watchdog *watchdog);

#endif
