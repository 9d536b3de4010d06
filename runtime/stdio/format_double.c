/* Doubles in decimal and hexadecimal, exactly: every digit printed is a digit of the number's binary value, rounded
   once to nearest, ties to even. Integers only; no binary64 arithmetic is needed. */
#include "format.h"

#include "../internal/divide.h"
#include "../internal/machine.h"

/* Inlining would put everything's variables into one frame. */
#define SEPARATE __attribute__((noinline))

/* The decimal digits of mantissa * 2^exponent from the first to the last, nine at a time. The integer part is held in
   base 10^9; the fraction, which takes the same array when the integer part is through, in base 2^32: multiplied by
   10^9, it yields nine more digits. The greatest double has 309 digits, 35 limbs; the least has 1074 bits after the
   point, 34 limbs. */
#define LIMBS 35
#define BASE 1000000000u

/* A number rounded to a digit: what to change in its digits. */
struct rounded {
  int power;        /* of the first digit, after rounding */
  int count;        /* digits to print, from the first */
  int incremented;  /* the digit that rounding increments, after which 9s become 0; -1: all are 9, a 1 precedes them;
                       or count */
  int last_nonzero; /* the last digit that is not 0, after rounding; -1 if there is none */
};

struct digits {
  struct rounded rounded;
  uint64_t mantissa;
  int exponent;
  unsigned char integer_limbs;  /* not yet read */
  unsigned char fraction_limbs; /* from first_limb on */
  unsigned char first_limb;     /* those below are zero */
  uint32_t group, divisor; /* digits of the current group that are not yet read, and the place of the first of them */
  uint32_t limb[LIMBS];
};

/* In global memory, one for all threads: it would take a third of a stack. */
static struct digits shared_digits;
static struct ticket_lock digits_lock;

SEPARATE static void start_integer(struct digits *d) {
  int shift = d->exponent;
  d->integer_limbs = 0;
  if (shift <= -64)
    return;
  uint64_t x = shift < 0 ? d->mantissa >> -shift : d->mantissa;
  int n = 0;
  while (x) {
    struct divided r = divide_by_billion(x);
    d->limb[n++] = r.remainder;
    x = r.quotient;
  }
  while (shift > 0) {
    int step = shift < 29 ? shift : 29;
    uint32_t carry = 0;
    for (int i = 0; i < n; i++) {
      struct divided r = divide_by_billion(((uint64_t)d->limb[i] << step) + carry);
      d->limb[i] = r.remainder;
      carry = r.quotient;
    }
    if (carry)
      d->limb[n++] = carry;
    shift -= step;
  }
  d->integer_limbs = (unsigned char)n;
}

/* Starts with the fraction. If it is shorter than the mantissa, the shift drops the integer bits at the top. */
SEPARATE static void start_fraction(struct digits *d) {
  int bits = -d->exponent; /* after the point */
  int limbs = bits > 0 ? (bits + 31) / 32 : 0;
  unsigned up = (unsigned)(32 * limbs - bits) & 31; /* the mantissa stands this much above the lowest limb's end */
  uint32_t low = low_word(d->mantissa), high = high_word(d->mantissa);
  for (int i = 3; i < limbs; i++)
    d->limb[i] = 0;
  d->limb[0] = low << up;
  d->limb[1] = high << up | low >> 1 >> (31 - up);
  d->limb[2] = high >> 1 >> (31 - up);
  d->first_limb = 0;
  d->fraction_limbs = (unsigned char)limbs;
}

static uint32_t next_group(struct digits *d) {
  if (d->integer_limbs) {
    uint32_t group = d->limb[--d->integer_limbs];
    if (d->integer_limbs == 0)
      start_fraction(d);
    return group;
  }
  while (d->first_limb < d->fraction_limbs && d->limb[d->first_limb] == 0)
    d->first_limb++;
  uint32_t carry = 0;
  for (int i = d->first_limb; i < d->fraction_limbs; i++) {
    uint64_t product = mul_wide(d->limb[i], BASE) + carry;
    d->limb[i] = low_word(product);
    carry = high_word(product);
  }
  return carry;
}

/* Sets d to the first digit that is not 0 and returns its power of ten. The number is not 0. */
SEPARATE static int first_digit(struct digits *d) {
  start_integer(d);
  int power = 9 * d->integer_limbs + 8;
  if (d->integer_limbs == 0) {
    start_fraction(d);
    power = 8;
  }
  do {
    d->group = next_group(d);
    power -= 9;
  } while (d->group == 0);
  for (d->divisor = BASE / 10; d->group < d->divisor; d->divisor /= 10)
    power--;
  return power;
}

SEPARATE static int next_digit(struct digits *d) {
  if (d->divisor == 0) {
    d->group = next_group(d);
    d->divisor = BASE / 10;
  }
  int digit = 0;
  for (; d->group >= d->divisor; d->group -= d->divisor)
    digit++;
  d->divisor /= 10;
  return digit;
}

static int rest_is_zero(const struct digits *d) {
  if (d->group)
    return 0;
  if (d->integer_limbs) {
    for (int i = 0; i < d->integer_limbs; i++)
      if (d->limb[i])
        return 0;
    return d->exponent >= 0 || d->mantissa << (64 + (d->exponent < -63 ? -63 : d->exponent)) == 0;
  }
  for (int i = d->first_limb; i < d->fraction_limbs; i++)
    if (d->limb[i])
      return 0;
  return 1;
}

/* Rounds the number to count digits, or, if count is negative, to places digits after the point. */
SEPARATE static void round_digits(struct digits *d, int count, int places) {
  struct rounded *r = &d->rounded;
  int power = 0, to_read = count < 0 ? places + 1 : count;
  r->last_nonzero = -1;
  if (d->mantissa) {
    power = first_digit(d);
    if (count < 0)
      to_read = power + 1 + places;
  }
  r->power = power;
  r->count = r->incremented = to_read < 0 ? 0 : to_read;
  if (d->mantissa == 0 || to_read < 0) /* far below the last place: 0 */
    return;
  int last_nonzero = -1, last_not_nine = -1, digit = 0;
  for (int i = 0; i < to_read; i++) {
    digit = next_digit(d);
    if (digit != 9)
      last_not_nine = i;
    if (digit)
      last_nonzero = i;
    else if (i > last_nonzero + 20 && rest_is_zero(d))
      break; /* only zeros follow; a precision of thousands need not read them */
  }
  int next = next_digit(d);
  if (next > 5 || (next == 5 && (digit & 1 || !rest_is_zero(d)))) {
    r->incremented = last_nonzero = last_not_nine;
    if (last_not_nine < 0) {
      r->power++;
      last_nonzero = 0;
      if (count < 0)
        r->count++;
    }
  }
  r->last_nonzero = last_nonzero;
}

/* Digit number i of the rounded number; called for i = 0, 1, 2 ... in turn. */
static int rounded_digit(struct digits *d, int i) {
  const struct rounded *r = &d->rounded;
  if (r->incremented < 0)
    return '0' + (i == 0);
  if (i > r->last_nonzero)
    return '0';
  return '0' + next_digit(d) + (i == r->incremented);
}

static int exponent_size(int power) {
  return power <= -100 || power >= 100 ? 5 : 4;
}

SEPARATE static void put_exponent(struct sink *out, int letter, int power, int least_digits) {
  trax_put(out, letter);
  trax_put(out, power < 0 ? '-' : '+');
  unsigned x = (unsigned)(power < 0 ? -power : power);
  unsigned least = least_digits == 2 ? 10 : 1;
  for (unsigned place = 1000; place; place /= 10)
    if (x >= place || place <= least)
      trax_put(out, '0' + (int)(x / place % 10));
}

SEPARATE static void format_decimal(struct sink *out, const struct conversion *how, const char *sign,
                                    struct digits *d) {
  const struct rounded *r = &d->rounded;
  int precision = how->precision < 0 ? 6 : how->precision;
  int fixed = how->letter == 'f';
  if (how->letter == 'g') {
    if (precision == 0)
      precision = 1;
    round_digits(d, precision, 0);
    fixed = r->power >= -4 && r->power < precision;
    int significant = how->flags & FLAG_ALT ? precision : r->last_nonzero + 1;
    precision = significant - 1 - (fixed ? r->power : 0);
    if (precision < 0)
      precision = 0;
  } else {
    round_digits(d, fixed ? -1 : precision + 1, precision);
  }
  int integers = fixed && r->power > 0 ? r->power + 1 : 1; /* digits before the point */
  int point = precision > 0 || how->flags & FLAG_ALT;
  trax_put_prefix(out, how, sign, integers + point + precision + (fixed ? 0 : exponent_size(r->power)));
  if (d->mantissa)
    first_digit(d); /* again from the first digit, to print them */
  /* Before the first digit, zeros. */
  int digit = fixed && r->last_nonzero >= 0 ? r->power + 1 - integers : 0;
  for (int i = 0; i < integers + precision; i++, digit++) {
    if (i == integers)
      trax_put(out, '.');
    trax_put(out, digit < 0 ? '0' : rounded_digit(d, digit));
  }
  if (point && precision == 0)
    trax_put(out, '.');
  if (!fixed)
    put_exponent(out, how->is_upper ? 'E' : 'e', r->power, 2);
}

/* 0xh.hhhp+d; a subnormal's first digit is 0. */
SEPARATE static void format_hexadecimal(struct sink *out, const struct conversion *how, const char *sign,
                                        uint64_t bits) {
  static const char lower[] = "0123456789abcdef", upper[] = "0123456789ABCDEF";
  int power = (int)(high_word(bits) >> 20 & 0x7FF);
  uint64_t m = bits & 0x000FFFFFFFFFFFFFu;
  if (power)
    m |= 0x0010000000000000u;
  power = power ? power - 1023 : m ? -1022 : 0;
  int precision = how->precision;
  if (precision < 0) {
    precision = 13;
    for (uint64_t rest = m; precision && (rest & 15) == 0; rest >>= 4)
      precision--;
  } else if (precision < 13) {
    int dropped = 52 - 4 * precision;
    uint64_t half = (uint64_t)1 << (dropped - 1), rest = m & (2 * half - 1);
    m -= rest;
    if (rest > half || (rest == half && m >> dropped & 1))
      m += 2 * half;
  }
  char prefix[4], *p = prefix;
  if (*sign)
    *p++ = *sign;
  if (!(how->flags & FLAG_BARE)) {
    *p++ = '0';
    *p++ = how->is_upper ? 'X' : 'x';
  }
  *p = 0;
  int point = precision > 0 || how->flags & FLAG_ALT;
  int size = power < 0 ? -power : power;
  trax_put_prefix(out, how, prefix, 1 + point + precision + 3 + (size > 9) + (size > 99) + (size > 999));
  for (int i = 0; i <= precision; i++) {
    trax_put(out, (how->is_upper ? upper : lower)[i > 13 ? 0 : m >> (52 - 4 * i) & 15]);
    if (i == 0 && point)
      trax_put(out, '.');
  }
  put_exponent(out, how->is_upper ? 'P' : 'p', power, 1);
}

void trax_format_double(struct sink *out, const struct conversion *how, double x) {
  uint64_t bits = double_bits(x);
  const char *sign = bits >> 63 ? "-" : how->flags & FLAG_PLUS ? "+" : how->flags & FLAG_SPACE ? " " : "";
  int start = out->count;
  int exponent = (int)(high_word(bits) >> 20 & 0x7FF);
  uint64_t fraction = bits & 0x000FFFFFFFFFFFFFu;
  if (exponent == 0x7FF) {
    struct conversion plain = *how;
    plain.flags &= (unsigned char)~FLAG_ZERO;
    trax_put_prefix(out, &plain, sign, 3);
    const char *name = fraction ? how->is_upper ? "NAN" : "nan" : how->is_upper ? "INF" : "inf";
    for (int i = 0; i < 3; i++)
      trax_put(out, name[i]);
  } else if (how->letter == 'a') {
    format_hexadecimal(out, how, sign, bits);
  } else {
    lock(&digits_lock);
    shared_digits.mantissa = exponent ? fraction | 0x0010000000000000u : fraction;
    shared_digits.exponent = (exponent ? exponent : 1) - 1075;
    format_decimal(out, how, sign, &shared_digits);
    unlock(&digits_lock);
  }
  trax_put_suffix(out, how, start);
}
