/* What POSIX has here; declared with the others. */
#ifndef TRAX_STRINGS_H
#define TRAX_STRINGS_H

#include <string.h>

#endif
