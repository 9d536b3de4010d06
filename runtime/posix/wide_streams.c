/* Streams of wide characters: of their UTF-8, by the functions for bytes. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "wide_format.h"

enum { MOST_BYTES = 4 }; /* of a character */

int fwide(FILE *stream, int mode) {
  (void)stream;
  return mode;
}

/* --- characters --- */

wint_t fgetwc(FILE *stream) {
  mbstate_t state = {0};
  for (;;) {
    const int c = fgetc(stream);
    if (c == EOF) {
      if (!mbsinit(&state))
        errno = EILSEQ;
      return WEOF;
    }
    const char byte = (char)c;
    wchar_t wide;
    const size_t used = mbrtowc(&wide, &byte, 1, &state);
    if (used == (size_t)-1)
      return WEOF;
    if (used != (size_t)-2)
      return (wint_t)wide;
  }
}

wint_t getwc(FILE *stream) {
  return fgetwc(stream);
}

wint_t getwchar(void) {
  return fgetwc(stdin);
}

wint_t ungetwc(wint_t c, FILE *stream) {
  char bytes[MOST_BYTES];
  mbstate_t state = {0};
  size_t count = c == WEOF ? (size_t)-1 : wcrtomb(bytes, (wchar_t)c, &state);
  if (count == (size_t)-1)
    return WEOF;
  while (count-- > 0)
    if (ungetc(bytes[count] & 0xFF, stream) == EOF)
      return WEOF;
  return c;
}

wint_t fputwc(wchar_t c, FILE *stream) {
  char bytes[MOST_BYTES];
  mbstate_t state = {0};
  const size_t count = wcrtomb(bytes, c, &state);
  return count != (size_t)-1 && fwrite(bytes, 1, count, stream) == count ? (wint_t)c : WEOF;
}

wint_t putwc(wchar_t c, FILE *stream) {
  return fputwc(c, stream);
}

wint_t putwchar(wchar_t c) {
  return fputwc(c, stdout);
}

wchar_t *fgetws(wchar_t *restrict to, int size, FILE *restrict stream) {
  int length = 0;
  while (length < size - 1) {
    const wint_t c = fgetwc(stream);
    if (c == WEOF) {
      if (ferror(stream) || !feof(stream) || length == 0)
        return NULL;
      break;
    }
    to[length++] = (wchar_t)c;
    if (c == L'\n')
      break;
  }
  if (size <= 0)
    return NULL;
  to[length] = 0;
  return to;
}

/* The text as bytes from malloc. NULL: errno has the reason. */
static char *narrow(const wchar_t *text) {
  const size_t size = wcstombs(NULL, text, 0);
  char *bytes = size == (size_t)-1 ? NULL : malloc(size + 1);
  if (bytes)
    wcstombs(bytes, text, size + 1);
  return bytes;
}

int fputws(const wchar_t *restrict text, FILE *restrict stream) {
  char *bytes = narrow(text);
  const int result = bytes ? fputs(bytes, stream) : EOF;
  free(bytes);
  return result;
}

/* --- formatted output --- */

/* Formats to memory from malloc. *count receives the bytes; the result is NULL after an error. */
static char *format_bytes(const wchar_t *format, va_list arguments, int *count) {
  char *bytes = narrow(format), *text = bytes ? __trax_format_wide(bytes, arguments, count) : NULL;
  free(bytes);
  return text;
}

int vfwprintf(FILE *restrict stream, const wchar_t *restrict format, va_list arguments) {
  int count;
  char *text = format_bytes(format, arguments, &count);
  int result = -1;
  if (text && fwrite(text, 1, (size_t)count, stream) == (size_t)count)
    result = (int)__trax_characters(text, (size_t)count);
  free(text);
  return result;
}

int vswprintf(wchar_t *restrict to, size_t size, const wchar_t *restrict format, va_list arguments) {
  int count;
  char *text = format_bytes(format, arguments, &count);
  size_t length = text ? __trax_characters(text, (size_t)count) : 0, at = 0;
  const char *from = text;
  mbstate_t state = {0};
  while (at < length && at + 1 < size) {
    const size_t used = mbrtowc(&to[at++], from, (size_t)(text + count - from), &state);
    from += used && used < (size_t)-2 ? used : 1;
  }
  if (size)
    to[at] = 0;
  free(text);
  return text && length < size ? (int)length : -1;
}

#define WITH_ARGUMENTS(CALL)                                                                                           \
  va_list arguments;                                                                                                   \
  va_start(arguments, format);                                                                                         \
  const int result = CALL;                                                                                             \
  va_end(arguments);                                                                                                   \
  return result

int vwprintf(const wchar_t *restrict format, va_list arguments) {
  return vfwprintf(stdout, format, arguments);
}

int wprintf(const wchar_t *restrict format, ...) {
  WITH_ARGUMENTS(vfwprintf(stdout, format, arguments));
}

int fwprintf(FILE *restrict stream, const wchar_t *restrict format, ...) {
  WITH_ARGUMENTS(vfwprintf(stream, format, arguments));
}

int swprintf(wchar_t *restrict to, size_t size, const wchar_t *restrict format, ...) {
  WITH_ARGUMENTS(vswprintf(to, size, format, arguments));
}

/* --- formatted input --- */

int vfwscanf(FILE *restrict stream, const wchar_t *restrict format, va_list arguments) {
  char *bytes = narrow(format);
  const int result = bytes ? vfscanf(stream, bytes, arguments) : EOF;
  free(bytes);
  return result;
}

int vswscanf(const wchar_t *restrict text, const wchar_t *restrict format, va_list arguments) {
  char *from = narrow(text), *bytes = narrow(format);
  const int result = from && bytes ? vsscanf(from, bytes, arguments) : EOF;
  free(from);
  free(bytes);
  return result;
}

int vwscanf(const wchar_t *restrict format, va_list arguments) {
  return vfwscanf(stdin, format, arguments);
}

int wscanf(const wchar_t *restrict format, ...) {
  WITH_ARGUMENTS(vfwscanf(stdin, format, arguments));
}

int fwscanf(FILE *restrict stream, const wchar_t *restrict format, ...) {
  WITH_ARGUMENTS(vfwscanf(stream, format, arguments));
}

int swscanf(const wchar_t *restrict text, const wchar_t *restrict format, ...) {
  WITH_ARGUMENTS(vswscanf(text, format, arguments));
}
