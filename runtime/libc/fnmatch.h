/* Names that match a pattern of the shell. */
#ifndef TRAX_FNMATCH_H
#define TRAX_FNMATCH_H

#define FNM_PATHNAME 1
#define FNM_FILE_NAME FNM_PATHNAME
#define FNM_NOESCAPE 2
#define FNM_PERIOD 4
#define FNM_LEADING_DIR 8
#define FNM_CASEFOLD 16
#define FNM_NOMATCH 1

#ifdef __cplusplus
extern "C" {
#endif

int fnmatch(const char *pattern, const char *text, int flags); /* 0 or FNM_NOMATCH */

#ifdef __cplusplus
}
#endif

#endif
