// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global -D_GNU_SOURCE"
// Functions of POSIX, BSD and GNU that programs of others call, as the host has them.
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <errno.h>
#include <getopt.h>
#include <locale.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include <unistd.h>
#include <wchar.h>
#include <wctype.h>

static int descending(const void *a, const void *b, void *context) {
  ++*(int *)context;
  return *(const int *)b - *(const int *)a;
}

static volatile int raised;
static void on_signal(int number) {
  raised = number;
}

static void sort(void) {
  int numbers[50], calls = 0;
  for (int i = 0; i < 50; i++)
    numbers[i] = i * 37 % 53;
  qsort_r(numbers, 50, sizeof *numbers, descending, &calls);
  int good = calls > 0;
  for (int i = 1; i < 50; i++)
    good &= numbers[i - 1] >= numbers[i];
  printf("sorted %d\n", good);
}

static void options(int count, char **arguments) {
  static const struct option longs[] = {{"all", no_argument, NULL, 'a'},
                                        {"size", required_argument, NULL, 's'},
                                        {"maybe", optional_argument, NULL, 'm'},
                                        {0}};
  int c;
  optind = 0;
  opterr = 0;
  while ((c = getopt_long(count, arguments, "abs:x::", longs, NULL)) != -1)
    printf("%c(%s) ", c, optarg ? optarg : "");
  printf("|");
  for (int i = optind; i < count; i++)
    printf(" %s", arguments[i]);
  printf("\n");
}

static void random_numbers(void) {
  unsigned short state[3] = {1, 2, 3};
  srand48(42);
  for (int i = 0; i < 3; i++) {
    printf("%ld ", lrand48());
    printf("%ld ", mrand48());
    printf("%.15f ", drand48());
    printf("%ld ", nrand48(state));
    printf("%ld ", jrand48(state));
    printf("%.15f\n", erand48(state));
  }
  printf("%ld", random());
  srandom(17);
  for (int i = 0; i < 40; i++)
    random();
  printf(" %ld\n", random());
}

static void strings(void) {
  char text[] = "a,b,,c", *rest = text, *part, *made = NULL;
  while ((part = strsep(&rest, ",")))
    printf("[%s]", part);
  printf(" %d %d %d\n", ffs(48), ffsll(1LL << 40), ffs(0));
  printf("%s %s %d\n", strcasestr("Hello World", "WORLD"), strchrnul("abc", 'x') - 3, strcasecmp("ABC", "abd") < 0);
  char block[8];
  memset(block, 1, sizeof block);
  bzero(block, 4);
  printf("%d %d %s\n", block[3], block[4], index("path/name", '/'));
  const int length = asprintf(&made, "%d-%s", 42, "made");
  printf("%d %s\n", length, made);
  free(made);
  void *memory = NULL;
  const int failed = posix_memalign(&memory, 64, 100);
  printf("%d %d\n", failed, (int)((uintptr_t)memory & 63));
  free(memory);
  printf("%s %s %d\n", strerror(ENOENT), strerror(EACCES), getenv("NO_SUCH_VARIABLE") == NULL);
}

static void times(void) {
  static const time_t moments[] = {0, 951782400, 1709208000, -86401, 4102444799};
  for (unsigned i = 0; i < sizeof moments / sizeof *moments; i++) {
    char text[100];
    struct tm *parts = gmtime(&moments[i]);
    strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S %a %b %j %U %W %V %G %y %p %I %e %D %T", parts);
    printf("%s %d\n", text, timegm(parts) == moments[i]);
  }
  struct tm odd = {.tm_year = 124, .tm_mon = 14, .tm_mday = 35, .tm_hour = -5, .tm_min = 75};
  printf("%s", asctime((timegm(&odd), &odd)));
}

static void wide(void) {
  wchar_t text[16];
  char bytes[16];
  printf("%zu %d %d %d\n", wcslen(L"wide"), wcscmp(L"a", L"b") < 0, iswalpha(L'x') != 0, (int)towupper(L'q'));
  wcscat(wcscpy(text, L"one"), L"two");
  printf("%ls %d %ls\n", text, (int)(wcschr(text, L't') - text), wcsstr(text, L"et"));
  printf("%d %d\n", (int)mbstowcs(text, "plain", 16), (int)wcstombs(bytes, L"text", 16));
}

int main(void) {
  char *first[] = {"program", "-ab", "file", "--size=3", "-s", "4", "other", "--maybe", "-x5", "--", "-a", NULL};
  char *second[] = {"program", "-z", "--al", "--unknown", "-s", NULL};
  sort();
  options(11, first);
  options(5, second);
  random_numbers();
  strings();
  times();
  wide();
  signal(SIGUSR1, on_signal);
  raise(SIGUSR1);
  printf("%d %s %s\n", raised, setlocale(LC_ALL, "C"), localeconv()->decimal_point);
  return 0;
}
