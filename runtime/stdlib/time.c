/* What there is of <time.h>. */
#include "../internal/machine.h"

#include <time.h>

clock_t clock(void) {
  return (clock_t)machine_cycles();
}

double difftime(time_t end, time_t start) {
  return (double)(end - start);
}
