#include "trax/signals.h"

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

volatile sig_atomic_t trax_signal;

static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
enum { COUNT = sizeof numbers / sizeof *numbers };

static void on_signal(int number);

static void restore_defaults(void) {
  for (size_t i = 0; i < COUNT; i++) {
    struct sigaction before;
    if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler == on_signal)
      signal(numbers[i], SIG_DFL);
  }
}

static void on_signal(int number) {
  if (!trax_signal)
    trax_signal = number;
  restore_defaults(); /* a second signal, of any number, ends the program */
}

void trax_catch_signal(int number) {
  struct sigaction before, action = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND};
  sigemptyset(&action.sa_mask);
  if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(number, &action, NULL);
}

void trax_catch_signals(void) {
  for (size_t i = 0; i < COUNT; i++)
    trax_catch_signal(numbers[i]);
}

void trax_end_by_signal(void) {
  const int number = trax_signal;
  fflush(stdout);
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0}); /* no core file: SIGQUIT has been handled */
  signal(number, SIG_DFL);
  raise(number);
  _Exit(128 + number); /* reached only if the signal is blocked */
}

void trax_hold_signals(sigset_t *before) {
  sigset_t held;
  sigemptyset(&held);
  for (size_t i = 0; i < COUNT; i++)
    sigaddset(&held, numbers[i]);
  sigprocmask(SIG_BLOCK, &held, before);
}

void trax_allow_signals(const sigset_t *before) {
  sigprocmask(SIG_SETMASK, before, NULL);
}

pid_t trax_fork(int signal) {
  sigset_t before;
  trax_hold_signals(&before);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    restore_defaults();
    prctl(PR_SET_PDEATHSIG, signal);
    if (getppid() != parent)
      _exit(127);
  }
  trax_allow_signals(&before);
  return child;
}

trax_status trax_wait_for_child(pid_t child, int signal, const volatile int *interrupt, int *status) {
  const struct timespec pause = {.tv_nsec = 2000000};
  bool stopped = false;
  for (pid_t ended = 0; ended != child;) {
    ended = waitpid(child, status, interrupt && !stopped ? WNOHANG : 0);
    if (ended < 0 && errno != EINTR)
      return TRAX_ERROR;
    if (ended != child && !stopped && interrupt && *interrupt)
      stopped = kill(child, signal) == 0;
    else if (ended == 0)
      nanosleep(&pause, NULL);
  }
  /* the interrupt may also have ended the child itself */
  return interrupt && *interrupt ? TRAX_INTERRUPTED : TRAX_OK;
}

/* Whether the process has ended. Until its parent has asked for its status it is a zombie. */
static bool has_ended(pid_t process) {
  if (kill(process, 0) < 0 && errno == ESRCH)
    return true;
  char name[64], text[512] = "";
  snprintf(name, sizeof name, "/proc/%ld/stat", (long)process);
  FILE *file = fopen(name, "r");
  if (!file)
    return false;
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  const char *state = strrchr(text, ')');
  return state && strncmp(state, ") Z", 3) == 0;
}

void trax_end_with_parent(void) {
  const char *text = getenv("TRAX_PARENT");
  const pid_t parent = text ? (pid_t)atol(text) : 0;
  if (parent <= 0)
    return;
  if (parent == getppid())
    prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (parent != getppid() && has_ended(parent)) /* before prctl, or before this process could look */
    raise(SIGTERM);
}
