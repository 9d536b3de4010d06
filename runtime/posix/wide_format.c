/* Formatted output of wide characters: their UTF-8. Widths and precisions of texts count characters, so those are
   formatted here, and the others, whose characters are bytes, by asprintf. */
#include "wide_format.h"

#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

struct text {
  char *bytes; /* from malloc */
  size_t count, capacity;
  int failed;
};

struct directive {
  char flags[8];
  int width, precision; /* -1: none */
  enum { INT, CHAR, SHORT, LONG, LONG_LONG, SIZE, LONG_DOUBLE } length;
  char letter;
};

size_t __trax_characters(const char *bytes, size_t count) {
  size_t characters = 0;
  for (size_t i = 0; i < count; i++)
    characters += (bytes[i] & 0xC0) != 0x80;
  return characters;
}

static void put(struct text *to, const char *bytes, size_t count) {
  if (to->failed)
    return;
  if (to->count + count > to->capacity) {
    const size_t capacity = 2 * (to->count + count) + 16;
    char *grown = realloc(to->bytes, capacity);
    if (!grown) {
      to->failed = 1;
      return;
    }
    to->bytes = grown;
    to->capacity = capacity;
  }
  memcpy(to->bytes + to->count, bytes, count);
  to->count += count;
}

static void pad(struct text *to, int count) {
  while (count-- > 0)
    put(to, " ", 1);
}

static int read_number(const char **format, va_list *arguments) {
  int number = 0;
  if (**format == '*') {
    ++*format;
    return va_arg(*arguments, int);
  }
  while (isdigit((unsigned char)**format))
    number = number * 10 + *(*format)++ - '0';
  return number;
}

static int read_length(const char **format) {
  switch (*(*format)++) {
  case 'h':
    return **format == 'h' ? ++*format, CHAR : SHORT;
  case 'l':
    return **format == 'l' ? ++*format, LONG_LONG : LONG;
  case 'j':
    return LONG_LONG;
  case 'z':
  case 't':
    return SIZE;
  case 'L':
    return LONG_DOUBLE;
  default:
    --*format;
    return INT;
  }
}

/* Reads a directive, from after its % up to its letter. */
static struct directive read_directive(const char **format, va_list *arguments) {
  struct directive it = {.precision = -1};
  size_t flags = 0;
  for (; **format && strchr("-+ #0", **format); ++*format)
    if (!strchr(it.flags, **format))
      it.flags[flags++] = **format;
  it.width = read_number(format, arguments);
  if (it.width < 0) {
    it.width = -it.width;
    if (!strchr(it.flags, '-'))
      it.flags[flags] = '-';
  }
  if (**format == '.') {
    ++*format;
    it.precision = read_number(format, arguments);
  }
  it.length = read_length(format);
  it.letter = **format;
  *format += it.letter != 0;
  return it;
}

static void put_padded(struct text *to, const struct directive *it, const char *bytes, size_t count) {
  const int missing = it->width - (int)__trax_characters(bytes, count), is_left = strchr(it->flags, '-') != NULL;
  pad(to, is_left ? 0 : missing);
  put(to, bytes, count);
  pad(to, is_left ? missing : 0);
}

static void put_character(struct text *to, const struct directive *it, wint_t c) {
  char bytes[8];
  mbstate_t state = {0};
  const size_t count = c == WEOF ? (size_t)-1 : wcrtomb(bytes, (wchar_t)c, &state);
  if (count == (size_t)-1)
    to->failed = 1;
  else
    put_padded(to, it, bytes, count);
}

/* At most `precision` characters of a text in UTF-8. */
static void put_bytes(struct text *to, const struct directive *it, const char *bytes) {
  size_t count = 0;
  mbstate_t state = {0};
  for (int i = 0; i != it->precision && bytes[count]; i++) {
    const size_t used = mbrtowc(NULL, bytes + count, 4, &state);
    if (used > 4) {
      to->failed = 1;
      return;
    }
    count += used;
  }
  put_padded(to, it, bytes, count);
}

static void put_wide(struct text *to, const struct directive *it, const wchar_t *text) {
  struct text bytes = {0};
  for (int i = 0; i != it->precision && text[i]; i++)
    put_character(&bytes, &(struct directive){.flags = ""}, (wint_t)text[i]);
  to->failed |= bytes.failed;
  put_padded(to, it, bytes.bytes, bytes.count);
  free(bytes.bytes);
}

static void put_number(struct text *to, const struct directive *it, va_list *arguments) {
  static const char *const lengths[] = {"", "hh", "h", "l", "ll", "z", "L"};
  char format[40], *piece = NULL;
  int count;
  if (it->precision >= 0)
    snprintf(format, sizeof format, "%%%s*.%d%s%c", it->flags, it->precision, lengths[it->length], it->letter);
  else
    snprintf(format, sizeof format, "%%%s*%s%c", it->flags, lengths[it->length], it->letter);
#pragma clang diagnostic ignored "-Wformat-nonliteral"
  if (strchr("aAeEfFgG", it->letter))
    count = asprintf(&piece, format, it->width, va_arg(*arguments, double));
  else if (it->letter == 'p')
    count = asprintf(&piece, format, it->width, va_arg(*arguments, void *));
  else if (it->length == LONG_LONG)
    count = asprintf(&piece, format, it->width, va_arg(*arguments, long long));
  else
    count = asprintf(&piece, format, it->width, va_arg(*arguments, int)); /* long and size_t are as long */
  if (count < 0)
    to->failed = 1;
  else
    put(to, piece, (size_t)count);
  free(piece);
}

/* Stores the number of characters so far. */
static void store_count(const struct text *to, const struct directive *it, void *place) {
  const size_t count = __trax_characters(to->bytes, to->count);
  if (it->length == CHAR)
    *(signed char *)place = (signed char)count;
  else if (it->length == SHORT)
    *(short *)place = (short)count;
  else if (it->length == LONG_LONG)
    *(long long *)place = (long long)count;
  else
    *(int *)place = (int)count;
}

static void format_one(struct text *to, const char **format, va_list *arguments) {
  const struct directive it = read_directive(format, arguments);
  switch (it.letter) {
  case '%':
    put(to, "%", 1);
    break;
  case 'c':
    put_character(to, &it, it.length == LONG ? va_arg(*arguments, wint_t) : btowc(va_arg(*arguments, int) & 255));
    break;
  case 's':
    if (it.length == LONG)
      put_wide(to, &it, va_arg(*arguments, const wchar_t *));
    else
      put_bytes(to, &it, va_arg(*arguments, const char *));
    break;
  case 'n':
    store_count(to, &it, va_arg(*arguments, void *));
    break;
  case '\0':
    to->failed = 1;
    break;
  default:
    put_number(to, &it, arguments);
  }
}

char *__trax_format_wide(const char *format, va_list arguments, int *count) {
  struct text to = {0};
  va_list rest;
  va_copy(rest, arguments);
  put(&to, "", 0);
  while (*format && !to.failed) {
    const size_t plain = strcspn(format, "%");
    put(&to, format, plain);
    format += plain;
    if (*format++ == '\0')
      break;
    format_one(&to, &format, &rest);
  }
  va_end(rest);
  *count = to.failed ? -1 : (int)to.count;
  if (!to.failed)
    return to.bytes;
  free(to.bytes);
  return NULL;
}
