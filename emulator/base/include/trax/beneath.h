/* Files that lie beneath a folder, given by a descriptor, whatever links another process puts there: no path leaves the
   folder, and no link or device is written. */
#ifndef TRAX_BENEATH_H
#define TRAX_BENEATH_H

#include "trax/status.h"

#include <stddef.h>

/* As openat, for a path that stays beneath the folder; -1 with errno. A link that stays beneath is followed, if the
   host has openat2; else ELOOP, or ENOTDIR for a link to a folder on the way. */
int trax_beneath_open(int folder, const char *path, int flags);

/* Writes a whole file, under a temporary name that does not depend on `path`, and renames it. An error leaves the
   earlier file of that name. A link, a device, a pipe and a folder of that name are refused. shown: the path in
   messages. */
trax_status trax_beneath_write(int folder, const char *path, const char *shown, const void *bytes, size_t size,
                               trax_error *error);
/* Whether this could be done now. */
trax_status trax_beneath_check(int folder, const char *path, const char *shown, trax_error *error);

#endif
