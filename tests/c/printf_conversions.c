// RUN: %run_c %s %t
// Expected output by hand.
// printf's wide characters, counts, binary numbers and extensions; no conversion shifts the arguments behind it.
#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

int main(void) {
  signed char c = -1;
  short s = -1;
  int n = -1;
  long l = -1;
  long long ll = -1;
  intmax_t j = -1;
  size_t z = 99;
  ptrdiff_t t = -1;
  printf("1%hhn 2%hn %d%n %s%ln %.1f%lln %jn%zn%%%tn|%d\n", &c, &s, 33, &n, "four", &l, 5.5, &ll, &j, &z, &t, 6);
  printf("%d %d %d %ld %lld %jd %zu %td\n", c, s, n, l, ll, j, z, t);
  iprintf("%d%n\n", 12345, &n);
  printf("%d\n", n);

  const wchar_t text[] = L"a\u00e9\u20ac\U0001F600";
  const wchar_t unterminated[] = {L'x', 0x20AC};
  printf("[%ls] [%S] [%lc] [%C] %d\n", text, text, (__WINT_TYPE__)0x20AC, (__WINT_TYPE__)L'z', 1);
  printf("[%.3ls] [%.5ls] [%12.6ls] [%-7.3ls] [%.4ls] %d\n", text, text, text, text, unterminated, 2);
  printf("[%5lc] [%-5lc] [%c] [%s] %d\n", (__WINT_TYPE__)0xE9, (__WINT_TYPE__)0xE9, 'c', "narrow", 3);
  iprintf("[%ls] [%lc] %d\n", text, (__WINT_TYPE__)0x7FF, 4);
  errno = 0;
  n = printf("surrogate %lc %d", (__WINT_TYPE__)0xD800, 5);
  printf("\n%d %d\n", n, errno == EILSEQ);

  printf("%b %#b %#10B %#B %010b %llb %d\n", 10u, 10u, 5u, 0u, 6u, 0x8000000000000001ULL, 6);
  printf("%'d %qd %Ld %hhx %d\n", 1234567, 1LL << 40, -5LL, 0x1FFu & 0xFF, 7);
  return 0;
}
