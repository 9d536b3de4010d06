/* C's time, as far as the machine knows it: clock() gives the nanoseconds that its cycles so far take at the chip's
   clock, or -1 if the loader has not set the clock. The time of day is the same: the machine starts at the beginning
   of 1970, in UTC, so that a run gives the same every time. */
#ifndef TRAX_TIME_H
#define TRAX_TIME_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>
#include <trax/names.h>

#ifndef TRAX_TIME_T
#define TRAX_TIME_T
typedef long long time_t;
typedef long long clock_t;
#endif

#define CLOCKS_PER_SEC ((clock_t)1000000000)

struct timespec {
  time_t tv_sec;
  long tv_nsec;
};

struct tm {
  int tm_sec, tm_min, tm_hour, tm_mday, tm_mon, tm_year, tm_wday, tm_yday, tm_isdst;
#ifdef __TRAX_ALL_NAMES
  long tm_gmtoff;      /* 0, unless strptime has read another one */
  const char *tm_zone; /* "UTC" */
#else
  long __tm_gmtoff;
  const char *__tm_zone;
#endif
};

#ifdef __cplusplus
extern "C" {
#endif

#define TIME_UTC 1
#ifdef __TRAX_ALL_NAMES
#define CLOCK_REALTIME 0
#define CLOCK_MONOTONIC 1
#define CLOCK_PROCESS_CPUTIME_ID 2
typedef int clockid_t;
#endif

clock_t clock(void);
time_t time(time_t *seconds);
int timespec_get(struct timespec *now, int base);
struct tm *gmtime(const time_t *seconds); /* all threads share one struct tm and one text */
struct tm *localtime(const time_t *seconds);
time_t mktime(struct tm *parts);
char *asctime(const struct tm *parts);
char *ctime(const time_t *seconds);
size_t strftime(char *__restrict to, size_t size, const char *__restrict format, const struct tm *__restrict parts);
double difftime(time_t end, time_t start);
#if defined __TRAX_ALL_NAMES || __STDC_VERSION__ > 201710L
struct tm *gmtime_r(const time_t *__restrict seconds, struct tm *__restrict parts);
struct tm *localtime_r(const time_t *__restrict seconds, struct tm *__restrict parts);
time_t timegm(struct tm *parts);
#endif
#ifdef __TRAX_ALL_NAMES
int clock_gettime(clockid_t clock, struct timespec *now);
int clock_getres(clockid_t clock, struct timespec *step);
int nanosleep(const struct timespec *duration, struct timespec *left); /* waits for so much simulated time */
char *strptime(const char *__restrict text, const char *__restrict format, struct tm *__restrict parts);
#endif

#ifdef __cplusplus
}
#endif

#endif
