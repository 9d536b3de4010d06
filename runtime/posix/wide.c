/* Numbers and times as wide characters: by the functions for bytes, from and to copies in the heap, because texts may
   be long. */
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <wchar.h>

/* Copies blanks and the characters that numbers consist of as bytes. NULL: no memory. */
static char *copy(const wchar_t *text) {
  size_t length = 0;
  while (isascii(text[length]) && isspace(text[length]))
    length++;
  while (text[length] && isascii(text[length]) && (isalnum(text[length]) || strchr("+-._()", text[length])))
    length++;
  char *bytes = malloc(length + 1);
  for (size_t i = 0; bytes && i < length; i++)
    bytes[i] = (char)text[i];
  if (bytes)
    bytes[length] = 0;
  return bytes;
}

#define CONVERSION(TYPE, NAME, CALL, PARAMETERS)                                                                       \
  TYPE NAME PARAMETERS {                                                                                               \
    char *bytes = copy(text), *last = bytes;                                                                           \
    TYPE number = bytes ? CALL : 0;                                                                                    \
    if (end)                                                                                                           \
      *end = (wchar_t *)(uintptr_t)text + (last - bytes);                                                              \
    free(bytes);                                                                                                       \
    return number;                                                                                                     \
  }
#define REAL(TYPE, NAME, FOR_BYTES)                                                                                    \
  CONVERSION(TYPE, NAME, FOR_BYTES(bytes, &last), (const wchar_t *restrict text, wchar_t **restrict end))
#define INTEGER(TYPE, NAME, FOR_BYTES)                                                                                 \
  CONVERSION(TYPE, NAME, FOR_BYTES(bytes, &last, base),                                                                \
             (const wchar_t *restrict text, wchar_t **restrict end, int base))

REAL(float, wcstof, strtof)
REAL(double, wcstod, strtod)
REAL(long double, wcstold, strtold)
INTEGER(long, wcstol, strtol)
INTEGER(unsigned long, wcstoul, strtoul)
INTEGER(long long, wcstoll, strtoll)
INTEGER(unsigned long long, wcstoull, strtoull)
INTEGER(intmax_t, wcstoimax, strtoimax)
INTEGER(uintmax_t, wcstoumax, strtoumax)

size_t wcsftime(wchar_t *restrict to, size_t size, const wchar_t *restrict format, const struct tm *restrict time) {
  const size_t format_size = 4 * wcslen(format) + 1;
  char *bytes = size <= (size_t)-1 / 8 ? malloc(4 * size + format_size) : NULL; /* the result, then the format */
  size_t length = 0;
  if (bytes && wcstombs(bytes + 4 * size, format, format_size) != (size_t)-1 &&
      strftime(bytes, 4 * size, bytes + 4 * size, time))
    length = mbstowcs(to, bytes, size);
  free(bytes);
  return length < size ? length : 0;
}
