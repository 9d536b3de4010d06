/* The rest of POSIX, for programs that name what they then do not need, with -DTRAX_POSIX: without it these headers and
   functions are errors when the program is compiled. Threads are those of <threads.h>. What is not possible fails with
   ENOSYS when it is called. The functions are inline, so that scripts that look for them in the library find none. */
#ifndef TRAX_POSIX_H
#define TRAX_POSIX_H

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/types.h>
#include <threads.h>
#include <time.h>

#define __TRAX_INLINE static __inline __attribute__((__unused__))
#define __TRAX_FAILS(type, name, parameters, result)                                                                   \
  __TRAX_INLINE type name parameters {                                                                                 \
    errno = ENOSYS;                                                                                                    \
    return result;                                                                                                     \
  }

/* --- processes: <unistd.h> <sys/wait.h> <signal.h> <stdio.h> --- */

#define WNOHANG 1
#define WUNTRACED 2
#define WIFEXITED(status) (((status)&127) == 0)
#define WEXITSTATUS(status) ((status) >> 8 & 255)
#define WIFSIGNALED(status) (((status)&127) != 0)
#define WTERMSIG(status) ((status)&127)
typedef void (*sighandler_t)(int);
#define SIGCHLD 17
#define SIGCONT 18
#define SIGSTOP 19
#define SIGTSTP 20
#define SIGTTIN 21
#define SIGTTOU 22
__TRAX_FAILS(pid_t, fork, (void), -1)
__TRAX_FAILS(pid_t, vfork, (void), -1)
__TRAX_FAILS(int, execv, (const char *, char *const *), -1)
__TRAX_FAILS(int, execve, (const char *, char *const *, char *const *), -1)
__TRAX_FAILS(int, execvp, (const char *, char *const *), -1)
__TRAX_FAILS(int, execl, (const char *, const char *, ...), -1)
__TRAX_FAILS(int, execlp, (const char *, const char *, ...), -1)
__TRAX_FAILS(pid_t, wait, (int *), -1)
__TRAX_FAILS(pid_t, waitpid, (pid_t, int *, int), -1)
__TRAX_FAILS(int, kill, (pid_t, int), -1)
__TRAX_FAILS(int, setuid, (uid_t), -1)
__TRAX_FAILS(int, setgid, (gid_t), -1)
__TRAX_FAILS(unsigned, alarm, (unsigned), 0)
__TRAX_FAILS(FILE *, popen, (const char *, const char *), NULL)
__TRAX_FAILS(int, pclose, (FILE *), -1)
__TRAX_FAILS(FILE *, fmemopen, (void *, size_t, const char *), NULL)
__TRAX_FAILS(FILE *, open_memstream, (char **, size_t *), NULL)
__TRAX_FAILS(int, link, (const char *, const char *), -1)
__TRAX_FAILS(int, symlink, (const char *, const char *), -1)

/* --- <pwd.h> <sys/resource.h> <sys/utsname.h> --- */

struct passwd {
  char *pw_name, *pw_passwd;
  uid_t pw_uid;
  gid_t pw_gid;
  char *pw_gecos, *pw_dir, *pw_shell;
};
__TRAX_FAILS(struct passwd *, getpwuid, (uid_t), NULL)
__TRAX_FAILS(struct passwd *, getpwnam, (const char *), NULL)

#define RUSAGE_SELF 0
struct rusage {
  struct timeval ru_utime, ru_stime;
  long ru_maxrss;
};
__TRAX_INLINE int getrusage(int who, struct rusage *usage) {
  const clock_t now = clock();
  (void)who;
  memset(usage, 0, sizeof *usage);
  usage->ru_utime.tv_sec = now / CLOCKS_PER_SEC;
  usage->ru_utime.tv_usec = (suseconds_t)(now % CLOCKS_PER_SEC * 1000000 / CLOCKS_PER_SEC);
  return 0;
}

/* --- memory and libraries: <sys/mman.h> <dlfcn.h> --- */

#define PROT_NONE 0
#define PROT_READ 1
#define PROT_WRITE 2
#define PROT_EXEC 4
#define MAP_SHARED 1
#define MAP_PRIVATE 2
#define MAP_ANONYMOUS 32
#define MAP_ANON MAP_ANONYMOUS
#define MAP_FAILED ((void *)-1)
__TRAX_FAILS(void *, mmap, (void *, size_t, int, int, int, off_t), MAP_FAILED)
__TRAX_FAILS(int, munmap, (void *, size_t), -1)
__TRAX_FAILS(int, mprotect, (void *, size_t, int), -1)

#define RTLD_LAZY 1
#define RTLD_NOW 2
#define RTLD_GLOBAL 256
#define RTLD_LOCAL 0
__TRAX_FAILS(void *, dlopen, (const char *, int), NULL)
__TRAX_FAILS(void *, dlsym, (void *, const char *), NULL)
__TRAX_FAILS(int, dlclose, (void *), -1)
__TRAX_INLINE char *dlerror(void) {
  return (char *)"nothing is linked at run time";
}

/* --- terminals: <termios.h> <sys/ioctl.h> --- */

typedef unsigned tcflag_t, speed_t;
typedef unsigned char cc_t;
struct termios {
  tcflag_t c_iflag, c_oflag, c_cflag, c_lflag;
  cc_t c_cc[32];
};
enum { IGNBRK = 1, BRKINT = 2, PARMRK = 8, ISTRIP = 32, INLCR = 64, IGNCR = 128, ICRNL = 256, IXON = 1024 };
enum { OPOST = 1, CSIZE = 48, CS8 = 48, PARENB = 256 };
enum { ISIG = 1, ICANON = 2, ECHO = 8, ECHONL = 64, IEXTEN = 32768 };
enum { VTIME = 5, VMIN = 6, TCSANOW = 0, TCSADRAIN = 1, TCSAFLUSH = 2 };
__TRAX_FAILS(int, tcgetattr, (int, struct termios *), -1)
__TRAX_FAILS(int, tcsetattr, (int, int, const struct termios *), -1)

#define TIOCGWINSZ 0x5413
struct winsize {
  unsigned short ws_row, ws_col, ws_xpixel, ws_ypixel;
};
__TRAX_FAILS(int, ioctl, (int, unsigned long, ...), -1)

/* --- <sys/select.h>: files are ready at all times --- */

#define FD_SETSIZE 256
typedef struct {
  unsigned __bits[FD_SETSIZE / 32];
} fd_set;
#define FD_ZERO(set) ((void)memset(set, 0, sizeof(fd_set)))
#define FD_SET(number, set) ((void)((set)->__bits[(number) / 32] |= 1u << (number) % 32))
#define FD_CLR(number, set) ((void)((set)->__bits[(number) / 32] &= ~(1u << (number) % 32)))
#define FD_ISSET(number, set) ((set)->__bits[(number) / 32] >> (number) % 32 & 1)
__TRAX_INLINE int select(int count, fd_set *reads, fd_set *writes, fd_set *others, struct timeval *duration) {
  int ready = 0;
  for (int i = 0; i < count; i++)
    ready += (reads && FD_ISSET(i, reads)) + (writes && FD_ISSET(i, writes));
  if (others)
    FD_ZERO(others);
  if (!ready && duration) {
    const struct timespec wait = {duration->tv_sec, (long)duration->tv_usec * 1000};
    thrd_sleep(&wait, NULL);
  }
  return ready;
}

/* --- <pthread.h>: a pointer is as long as C11's int --- */

typedef thrd_t pthread_t;
typedef mtx_t pthread_mutex_t;
typedef cnd_t pthread_cond_t;
typedef once_flag pthread_once_t;
typedef tss_t pthread_key_t;
typedef int pthread_attr_t, pthread_mutexattr_t, pthread_condattr_t;
#define PTHREAD_MUTEX_INITIALIZER                                                                                      \
  { 0 }
#define PTHREAD_COND_INITIALIZER                                                                                       \
  { 0 }
#define PTHREAD_ONCE_INIT ONCE_FLAG_INIT
enum { PTHREAD_CREATE_JOINABLE, PTHREAD_CREATE_DETACHED };
enum { PTHREAD_MUTEX_NORMAL = mtx_plain, PTHREAD_MUTEX_DEFAULT = mtx_plain, PTHREAD_MUTEX_RECURSIVE = mtx_recursive };

__TRAX_INLINE int __trax_thread_error(int result) {
  return result == thrd_success    ? 0
         : result == thrd_busy     ? EBUSY
         : result == thrd_timedout ? ETIMEDOUT
         : result == thrd_nomem    ? ENOMEM
                                   : EAGAIN;
}
__TRAX_INLINE int pthread_attr_init(pthread_attr_t *attributes) {
  *attributes = PTHREAD_CREATE_JOINABLE;
  return 0;
}
__TRAX_INLINE int pthread_attr_setdetachstate(pthread_attr_t *attributes, int state) {
  *attributes = state;
  return 0;
}
__TRAX_INLINE int pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size) {
  (void)attributes; /* -mstack-size sets it */
  (void)size;
  return 0;
}
__TRAX_INLINE int pthread_attr_destroy(pthread_attr_t *attributes) {
  (void)attributes;
  return 0;
}
__TRAX_INLINE int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*function)(void *),
                                 void *argument) {
  const int result = thrd_create(thread, (thrd_start_t)(void (*)(void))function, argument);
  if (result == thrd_success && attributes && *attributes == PTHREAD_CREATE_DETACHED)
    thrd_detach(*thread);
  return __trax_thread_error(result);
}
__TRAX_INLINE int pthread_join(pthread_t thread, void **value) {
  int result;
  const int status = __trax_thread_error(thrd_join(thread, &result));
  if (value && !status)
    *value = (void *)(long)result;
  return status;
}
__TRAX_INLINE int pthread_detach(pthread_t thread) {
  return __trax_thread_error(thrd_detach(thread));
}
__TRAX_INLINE pthread_t pthread_self(void) {
  return thrd_current();
}
__TRAX_INLINE int pthread_equal(pthread_t a, pthread_t b) {
  return thrd_equal(a, b);
}
__TRAX_INLINE __attribute__((__noreturn__)) void pthread_exit(void *value) {
  thrd_exit((int)(long)value);
}
__TRAX_INLINE int pthread_mutexattr_init(pthread_mutexattr_t *attributes) {
  *attributes = mtx_plain;
  return 0;
}
__TRAX_INLINE int pthread_mutexattr_settype(pthread_mutexattr_t *attributes, int kind) {
  *attributes = kind;
  return 0;
}
__TRAX_INLINE int pthread_mutexattr_destroy(pthread_mutexattr_t *attributes) {
  (void)attributes;
  return 0;
}
__TRAX_INLINE int pthread_mutex_init(pthread_mutex_t *mutex, const pthread_mutexattr_t *attributes) {
  return __trax_thread_error(mtx_init(mutex, attributes ? *attributes : mtx_plain));
}
__TRAX_INLINE int pthread_mutex_destroy(pthread_mutex_t *mutex) {
  mtx_destroy(mutex);
  return 0;
}
__TRAX_INLINE int pthread_mutex_lock(pthread_mutex_t *mutex) {
  return __trax_thread_error(mtx_lock(mutex));
}
__TRAX_INLINE int pthread_mutex_trylock(pthread_mutex_t *mutex) {
  return __trax_thread_error(mtx_trylock(mutex));
}
__TRAX_INLINE int pthread_mutex_unlock(pthread_mutex_t *mutex) {
  return __trax_thread_error(mtx_unlock(mutex));
}
__TRAX_INLINE int pthread_cond_init(pthread_cond_t *condition, const pthread_condattr_t *attributes) {
  (void)attributes;
  return __trax_thread_error(cnd_init(condition));
}
__TRAX_INLINE int pthread_cond_destroy(pthread_cond_t *condition) {
  cnd_destroy(condition);
  return 0;
}
__TRAX_INLINE int pthread_cond_signal(pthread_cond_t *condition) {
  return __trax_thread_error(cnd_signal(condition));
}
__TRAX_INLINE int pthread_cond_broadcast(pthread_cond_t *condition) {
  return __trax_thread_error(cnd_broadcast(condition));
}
__TRAX_INLINE int pthread_cond_wait(pthread_cond_t *condition, pthread_mutex_t *mutex) {
  return __trax_thread_error(cnd_wait(condition, mutex));
}
__TRAX_INLINE int pthread_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex,
                                         const struct timespec *until) {
  return __trax_thread_error(cnd_timedwait(condition, mutex, until));
}
__TRAX_INLINE int pthread_once(pthread_once_t *once, void (*function)(void)) {
  call_once(once, function);
  return 0;
}
__TRAX_INLINE int pthread_key_create(pthread_key_t *key, void (*destructor)(void *)) {
  return __trax_thread_error(tss_create(key, destructor));
}
__TRAX_INLINE void *pthread_getspecific(pthread_key_t key) {
  return tss_get(key);
}
__TRAX_INLINE int pthread_setspecific(pthread_key_t key, const void *value) {
  return __trax_thread_error(tss_set(key, (void *)value));
}

#undef __TRAX_FAILS
#undef __TRAX_INLINE

#endif
