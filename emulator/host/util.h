/* Small things the host side uses, all of base: names that were mistyped, files read and written whole. */
#ifndef TRAX_HOST_UTIL_H
#define TRAX_HOST_UTIL_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "trax/input.h"
#include "trax/names.h"
#include "trax/output.h"

#endif
