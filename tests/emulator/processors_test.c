/* How many processors the quotas of control groups allow (trax/processors.h): files as the kernel writes them,
   in a folder that stands for the root. */
#define _GNU_SOURCE /* sched_getaffinity */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "temporary.h"
#include "trax/emulator.h"
#include "trax/processors.h"

#include <errno.h>
#include <ftw.h>
#include <limits.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_FILES = 4 };

struct host {
  const char *name;
  unsigned processors; /* UINT_MAX: no quota */
  struct {
    const char *path, *content;
  } files[MOST_FILES];
};

#define CGROUP "/proc/self/cgroup"

static const struct host hosts[] = {
    {"no files at all", UINT_MAX, {{0}}},
    {"no groups", UINT_MAX, {{CGROUP, ""}}},
    {"no quota", UINT_MAX, {{CGROUP, "0::/a\n"}, {"/sys/fs/cgroup/a/cpu.max", "max 100000\n"}}},
    {"in a container", 2, {{CGROUP, "0::/\n"}, {"/sys/fs/cgroup/cpu.max", "250000 100000\n"}}},
    {"less than one", 1, {{CGROUP, "0::/\n"}, {"/sys/fs/cgroup/cpu.max", "5000 100000\n"}}},
    {"of a group around",
     3,
     {{CGROUP, "5:cpuset:/b\n0::/a/b.slice/c\n"},
      {"/sys/fs/cgroup/a/b.slice/c/cpu.max", "800000 100000\n"},
      {"/sys/fs/cgroup/a/b.slice/cpu.max", "max 100000\n"},
      {"/sys/fs/cgroup/a/cpu.max", "300000 100000\n"}}},
    {"only a part is mounted", 4, {{CGROUP, "0::/docker/x/y\n"}, {"/sys/fs/cgroup/cpu.max", "40000 10000\n"}}},
    {"a group outside of what is mounted",
     5,
     {{CGROUP, "0::/../other\n"}, {"/sys/fs/cgroup/cpu.max", "50000 10000\n"}}},
    {"nonsense", UINT_MAX, {{CGROUP, "\n:\n::\n0:x:\n0::\n99"}, {"/sys/fs/cgroup/cpu.max", "-1 0\n"}}},
};

static void put(const char *root, const char *path, const char *content) {
  char full[PATH_MAX];
  snprintf(full, sizeof full, "%s%s", root, path);
  for (char *slash = full + strlen(root) + 1; (slash = strchr(slash, '/')); *slash++ = '/') {
    *slash = '\0';
    mkdir(full, 0777);
  }
  FILE *file = fopen(full, "w");
  assert_non_null(file);
  fputs(content, file);
  fclose(file);
}

static int remove_one(const char *path, const struct stat *status, int type, struct FTW *place) {
  (void)status;
  (void)type;
  (void)place;
  return remove(path);
}

static void quotas(void **state) {
  (void)state;
  const char *root = test_path("root");
  for (size_t i = 0; i < sizeof hosts / sizeof *hosts; i++) {
    assert_int_equal(mkdir(root, 0777), 0);
    for (unsigned j = 0; j < MOST_FILES && hosts[i].files[j].path; j++)
      put(root, hosts[i].files[j].path, hosts[i].files[j].content);
    const unsigned processors = trax_quota_processors(root);
    nftw(root, remove_one, 8, FTW_DEPTH | FTW_PHYS);
    if (processors != hosts[i].processors)
      fail_msg("%s: %u processors, not %u", hosts[i].name, processors, hosts[i].processors);
  }
}

static void this_host(void **state) {
  (void)state;
  const unsigned processors = trax_host_processors();
  assert_true(processors >= 1 && processors <= (unsigned)sysconf(_SC_NPROCESSORS_CONF));
}

static size_t mask_bytes; /* of an invented host, on which all processors may be used; 0: this host */

int __real_sched_getaffinity(pid_t process, size_t size, cpu_set_t *set);
int __wrap_sched_getaffinity(pid_t process, size_t size, cpu_set_t *set);

int __wrap_sched_getaffinity(pid_t process, size_t size, cpu_set_t *set) {
  if (!mask_bytes)
    return __real_sched_getaffinity(process, size, set);
  memset(set, 0, size);
  if (size < mask_bytes) {
    errno = EINVAL;
    return -1;
  }
  memset(set, 0xFF, mask_bytes);
  return 0;
}

/* A host with more processors than a cpu_set_t has bits; one that says nothing has a processor. */
static void many_processors(void **state) {
  (void)state;
  static const unsigned processors[][2] = {{64, 64}, {1024, 1024}, {2048, 2048}, {65536, 65536}, {131072, 1}};
  const unsigned quota = trax_quota_processors("");
  for (size_t i = 0; i < sizeof processors / sizeof *processors; i++) {
    const unsigned expected = processors[i][1];
    mask_bytes = processors[i][0] / CHAR_BIT;
    assert_int_equal(trax_host_processors(), expected < quota ? expected : quota);
  }
  mask_bytes = 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(quotas), cmocka_unit_test(this_host),
                                     cmocka_unit_test(many_processors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
