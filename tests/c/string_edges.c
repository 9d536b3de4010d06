// RUN: %run_c %s %t --turns -O0,-O2,-Os
// String functions at their edges: nothing, one byte, bytes above 127, every alignment, sizes that stop them, overlaps.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char buffer[80], other[80];

static int sign(int x) {
  return (x > 0) - (x < 0);
}

__attribute__((noinline)) static void lengths(void) {
  unsigned hash = 0;
  for (unsigned at = 0; at < 5; at++)
    for (unsigned n = 0; n < 12; n++) {
      memset(buffer, 'x', sizeof buffer - 1);
      buffer[at + n] = 0;
      hash = hash * 7 + (unsigned)strlen(buffer + at);
      hash = hash * 7 + (unsigned)strnlen(buffer + at, 6);
      hash = hash * 7 + (memchr(buffer + at, 0, n) == NULL) + 2 * (memchr(buffer + at, 0, n + 1) == buffer + at + n);
      strcpy(other + 3, buffer + at);
      hash = hash * 7 + (unsigned)(strcmp(other + 3, buffer + at) == 0 && other[3 + n] == 0);
    }
  printf("%u\n", hash);
}

__attribute__((noinline)) static void comparisons(const char *a, const char *b) {
  printf("%d %d %d %d\n", sign(strcmp(a, b)), sign(strncmp(a, b, 2)), sign(strncmp(a, b, 0)), sign(memcmp(a, b, 1)));
}

__attribute__((noinline)) static void bounded(void) {
  memset(buffer, '.', 20);
  strncpy(buffer, "ab", 6); /* pads with zeros */
  for (int i = 0; i < 9; i++)
    printf("%x ", buffer[i]);
  strncpy(buffer, "abcdefgh", 4); /* and here ends without one */
  printf("%c%c%x\n", buffer[3], buffer[6], buffer[4]);
  strcpy(buffer, "ab");
  strncat(buffer, "cdefg", 3);
  strncat(buffer, "xyz", 0);
  puts(strcat(buffer, ""));
}

__attribute__((noinline)) static void searches(void) {
  strcpy(buffer, "a\x80"
                 "bcbcbd\xff");
  printf("%d %d %d\n", (int)(strchr(buffer, '\x80') - buffer), (int)(strrchr(buffer, 'b') - buffer),
         (int)(strchr(buffer, 0) - buffer));
  printf("%d %d %d\n", (int)(strstr(buffer, "bcbd") - buffer), strstr(buffer, "bcbe") == NULL,
         strstr(buffer, "") == buffer);
  printf("%d %d %d\n",
         (int)strspn(buffer, "\x80"
                             "ab"),
         (int)strcspn(buffer, ""), (int)strspn(buffer, ""));
  printf("%d %d\n",
         (int)(strpbrk(buffer, "\xff"
                               "d") -
               buffer),
         strpbrk(buffer, "xyz") == NULL);
  printf("%d %d\n", (int)((char *)memchr(buffer, 0x1FF, 20) - buffer), strrchr("", 'a') == NULL);
}

__attribute__((noinline)) static void tokens(char *text, const char *separators) {
  char *rest;
  for (char *t = strtok_r(text, separators, &rest); t; t = strtok_r(NULL, separators, &rest))
    printf("[%s]", t);
  puts("");
}

__attribute__((noinline)) static void overlaps(void) {
  unsigned hash = 0;
  for (int from = 0; from < 6; from++)
    for (int to = 0; to < 6; to++) {
      for (int i = 0; i < 40; i++)
        buffer[i] = (char)(i * 5);
      memmove(buffer + to, buffer + from, 29);
      for (int i = 0; i < 40; i++)
        hash = hash * 31 + (unsigned char)buffer[i];
    }
  printf("%x\n", hash);
}

int main(void) {
  lengths();
  comparisons("", "");
  comparisons("", "a");
  comparisons("\x80", "\x7f"); /* as unsigned char */
  comparisons("abc", "abd");
  comparisons("abcd", "abc");
  bounded();
  searches();
  strcpy(other, ",,one,;two;,");
  tokens(other, ",;");
  strcpy(other, ",,,");
  tokens(other, ",");
  overlaps();
  char *copy = strdup("copied");
  puts(copy);
  free(copy);
  return 0;
}
