/* Words in a text: by comparison at every place, and after Horspool. */
#include "../bench.h"

#include <string.h>

enum { SIZE = 8000 };
static char text[SIZE + 1];
static const char *const words[] = {"ray", "light", "shadow", "triangle", "nowhere to be found"};

void kernel_setup(void) {
  static const char *const parts[] = {"the ",   "ray ",  "hits ",     "a ",      "trihedral ", "and ", "the ",
                                      "light ", "that ", "triangle ", "throws ", "shadows ",   "of ",  "night "};
  uint32_t random = 12;
  int at = 0;
  while (at < SIZE) {
    const char *part = parts[(next_random(&random) >> 16) % 14];
    while (*part && at < SIZE)
      text[at++] = *part++;
  }
  text[SIZE] = 0;
}

static int count_simple(const char *haystack, const char *needle) {
  int found = 0;
  for (; *haystack; haystack++) {
    const char *h = haystack, *n = needle;
    while (*n && *h == *n)
      h++, n++;
    found += *n == 0;
  }
  return found;
}

static int count_horspool(const char *haystack, int size, const char *needle) {
  static int skip[256];
  int length = (int)strlen(needle), found = 0;
  for (int i = 0; i < 256; i++)
    skip[i] = length;
  for (int i = 0; i < length - 1; i++)
    skip[(unsigned char)needle[i]] = length - 1 - i;
  for (int at = 0; at + length <= size; at += skip[(unsigned char)haystack[at + length - 1]]) {
    int i = length - 1;
    while (i >= 0 && haystack[at + i] == needle[i])
      i--;
    found += i < 0;
  }
  return found;
}

struct result kernel_run(void) {
  uint32_t checksum = 0;
  for (unsigned i = 0; i < sizeof words / sizeof *words; i++) {
    checksum = mix(checksum, (uint32_t)count_simple(text, words[i]));
    checksum = mix(checksum, (uint32_t)count_horspool(text, SIZE, words[i]));
  }
  return (struct result){checksum, 0};
}
