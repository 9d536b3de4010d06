/* C's time, as far as the machine knows it: clock() gives the nanoseconds that its cycles so far take at the chip's
   clock, or -1 if the loader did not say what that is. There is no time of day. */
#ifndef TRAX_TIME_H
#define TRAX_TIME_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>

typedef long long time_t;
typedef long long clock_t;

#define CLOCKS_PER_SEC ((clock_t)1000000000)

struct timespec {
  time_t tv_sec;
  long tv_nsec;
};

struct tm {
  int tm_sec, tm_min, tm_hour, tm_mday, tm_mon, tm_year, tm_wday, tm_yday, tm_isdst;
};

#ifdef __cplusplus
extern "C" {
#endif

clock_t clock(void);
double difftime(time_t end, time_t start);

#ifdef __cplusplus
}
#endif

#endif
