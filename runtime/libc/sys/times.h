/* The time that the program has taken. */
#ifndef TRAX_SYS_TIMES_H
#define TRAX_SYS_TIMES_H

#include <sys/types.h>

struct tms {
  clock_t tms_utime, tms_stime, tms_cutime, tms_cstime;
};

#ifdef __cplusplus
extern "C" {
#endif

clock_t times(struct tms *times); /* in nanoseconds, as clock() */

#ifdef __cplusplus
}
#endif

#endif
