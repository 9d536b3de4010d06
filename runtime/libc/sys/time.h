/* The time of day. As on other systems, <time.h> is not included. */
#ifndef TRAX_SYS_TIME_H
#define TRAX_SYS_TIME_H

#include <sys/select.h>

struct timezone {
  int tz_minuteswest, tz_dsttime;
};

#ifdef __cplusplus
extern "C" {
#endif

int gettimeofday(struct timeval *__restrict now, void *__restrict zone);
int utimes(const char *path, const struct timeval times[2]); /* files have no times: does nothing */

#ifdef __cplusplus
}
#endif

#endif
