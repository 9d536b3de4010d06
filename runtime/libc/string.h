/* Memory and string functions of the C library. */
#ifndef TRAX_STRING_H
#define TRAX_STRING_H

#define __need_size_t
#define __need_NULL
#include <stddef.h>
#include <trax/names.h>
#ifdef __TRAX_ALL_NAMES
#include <strings.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

void *memcpy(void *__restrict to, const void *__restrict from, size_t size);
void *memmove(void *to, const void *from, size_t size);
void *memset(void *to, int byte, size_t size);
int memcmp(const void *a, const void *b, size_t size);
void *memchr(const void *memory, int byte, size_t size);
size_t strlen(const char *string);
int strcmp(const char *a, const char *b);
int strncmp(const char *a, const char *b, size_t size);
char *strcpy(char *__restrict to, const char *__restrict from);
char *strncpy(char *__restrict to, const char *__restrict from, size_t size);
char *strcat(char *__restrict to, const char *__restrict from);
char *strncat(char *__restrict to, const char *__restrict from, size_t size);
char *strchr(const char *string, int c);
char *strrchr(const char *string, int c);
char *strstr(const char *string, const char *part);
size_t strspn(const char *string, const char *set);
size_t strcspn(const char *string, const char *set);
char *strpbrk(const char *string, const char *set);
char *strtok(char *__restrict string, const char *__restrict separators); /* each thread has its own rest */
int strcoll(const char *a, const char *b);
size_t strxfrm(char *__restrict to, const char *__restrict from, size_t size);
char *strerror(int number);

#if defined __TRAX_ALL_NAMES || __STDC_VERSION__ > 201710L
void *memccpy(void *__restrict to, const void *__restrict from, int byte, size_t size);
char *strdup(const char *string); /* by malloc */
char *strndup(const char *string, size_t size);
#endif
#ifdef __TRAX_ALL_NAMES
void *memrchr(const void *memory, int byte, size_t size);
void *memmem(const void *memory, size_t size, const void *part, size_t part_size);
void *mempcpy(void *__restrict to, const void *__restrict from, size_t size);
size_t strnlen(const char *string, size_t size);
char *strtok_r(char *__restrict string, const char *__restrict separators, char **__restrict rest);
char *stpcpy(char *__restrict to, const char *__restrict from);
char *stpncpy(char *__restrict to, const char *__restrict from, size_t size);
size_t strlcpy(char *__restrict to, const char *__restrict from, size_t size);
size_t strlcat(char *__restrict to, const char *__restrict from, size_t size);
char *strsep(char **__restrict rest, const char *__restrict separators);
char *strchrnul(const char *string, int c);
char *strcasestr(const char *string, const char *part);
void *rawmemchr(const void *memory, int byte);
int strerror_r(int number, char *to, size_t size);
char *strsignal(int number);
void explicit_bzero(void *memory, size_t size);
#endif

#ifdef __cplusplus
}
#endif

#endif
