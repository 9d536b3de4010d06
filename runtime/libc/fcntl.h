/* Opening files by descriptor. */
#ifndef TRAX_FCNTL_H
#define TRAX_FCNTL_H

#include <sys/stat.h>
#include <sys/types.h>

#define O_RDONLY 0
#define O_WRONLY 1
#define O_RDWR 2
#define O_ACCMODE 3
#define O_APPEND 0x8
#define O_CREAT 0x200
#define O_TRUNC 0x400
#define O_EXCL 0x800
/* Accepted without effect: what they demand is always true here. */
#define O_NONBLOCK 0
#define O_CLOEXEC 0
#define O_NOCTTY 0
#define O_SYNC 0

#ifdef __cplusplus
extern "C" {
#endif

int open(const char *path, int flags, ...);
int creat(const char *path, mode_t mode);

#ifdef __cplusplus
}
#endif

#endif
