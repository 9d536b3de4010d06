/* The heap's functions: those of <stdlib.h>, and two more. */
#ifndef TRAX_MALLOC_H
#define TRAX_MALLOC_H

#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

void *memalign(size_t alignment, size_t size);
size_t malloc_usable_size(void *memory);

#ifdef __cplusplus
}
#endif

#endif
