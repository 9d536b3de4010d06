/* Files have no times. */
#ifndef TRAX_UTIME_H
#define TRAX_UTIME_H

#include <sys/types.h>

struct utimbuf {
  time_t actime, modtime;
};

#ifdef __cplusplus
extern "C" {
#endif

int utime(const char *path, const struct utimbuf *times); /* does nothing */

#ifdef __cplusplus
}
#endif

#endif
