// RUN: %clang -O2 -mstack=global %s -o %t 2>%t.words
// RUN: grep -c 'warning: .* fails with ENOSYS: ' %t.words | grep -qx 4
// RUN: %trax_sim --engine functional --set chip.tps_per_tm=8 --main-on 0 %t
// pthreads are C11's threads. What is not possible fails with ENOSYS, and the compiler warns of it. The status is the
// line of a failure.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <pwd.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#define CHECK(CONDITION)                                                                                               \
  do {                                                                                                                 \
    if (!(CONDITION))                                                                                                  \
      exit(__LINE__);                                                                                                  \
  } while (0)
#define FAILS(CALL) (errno = 0, (CALL) && errno == ENOSYS)

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_key_t key;
static int sum, begun, ended;

static void begin(void) {
  begun++;
}

static void end(void *value) {
  pthread_mutex_lock(&mutex);
  ended += value != NULL;
  pthread_mutex_unlock(&mutex);
}

static void *work(void *argument) {
  pthread_once(&once, begin);
  pthread_setspecific(key, argument);
  for (int i = 0; i < 100; i++) {
    pthread_mutex_lock(&mutex);
    sum++;
    pthread_mutex_unlock(&mutex);
  }
  pthread_cond_broadcast(&condition);
  return (char *)argument + 1;
}

static void threads(void) {
  enum { MANY = 7 };
  pthread_t thread[MANY + 1];
  void *value;
  CHECK(pthread_key_create(&key, end) == 0);
  for (int i = 0; i < MANY; i++)
    CHECK(pthread_create(&thread[i], NULL, work, (void *)(i + 1L)) == 0);
  CHECK(pthread_create(&thread[MANY], NULL, work, NULL) == EAGAIN);
  pthread_mutex_lock(&mutex);
  while (sum < MANY * 100)
    pthread_cond_wait(&condition, &mutex);
  pthread_mutex_unlock(&mutex);
  for (int i = 0; i < MANY; i++)
    CHECK(pthread_join(thread[i], &value) == 0 && value == (void *)(i + 2L));
  CHECK(begun == 1 && ended == MANY);
}

static void impossible(void) {
  struct termios modes;
  struct rusage usage;
  CHECK(FAILS(fork() == -1) && FAILS(waitpid(-1, NULL, 0) == -1) && FAILS(!popen("ls", "r")));
  CHECK(FAILS(pipe(NULL) == -1));
  CHECK(FAILS(mmap(NULL, 1, PROT_READ, MAP_SHARED, 0, 0) == MAP_FAILED) && FAILS(!dlopen("x", RTLD_NOW)) && dlerror());
  CHECK(FAILS(tcgetattr(0, &modes) == -1) && FAILS(ioctl(0, TIOCGWINSZ, NULL) == -1) && FAILS(!getpwuid(0)));
  CHECK(getrusage(RUSAGE_SELF, &usage) == 0 && usage.ru_stime.tv_sec == 0);
}

static void waits(void) {
  fd_set set;
  struct timeval second = {1, 0};
  const time_t before = time(NULL);
  FD_ZERO(&set);
  FD_SET(1, &set);
  CHECK(select(2, NULL, &set, NULL, &second) == 1 && FD_ISSET(1, &set) && time(NULL) == before);
  second.tv_sec = 0;
  second.tv_usec = 5;
  CHECK(select(0, NULL, NULL, NULL, &second) == 0);
}

static void library(void) {
  char *memory = malloc(100), *large = malloc(5000);
  FILE *file = fopen("/dev/null", "r+");
  CHECK(sizeof(FILE) >= sizeof *stdin);
  CHECK(malloc_usable_size(memory) >= 100 && malloc_usable_size(large) >= 5000 && malloc_usable_size(NULL) == 0);
  free(memory);
  free(large);
  CHECK(file && __freadable(file) && __fwritable(file) && !__freading(file) && !__fwriting(file));
  fputs("text", file);
  CHECK(__fwriting(file) && __fpending(file) == 4);
  __fpurge(file);
  CHECK(__fpending(file) == 0);
  __fseterr(file);
  CHECK(ferror(file) && fclose(file) == 0);
  CHECK(openat(5, "x", O_RDONLY) == -1 && errno == EBADF && openat(AT_FDCWD, "/dev/null", O_RDONLY) > 2);
  CHECK(getdtablesize() == 256 && sysconf(_SC_OPEN_MAX) == 256 && strcmp(getprogname(), "program") == 0);
}

int main(void) {
  threads();
  impossible();
  waits();
  library();
  return 0;
}
