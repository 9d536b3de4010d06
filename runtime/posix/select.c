/* Files are ready at all times, so nothing waits but a call without any. */
#include <string.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <time.h>

static int count_of(const fd_set *set, int count) {
  int result = 0;
  for (int i = 0; set && i < count; i++)
    result += FD_ISSET(i, set);
  return result;
}

int select(int count, fd_set *restrict reads, fd_set *restrict writes, fd_set *restrict others,
           struct timeval *restrict duration) {
  const int ready = count_of(reads, count) + count_of(writes, count);
  if (others)
    FD_ZERO(others);
  if (!ready && duration) {
    const struct timespec wait = {duration->tv_sec, (long)duration->tv_usec * 1000};
    nanosleep(&wait, NULL);
  }
  return ready;
}

int getrusage(int who, struct rusage *usage) {
  const clock_t now = who == RUSAGE_SELF ? clock() : 0;
  memset(usage, 0, sizeof *usage);
  usage->ru_utime.tv_sec = now / CLOCKS_PER_SEC;
  usage->ru_utime.tv_usec = (suseconds_t)(now % CLOCKS_PER_SEC / (CLOCKS_PER_SEC / 1000000));
  return 0;
}
