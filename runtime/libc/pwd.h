/* There are no users. */
#ifndef TRAX_PWD_H
#define TRAX_PWD_H

#include <sys/types.h>
#include <trax/names.h>

struct passwd {
  char *pw_name, *pw_passwd;
  uid_t pw_uid;
  gid_t pw_gid;
  char *pw_gecos, *pw_dir, *pw_shell;
};

__TRAX_FAILS(struct passwd *, getpwuid, (uid_t user), 0)
__TRAX_FAILS(struct passwd *, getpwnam, (const char *name), 0)

#endif
