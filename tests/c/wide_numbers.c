// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global"
// Numbers, words and times of wide characters; UTF-16 and UTF-32. at_quick_exit.
#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <uchar.h>
#include <wchar.h>

static void first(void) {
  puts("first");
  fflush(stdout);
}
static void second(void) {
  puts("second");
}

int main(void) {
  setlocale(LC_ALL, "C.UTF-8");
  wchar_t *end, buffer[32];
  const wchar_t *text = L"  -0x1fz";
  long n = wcstol(text, &end, 0);
  printf("%ld %d\n", n, (int)(end - text));
  printf("%lu %llu\n", wcstoul(L"4000000000", NULL, 10), wcstoull(L"zz", &end, 36));
  errno = 0;
  long long large = wcstoll(L"99999999999999999999", &end, 10);
  printf("%lld %d\n", large, errno == ERANGE);
  double number;
  text = L"\t2.5e1x\x20ac";
  number = wcstod(text, &end);
  printf("%g %d\n", number, (int)(end - text));
  printf("%g %g\n", (double)wcstof(L"nan(1)", &end) != 0 ? 1.0 : 0.0, (double)wcstold(L"-inf", NULL));
  text = L"\x20ac";
  number = wcstod(text, &end);
  printf("%g %d\n", number, (int)(end - text));
  printf("%jd %ju\n", wcstoimax(L"-7", NULL, 10), wcstoumax(L"7", NULL, 8));

  wchar_t words[] = L",a,,bc;d", *state;
  for (wchar_t *w = wcstok(words, L",;", &state); w; w = wcstok(NULL, L",;", &state))
    printf("%d ", (int)wcslen(w));
  printf("%d", (int)wcsxfrm(buffer, L"abc", 32));
  printf(" %d\n", (int)wcscmp(buffer, L"abc"));
  struct tm time = {.tm_year = 126, .tm_mon = 10, .tm_mday = 23, .tm_hour = 7};
  printf("%d", (int)wcsftime(buffer, 32, L"%Y-%m-%d \x20ac %H", &time));
  printf(" %d %x\n", (int)wcscmp(buffer, L"2026-11-23 \x20ac 07"), (unsigned)buffer[11]);
  printf("%d %d\n", (int)wcsftime(buffer, 4, L"%Y", &time), (int)wcsftime(buffer, 5, L"%Y", &time));

  mbstate_t in = {0}, out = {0};
  char16_t half;
  char32_t whole;
  char bytes[8] = "";
  const char *smile = "\xf0\x9f\x98\x80";
  printf("%d", (int)mbrtoc16(&half, smile, 4, &in));
  printf(" %x %d", half, (int)c16rtomb(bytes, half, &out));
  printf(" %d", (int)mbrtoc16(&half, smile + 4, 1, &in));
  printf(" %x %d", half, (int)c16rtomb(bytes, half, &out));
  printf(" %d\n", memcmp(bytes, smile, 4));
  printf("%d", (int)mbrtoc32(&whole, smile, 4, &in));
  printf(" %x %d\n", (unsigned)whole, (int)c32rtomb(bytes, whole, &out));
  errno = 0;
  printf("%d", (int)c16rtomb(bytes, 0xd800, &out));
  printf(" %d", (int)c16rtomb(bytes, 'a', &out));
  printf(" %d\n", errno == EILSEQ);
  if (at_quick_exit(first) || at_quick_exit(second))
    return 1;
  quick_exit(0);
}
