/* Interrupts. SIGINT, SIGTERM and SIGHUP mean the same to every program of the project: it stops, removes what it has
   not finished, ends its children, says so in a line, and ends by the signal itself, so that its parent sees death by
   that signal (in a shell: exit status 130, 143, 129). A second signal ends it at once. What was ignored when the
   program was started (nohup) stays ignored. Programs that have nothing to remove leave the signals alone, which is the
   same. */
#ifndef TRAX_SIGNALS_H
#define TRAX_SIGNALS_H

#include <signal.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of the first signal that came; 0: none. Long work looks at it through its options' `interrupt`; calls that
   wait return with EINTR. */
extern volatile sig_atomic_t trax_signal;

void trax_catch_signals(void);
/* One more, which means the same. */
void trax_catch_signal(int number);
/* In a child: each ends it at once. */
void trax_default_signals(void);
/* The end of a program that was interrupted; called when trax_signal is one. */
__attribute__((noreturn)) void trax_end_by_signal(void);

/* From now until trax_allow_signals they wait: no file is left half-written. */
void trax_hold_signals(sigset_t *before);
void trax_allow_signals(const sigset_t *before);

#ifdef __cplusplus
}
#endif
#endif
