/* POSIX's header; <string.h> declares the functions. */
#ifndef TRAX_STRINGS_H
#define TRAX_STRINGS_H

#include <string.h>

#endif
