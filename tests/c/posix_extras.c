// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global -D_GNU_SOURCE"
// The environment, paths, patterns, tables and trees, times from text, byte orders, and jumps, as the host has them.
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <byteswap.h>
#include <endian.h>
#include <err.h>
#include <errno.h>
#include <fnmatch.h>
#include <malloc.h>
#include <memory.h>
#include <search.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sysexits.h>
#include <time.h>
#include <unistd.h>

#include <libgen.h>
#include <limits.h>

static void environment(void) {
  static char own[] = "OWN=1";
  clearenv();
  printf("%d", getenv("A") == NULL);
  printf(" %d %d", setenv("A", "one", 1), setenv("A", "two", 0));
  printf(" %s", getenv("A"));
  setenv("A", "three", 1);
  setenv("AB", "x", 1);
  putenv(own);
  own[4] = '2';
  printf(" %s %s %s", getenv("A"), getenv("AB"), getenv("OWN"));
  printf(" %d %d", setenv("B=C", "", 1), setenv("", "", 1));
  int count = 0;
  for (char **it = environ; it && *it; it++)
    count++;
  unsetenv("A");
  putenv("OWN");
  printf(" %d %d %s\n", count, getenv("A") == NULL && getenv("OWN") == NULL, getenv("AB"));
}

static void paths(void) {
  static const char *const all[] = {"", "/", "a", "a/", "/a", "/a/b", "a/b//", "a//b", "/a//", "..", "./x"};
  for (unsigned i = 0; i < sizeof all / sizeof *all; i++) {
    char one[16], other[16];
    strcpy(one, all[i]);
    strcpy(other, all[i]);
    printf("%s:%s:%s ", all[i], dirname(one), basename(other));
  }
  printf("\n");
}

static void patterns(void) {
  static const char *const pattern[] = {"*.c",   "a?c",    "[a-c]*",       "[!a]b", "a*b*c", "*",   "\\*",
                                        "a/*/c", "[]x]",   "[[:digit:]]*", "x[",    "*.*",   "a\\", "[a-",
                                        "?*?",   "[^b-d]", "*a*a*b",       "[\\]]", "a"};
  static const char *const text[] = {"x.c", "abc", "a.c", ".c", "b",   "*",     "a/b/c", "a/b/d/c", "]",
                                     "12",  "x[",  "a/c", "",   "aab", "aXbYc", "a",     "abcabc",  "a/.b/c"};
  static const int flags[] = {
      0, FNM_PATHNAME, FNM_PERIOD, FNM_PATHNAME | FNM_PERIOD, FNM_NOESCAPE, FNM_CASEFOLD, FNM_LEADING_DIR};
  for (unsigned f = 0; f < sizeof flags / sizeof *flags; f++)
    for (unsigned p = 0; p < sizeof pattern / sizeof *pattern; p++) {
      unsigned bits = 0;
      for (unsigned t = 0; t < sizeof text / sizeof *text; t++)
        bits = bits << 1 | (fnmatch(pattern[p], text[t], flags[f]) == 0);
      printf("%05x%s", bits, p + 1 < sizeof pattern / sizeof *pattern ? " " : "\n");
    }
}

static int by_number(const void *a, const void *b) {
  return *(const int *)a < *(const int *)b ? -1 : *(const int *)a > *(const int *)b;
}

static int visited, sorted = 1, latest;
static void visit(const void *node, VISIT when, int depth) {
  (void)depth;
  if (when == postorder || when == leaf) {
    const int key = **(const int *const *)node;
    sorted &= !visited++ || latest < key;
    latest = key;
  }
}
static void forget(void *key) {
  (void)key;
  visited--;
}

static void tables(void) {
  static int keys[1000];
  void *root = NULL;
  for (int i = 0; i < 1000; i++) {
    keys[i] = i * 389 % 1000;
    tsearch(&keys[i], &root, by_number);
  }
  const int again = 17, missing = 5000;
  printf("tree %d %d", **(int **)tsearch(&again, &root, by_number), tfind(&missing, &root, by_number) == NULL);
  for (int i = 0; i < 1000; i += 3)
    tdelete(&keys[i], &root, by_number);
  printf(" %d", tdelete(&missing, &root, by_number) == NULL);
  twalk(root, visit);
  printf(" %d %d", visited, sorted);
  tdestroy(root, forget);
  printf(" %d\n", visited);
  printf("tables %d", hcreate(30));
  printf(" %d\n", hcreate(30));
  static char words[30][8];
  for (int i = 0; i < 30; i++) {
    snprintf(words[i], sizeof words[i], "key%d", i);
    hsearch((ENTRY){words[i], &keys[i]}, ENTER);
  }
  ENTRY *found = hsearch((ENTRY){"key17", NULL}, FIND);
  printf("table %d %d\n", found && found->data == &keys[17], hsearch((ENTRY){"key30", NULL}, FIND) == NULL);
  hdestroy();
  int array[5] = {3, 1, 4}, key = 1, added = 9;
  size_t count = 3;
  printf("array %d", (int)((int *)lfind(&key, array, &count, sizeof key, by_number) - array));
  printf(" %d", (int)((int *)lsearch(&added, array, &count, sizeof key, by_number) - array));
  printf(" %d\n", (int)count);
}

static void times(void) {
  static const char *const cases[][2] = {{"2024-02-29 13:45:10", "%Y-%m-%d %H:%M:%S"},
                                         {"Thu, 05 Mar 1998 01:02:03 PM", "%a, %d %b %Y %I:%M:%S %p"},
                                         {"12/31/99", "%D"},
                                         {"7:08", "%R"},
                                         {"12 AM", "%I %p"},
                                         {"2024-13-01", "%Y-%m-%d"},
                                         {"wednesday", "%A"},
                                         {"20 07 15 03", "%C %y %d %m"},
                                         {"100%", "100%%"},
                                         {"x", "y"},
                                         {"2023-06-01T10:20:30 rest", "%FT%T"},
                                         {"12:30 +0145", "%R %z"},
                                         {"-01:30,", "%z"},
                                         {"+01", "%z"},
                                         {"Z", "%z"},
                                         {"+010", "%z"},
                                         {"-0160", "%z"},
                                         {"01", "%z"},
                                         {"2024 24 09", "%G %g %V"}};
  for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct tm t = {0};
    const char *end = strptime(cases[i][0], cases[i][1], &t);
    if (end)
      printf("%d-%d-%d %d:%d:%d %d %d %ld '%s'; ", t.tm_year, t.tm_mon, t.tm_mday, t.tm_hour, t.tm_min, t.tm_sec,
             t.tm_wday, t.tm_yday, t.tm_gmtoff, end);
    else
      printf("no; ");
  }
  printf("\n");
}

int main(void) {
  environment();
  paths();
  patterns();
  tables();
  times();
  printf("%x %x %llx %x %x\n", bswap_16(0x1234), bswap_32(0x12345678),
         (unsigned long long)bswap_64(0x123456789abcdefull), (unsigned)htobe32(0x12345678), (unsigned)le16toh(0x1234));
  sigjmp_buf place;
  volatile int jumps = 0;
  const int got = sigsetjmp(place, 1);
  if (got < 3) {
    jumps++;
    siglongjmp(place, got + 1);
  }
  printf("%d %d %d %d\n", jumps, got, EX_USAGE, MB_LEN_MAX >= 4);
  errno = 0;
  return 0;
}
