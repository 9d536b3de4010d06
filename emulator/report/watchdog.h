/* The watchdog: ends a run that gets nowhere (docs/emulator.md, "Watchdog"). */
#ifndef TRAX_REPORT_WATCHDOG_H
#define TRAX_REPORT_WATCHDOG_H

#include "machine/machine.h"

struct trax_watchdog;

/* Before the run. Looks at the machine every `cycles` cycles, and ends the run with TRAX_STUCK if since the last look
   no thread has ended or executed a trap (a ray, an item, output). NULL if there is no memory. */
struct trax_watchdog *trax_watchdog_begin(trax_machine *machine, uint64_t cycles);
/* If it has ended the run: what the threads did meanwhile and where they are, in lines of threads that did the same. */
void trax_watchdog_print(const struct trax_watchdog *watchdog, FILE *out);
/* After the run; which may be NULL. */
void trax_watchdog_end(struct trax_watchdog *watchdog);

#endif
