/* Functions of BSD and GNU. */
#include <ctype.h>
#include <stddef.h>
#include <string.h>

size_t strlcpy(char *restrict to, const char *restrict from, size_t size) {
  size_t length = strlen(from);
  if (size) {
    size_t part = length < size ? length : size - 1;
    memcpy(to, from, part);
    to[part] = 0;
  }
  return length;
}

size_t strlcat(char *restrict to, const char *restrict from, size_t size) {
  size_t used = strnlen(to, size);
  return used + strlcpy(to + used, from, size - used);
}

char *strsep(char **restrict rest, const char *restrict separators) {
  char *token = *rest;
  if (!token)
    return NULL;
  char *end = token + strcspn(token, separators);
  *rest = *end ? end + 1 : NULL;
  *end = 0;
  return token;
}

char *strchrnul(const char *string, int c) {
  while (*string && *string != (char)c)
    string++;
  return (char *)string;
}

char *strcasestr(const char *string, const char *part) {
  size_t length = strlen(part);
  for (; strncasecmp(string, part, length) != 0; string++)
    if (!*string)
      return NULL;
  return (char *)string;
}

void *rawmemchr(const void *memory, int byte) {
  return memchr(memory, byte, (size_t)-1 - (size_t)memory);
}

int bcmp(const void *a, const void *b, size_t size) {
  return memcmp(a, b, size);
}

void bcopy(const void *from, void *to, size_t size) {
  memmove(to, from, size);
}

void bzero(void *memory, size_t size) {
  memset(memory, 0, size);
}

void explicit_bzero(void *memory, size_t size) {
  memset(memory, 0, size);
  __asm__ volatile("" : : "r"(memory) : "memory");
}

char *index(const char *string, int c) {
  return strchr(string, c);
}

char *rindex(const char *string, int c) {
  return strrchr(string, c);
}

int ffs(int x) {
  return __builtin_ffs(x);
}

int ffsl(long x) {
  return __builtin_ffsl(x);
}

int ffsll(long long x) {
  return __builtin_ffsll(x);
}
