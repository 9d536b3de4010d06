/* Files are ready at all times. */
#ifndef TRAX_SYS_SELECT_H
#define TRAX_SYS_SELECT_H

#include <sys/types.h>

struct timeval {
  time_t tv_sec;
  suseconds_t tv_usec;
};

#define FD_SETSIZE 256
typedef struct {
  unsigned __bits[FD_SETSIZE / 32];
} fd_set;
#define FD_ZERO(set) ((void)(*(set) = (fd_set){{0}}))
#define FD_SET(number, set) ((void)((set)->__bits[(number) / 32] |= 1u << (number) % 32))
#define FD_CLR(number, set) ((void)((set)->__bits[(number) / 32] &= ~(1u << (number) % 32)))
#define FD_ISSET(number, set) ((int)((set)->__bits[(number) / 32] >> (number) % 32 & 1))

#ifdef __cplusplus
extern "C" {
#endif

/* Waits for so much simulated time if no file is in the sets. */
int select(int count, fd_set *__restrict reads, fd_set *__restrict writes, fd_set *__restrict others,
           struct timeval *__restrict duration);

#ifdef __cplusplus
}
#endif

#endif
