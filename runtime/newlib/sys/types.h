/* The types that newlib's mathematical functions take from its <sys/types.h>. */
#ifndef TRAX_NEWLIB_TYPES_H
#define TRAX_NEWLIB_TYPES_H

#include <stdint.h>

typedef int32_t __int32_t;
typedef uint32_t __uint32_t;

#endif
