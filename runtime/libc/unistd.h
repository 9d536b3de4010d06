/* Files by descriptor, and the options of a command line. */
#ifndef TRAX_UNISTD_H
#define TRAX_UNISTD_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>
#include <trax/names.h>

#include <getopt.h>

#define _POSIX_VERSION 200809L /* for what is here */
#define STDIN_FILENO 0
#define STDOUT_FILENO 1
#define STDERR_FILENO 2
#ifndef SEEK_SET
#define SEEK_SET 0
#define SEEK_CUR 1
#define SEEK_END 2
#endif
#define F_OK 0
#define X_OK 1
#define W_OK 2
#define R_OK 4
#define _SC_PAGESIZE 1
#define _SC_NPROCESSORS_ONLN 2
#define _SC_CLK_TCK 3
#define _SC_OPEN_MAX 4

#ifdef __cplusplus
extern "C" {
#endif

ssize_t read(int descriptor, void *memory, size_t size);
ssize_t write(int descriptor, const void *memory, size_t size);
/* Like lseek, read or write, and lseek: not by two threads at once. */
ssize_t pread(int descriptor, void *memory, size_t size, off_t place);
ssize_t pwrite(int descriptor, const void *memory, size_t size, off_t place);
int close(int descriptor);
off_t lseek(int descriptor, off_t offset, int origin);
int ftruncate(int descriptor, off_t size);
int fsync(int descriptor);
int fdatasync(int descriptor);
int truncate(const char *path, off_t size);
int dup(int descriptor);
int dup2(int descriptor, int other);
int isatty(int descriptor);
int access(const char *path, int mode);
int unlink(const char *path);
/* Paths from an open folder; AT_FDCWD (<fcntl.h>): from the beginning of all paths. */
int unlinkat(int folder, const char *path, int flags);
int faccessat(int folder, const char *path, int mode, int flags);
int rmdir(const char *path);
char *getcwd(char *to, size_t size);                   /* "/": names are those that the user gave to folders */
int chdir(const char *path);                           /* fails */
int chown(const char *path, uid_t owner, gid_t group); /* files have no owners: does nothing */
int fchown(int descriptor, uid_t owner, gid_t group);
__attribute__((noreturn)) void _exit(int status);
pid_t getpid(void);
uid_t getuid(void);
uid_t geteuid(void);
gid_t getgid(void);
gid_t getegid(void);
int gethostname(char *name, size_t size); /* "trax" */
long sysconf(int name);
int getpagesize(void);
int getdtablesize(void);
int pipe(int descriptors[2]);                                                    /* fails: there is no other process */
ssize_t readlink(const char *__restrict path, char *__restrict to, size_t size); /* fails: EINVAL, of a link ENOSYS */
extern char **environ;
/* They wait for so much simulated time. */
unsigned sleep(unsigned seconds);
int usleep(useconds_t microseconds);

/* Not here. */
#define __TRAX_NO_PROCESSES "there are no processes"
__TRAX_REFUSES(pid_t, fork, (void), -1, __TRAX_NO_PROCESSES)
__TRAX_REFUSES(pid_t, vfork, (void), -1, __TRAX_NO_PROCESSES)
__TRAX_REFUSES(int, execv, (const char *path, char *const arguments[]), -1, __TRAX_NO_PROCESSES)
__TRAX_REFUSES(int, execve, (const char *path, char *const arguments[], char *const environment[]), -1,
               __TRAX_NO_PROCESSES)
__TRAX_REFUSES(int, execvp, (const char *name, char *const arguments[]), -1, __TRAX_NO_PROCESSES)
__TRAX_REFUSES(int, execl, (const char *path, const char *argument, ...), -1, __TRAX_NO_PROCESSES)
__TRAX_REFUSES(int, execlp, (const char *name, const char *argument, ...), -1, __TRAX_NO_PROCESSES)
#undef __TRAX_NO_PROCESSES
__TRAX_FAILS(int, setuid, (uid_t user), -1)
__TRAX_FAILS(int, setgid, (gid_t group), -1)
__TRAX_REFUSES(unsigned, alarm, (unsigned seconds), 0, "nothing interrupts a thread; compare time()")
__TRAX_REFUSES(int, link, (const char *from, const char *to), -1, "copy the file")
__TRAX_REFUSES(int, symlink, (const char *from, const char *to), -1, "copy the file")

#ifdef __cplusplus
}
#endif

#endif
