/* The time that the program has taken. */
#ifndef TRAX_SYS_RESOURCE_H
#define TRAX_SYS_RESOURCE_H

#include <sys/time.h>

#define RUSAGE_SELF 0
#define RUSAGE_CHILDREN (-1)
struct rusage {
  struct timeval ru_utime, ru_stime;
  long ru_maxrss;
};

#ifdef __cplusplus
extern "C" {
#endif

int getrusage(int who, struct rusage *usage); /* ru_utime alone */

#ifdef __cplusplus
}
#endif

#endif
