// std::to_chars of floating-point numbers, on printf's formatting of doubles.
#include <bit>
#include <charconv>
#include <cmath>

#include <stdlib.h>
#include <string.h>

extern "C" {
#include "../stdio/format.h"
}

_LIBCPP_BEGIN_NAMESPACE_STD

namespace {

constexpr int most_digits = 17;

/// digits[0].digits[1]... * 10^exponent
struct decimal {
  char digits[most_digits];
  int count, exponent;
};

void print(sink &out, double value, char letter, int precision, unsigned char flags = 0) {
  const conversion how = {flags, letter, 0, 0, 0, precision};
  trax_format_double(&out, &how, value);
}

/// The number of so many digits that is nearest to value, which is finite and not negative.
decimal nearest(double value, int count) {
  char text[most_digits + 8];
  sink out = {text, text + sizeof text - 1, 0};
  print(out, value, 'e', count - 1);
  *out.at = 0;
  decimal number = {{text[0]}, count, atoi(strchr(text, 'e') + 1)};
  memcpy(number.digits + 1, text + 2, static_cast<size_t>(count - 1));
  return number;
}

/// The next greater number of as many digits.
void increase(decimal &number) {
  for (int i = number.count - 1; i >= 0; i--) {
    if (number.digits[i] != '9') {
      number.digits[i]++;
      return;
    }
    number.digits[i] = '0';
  }
  number.digits[0] = '1';
  number.exponent++;
}

double to_number(const char *text, double) {
  return strtod(text, nullptr);
}
double to_number(const char *text, float) {
  return static_cast<double>(strtof(text, nullptr));
}

/// e+05
char *write_exponent(char *to, int exponent) {
  *to++ = 'e';
  *to++ = exponent < 0 ? '-' : '+';
  const int size = exponent < 0 ? -exponent : exponent;
  if (size > 99)
    *to++ = static_cast<char>('0' + size / 100);
  *to++ = static_cast<char>('0' + size / 10 % 10);
  *to++ = static_cast<char>('0' + size % 10);
  return to;
}

template <class Number> bool reads_as(const decimal &number, Number value) {
  char text[most_digits + 6];
  memcpy(text, number.digits, static_cast<size_t>(number.count));
  *write_exponent(text + number.count, number.exponent - (number.count - 1)) = 0;
  return to_number(text, value) == static_cast<double>(value);
}

/// Finds a number of so many digits that reads as value: the nearest, or the next greater one. The latter can read as a
/// power of two, since twice as many numbers above it do as below.
template <class Number> bool represent(decimal &number, Number value, bool is_power, int count) {
  number = nearest(static_cast<double>(value), count);
  if (reads_as(number, value))
    return true;
  if (!is_power)
    return false;
  increase(number);
  return reads_as(number, value);
}

/// The number with the fewest digits that reads as value, by bisection: if some digits suffice, so do more.
template <class Number> decimal shortest(Number value) {
  const uint64_t significand = bit_cast<uint64_t>(static_cast<double>(value)) << 12;
  int enough = sizeof(Number) == sizeof(float) ? 9 : most_digits, too_few = 0;
  decimal number = {}, found = {};
  represent(found, value, significand == 0, enough);
  while (enough - too_few > 1) {
    const int middle = (enough + too_few) / 2;
    if (represent(number, value, significand == 0, middle)) {
      enough = middle;
      found = number;
    } else {
      too_few = middle;
    }
  }
  return found;
}

void print_scientific(sink &out, const decimal &number) {
  trax_put(&out, number.digits[0]);
  for (int i = 1; i < number.count; i++) {
    if (i == 1)
      trax_put(&out, '.');
    trax_put(&out, number.digits[i]);
  }
  char exponent[5];
  for (const char *p = exponent, *end = write_exponent(exponent, number.exponent); p != end;)
    trax_put(&out, *p++);
}

/// Prints all digits of an integer, which takes no more characters.
void print_fixed(sink &out, const decimal &number, double value) {
  const int exponent = number.exponent;
  if (exponent >= number.count - 1) {
    print(out, value, 'f', 0);
    return;
  }
  for (int i = exponent < 0 ? exponent : 0; i < number.count; i++) { // zeros before the first digit
    trax_put(&out, i < 0 ? '0' : number.digits[i]);
    if (i == exponent)
      trax_put(&out, '.');
  }
}

/// Whether it takes no more characters than in the scientific notation.
bool is_short_fixed(const decimal &number) {
  const int exponent = number.exponent, count = number.count;
  const int fixed = exponent < 0 ? count + 1 - exponent : exponent < count - 1 ? count + 1 : exponent + 1;
  return fixed <= count + (count > 1) + (exponent > 99 || exponent < -99 ? 5 : 4);
}

template <class Number> void print_shortest(sink &out, Number value, chars_format format) {
  const decimal number = shortest(value);
  if (format == chars_format::fixed ||
      (format == chars_format::general && number.exponent >= -4 && number.exponent < 6) ||
      (format == chars_format{} && is_short_fixed(number)))
    print_fixed(out, number, static_cast<double>(value));
  else
    print_scientific(out, number);
}

/// Prints like printf with %f, %e, %g or %a; without a precision, the shortest decimal number that reads as value.
template <class Number>
to_chars_result convert(char *first, char *last, Number value, chars_format format, bool is_shortest, int precision) {
  if (first == last)
    return {last, errc::value_too_large};
  sink out = {first, last, 0};
  if (signbit(value))
    trax_put(&out, '-');
  const Number magnitude = fabs(value);
  if (format == chars_format::hex)
    print(out, static_cast<double>(magnitude), 'a', precision, FLAG_BARE);
  else if (!is_shortest || !isfinite(value))
    print(out, static_cast<double>(magnitude),
          format == chars_format::fixed        ? 'f'
          : format == chars_format::scientific ? 'e'
                                               : 'g',
          precision);
  else
    print_shortest(out, magnitude, format);
  return out.count <= last - first ? to_chars_result{first + out.count, errc{}}
                                   : to_chars_result{last, errc::value_too_large};
}

} // namespace

#define TO_CHARS(type, arithmetic)                                                                                     \
  to_chars_result to_chars(char *first, char *last, type value) {                                                      \
    return convert(first, last, static_cast<arithmetic>(value), chars_format{}, true, -1);                             \
  }                                                                                                                    \
  to_chars_result to_chars(char *first, char *last, type value, chars_format format) {                                 \
    return convert(first, last, static_cast<arithmetic>(value), format, true, -1);                                     \
  }                                                                                                                    \
  to_chars_result to_chars(char *first, char *last, type value, chars_format format, int precision) {                  \
    return convert(first, last, static_cast<arithmetic>(value), format, false, precision);                             \
  }
TO_CHARS(float, float)
TO_CHARS(double, double)
TO_CHARS(long double, double)

_LIBCPP_END_NAMESPACE_STD
