/* Preloaded into trax-render: what its child for the compiler does instead of exec, so that a signal always arrives at
   the same moment. It makes a folder of its number, signals the parent, and then waits for a signal itself, or ends. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

int execv(const char *path, char *const arguments[]) {
  (void)path;
  (void)arguments;
  if (mkdir("first", 0700) == 0)
    kill(getppid(), SIGTERM);
  else
    mkdir("second", 0700);
  while (getenv("INTERRUPT_WAIT"))
    pause();
  _exit(1);
}

/* The parent learns of the child's end before it looks for its own signal. */
pid_t waitpid(pid_t child, int *status, int options) {
  pid_t (*const next)(pid_t, int *, int) = (pid_t(*)(pid_t, int *, int))dlsym(RTLD_NEXT, "waitpid");
  if (getenv("INTERRUPT_WAIT"))
    return next(child, status, options);
  pid_t ended;
  while ((ended = next(child, status, 0)) < 0 && errno == EINTR)
    ;
  return ended;
}
