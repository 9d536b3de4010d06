/* Signals come from raise alone: nothing interrupts a thread. A signal without a handler ends the program as abort
 * does.
 */
#ifndef TRAX_SIGNAL_H
#define TRAX_SIGNAL_H

#include <trax/names.h>
#ifdef __TRAX_ALL_NAMES
#include <sys/types.h>
#endif

typedef int sig_atomic_t;

#define SIGHUP 1
#define SIGINT 2
#define SIGQUIT 3
#define SIGILL 4
#define SIGTRAP 5
#define SIGABRT 6
#define SIGBUS 7
#define SIGFPE 8
#define SIGKILL 9
#define SIGUSR1 10
#define SIGSEGV 11
#define SIGUSR2 12
#define SIGPIPE 13
#define SIGALRM 14
#define SIGTERM 15
#define SIGCHLD 17
#define SIGCONT 18
#define SIGSTOP 19
#define SIGTSTP 20
#define SIGTTIN 21
#define SIGTTOU 22

#define SIG_DFL ((void (*)(int))0)
#define SIG_IGN ((void (*)(int))1)
#define SIG_ERR ((void (*)(int)) - 1)

#ifdef __TRAX_ALL_NAMES
#define NSIG 32
#define SA_RESTART 0x10000000
#define SA_NODEFER 0x40000000
#define SA_RESETHAND 0x80000000
#define SIG_BLOCK 0
#define SIG_UNBLOCK 1
#define SIG_SETMASK 2

typedef unsigned long sigset_t;
typedef void (*sighandler_t)(int);
struct sigaction {
  void (*sa_handler)(int);
  sigset_t sa_mask;
  int sa_flags;
};
#endif

#ifdef __cplusplus
extern "C" {
#endif

void (*signal(int number, void (*handler)(int)))(int);
int raise(int number);
#ifdef __TRAX_ALL_NAMES
int sigaction(int number, const struct sigaction *__restrict action, struct sigaction *__restrict before);
int sigemptyset(sigset_t *set);
int sigfillset(sigset_t *set);
int sigaddset(sigset_t *set, int number);
int sigdelset(sigset_t *set, int number);
int sigismember(const sigset_t *set, int number);
int sigprocmask(int how, const sigset_t *__restrict set, sigset_t *__restrict before); /* does nothing */
__TRAX_FAILS(int, kill, (pid_t process, int number), -1)
#endif

#ifdef __cplusplus
}
#endif

#endif
