/* String functions. */
#include <stdint.h>
#include <string.h>

typedef uint32_t __attribute__((may_alias)) word;

/* Whether a word has a zero byte: only in such a byte does subtracting 1 set a bit 7 that was clear. */
static inline int has_zero_byte(word w) {
  return ((w - 0x01010101) & ~w & 0x80808080) != 0;
}

size_t strlen(const char *string) {
  const char *p = string;
  for (; (uintptr_t)p & 3; p++)
    if (!*p)
      return (size_t)(p - string);
  while (!has_zero_byte(*(const word *)p)) /* an aligned word never reaches beyond memory that the string is in */
    p += 4;
  while (*p)
    p++;
  return (size_t)(p - string);
}

size_t strnlen(const char *string, size_t size) {
  size_t n = 0;
  while (n < size && string[n])
    n++;
  return n;
}

int strcmp(const char *a, const char *b) {
  if ((((uintptr_t)a | (uintptr_t)b) & 3) == 0)
    for (; *(const word *)a == *(const word *)b && !has_zero_byte(*(const word *)a); a += 4)
      b += 4;
  for (; *a && *a == *b; a++)
    b++;
  return (unsigned char)*a - (unsigned char)*b;
}

int strncmp(const char *a, const char *b, size_t size) {
  for (; size; size--, a++, b++)
    if (!*a || *a != *b)
      return (unsigned char)*a - (unsigned char)*b;
  return 0;
}

char *strcpy(char *restrict to, const char *restrict from) {
  char *t = to;
  while ((*t++ = *from++))
    ;
  return to;
}

char *strncpy(char *restrict to, const char *restrict from, size_t size) {
  char *t = to;
  for (; size && *from; size--)
    *t++ = *from++;
  for (; size; size--)
    *t++ = 0;
  return to;
}

char *strcat(char *restrict to, const char *restrict from) {
  strcpy(to + strlen(to), from);
  return to;
}

char *strncat(char *restrict to, const char *restrict from, size_t size) {
  char *t = to + strlen(to);
  for (; size && *from; size--)
    *t++ = *from++;
  *t = 0;
  return to;
}

char *strchr(const char *string, int c) {
  for (const unsigned char *s = (const unsigned char *)string;; s++) {
    if (*s == (unsigned char)c)
      return (char *)(uintptr_t)s;
    if (!*s)
      return NULL;
  }
}

char *strrchr(const char *string, int c) {
  const char *found = NULL;
  do
    if (*string == (char)c)
      found = string;
  while (*string++);
  return (char *)(uintptr_t)found;
}

char *strstr(const char *string, const char *part) {
  for (;; string++) {
    size_t n = 0;
    while (part[n] && string[n] == part[n])
      n++;
    if (!part[n])
      return (char *)(uintptr_t)string;
    if (!*string)
      return NULL;
  }
}

static int is_member(char c, const char *set) {
  for (; *set; set++)
    if (*set == c)
      return 1;
  return 0;
}

size_t strspn(const char *string, const char *set) {
  size_t n = 0;
  while (string[n] && is_member(string[n], set))
    n++;
  return n;
}

size_t strcspn(const char *string, const char *set) {
  size_t n = 0;
  while (string[n] && !is_member(string[n], set))
    n++;
  return n;
}

char *strpbrk(const char *string, const char *set) {
  string += strcspn(string, set);
  return *string ? (char *)(uintptr_t)string : NULL;
}

char *strtok_r(char *restrict string, const char *restrict separators, char **restrict rest) {
  if (!string)
    string = *rest;
  string += strspn(string, separators);
  char *end = string + strcspn(string, separators);
  *rest = end;
  if (end == string)
    return NULL;
  if (*end) {
    *end = 0;
    *rest = end + 1;
  }
  return string;
}
