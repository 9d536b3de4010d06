/* Host calls (docs/abi.md, "Host calls"): the trap `host` with a block of words. */
#ifndef TRAX_RUNTIME_HOST_H
#define TRAX_RUNTIME_HOST_H

#include <errno.h>
#include <trax/host_calls.h>

#include "inline.h"

/* The result, or an error number times -1. */
INLINE int host_call(unsigned number, unsigned a, unsigned b, unsigned c) {
  unsigned block[TRAX_HOST_WORDS] = {number, a, b, c};
#ifdef __trax__
  __asm__ volatile("trap %0, host" : : "r"(block) : "memory");
#else
  block[0] = -TRAX_HOST_NO_CALL;
#endif
  return (int)block[0];
}

/* The same for a caller that reports errors by -1 and errno. */
INLINE int host_result(int result) {
  if (result >= 0)
    return result;
  errno = -result;
  return -1;
}

#endif
