/* Integers from text. */
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>

static int digit_value(int c) {
  if (isdigit(c))
    return c - '0';
  return isalpha(c) ? (c | 32) - 'a' + 10 : 99;
}

#define LONG_LIMIT ((unsigned long)__LONG_MAX__) /* <limits.h> of a host compiler may need the host's own */
#define LONG_LONG_LIMIT ((unsigned long long)__LONG_LONG_MAX__)

/* The number's sign and magnitude, which is the limit for that sign if the text overflows it. */
struct parsed {
  unsigned long long magnitude;
  short negative, overflow;
};

static struct parsed parse(const char *text, char **end, int base, unsigned long long positive_limit,
                           unsigned long long negative_limit) {
  const char *p = text;
  struct parsed number = {0, 0, 0};
  while (isspace(*p))
    p++;
  if (*p == '+' || *p == '-')
    number.negative = *p++ == '-';
  if ((base == 0 || base == 16) && p[0] == '0' && (p[1] | 32) == 'x' && digit_value(p[2]) < 16) {
    p += 2;
    base = 16;
  }
  if (base == 0)
    base = *p == '0' ? 8 : 10;
  if (base < 2 || base > 36) {
    errno = EINVAL;
    if (end)
      *end = (char *)(unsigned long)text;
    return (struct parsed){0, 0, 0};
  }
  unsigned long long limit = number.negative ? negative_limit : positive_limit;
  const char *digits = p;
  for (int digit; (digit = digit_value(*p)) < base; p++) {
    /* Multiplying in halves shows the overflow without a division. */
    unsigned long long low = (number.magnitude & 0xFFFFFFFF) * (unsigned)base + (unsigned)digit;
    unsigned long long high = (number.magnitude >> 32) * (unsigned)base + (low >> 32);
    number.magnitude = high << 32 | (low & 0xFFFFFFFF);
    if (high >> 32 || number.magnitude > limit)
      number.overflow = 1;
    if (number.overflow)
      number.magnitude = limit;
  }
  if (number.overflow)
    errno = ERANGE;
  if (end)
    *end = (char *)(unsigned long)(p == digits ? text : p);
  return number;
}

static long long signed_value(struct parsed number) {
  return (long long)(number.negative ? 0 - number.magnitude : number.magnitude);
}

long long strtoll(const char *restrict text, char **restrict end, int base) {
  return signed_value(parse(text, end, base, LONG_LONG_LIMIT, LONG_LONG_LIMIT + 1));
}

long strtol(const char *restrict text, char **restrict end, int base) {
  return (long)signed_value(parse(text, end, base, LONG_LIMIT, LONG_LIMIT + 1));
}

/* A minus sign negates modulo the type's range, as C has it; a number out of range gives the greatest value. */
unsigned long long strtoull(const char *restrict text, char **restrict end, int base) {
  struct parsed number = parse(text, end, base, ~0ull, ~0ull);
  return number.negative && !number.overflow ? 0 - number.magnitude : number.magnitude;
}

unsigned long strtoul(const char *restrict text, char **restrict end, int base) {
  struct parsed number = parse(text, end, base, ~0ul, ~0ul);
  unsigned long magnitude = (unsigned long)number.magnitude;
  return number.negative && !number.overflow ? 0 - magnitude : magnitude;
}

long long atoll(const char *text) {
  return strtoll(text, NULL, 10);
}
long atol(const char *text) {
  return strtol(text, NULL, 10);
}
int atoi(const char *text) {
  return (int)strtol(text, NULL, 10);
}

intmax_t strtoimax(const char *restrict text, char **restrict end, int base) {
  return strtoll(text, end, base);
}
uintmax_t strtoumax(const char *restrict text, char **restrict end, int base) {
  return strtoull(text, end, base);
}
