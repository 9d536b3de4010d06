/* The waiting threads, and the state that they poll. */
#ifndef TRAX_RUNTIME_TEAM_H
#define TRAX_RUNTIME_TEAM_H

#include "../internal/machine.h"

#include <stdlib.h>
#include <string.h>
#include <trax/parallel.h>

#ifdef __trax__

/* Calls the function on the threads below `size` (0: all), or on this one alone. Returns their number. */
unsigned __trax_team_run(void (*function)(void *), void *context, unsigned size);
/* Lets the other threads wait for work. Returns their number. */
unsigned __trax_team_open(void);
/* The number of threads for a call's work: 1 within other work, on other threads than 0, and while created threads run.
 */
unsigned __trax_team_available(void);
/* The size of the team in which this thread works; 0: in none. */
extern _Thread_local unsigned __trax_team_members;

/* In programs with thrd_create: runs the function that the waiting thread was given; returns the number of such
 * threads. */
__attribute__((weak)) void __trax_errand(void);
__attribute__((weak)) unsigned __trax_errands(void);

#endif
#endif
