/* The configuration of newlib's mathematical functions, included before each of their files. The headers beside this
   one replace newlib's own. No errno, one rounding mode, no exception flags; the new code for exp, log and pow, which
   has no divisions. */
#ifndef TRAX_NEWLIB_CONFIG_H
#define TRAX_NEWLIB_CONFIG_H

#define __OBSOLETE_MATH 0
#define _IEEE_LIBM
#define WANT_ERRNO 0
#define WANT_ROUNDING 0
/* Rounding to an integer is cheap where adding is not. */
#define HAVE_FAST_ROUND 1

/* This one, 60 units in the last place off, is not used. */
#define erfcf __newlib_erfcf

#endif
