/* Limits beyond clang's header, which includes this one. */
#ifndef TRAX_LIMITS_H
#define TRAX_LIMITS_H

#include <trax/names.h>

#define MB_LEN_MAX 4
#ifdef __TRAX_ALL_NAMES
#define PATH_MAX 4096
#define NAME_MAX 255
#define SSIZE_MAX __INT_MAX__
#endif

#endif
