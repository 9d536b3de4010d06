/* An old name of <string.h>. */
#ifndef TRAX_MEMORY_H
#define TRAX_MEMORY_H

#include <string.h>

#endif
