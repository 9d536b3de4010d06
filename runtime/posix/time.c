/* The time of day: seconds of simulated time since the beginning of 1970, and calendar time in UTC. */
#include <errno.h>
#include <stddef.h>
#include <sys/time.h>
#include <sys/times.h>
#include <time.h>
#include <unistd.h>

enum { NANOSECONDS = 1000000000, DAY = 86400 };

/* --- now --- */

int clock_gettime(clockid_t id, struct timespec *now) {
  (void)id;
  clock_t nanoseconds = clock();
  if (nanoseconds < 0)
    nanoseconds = 0;
  now->tv_sec = nanoseconds / NANOSECONDS;
  now->tv_nsec = (long)(nanoseconds % NANOSECONDS);
  return 0;
}

int clock_getres(clockid_t id, struct timespec *step) {
  (void)id;
  if (step)
    *step = (struct timespec){0, 1};
  return 0;
}

int timespec_get(struct timespec *now, int base) {
  clock_gettime(CLOCK_REALTIME, now);
  return base;
}

time_t time(time_t *seconds) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (seconds)
    *seconds = now.tv_sec;
  return now.tv_sec;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone) {
  (void)zone;
  struct timespec exact;
  clock_gettime(CLOCK_REALTIME, &exact);
  *now = (struct timeval){exact.tv_sec, exact.tv_nsec / 1000};
  return 0;
}

clock_t times(struct tms *taken) {
  *taken = (struct tms){.tms_utime = clock()};
  return taken->tms_utime;
}

int nanosleep(const struct timespec *duration, struct timespec *left) {
  (void)left;
  clock_t until = clock() + duration->tv_sec * NANOSECONDS + duration->tv_nsec;
  while (clock() >= 0 && clock() < until)
    ;
  return 0;
}

unsigned sleep(unsigned seconds) {
  nanosleep(&(struct timespec){seconds, 0}, NULL);
  return 0;
}

int usleep(useconds_t microseconds) {
  return nanosleep(&(struct timespec){microseconds / 1000000, (long)(microseconds % 1000000 * 1000)}, NULL);
}

/* --- the calendar --- */

/* Days since 1970-01-01 of a day of the Gregorian calendar. Years begin in March here, so that a leap day is a year's
   last. */
static long long days_from(long long year, int month, int day) {
  year -= month <= 2;
  long long era = (year >= 0 ? year : year - 399) / 400;
  int of_era = (int)(year - era * 400);
  int of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

struct tm *gmtime_r(const time_t *restrict seconds, struct tm *restrict parts) {
  long long days = *seconds / DAY;
  int rest = (int)(*seconds % DAY);
  if (rest < 0) {
    rest += DAY;
    days--;
  }
  long long shifted = days + 719468, era = (shifted >= 0 ? shifted : shifted - 146096) / 146097;
  int of_era = (int)(shifted - era * 146097);
  int year_of_era = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  int of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  int month = (5 * of_year + 2) / 153;
  *parts = (struct tm){.tm_zone = "UTC",
                       .tm_sec = rest % 60,
                       .tm_min = rest / 60 % 60,
                       .tm_hour = rest / 3600,
                       .tm_mday = of_year - (153 * month + 2) / 5 + 1,
                       .tm_mon = month < 10 ? month + 2 : month - 10};
  long long year = year_of_era + era * 400 + (parts->tm_mon < 2);
  parts->tm_year = (int)(year - 1900);
  parts->tm_wday = (int)((days % 7 + 11) % 7);
  parts->tm_yday = (int)(days - days_from(year, 1, 1));
  return parts;
}

struct tm *localtime_r(const time_t *restrict seconds, struct tm *restrict parts) {
  return gmtime_r(seconds, parts);
}

static struct tm shared;

struct tm *gmtime(const time_t *seconds) {
  return gmtime_r(seconds, &shared);
}

struct tm *localtime(const time_t *seconds) {
  return gmtime_r(seconds, &shared);
}

time_t timegm(struct tm *parts) {
  long long months = parts->tm_mon + 12LL * parts->tm_year, year = months / 12;
  int month = (int)(months % 12);
  if (month < 0) {
    month += 12;
    year--;
  }
  time_t seconds = (days_from(year + 1900, month + 1, 1) + parts->tm_mday - 1) * DAY + parts->tm_hour * 3600LL +
                   parts->tm_min * 60LL + parts->tm_sec;
  gmtime_r(&seconds, parts);
  return seconds;
}

time_t mktime(struct tm *parts) {
  return timegm(parts);
}
