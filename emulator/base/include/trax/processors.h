/* How many processors of the host this process may use. */
#ifndef TRAX_PROCESSORS_H
#define TRAX_PROCESSORS_H

#ifdef __cplusplus
extern "C" {
#endif

/* The number of processors of the affinity mask, or fewer if a quota of the process's control groups, version 1 or 2, is
   less: whole processors, and at least one. */
unsigned trax_host_processors(void);

/* What the quotas allow, UINT_MAX if there are none. All paths, /proc/self/cgroup and mountinfo among them, begin with
   `root`: "" but for tests. */
unsigned trax_quota_processors(const char *root);

#ifdef __cplusplus
}
#endif
#endif
