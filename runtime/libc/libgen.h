/* Parts of paths. Both functions may change the path. */
#ifndef TRAX_LIBGEN_H
#define TRAX_LIBGEN_H

#ifdef __cplusplus
extern "C" {
#endif

char *dirname(char *path);
char *__xpg_basename(char *path);
#define basename __xpg_basename /* as POSIX has it; that of <string.h> with _GNU_SOURCE is GNU's */

#ifdef __cplusplus
}
#endif

#endif
