/* newlib's complex functions test the guard of its own header. */
#include_next <complex.h>
#define _COMPLEX_H
