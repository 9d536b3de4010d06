/* Types of POSIX. */
#ifndef TRAX_SYS_TYPES_H
#define TRAX_SYS_TYPES_H

#define __need_size_t
#include <stddef.h>
#include <stdint.h>
#include <sys/cdefs.h>

typedef int ssize_t;
typedef long long off_t;
typedef long long ino_t;
typedef unsigned mode_t;
typedef unsigned dev_t;
typedef unsigned nlink_t;
typedef int pid_t;
typedef unsigned uid_t;
typedef unsigned gid_t;
typedef unsigned id_t;
typedef long blksize_t;
typedef long long blkcnt_t;
typedef long suseconds_t;
typedef unsigned useconds_t;
typedef unsigned char u_char;
typedef unsigned short u_short;
typedef unsigned u_int;
typedef unsigned long u_long;
typedef unsigned char u_int8_t;
typedef unsigned short u_int16_t;
typedef unsigned u_int32_t;
typedef unsigned long long u_int64_t;

#ifndef TRAX_TIME_T
#define TRAX_TIME_T
typedef long long time_t;
typedef long long clock_t;
#endif

#endif
