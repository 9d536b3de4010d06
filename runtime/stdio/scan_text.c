/* %s, %c and %[ of scanf. */
#include "scan.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <wchar.h>

/* The next character of a set, and what follows it. */
static int character(const char **set, int is_wide) {
  wchar_t wide;
  size_t used = is_wide ? mbrtowc(&wide, *set, 4, &(mbstate_t){0}) : 0;
  if (used == 0 || used > 4)
    return (unsigned char)*(*set)++;
  *set += used;
  return wide;
}

int trax_scan_set_has(const char *set, int c, int is_wide, const char **end) {
  int inverted = *set == '^', found = 0, before = -1;
  set += inverted;
  for (const char *first = set; *set && (*set != ']' || set == first);) {
    if (*set == '-' && before >= 0 && set[1] && set[1] != ']') {
      set++;
      int last = character(&set, is_wide);
      found |= c >= before && c <= last;
      before = last;
    } else {
      before = character(&set, is_wide);
      found |= c == before;
    }
  }
  *end = *set ? set + 1 : set;
  return found != inverted;
}

/* The next character, of several bytes if it is a wide one. EOF: none, or (with errno) no character. */
static int take(struct source *from, int is_wide, unsigned char bytes[4], int *length) {
  mbstate_t state = {0};
  wchar_t wide;
  for (*length = 0;;) {
    int c = trax_scan_next(from);
    if (c == EOF || !is_wide) {
      bytes[0] = (unsigned char)c;
      errno = c == EOF && *length ? EILSEQ : errno;
      *length = 1;
      return c;
    }
    bytes[(*length)++] = (unsigned char)c;
    size_t used = mbrtowc(&wide, (const char *)&bytes[*length - 1], 1, &state);
    if (used != (size_t)-2)
      return used == (size_t)-1 ? EOF : wide;
  }
}

int trax_scan_text(struct source *from, const struct directive *how, const char *set, void *to) {
  const int is_wide = how->length == 'l';
  const int most = how->has_width ? how->width : how->letter == 'c' ? 1 : __INT_MAX__;
  int count = 0, c = EOF, length;
  unsigned char bytes[4];
  const char *end;
  for (; count < most && (c = take(from, is_wide, bytes, &length)) != EOF; count++) {
    if ((how->letter == 's' && c < 0x80 && isspace(c)) ||
        (how->letter == '[' && !trax_scan_set_has(set, c, is_wide, &end))) {
      while (length)
        trax_scan_back(from, bytes[--length]);
      break;
    }
    if (how->discards)
      continue;
    if (is_wide)
      ((wchar_t *)to)[count] = c;
    else
      ((char *)to)[count] = (char)c;
  }
  if (count == 0 || (how->letter == 'c' && count < most))
    return c == EOF ? EOF : 0;
  if (how->letter != 'c' && !how->discards) {
    if (is_wide)
      ((wchar_t *)to)[count] = 0;
    else
      ((char *)to)[count] = 0;
  }
  return 1;
}
