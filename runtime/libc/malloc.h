/* An old name of <stdlib.h>, which declares the heap's functions, and one more. */
#ifndef TRAX_MALLOC_H
#define TRAX_MALLOC_H

#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

size_t malloc_usable_size(void *memory);

#ifdef __cplusplus
}
#endif

#endif
