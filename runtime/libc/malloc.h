/* An old name of <stdlib.h>, which declares the heap's functions. */
#ifndef TRAX_MALLOC_H
#define TRAX_MALLOC_H

#include <stdlib.h>

#endif
