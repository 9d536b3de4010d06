/* Types of C's time. The machine knows no time of day: trax_cycles64() of <trax.h> counts its cycles. */
#ifndef TRAX_TIME_H
#define TRAX_TIME_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>

typedef long long time_t;
typedef unsigned long clock_t;

struct timespec {
  time_t tv_sec;
  long tv_nsec;
};

struct tm {
  int tm_sec, tm_min, tm_hour, tm_mday, tm_mon, tm_year, tm_wday, tm_yday, tm_isdst;
};

#endif
