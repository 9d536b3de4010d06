// RUN: %run_c %s %t --turns -O2,-Os --cflags -std=c++20 --simflags "--engine functional"
// std::to_chars of float and double. Expected output by g++ -std=c++20 -O2 (libstdc++).
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <limits>

static uint64_t state = 1;
static uint64_t random64() {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return state;
}

static uint32_t hash;
static int printed;
static char text[2000];

static void use(std::to_chars_result result) {
  *result.ptr = 0;
  if (result.ec != std::errc{})
    std::strcpy(text, "too large");
  for (const char *p = text; *p; p++)
    hash = (hash ^ static_cast<unsigned char>(*p)) * 16777619u;
  hash = (hash ^ '\n') * 16777619u;
  if (printed-- > 0)
    std::puts(text);
}

template <class Number> static void all(Number x) {
  using std::chars_format;
  char *end = text + sizeof text - 1;
  use(std::to_chars(text, end, x));
  use(std::to_chars(text, end, x, chars_format::scientific));
  use(std::to_chars(text, end, x, chars_format::fixed));
  use(std::to_chars(text, end, x, chars_format::general));
  if (std::isnormal(x) || x == 0) // libstdc++ normalises the others
    use(std::to_chars(text, end, x, chars_format::hex));
  for (int precision : {0, 3, 20}) {
    use(std::to_chars(text, end, x, chars_format::scientific, precision));
    use(std::to_chars(text, end, x, chars_format::fixed, precision));
    use(std::to_chars(text, end, x, chars_format::general, precision));
    if (std::isnormal(x) || x == 0)
      use(std::to_chars(text, end, x, chars_format::hex, precision));
  }
}

template <class Number, class Bits> static void some(int count) {
  static const double special[] = {
      0, -0.0, 1, -1, 0.1, 1e5, 123456, 1234567, 1e21, 1e22, 1e23, 9007199254740993.0, 5e-324,
      2.2250738585072014e-308, 1.7976931348623157e308, 5.684341886080801e-14, 1e-7, 0.001, 0.0001, 1e-5, 3.4028235e38,
      1.1754944e-38, 1.4e-45, 33554432, 8.589973e9, 100, 1e16, 1e17, 0.3};
  for (double x : special) {
    all(static_cast<Number>(x));
    std::printf("%08x\n", static_cast<unsigned>(hash));
  }
  // Powers of two, below which there is half as much room.
  for (int e = std::numeric_limits<Number>::min_exponent - 24; e < std::numeric_limits<Number>::max_exponent; e += 3)
    use(std::to_chars(text, text + 100, std::ldexp(static_cast<Number>(1), e)));
  std::printf("%08x\n", static_cast<unsigned>(hash));
  for (int i = 0; i < count; i++) {
    Number x;
    Bits bits = static_cast<Bits>(random64());
    std::memcpy(&x, &bits, sizeof x);
    if (i & 1) // of few digits
      x = static_cast<Number>(static_cast<int>(random64() % 200000) - 100000) /
          static_cast<Number>(1 << random64() % 10);
    if (!std::isfinite(x))
      continue;
    use(std::to_chars(text, text + 100, x));
    use(std::to_chars(text, text + 100, x, std::chars_format::scientific));
  }
  std::printf("%08x\n", static_cast<unsigned>(hash));
}

int main() {
  printed = 60;
  some<double, uint64_t>(100);
  printed = 60;
  some<float, uint32_t>(100);
  // Results that do not fit, and results that just fit.
  for (int size = 0; size < 8; size++) {
    std::memset(text, '#', 12);
    auto result = std::to_chars(text, text + size, -12.25);
    std::printf("%d %d %d\n", size, static_cast<int>(result.ptr - text), result.ec == std::errc::value_too_large);
    if (result.ec == std::errc{})
      std::printf("%.8s\n", text);
  }
  return 0;
}
