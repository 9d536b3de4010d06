/* String functions that are called seldom. */
#include <ctype.h>
#include <errno.h>
#include <stdint.h>
#include <string.h>

void *memrchr(const void *memory, int byte, size_t size) {
  for (const unsigned char *p = (const unsigned char *)memory + size; size; size--)
    if (*--p == (unsigned char)byte)
      return (void *)(uintptr_t)p;
  return NULL;
}

void *memccpy(void *restrict to, const void *restrict from, int byte, size_t size) {
  unsigned char *t = to;
  for (const unsigned char *f = from; size; size--)
    if ((*t++ = *f++) == (unsigned char)byte)
      return t;
  return NULL;
}

void *memmem(const void *memory, size_t size, const void *part, size_t part_size) {
  const char *p = memory;
  for (; size >= part_size; p++, size--)
    if (memcmp(p, part, part_size) == 0)
      return (void *)(uintptr_t)p;
  return NULL;
}

void *mempcpy(void *restrict to, const void *restrict from, size_t size) {
  return (char *)memcpy(to, from, size) + size;
}

char *stpcpy(char *restrict to, const char *restrict from) {
  while ((*to = *from++))
    to++;
  return to;
}

char *stpncpy(char *restrict to, const char *restrict from, size_t size) {
  for (; size && *from; size--)
    *to++ = *from++;
  memset(to, 0, size);
  return to;
}

char *strtok(char *restrict string, const char *restrict separators) {
  static _Thread_local char *rest;
  return strtok_r(string, separators, &rest);
}

int strncasecmp(const char *a, const char *b, size_t size) {
  for (; size; size--, a++, b++) {
    int difference = tolower((unsigned char)*a) - tolower((unsigned char)*b);
    if (difference || !*a)
      return difference;
  }
  return 0;
}

int strcasecmp(const char *a, const char *b) {
  return strncasecmp(a, b, SIZE_MAX);
}

/* There is one locale, the C locale. */
int strcoll(const char *a, const char *b) {
  return strcmp(a, b);
}

size_t strxfrm(char *restrict to, const char *restrict from, size_t size) {
  size_t length = strlen(from);
  if (size)
    memcpy(to, from, length < size ? length + 1 : size);
  return length;
}
