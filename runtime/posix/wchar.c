/* Strings of wide characters. */
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

size_t wcslen(const wchar_t *string) {
  return wcsnlen(string, (size_t)-1);
}

size_t wcsnlen(const wchar_t *string, size_t size) {
  size_t length = 0;
  while (length < size && string[length])
    length++;
  return length;
}

wchar_t *wmemcpy(wchar_t *restrict to, const wchar_t *restrict from, size_t size) {
  return memcpy(to, from, size * sizeof *to);
}

wchar_t *wmemmove(wchar_t *to, const wchar_t *from, size_t size) {
  return memmove(to, from, size * sizeof *to);
}

wchar_t *wmemset(wchar_t *to, wchar_t c, size_t size) {
  for (size_t i = 0; i < size; i++)
    to[i] = c;
  return to;
}

int wmemcmp(const wchar_t *a, const wchar_t *b, size_t size) {
  for (; size; size--, a++, b++)
    if (*a != *b)
      return *a < *b ? -1 : 1;
  return 0;
}

wchar_t *wmemchr(const wchar_t *memory, wchar_t c, size_t size) {
  for (; size; size--, memory++)
    if (*memory == c)
      return (wchar_t *)memory;
  return NULL;
}

wchar_t *wcscpy(wchar_t *restrict to, const wchar_t *restrict from) {
  return wmemcpy(to, from, wcslen(from) + 1);
}

wchar_t *wcsncpy(wchar_t *restrict to, const wchar_t *restrict from, size_t size) {
  size_t length = wcsnlen(from, size);
  wmemcpy(to, from, length);
  wmemset(to + length, 0, size - length);
  return to;
}

wchar_t *wcscat(wchar_t *restrict to, const wchar_t *restrict from) {
  wcscpy(to + wcslen(to), from);
  return to;
}

wchar_t *wcsncat(wchar_t *restrict to, const wchar_t *restrict from, size_t size) {
  size_t used = wcslen(to), length = wcsnlen(from, size);
  wmemcpy(to + used, from, length);
  to[used + length] = 0;
  return to;
}

int wcsncmp(const wchar_t *a, const wchar_t *b, size_t size) {
  for (; size; size--, a++, b++)
    if (*a != *b || !*a)
      return *a == *b ? 0 : *a < *b ? -1 : 1;
  return 0;
}

int wcscmp(const wchar_t *a, const wchar_t *b) {
  return wcsncmp(a, b, (size_t)-1);
}

int wcscoll(const wchar_t *a, const wchar_t *b) {
  return wcscmp(a, b);
}

wchar_t *wcschr(const wchar_t *string, wchar_t c) {
  return wmemchr(string, c, wcslen(string) + 1);
}

wchar_t *wcsrchr(const wchar_t *string, wchar_t c) {
  for (size_t i = wcslen(string) + 1; i-- > 0;)
    if (string[i] == c)
      return (wchar_t *)string + i;
  return NULL;
}

wchar_t *wcsstr(const wchar_t *string, const wchar_t *part) {
  size_t length = wcslen(part);
  for (; wcsncmp(string, part, length) != 0; string++)
    if (!*string)
      return NULL;
  return (wchar_t *)string;
}

size_t wcscspn(const wchar_t *string, const wchar_t *set) {
  size_t length = 0;
  while (string[length] && !wcschr(set, string[length]))
    length++;
  return length;
}

size_t wcsspn(const wchar_t *string, const wchar_t *set) {
  size_t length = 0;
  while (string[length] && wcschr(set, string[length]))
    length++;
  return length;
}

wchar_t *wcspbrk(const wchar_t *string, const wchar_t *set) {
  string += wcscspn(string, set);
  return *string ? (wchar_t *)string : NULL;
}

wchar_t *wcsdup(const wchar_t *string) {
  size_t size = wcslen(string) + 1;
  wchar_t *copy = malloc(size * sizeof *copy);
  return copy ? wmemcpy(copy, string, size) : NULL;
}

size_t wcsxfrm(wchar_t *restrict to, const wchar_t *restrict from, size_t size) {
  size_t length = wcslen(from);
  if (size)
    wmemcpy(to, from, length < size ? length + 1 : size);
  return length;
}

wchar_t *wcstok(wchar_t *restrict string, const wchar_t *restrict set, wchar_t **restrict state) {
  string = string ? string : *state;
  string += wcsspn(string, set);
  *state = string + wcscspn(string, set);
  if (*state == string)
    return NULL;
  if (**state)
    *(*state)++ = 0;
  return string;
}

int wcwidth(wchar_t c) {
  return c == 0 ? 0 : (c >= 32 && c < 127) || c >= 160 ? 1 : -1;
}
