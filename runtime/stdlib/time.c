/* clock and difftime. */
#include "../internal/machine.h"

#include <time.h>

/* The chip's clock in MHz, at most 100,000. The loader stores it here (docs/abi.md, "Buffers"). */
unsigned __trax_clock_mhz;

clock_t clock(void) {
  _Static_assert(CLOCKS_PER_SEC == 1000000000, "nanoseconds");
  unsigned mhz = __trax_clock_mhz;
  if (mhz == 0) /* the loader has no clock, or found no symbol table */
    return -1;
  unsigned long long cycles = machine_cycles(), microseconds = cycles / mhz;
  unsigned rest = (unsigned)(cycles - microseconds * mhz);
  return (clock_t)(microseconds * 1000 + rest * 1000 / mhz);
}

double difftime(time_t end, time_t start) {
  return (double)(end - start);
}
