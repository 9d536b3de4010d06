/* The formatting engine: flags, width, precision, integers and strings. Frames are small throughout: a program has 512
   bytes of stack. */
#include "format.h"

#include "../internal/machine.h"

#include <string.h>

void trax_put(struct sink *out, int c) {
  out->count++;
  if (!out->at)
    machine_put_char(c);
  else if (out->at < out->end)
    *out->at++ = (char)c;
}

void trax_put_repeated(struct sink *out, int c, int count) {
  for (; count > 0; count--)
    trax_put(out, c);
}

void trax_put_prefix(struct sink *out, const struct conversion *how, const char *prefix, int body) {
  int padding = how->width - body - (int)strlen(prefix);
  if (!(how->flags & (FLAG_LEFT | FLAG_ZERO)))
    trax_put_repeated(out, ' ', padding);
  while (*prefix)
    trax_put(out, *prefix++);
  if ((how->flags & (FLAG_LEFT | FLAG_ZERO)) == FLAG_ZERO)
    trax_put_repeated(out, '0', padding);
}

void trax_put_suffix(struct sink *out, const struct conversion *how, int start) {
  if (how->flags & FLAG_LEFT)
    trax_put_repeated(out, ' ', how->width - (out->count - start));
}

static void format_string(struct sink *out, struct conversion *how, const char *s) {
  if (!s)
    s = "(null)";
  int length = (int)(how->precision < 0 ? strlen(s) : strnlen(s, (size_t)how->precision));
  int start = out->count;
  how->flags &= (unsigned char)~FLAG_ZERO;
  trax_put_prefix(out, how, "", length);
  while (length--)
    trax_put(out, *s++);
  trax_put_suffix(out, how, start);
}

/* The digits of x, written to end at end; returns where they begin. No digits for 0. */
static char *write_digits(char *end, unsigned long long x, const struct conversion *how) {
  if (how->letter == 'u') {
    for (; x >> 32; x /= 10)
      *--end = (char)('0' + (int)(x % 10));
    for (unsigned low = (unsigned)x; low; low /= 10)
      *--end = (char)('0' + low % 10);
    return end;
  }
  int shift = how->letter == 'o' ? 3 : 4;
  for (; x; x >>= shift)
    *--end = (how->is_upper ? "0123456789ABCDEF" : "0123456789abcdef")[(unsigned)x & ((1u << shift) - 1)];
  return end;
}

/* how->letter is u, o or x. */
static void format_integer(struct sink *out, struct conversion *how, const char *prefix, unsigned long long x) {
  char digits[22]; /* 64 bits in octal */
  char *p = write_digits(digits + sizeof digits, x, how);
  int count = (int)(digits + sizeof digits - p);
  int precision = how->precision;
  if (precision >= 0)
    how->flags &= (unsigned char)~FLAG_ZERO;
  else
    precision = 1;
  if (how->letter == 'o' && how->flags & FLAG_ALT && precision <= count)
    precision = count + 1;
  if (precision < count)
    precision = count;
  int start = out->count;
  trax_put_prefix(out, how, prefix, precision);
  trax_put_repeated(out, '0', precision - count);
  for (; count; count--)
    trax_put(out, *p++);
  trax_put_suffix(out, how, start);
}

/* Length modifiers as sizes. */
enum length { LENGTH_CHAR, LENGTH_SHORT, LENGTH_INT, LENGTH_LONG, LENGTH_LONG_LONG };

static const char *parse_length(const char *f, enum length *length) {
  *length = LENGTH_INT;
  switch (*f) {
  case 'h':
    *length = f[1] == 'h' ? LENGTH_CHAR : LENGTH_SHORT;
    return f + 1 + (f[1] == 'h');
  case 'l':
    *length = f[1] == 'l' ? LENGTH_LONG_LONG : LENGTH_LONG;
    return f + 1 + (f[1] == 'l');
  case 'j':
    *length = LENGTH_LONG_LONG;
    return f + 1;
  case 'z':
  case 't':
    *length = LENGTH_LONG;
    return f + 1;
  case 'L':
    return f + 1; /* long double is double */
  default:
    return f;
  }
}

static const char *parse_flags(const char *f, struct conversion *how) {
  static const char flags[] = "-+ #0";
  const char *flag;
  how->flags = 0;
  while (*f && (flag = strchr(flags, *f))) {
    how->flags |= (unsigned char)(1 << (flag - flags));
    f++;
  }
  return f;
}

static const char *parse_number(const char *f, int *value) {
  int n = 0;
  for (; (unsigned)(*f - '0') < 10; f++)
    n = n < 100000000 ? 10 * n + (*f - '0') : n;
  *value = n;
  return f;
}

int trax_format(struct sink *out, const char *format, va_list arguments, double_formatter *format_double) {
  struct conversion how;
  for (const char *f = format; *f; f++) {
    if (*f != '%') {
      trax_put(out, *f);
      continue;
    }
    f = parse_flags(f + 1, &how);
    if (*f == '*') {
      how.width = va_arg(arguments, int);
      if (how.width < 0) {
        how.flags |= FLAG_LEFT;
        how.width = -how.width;
      }
      f++;
    } else {
      f = parse_number(f, &how.width);
    }
    how.precision = -1;
    if (*f == '.') {
      if (f[1] == '*') {
        how.precision = va_arg(arguments, int); /* negative: as if there were none */
        f += 2;
      } else {
        f = parse_number(f + 1, &how.precision);
      }
    }
    enum length length;
    f = parse_length(f, &length);
    how.is_upper = (unsigned)(*f - 'A') < 26;
    how.letter = (char)(*f | (how.is_upper ? 32 : 0));
    const char *prefix = "";
    unsigned long long x;
    switch (how.letter) {
    case 'd':
    case 'i': {
      long long value = length == LENGTH_LONG_LONG ? va_arg(arguments, long long)
                        : length == LENGTH_LONG    ? va_arg(arguments, long)
                                                   : va_arg(arguments, int);
      value = length == LENGTH_SHORT ? (short)value : length == LENGTH_CHAR ? (signed char)value : value;
      prefix = value < 0 ? "-" : how.flags & FLAG_PLUS ? "+" : how.flags & FLAG_SPACE ? " " : "";
      x = value < 0 ? 0 - (unsigned long long)value : (unsigned long long)value;
      how.letter = 'u';
      format_integer(out, &how, prefix, x);
      break;
    }
    case 'u':
    case 'o':
    case 'x':
      x = length == LENGTH_LONG_LONG ? va_arg(arguments, unsigned long long)
          : length == LENGTH_LONG    ? va_arg(arguments, unsigned long)
                                     : va_arg(arguments, unsigned);
      x = length == LENGTH_SHORT ? (unsigned short)x : length == LENGTH_CHAR ? (unsigned char)x : x;
      if (how.letter == 'x' && how.flags & FLAG_ALT && x)
        prefix = how.is_upper ? "0X" : "0x";
      format_integer(out, &how, prefix, x);
      break;
    case 'p':
      x = (unsigned long)va_arg(arguments, void *);
      how.letter = 'x';
      format_integer(out, &how, "0x", x);
      break;
    case 'c': {
      char c = (char)va_arg(arguments, int);
      how.precision = -1;
      int start = out->count;
      how.flags &= (unsigned char)~FLAG_ZERO;
      trax_put_prefix(out, &how, "", 1);
      trax_put(out, c);
      trax_put_suffix(out, &how, start);
      break;
    }
    case 's':
      format_string(out, &how, va_arg(arguments, const char *));
      break;
    case 'a':
    case 'e':
    case 'f':
    case 'g': {
      double value = va_arg(arguments, double);
      if (format_double)
        format_double(out, &how, value);
      else
        trax_put(out, '?');
      break;
    }
    case '%':
      trax_put(out, '%');
      break;
    case 0:
      return out->count;
    default: /* not a conversion: visible in the output rather than silently gone */
      trax_put(out, '%');
      trax_put(out, *f);
    }
  }
  return out->count;
}
