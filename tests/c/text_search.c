// RUN: %run_c %s %t --levels -O0,-O2,-Oz
// Searching text: Knuth-Morris-Pratt, Boyer-Moore-Horspool, wildcards, the distance of two words.
#include <stdio.h>
#include <string.h>

static unsigned char table[256], prefix[32];

__attribute__((noinline)) static int kmp(const char *text, const char *part) {
  int m = (int)strlen(part), found = 0;
  prefix[0] = 0;
  for (int i = 1, k = 0; i < m; i++) {
    while (k && part[i] != part[k])
      k = prefix[k - 1];
    prefix[i] = (unsigned char)(k += part[i] == part[k]);
  }
  for (int i = 0, k = 0; text[i]; i++) {
    while (k && (k == m || text[i] != part[k]))
      k = prefix[k - 1];
    k += text[i] == part[k];
    found += k == m;
  }
  return found;
}

__attribute__((noinline)) static int horspool(const char *text, const char *part) {
  int n = (int)strlen(text), m = (int)strlen(part);
  memset(table, m, sizeof table);
  for (int i = 0; i < m - 1; i++)
    table[(unsigned char)part[i]] = (unsigned char)(m - 1 - i);
  for (int at = 0; at + m <= n; at += table[(unsigned char)text[at + m - 1]])
    if (memcmp(text + at, part, (size_t)m) == 0)
      return at;
  return -1;
}

__attribute__((noinline)) static int matches(const char *text, const char *pattern) {
  const char *star = NULL, *retry = NULL;
  while (*text)
    if (*pattern == '*')
      star = pattern++, retry = text;
    else if (*pattern == '?' || *pattern == *text)
      pattern++, text++;
    else if (star)
      pattern = star + 1, text = ++retry;
    else
      return 0;
  while (*pattern == '*')
    pattern++;
  return *pattern == 0;
}

__attribute__((noinline)) static int distance(const char *a, const char *b) {
  static unsigned char row[16];
  int n = (int)strlen(b);
  for (int j = 0; j <= n; j++)
    row[j] = (unsigned char)j;
  for (int i = 0; a[i]; i++) {
    unsigned char corner = row[0]++;
    for (int j = 0; j < n; j++) {
      int best = corner + (a[i] != b[j]);
      corner = row[j + 1];
      best = best < row[j] + 1 ? best : row[j] + 1;
      row[j + 1] = (unsigned char)(best < corner + 1 ? best : corner + 1);
    }
  }
  return row[n];
}

int main(void) {
  static const char text[] = "abracadabra abracadabracadabra \xe9t\xe9";
  printf("%d %d %d\n", kmp(text, "abra"), kmp(text, "abracadabra"), kmp("aaaaaaa", "aaa"));
  printf("%d %d %d\n", horspool(text, "cadabrac"), horspool(text, "t\xe9"), horspool(text, "abraz"));
  printf("%d%d%d%d\n", matches("sphere.obj", "s*e.o?j"), matches("abc", "a*d"), matches("aXbXc", "*X*c"),
         matches("", "**"));
  printf("%d %d %d\n", distance("kitten", "sitting"), distance("", "abc"), distance("shadow", "window"));
  return 0;
}
