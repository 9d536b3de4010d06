// RUN: %run_c %s %t --simflags "--config 1x32" --status 5
// The exit status is that of the lowest thread whose status is not 0, whether by return or by exit.
#include <stdlib.h>
#include <trax.h>

__attribute__((noinline)) static void leave(int status) {
  exit(status);
}

int main(void) {
  unsigned thread = trax_thread();
  if (thread == 5)
    leave(5);
  if (thread == 2)
    trax_halt();
  return thread > 7 ? 9 : 0;
}
