/* POSIX's strings, which <string.h> includes. */
#ifndef TRAX_STRINGS_H
#define TRAX_STRINGS_H

#define __need_size_t
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

int strcasecmp(const char *a, const char *b);
int strncasecmp(const char *a, const char *b, size_t size);
int bcmp(const void *a, const void *b, size_t size);
void bcopy(const void *from, void *to, size_t size);
void bzero(void *memory, size_t size);
char *index(const char *string, int c);
char *rindex(const char *string, int c);
int ffs(int x);
int ffsl(long x);
int ffsll(long long x);

#ifdef __cplusplus
}
#endif

#endif
