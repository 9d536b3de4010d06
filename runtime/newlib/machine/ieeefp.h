/* The machine's floating point, for newlib's mathematical functions. */
#define __IEEE_LITTLE_ENDIAN
