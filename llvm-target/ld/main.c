/* trax-ld, the program. */
#include "ld.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <unistd.h>

/* Who ends the compiler that waits for this linker ends it, too. */
static void end_with_parent(void) {
  const char *parent = getenv("TRAX_PARENT");
  if (!parent || atol(parent) != (long)getppid())
    return;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (atol(parent) != (long)getppid())
    raise(SIGTERM);
}

int main(int argc, char **argv) {
  end_with_parent();
  return ld_main(argc, argv);
}
