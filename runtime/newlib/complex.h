/* newlib's complex functions ask for the guard of its own header. */
#include_next <complex.h>
#define _COMPLEX_H
