/* What newlib's mathematical functions ask about the machine's floating point. */
#define __IEEE_LITTLE_ENDIAN
