/* The formatting engine: flags, width, precision, integers and strings. Frames are small throughout: a program has 512
   bytes of stack. */
#include "format.h"

#include "../internal/machine.h"

#include <errno.h>
#include <stdint.h>
#include <string.h>

/* Weak: programs that do not use errno do not contain it. */
extern __thread int errno __attribute__((weak));

typedef __WINT_TYPE__ wint_t;

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

/* The bytes of c in UTF-8; returns how many, 0 if c is not a character. */
static int encode(char *bytes, wchar_t c) {
  uint32_t code = (uint32_t)c;
  if (code < 0x80) {
    bytes[0] = (char)code;
    return 1;
  }
  if (code > 0x10FFFF || code - 0xD800 < 0x800)
    return 0;
  int size = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  for (int i = size - 1; i > 0; i--, code >>= 6)
    bytes[i] = (char)(0x80 | (code & 0x3F));
  bytes[0] = (char)(0xF00 >> size | code);
  return size;
}

/* Formats one character, or a string as far as whole characters fit the precision. Returns 0 and prints nothing if a
   character cannot be encoded. */
SEPARATE static int format_wide(struct sink *out, struct conversion *how, const wchar_t *s, int is_string) {
  char bytes[4];
  int length = 0, size = 0, limit = is_string && how->precision >= 0 ? how->precision : __INT_MAX__;
  const wchar_t *end = s;
  while (length < limit && (*end || !is_string)) {
    if ((size = encode(bytes, *end)) == 0)
      return 0;
    if (size > limit - length)
      break;
    length += size;
    end++;
    if (!is_string)
      break;
  }
  int start = out->count;
  how->flags &= (unsigned char)~FLAG_ZERO;
  trax_put_prefix(out, how, "", length);
  for (; s != end; s++) {
    size = encode(bytes, *s);
    for (int i = 0; i < size; i++)
      trax_put(out, bytes[i]);
  }
  trax_put_suffix(out, how, start);
  return 1;
}

SEPARATE static int format_wide_character(struct sink *out, struct conversion *how, wchar_t c) {
  return format_wide(out, how, &c, 0);
}

/* how->letter is u, o, x or b. */
SEPARATE static void format_integer(struct sink *out, struct conversion *how, const char *prefix,
                                    unsigned long long x) {
  char digits[20]; /* of decimal numbers */
  char *p = digits + sizeof digits;
  int shift = how->letter == 'x' ? 4 : how->letter == 'o' ? 3 : how->letter == 'b';
  int count = 0; /* of digits; none for 0 */
  if (shift) {
    for (unsigned long long rest = x; rest; rest >>= shift)
      count++;
  } else {
    for (; x >> 32; x /= 10)
      *--p = (char)('0' + (int)(x % 10));
    for (unsigned low = (unsigned)x; low; low /= 10)
      *--p = (char)('0' + low % 10);
    count = (int)(digits + sizeof digits - p);
  }
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
  while (count--)
    trax_put(out, shift ? (how->is_upper ? "0123456789ABCDEF"
                                         : "0123456789abcdef")[(unsigned)(x >> count * shift) & ((1u << shift) - 1)]
                        : *p++);
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
  case 'q':
  case 'L': /* long double is double */
    how->length = LENGTH_LONG_LONG;
    return f + 1;
  case 'z':
  case 't':
    how->length = sizeof(size_t) == sizeof(int) ? LENGTH_INT : LENGTH_LONG;
    return f + 1;
  default:
    return f;
  }
}

static const char *parse_flags(const char *f, struct conversion *how) {
  static const char flags[] = "-+ #0'"; /* in the order of FLAG_LEFT and so on */
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

/* A va_list that functions can advance for their caller, for any type of va_list. */
struct arguments {
  va_list list;
};

/* Reads the part between % and the letter, and the letter; returns the letter's place. */
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
  how->is_upper = *f && strchr("XBAEFG", *f);
  how->letter = (char)(*f | (how->is_upper ? 32 : 0));
  if (*f == 'C' || *f == 'S') {
    how->length = LENGTH_LONG;
    how->letter = (char)(*f | 32);
  }
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
  if (how->flags & FLAG_ALT && value)
    prefix = how->letter == 'x' ? how->is_upper ? "0X" : "0x" : how->letter == 'b' ? how->is_upper ? "0B" : "0b" : "";
  format_integer(out, how, prefix, value);
}

SEPARATE static void format_character(struct sink *out, struct conversion *how, char c) {
  int start = out->count;
  how->flags &= (unsigned char)~FLAG_ZERO;
  trax_put_prefix(out, how, "", 1);
  trax_put(out, c);
  trax_put_suffix(out, how, start);
}

SEPARATE static void store_count(int count, const struct conversion *how, void *to) {
  switch (how->length) {
  case LENGTH_CHAR:
    *(signed char *)to = (signed char)count;
    break;
  case LENGTH_SHORT:
    *(short *)to = (short)count;
    break;
  case LENGTH_LONG:
    *(long *)to = count;
    break;
  case LENGTH_LONG_LONG:
    *(long long *)to = count;
    break;
  default:
    *(int *)to = count;
  }
}

/* Arguments after that of an unknown conversion cannot be found. The message is in global memory, where the host reads
   it; if two threads write it at once, the host gets one of them. */
__attribute__((noreturn)) SEPARATE static void refuse(const char *why, const char *letter) {
  static char message[64];
  char *to = message;
  const char *conversion = letter;
  while (*conversion != '%')
    conversion--;
  while (*why)
    *to++ = *why++;
  while (to < message + sizeof message - 1 && conversion <= letter && *conversion)
    *to++ = *conversion++;
  *to = 0;
  machine_abort(message);
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
    case 'b':
      format_unsigned(out, &how, &arguments);
      break;
    case 'p':
      how.letter = 'x';
      format_integer(out, &how, "0x", (unsigned long)va_arg(arguments.list, void *));
      break;
    case 'c':
      if (how.length != LENGTH_LONG)
        format_character(out, &how, (char)va_arg(arguments.list, int));
      else if (!format_wide_character(out, &how, (wchar_t)va_arg(arguments.list, wint_t)))
        goto not_encoded;
      break;
    case 's': {
      const void *s = va_arg(arguments.list, const void *);
      if (how.length != LENGTH_LONG || !s)
        format_string(out, &how, s);
      else if (!format_wide(out, &how, s, 1))
        goto not_encoded;
      break;
    }
    case 'a':
    case 'e':
    case 'f':
    case 'g':
      if (!format_double)
        refuse("iprintf formats no doubles: ", f);
      format_double(out, &how, va_arg(arguments.list, double));
      break;
    case 'n':
      store_count(out->count, &how, va_arg(arguments.list, void *));
      break;
    case '%':
      trax_put(out, '%');
      break;
    default:
      refuse("printf: unknown conversion: ", f);
    }
  }
  va_end(arguments.list);
  return out->count;

not_encoded:
  va_end(arguments.list);
  if (&errno)
    errno = EILSEQ;
  return -1;
}
