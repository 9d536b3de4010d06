/* How many processors the quotas of control groups allow (trax/processors.h): files as the kernel writes them,
   in a folder that stands for the root. */
#define _XOPEN_SOURCE 700
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "trax/processors.h"
#include "temporary.h"
#include "trax/emulator.h"

#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_FILES = 6 };

struct host {
  const char *name;
  unsigned processors; /* UINT_MAX: no quota */
  struct {
    const char *path, *content;
  } files[MOST_FILES];
};

#define V2 "35 24 0:30 / /sys/fs/cgroup rw,nosuid,nodev shared:9 - cgroup2 cgroup2 rw,nsdelegate\n"
#define V1 "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw,relatime - cgroup cgroup rw,cpu,cpuacct\n"
#define OTHERS                                                                                                         \
  "22 1 8:1 / / rw - ext4 /dev/sda1 rw\n"                                                                              \
  "33 31 0:30 / /sys/fs/cgroup/cpuset rw - cgroup cgroup rw,cpuset\n"
#define CGROUP "/proc/self/cgroup"
#define MOUNTS "/proc/self/mountinfo"

static const struct host hosts[] = {
    {"no files at all", UINT_MAX, {{0}}},
    {"no groups", UINT_MAX, {{CGROUP, ""}, {MOUNTS, OTHERS}}},
    {"version 2, no quota",
     UINT_MAX,
     {{CGROUP, "0::/a\n"}, {MOUNTS, V2}, {"/sys/fs/cgroup/a/cpu.max", "max 100000\n"}}},
    {"version 2, in a container",
     2,
     {{CGROUP, "0::/\n"}, {MOUNTS, OTHERS V2}, {"/sys/fs/cgroup/cpu.max", "250000 100000\n"}}},
    {"version 2, less than one", 1, {{CGROUP, "0::/\n"}, {MOUNTS, V2}, {"/sys/fs/cgroup/cpu.max", "5000 100000\n"}}},
    {"version 2, of a group around",
     3,
     {{CGROUP, "0::/a/b.slice/c\n"},
      {MOUNTS, V2},
      {"/sys/fs/cgroup/a/b.slice/c/cpu.max", "800000 100000\n"},
      {"/sys/fs/cgroup/a/b.slice/cpu.max", "max 100000\n"},
      {"/sys/fs/cgroup/a/cpu.max", "300000 100000\n"}}},
    {"version 2, only a part is mounted",
     4,
     {{CGROUP, "0::/docker/x/y\n"},
      {MOUNTS, "35 24 0:30 /docker/x /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n"},
      {"/sys/fs/cgroup/y/cpu.max", "max 100000\n"},
      {"/sys/fs/cgroup/cpu.max", "40000 10000\n"}}},
    {"version 2, a group outside of what is mounted",
     5,
     {{CGROUP, "0::/../other\n"},
      {MOUNTS, "35 24 0:30 /docker/x /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n"},
      {"/sys/fs/cgroup/cpu.max", "50000 10000\n"}}},
    {"version 2, mounted where a blank is",
     6,
     {{CGROUP, "0::/\n"},
      {MOUNTS, "35 24 0:30 / /my\\040groups rw - cgroup2 cgroup2 rw\n"},
      {"/my groups/cpu.max", "60000 10000\n"}}},
    {"version 1, no quota",
     UINT_MAX,
     {{CGROUP, "4:cpu,cpuacct:/a\n"},
      {MOUNTS, V1},
      {"/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "-1\n"},
      {"/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n"}}},
    {"version 1, of its group",
     7,
     {{CGROUP, "5:cpuset:/b\n4:cpu,cpuacct:/a\n"},
      {MOUNTS, OTHERS V1},
      {"/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "750000\n"},
      {"/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n"}}},
    {"both versions, the lesser quota",
     2,
     {{CGROUP, "4:cpu,cpuacct:/a\n0::/b\n"},
      {MOUNTS, OTHERS V1 V2},
      {"/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "750000\n"},
      {"/sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n"},
      {"/sys/fs/cgroup/b/cpu.max", "200000 100000\n"}}},
    {"nonsense",
     UINT_MAX,
     {{CGROUP, "\n:\n::\n0:x:\n0::\n99"},
      {MOUNTS, "\n - \n35 24\n35 24 0:30 / /sys/fs/cgroup - cgroup2\n35 24 0:30 / /m\\0 rw - cgroup2 c c"},
      {"/sys/fs/cgroup/cpu.max", "-1 0\n"}}},
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

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(quotas), cmocka_unit_test(this_host)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
