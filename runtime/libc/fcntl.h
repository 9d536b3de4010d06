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
#define O_NOFOLLOW 0x100000
#define O_DIRECTORY 0x200000
/* Accepted without effect: what they demand is always true here. */
#define O_NONBLOCK 0
#define O_CLOEXEC 0
#define O_NOCTTY 0
#define O_SYNC 0

/* Without effect: there is one process, so that all locks are free, and nothing is inherited. Others are EINVAL. */
#define F_DUPFD 0
#define F_GETFD 1
#define F_SETFD 2
#define F_GETFL 3
#define F_SETFL 4
#define F_GETLK 7
#define F_SETLK 8
#define F_SETLKW 9
#define F_DUPFD_CLOEXEC 14
#define FD_CLOEXEC 1
#define F_RDLCK 1
#define F_UNLCK 2
#define F_WRLCK 3
#define AT_FDCWD (-2)
#define AT_SYMLINK_NOFOLLOW 2
#define AT_EACCESS 1
#define AT_REMOVEDIR 8
struct flock {
  short l_type, l_whence;
  off_t l_start, l_len;
  pid_t l_pid;
};

#ifdef __cplusplus
extern "C" {
#endif

int fcntl(int descriptor, int command, ...);
int open(const char *path, int flags, ...);
int openat(int folder, const char *path, int flags, ...);
int creat(const char *path, mode_t mode);

#ifdef __cplusplus
}
#endif

#endif
