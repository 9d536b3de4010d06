/* Signals that the program raises itself. */
#include <errno.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>

static struct sigaction actions[NSIG];

static int is_signal(int number) {
  if (number > 0 && number < NSIG)
    return 1;
  errno = EINVAL;
  return 0;
}

void (*signal(int number, void (*handler)(int)))(int) {
  struct sigaction before;
  if (sigaction(number, &(struct sigaction){.sa_handler = handler}, &before))
    return SIG_ERR;
  return before.sa_handler;
}

int sigaction(int number, const struct sigaction *restrict action, struct sigaction *restrict before) {
  if (!is_signal(number))
    return -1;
  struct sigaction old = actions[number];
  if (action)
    actions[number] = *action;
  if (before)
    *before = old;
  return 0;
}

int raise(int number) {
  if (!is_signal(number))
    return -1;
  void (*handler)(int) = actions[number].sa_handler;
  if (handler == SIG_IGN)
    return 0;
  if (handler == SIG_DFL)
    abort();
  if ((unsigned)actions[number].sa_flags & SA_RESETHAND)
    actions[number].sa_handler = SIG_DFL;
  handler(number);
  return 0;
}

int sigemptyset(sigset_t *set) {
  *set = 0;
  return 0;
}

int sigfillset(sigset_t *set) {
  *set = ~(sigset_t)0;
  return 0;
}

int sigaddset(sigset_t *set, int number) {
  if (!is_signal(number))
    return -1;
  *set |= 1UL << number;
  return 0;
}

int sigdelset(sigset_t *set, int number) {
  if (!is_signal(number))
    return -1;
  *set &= ~(1UL << number);
  return 0;
}

int sigismember(const sigset_t *set, int number) {
  return is_signal(number) ? (int)(*set >> number & 1) : -1;
}

int sigprocmask(int how, const sigset_t *restrict set, sigset_t *restrict before) {
  (void)how;
  (void)set;
  if (before)
    *before = 0;
  return 0;
}
