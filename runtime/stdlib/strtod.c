/* Floating-point numbers from text, correctly rounded. Exact arithmetic in integers turns the decimal digits into as
   many binary ones as a significand takes, and a sticky bit. */
#include "../internal/divide.h"
#include "../internal/machine.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>

/* Inlining would put everything's variables into one frame. */
#define SEPARATE __attribute__((noinline))

/* digits[0 .. point-1] are the digits before the decimal point in base 10^9, the others those after it. There may be
   309 decimal digits before the point and 340 zeros after it. No number halfway between two doubles has more than 767
   digits from the first that is not 0 on, so of further digits it matters only whether they are zeros. */
#define SIGNIFICANT 774
#define LIMBS (39 + SIGNIFICANT / 9)
#define BITS_AT_A_TIME 29 /* 2^29 < 10^9: a limb times that carries less than a limb */
#define INTEGER_WORDS 33

/* In global memory, one for all threads: it is larger than a stack. */
static struct {
  uint32_t digits[LIMBS];
  int first, last, point; /* limbs that may not be 0 */
  uint32_t integer[INTEGER_WORDS];
} shared;
static struct ticket_lock shared_lock;

/* significand * 2^exponent, and whether it is a little more than that. */
struct binary {
  uint64_t significand;
  int exponent;
  int sticky;
};

enum kind { NOT_A_NUMBER, ZERO, FINITE, INFINITE, NAN_NUMBER };

struct parsed {
  const char *end;
  enum kind kind;
  int is_negative;
  struct binary value;
};

/* The characters of a decimal number. */
struct decimal {
  const char *start; /* of the first digit that is not 0 */
  int count;         /* digits from there on */
  int power;         /* 0.ddd * 10^power */
};

/* The optional exponent: a letter (in lower case), a sign, decimal digits. */
static const char *parse_exponent(const char *p, char letter, int *exponent) {
  const char *start = p;
  *exponent = 0;
  if ((*p | 32) != letter)
    return start;
  p++;
  int negative = *p == '-';
  if (*p == '-' || *p == '+')
    p++;
  if (!isdigit(*p))
    return start;
  int value = 0;
  for (; isdigit(*p); p++)
    value = value < 100000000 ? 10 * value + (*p - '0') : value;
  *exponent = negative ? -value : value;
  return p;
}

/* Returns the end of the number, or NULL if there are no digits. */
SEPARATE static const char *parse_decimal(const char *p, struct decimal *d) {
  int digits = 0, point = 0, exponent;
  *d = (struct decimal){p, 0, 0};
  for (; isdigit(*p) || (*p == '.' && !point); p++) {
    if (*p == '.') {
      point = 1;
      continue;
    }
    digits = 1;
    if (d->count == 0 && *p == '0') {
      d->power -= point;
      continue;
    }
    if (d->count++ == 0)
      d->start = p;
    d->power += !point;
  }
  if (!digits)
    return NULL;
  p = parse_exponent(p, 'e', &exponent);
  d->power += exponent;
  return p;
}

/* From text to limbs. The power is from -339 to 309. */
SEPARATE static void read_digits(const struct decimal *d) {
  int before = d->power > 0 ? (d->power + 8) / 9 : 0; /* limbs before the point */
  int position = 9 * before - d->power;               /* of the next digit, from the first limb's first */
  shared.point = before;
  shared.first = position / 9;
  for (int i = 0; i < LIMBS; i++)
    shared.digits[i] = 0;
  uint32_t limb = 0;
  const char *p = d->start;
  int rest = 0;
  for (int i = 0; i < d->count; p++) {
    if (*p == '.')
      continue;
    i++;
    if (i > SIGNIFICANT) {
      rest |= *p != '0';
      continue;
    }
    limb = 10 * limb + (uint32_t)(*p - '0');
    if (++position % 9 == 0) {
      shared.digits[position / 9 - 1] = limb;
      limb = 0;
    }
  }
  shared.last = (position - 1) / 9;
  if (position % 9) {
    for (; position % 9; position++)
      limb *= 10;
    shared.digits[shared.last] = limb;
  }
  if (rest)
    shared.digits[shared.last] |= 1; /* the last digit read, far after any that decides, shows that more follow */
}

/* The integer part to words; returns how many. */
SEPARATE static int read_integer(void) {
  int count = 0;
  for (int i = shared.first; i < shared.point; i++) {
    uint32_t carry = shared.digits[i];
    for (int j = 0; j < count; j++) {
      uint64_t product = mul_wide(shared.integer[j], 1000000000u) + carry;
      shared.integer[j] = low_word(product);
      carry = high_word(product);
    }
    if (carry)
      shared.integer[count++] = carry;
  }
  if (shared.first < shared.point)
    shared.first = shared.point;
  return count;
}

/* The integer part of the fraction times 2^29. */
SEPARATE static uint32_t next_bits(void) {
  uint32_t carry = 0;
  while (shared.last >= shared.first && shared.digits[shared.last] == 0)
    shared.last--;
  for (int i = shared.last; i >= shared.first; i--) {
    struct divided r = divide_by_billion(((uint64_t)shared.digits[i] << BITS_AT_A_TIME) + carry);
    shared.digits[i] = r.remainder;
    carry = r.quotient;
  }
  if (shared.first > shared.point) {
    if (carry)
      shared.digits[--shared.first] = carry;
    return 0;
  }
  return carry;
}

static int fraction_is_zero(void) {
  for (int i = shared.first; i <= shared.last; i++)
    if (shared.digits[i])
      return 0;
  return 1;
}

SEPARATE static struct binary to_binary(const struct decimal *d) {
  struct binary b = {0, 0, 0};
  lock(&shared_lock);
  read_digits(d);
  int count = read_integer();
  const uint32_t *word = shared.integer;
  if (count > 2) {
    b.significand = words(word[count - 1], word[count - 2]);
    b.exponent = 32 * (count - 2);
    int zeros = leading_zeros64(b.significand);
    if (zeros) {
      b.significand = b.significand << zeros | word[count - 3] >> (32 - zeros);
      b.exponent -= zeros;
    }
    b.sticky = word[count - 3] << zeros != 0;
    for (int i = 0; i < count - 3; i++)
      b.sticky |= word[i] != 0;
  } else if (count) {
    b.significand = words(count == 2 ? word[1] : 0, word[0]);
  }
  /* Bits of the fraction until there are 58 or more. */
  while (b.significand >> 57 == 0 && shared.last >= shared.first) {
    uint32_t bits = next_bits();
    int space = b.significand ? leading_zeros64(b.significand) : 64;
    int step = space < BITS_AT_A_TIME ? space : BITS_AT_A_TIME;
    int left = BITS_AT_A_TIME - step;
    b.significand = b.significand << step | bits >> left;
    b.exponent -= step;
    b.sticky |= (bits & ((1u << left) - 1)) != 0;
  }
  b.sticky |= !fraction_is_zero();
  unlock(&shared_lock);
  return b;
}

static int hexadecimal_digit(char c) {
  return isdigit(c) ? c - '0' : (unsigned)((c | 32) - 'a') < 6 ? (c | 32) - 'a' + 10 : -1;
}

/* Parses what follows 0x. Returns the end, or NULL if there are no digits. */
SEPARATE static const char *parse_hexadecimal(const char *p, struct binary *b) {
  int digits = 0, point = 0, exponent;
  *b = (struct binary){0, 0, 0};
  for (int digit; (digit = hexadecimal_digit(*p)) >= 0 || (*p == '.' && !point); p++) {
    if (*p == '.') {
      point = 1;
      continue;
    }
    digits = 1;
    if (b->significand >> 60) {
      b->sticky |= digit != 0;
      b->exponent += point ? 0 : 4;
    } else {
      b->significand = b->significand << 4 | (unsigned)digit;
      b->exponent -= point ? 4 : 0;
    }
  }
  if (!digits)
    return NULL;
  p = parse_exponent(p, 'p', &exponent);
  b->exponent += exponent;
  return p;
}

/* The length of a word in lower case if the text begins with it in any case, else 0. */
static int matches(const char *text, const char *word) {
  int n = 0;
  for (; word[n]; n++)
    if ((text[n] | 32) != word[n])
      return 0;
  return n;
}

/* "nan" and perhaps letters, digits and underscores in parentheses. */
static const char *skip_payload(const char *p) {
  if (*p != '(')
    return p;
  const char *q = p + 1;
  while (isalnum(*q) || *q == '_')
    q++;
  return *q == ')' ? q + 1 : p;
}

SEPARATE static void parse(const char *text, struct parsed *n) {
  struct decimal d;
  const char *p = text;
  *n = (struct parsed){text, NOT_A_NUMBER, 0, {0, 0, 0}};
  while (isspace(*p))
    p++;
  if (*p == '+' || *p == '-')
    n->is_negative = *p++ == '-';
  int length;
  if ((length = matches(p, "infinity")) || (length = matches(p, "inf"))) {
    n->kind = INFINITE;
    n->end = p + length;
    return;
  }
  if (matches(p, "nan")) {
    n->kind = NAN_NUMBER;
    n->end = skip_payload(p + 3);
    return;
  }
  const char *end;
  if (p[0] == '0' && (p[1] | 32) == 'x' && (end = parse_hexadecimal(p + 2, &n->value))) {
    n->end = end;
    n->kind = n->value.significand ? FINITE : ZERO;
    return;
  }
  if (!(end = parse_decimal(p, &d))) {
    n->is_negative = 0;
    return;
  }
  n->end = end;
  n->kind = d.count == 0 || d.power < -339 ? ZERO : d.power > 309 ? INFINITE : FINITE;
  if (n->kind == FINITE)
    n->value = to_binary(&d);
  else if (d.count)
    errno = ERANGE;
}

static void set_end(const struct parsed *n, char **end) {
  if (end)
    *end = (char *)(uintptr_t)n->end;
}

/* Moves the significand's leading bit to bit 63. An exponent that is far out of range stays so. */
static void normalise(struct binary *b) {
  int zeros = leading_zeros64(b->significand);
  b->significand <<= zeros;
  b->exponent -= zeros;
}

/* Whether the number is a multiple of 2^power, which a subnormal one then has exactly. */
static int is_multiple(const struct binary *b, int power) {
  int below = power - b->exponent;
  return !b->sticky && (below <= 0 || (below < 64 && !(b->significand & (((uint64_t)1 << below) - 1))));
}

double strtod(const char *restrict text, char **restrict end) {
  struct parsed n;
  parse(text, &n);
  set_end(&n, end);
  uint64_t sign_bit = (uint64_t)n.is_negative << 63;
  if (n.kind == NAN_NUMBER)
    return bits_double(sign_bit | DOUBLE_NAN);
  if (n.kind != FINITE)
    return bits_double(sign_bit | (n.kind == INFINITE ? DOUBLE_INFINITY : 0));
  normalise(&n.value);
  uint64_t significand = n.value.significand >> 1 | (n.value.significand & 1) | (unsigned)n.value.sticky;
  double result = trax_round_double((uint32_t)n.is_negative, n.value.exponent + 1 + 1023 + 62, significand);
  uint32_t exponent = high_word(double_bits(result)) >> 20 & 0x7FF;
  if (exponent == 0x7FF || (exponent == 0 && !is_multiple(&n.value, -1074)))
    errno = ERANGE;
  return result;
}

float strtof(const char *restrict text, char **restrict end) {
  struct parsed n;
  parse(text, &n);
  set_end(&n, end);
  uint32_t sign_bit = (uint32_t)n.is_negative << 31;
  if (n.kind == NAN_NUMBER)
    return bits_float(sign_bit | FLOAT_NAN);
  if (n.kind != FINITE)
    return bits_float(sign_bit | (n.kind == INFINITE ? FLOAT_INFINITY : 0));
  normalise(&n.value);
  uint32_t significand =
      high_word(n.value.significand) | (low_word(n.value.significand) != 0) | (unsigned)n.value.sticky;
  float result = trax_round_float((uint32_t)n.is_negative, n.value.exponent + 32 + 127 + 31, significand);
  uint32_t exponent = float_bits(result) >> 23 & 0xFF;
  if (exponent == 0xFF || (exponent == 0 && !is_multiple(&n.value, -149)))
    errno = ERANGE;
  return result;
}

long double strtold(const char *restrict text, char **restrict end) {
  return strtod(text, end);
}

double atof(const char *text) {
  return strtod(text, NULL);
}
