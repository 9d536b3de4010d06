/* The number of processors of the host that this process may use. */
#ifndef TRAX_PROCESSORS_H
#define TRAX_PROCESSORS_H

#ifdef __cplusplus
extern "C" {
#endif

/* The number of processors in the affinity mask, reduced to the CPU quota of the process's control groups (version 2),
 * rounded down, at least 1. */
unsigned trax_host_processors(void);

/* The number of processors that the quotas allow, UINT_MAX without a quota. `root` is put before the paths of the files
   read (/proc/self/cgroup and those below /sys/fs/cgroup); it is "" except in tests. */
unsigned trax_quota_processors(const char *root);

#ifdef __cplusplus
}
#endif
#endif
