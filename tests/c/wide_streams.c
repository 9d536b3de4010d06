// RUN: rm -rf %t && mkdir %t && %clang -O2 -mstack=global %s -o %t/program
// RUN: cd %t && %trax_sim --engine functional --dir .::d program | cmp - %S/wide_streams.expected
// Streams of wide characters: text, and formatted output and input. (Expected output of glibc, in a folder d.)
#include <errno.h>
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

static int print(FILE *f, const wchar_t *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int count = vfwprintf(f, format, arguments);
  va_end(arguments);
  return count;
}

static void bytes_of(const char *path) {
  FILE *f = fopen(path, "rb");
  for (int c; (c = getc(f)) != EOF;)
    printf("%02x", c);
  printf("\n");
  fclose(f);
}

int main(void) {
  wchar_t text[40];
  char narrow[20];
  int number = 0, other = 0;
  setlocale(LC_ALL, "C.UTF-8");
  FILE *f = fopen("d/x", "w+");
  printf("fputws %d", fputws(L"gr\u00fcn \u20ac\n", f) >= 0);
  printf(" fputwc %x", (unsigned)fputwc(0x1F600, f));
  printf(" putwc %x\n", (unsigned)putwc(L'\n', f));
  printf("fwprintf %d", fwprintf(f, L"%d|%5ls|%-4s|%lc|%.3f\n", 42, L"ab", "cd", (wint_t)0xE4, 2.5));
  printf(" %d\n", print(f, L"%x \u03c0\n", 255));
  rewind(f);
  printf("fgetwc %x", (unsigned)fgetwc(f));
  printf(" %x", (unsigned)getwc(f));
  printf(" ungetwc %x", (unsigned)ungetwc(0x20AC, f));
  printf(" %x\n", (unsigned)fgetwc(f));
  printf("fgetws %d", fgetws(text, 4, f) != NULL);
  printf(" %zu %x %x\n", wcslen(text), (unsigned)text[0], (unsigned)text[2]);
  printf("fgetws %d", fgetws(text, 40, f) != NULL);
  printf(" %zu", wcslen(text));
  printf(" %d", fgetws(text, 40, f) != NULL);
  printf(" %zu %x\n", wcslen(text), (unsigned)text[0]);
  printf("fwscanf %d", fwscanf(f, L"%d|%ls|%2s", &number, text, narrow));
  printf(" %d %zu\n", number, wcslen(text));
  while (fgetwc(f) != WEOF)
    continue;
  printf("end %d %d\n", feof(f) != 0, fgetws(text, 40, f) == NULL);
  fclose(f);
  bytes_of("d/x");

  printf("swprintf %d", swprintf(text, 40, L"%s-%ls-%d", "ab", L"\u00e9", 7));
  printf(" %ls", text);
  printf(" %d", swprintf(text, 4, L"%d", 12345));
  printf(" %d", swprintf(text, 6, L"%d", 12345));
  printf(" %d\n", swprintf(text, 40, L"%s", "a\xff"));
  printf("swscanf %d", swscanf(L"12 \u00e4bc 0x1f", L"%d %ls %i", &number, text, &other));
  printf(" %d %x %d\n", number, (unsigned)text[0], other);

  /* Widths and precisions count characters. */
  static const wchar_t *const formats[] = {L"[%5ls|%.2ls|%-6.3ls]", L"[%6s|%.1s|%-3s]"};
  for (int i = 0; i < 2; i++) {
    const int count = i ? swprintf(text, 40, formats[i], "\u00e9t\u20ac", "\u20acx", "\u00e9")
                        : swprintf(text, 40, formats[i], L"\u00e9t\u20ac", L"\u20acxy", L"\u00e9\u00e8xyz");
    printf("%d %ls\n", count, text);
  }
  const int count = swprintf(text, 40, L"\u00e9%-4lc%3c%*d%n", L'\u20ac', 'b', -4, 7, &number);
  printf("%d %d %ls|\n", count, number, text);

  f = fopen("d/bad", "wb");
  fputs("a\xff", f);
  fclose(f);
  f = fopen("d/bad", "r");
  errno = 0;
  printf("bad %x", (unsigned)fgetwc(f));
  printf(" %x", (unsigned)fgetwc(f));
  printf(" %d\n", errno == EILSEQ);
  fclose(f);
  fflush(stdout);
  f = freopen("d/x", "r", stdin);
  printf("stdin %x\n", (unsigned)getwchar());
  return f == NULL;
}
