/* Interrupts. Every program of the project handles SIGINT, SIGTERM and SIGHUP alike: it stops, removes unfinished
   files, ends its children, prints a line, and ends by the signal itself, so that its parent sees death by that signal
   (in a shell: exit status 130, 143, 129). A second signal ends it at once. Signals that were ignored when the program
   was started (nohup) stay ignored. Programs without unfinished files keep the default action. */
#ifndef TRAX_SIGNALS_H
#define TRAX_SIGNALS_H

#include "trax/status.h"

#include <signal.h>
#include <sys/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of the first signal that arrived; 0: none. Long computations poll it through the `interrupt` of their
   options; system calls that wait return EINTR. */
extern volatile sig_atomic_t trax_signal;

void trax_catch_signals(void);
/* Handles one more signal in the same way. */
void trax_catch_signal(int number);
/* fork() with the default actions in the child. After a plain fork() the child would have the handlers until it calls
   exec, and would only note a signal. The child receives `signal` when the thread that calls this ends. */
pid_t trax_fork(int signal);
/* Waits for a child's end and sets *status, as waitpid does. When *interrupt becomes true, the child receives `signal`,
   and the result is TRAX_INTERRUPTED; interrupt may be NULL. TRAX_ERROR: errno has the reason. */
trax_status trax_wait_for_child(pid_t child, int signal, const volatile int *interrupt, int *status);
/* Ends this process when its parent ends, if the environment variable TRAX_PARENT has the parent's number; at once if
   the parent has ended already. */
void trax_end_with_parent(void);
/* Ends the program by the signal in trax_signal, which must not be 0. */
__attribute__((noreturn)) void trax_end_by_signal(void);

/* Blocks the signals until trax_allow_signals, so that a group of operations on files is not interrupted. */
void trax_hold_signals(sigset_t *before);
void trax_allow_signals(const sigset_t *before);

#ifdef __cplusplus
}
#endif
#endif
