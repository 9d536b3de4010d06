/* The formatting engine: flags, width, precision, integers and strings. Frames are small throughout: a program has 512
   bytes of stack. */
#include "format.h"

#include "../internal/machine.h"

#include <string.h>

/* Inlining would put every conversion's variables into one frame. */
#define SEPARATE __attribute__((noinline))

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

SEPARATE static void format_string(struct sink *out, struct conversion *how, const char *s) {
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
SEPARATE static void format_integer(struct sink *out, struct conversion *how, const char *prefix,
                                    unsigned long long x) {
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

static const char *parse_length(const char *f, struct conversion *how) {
  how->length = LENGTH_INT;
  switch (*f) {
  case 'h':
    how->length = f[1] == 'h' ? LENGTH_CHAR : LENGTH_SHORT;
    return f + 1 + (f[1] == 'h');
  case 'l':
    how->length = f[1] == 'l' ? LENGTH_LONG_LONG : LENGTH_LONG;
    return f + 1 + (f[1] == 'l');
  case 'j':
    how->length = LENGTH_LONG_LONG;
    return f + 1;
  case 'z':
  case 't':
    how->length = LENGTH_LONG;
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

/* A va_list that functions can advance for their caller, whatever kind of type it is. */
struct arguments {
  va_list list;
};

/* What stands between % and the letter, and the letter; returns where it is. */
SEPARATE static const char *parse_conversion(const char *f, struct conversion *how, struct arguments *arguments) {
  f = parse_flags(f, how);
  if (*f == '*') {
    how->width = va_arg(arguments->list, int);
    if (how->width < 0) {
      how->flags |= FLAG_LEFT;
      how->width = -how->width;
    }
    f++;
  } else {
    f = parse_number(f, &how->width);
  }
  how->precision = -1;
  if (*f == '.') {
    if (f[1] == '*') {
      how->precision = va_arg(arguments->list, int); /* negative: as if there were none */
      f += 2;
    } else {
      f = parse_number(f + 1, &how->precision);
    }
  }
  f = parse_length(f, how);
  how->is_upper = (unsigned)(*f - 'A') < 26;
  how->letter = (char)(*f | (how->is_upper ? 32 : 0));
  return f;
}

SEPARATE static void format_signed(struct sink *out, struct conversion *how, struct arguments *arguments) {
  long long value;
  if (how->length == LENGTH_LONG_LONG)
    value = va_arg(arguments->list, long long);
  else if (how->length == LENGTH_LONG)
    value = va_arg(arguments->list, long);
  else
    value = va_arg(arguments->list, int);
  if (how->length == LENGTH_SHORT)
    value = (short)value;
  else if (how->length == LENGTH_CHAR)
    value = (signed char)value;
  const char *prefix = value < 0 ? "-" : how->flags & FLAG_PLUS ? "+" : how->flags & FLAG_SPACE ? " " : "";
  how->letter = 'u';
  format_integer(out, how, prefix, value < 0 ? 0 - (unsigned long long)value : (unsigned long long)value);
}

SEPARATE static void format_unsigned(struct sink *out, struct conversion *how, struct arguments *arguments) {
  unsigned long long value;
  if (how->length == LENGTH_LONG_LONG)
    value = va_arg(arguments->list, unsigned long long);
  else if (how->length == LENGTH_LONG)
    value = va_arg(arguments->list, unsigned long);
  else
    value = va_arg(arguments->list, unsigned);
  if (how->length == LENGTH_SHORT)
    value = (unsigned short)value;
  else if (how->length == LENGTH_CHAR)
    value = (unsigned char)value;
  const char *prefix = "";
  if (how->letter == 'x' && how->flags & FLAG_ALT && value)
    prefix = how->is_upper ? "0X" : "0x";
  format_integer(out, how, prefix, value);
}

SEPARATE static void format_character(struct sink *out, struct conversion *how, char c) {
  int start = out->count;
  how->flags &= (unsigned char)~FLAG_ZERO;
  trax_put_prefix(out, how, "", 1);
  trax_put(out, c);
  trax_put_suffix(out, how, start);
}

int trax_format(struct sink *out, const char *format, va_list list, double_formatter *format_double) {
  struct conversion how;
  struct arguments arguments;
  va_copy(arguments.list, list);
  for (const char *f = format; *f; f++) {
    if (*f != '%') {
      trax_put(out, *f);
      continue;
    }
    f = parse_conversion(f + 1, &how, &arguments);
    switch (how.letter) {
    case 'd':
    case 'i':
      format_signed(out, &how, &arguments);
      break;
    case 'u':
    case 'o':
    case 'x':
      format_unsigned(out, &how, &arguments);
      break;
    case 'p':
      how.letter = 'x';
      format_integer(out, &how, "0x", (unsigned long)va_arg(arguments.list, void *));
      break;
    case 'c':
      format_character(out, &how, (char)va_arg(arguments.list, int));
      break;
    case 's':
      format_string(out, &how, va_arg(arguments.list, const char *));
      break;
    case 'a':
    case 'e':
    case 'f':
    case 'g': {
      double value = va_arg(arguments.list, double);
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
      f--; /* the format ends within a conversion */
      break;
    default: /* not a conversion: visible in the output rather than silently gone */
      trax_put(out, '%');
      trax_put(out, *f);
    }
  }
  va_end(arguments.list);
  return out->count;
}
