/* Parts of paths, and names that match a pattern. */
#include <fnmatch.h>
#include <libgen.h>
#include <string.h>

/* Removes slashes from the end of [path, end), but for one at the beginning; the new end. */
static char *without_slashes(char *path, char *end) {
  while (end > path + 1 && end[-1] == '/')
    end--;
  return end;
}

char *__xpg_basename(char *path) {
  static char here[] = ".";
  if (!path || !*path)
    return here;
  char *end = without_slashes(path, path + strlen(path));
  *end = 0;
  char *last = strrchr(path, '/');
  return last && last[1] ? last + 1 : path;
}

char *dirname(char *path) {
  static char here[] = ".";
  if (!path || !*path)
    return here;
  char *end = without_slashes(path, path + strlen(path));
  while (end > path && end[-1] != '/')
    end--;
  if (end == path)
    return here;
  *without_slashes(path, end) = 0;
  return path;
}

/* --- fnmatch --- */

static int lower(int c, int flags) {
  return (flags & FNM_CASEFOLD) && c >= 'A' && c <= 'Z' ? c + 32 : c;
}

static int is_in_class(const char *name, size_t length, int c) {
  static const struct {
    char name[8];
    const char *ranges;
  } classes[] = {{"alpha", "azAZ"},     {"digit", "09"},     {"alnum", "azAZ09"}, {"upper", "AZ"},
                 {"lower", "az"},       {"space", "\t\r  "}, {"blank", "\t\t  "}, {"xdigit", "09afAF"},
                 {"punct", "!/:@[`{~"}, {"print", " ~"},     {"graph", "!~"}};
  for (unsigned i = 0; i < sizeof classes / sizeof *classes; i++)
    if (strlen(classes[i].name) == length && memcmp(classes[i].name, name, length) == 0)
      for (const char *range = classes[i].ranges; *range; range += 2)
        if (c >= range[0] && c <= range[1])
          return 1;
  return 0;
}

/* Whether a set, from behind its '[', has the character. Returns what follows it; NULL: it has no end. */
static const char *match_set(const char *set, int c, int flags, int *has) {
  const int is_inverse = *set == '!' || *set == '^';
  const char *first = set += is_inverse;
  *has = 0;
  for (; *set && (*set != ']' || set == first); set++) {
    const char *end;
    if (set[0] == '[' && set[1] == ':' && (end = strstr(set + 2, ":]")) != NULL) {
      *has |= is_in_class(set + 2, (size_t)(end - set - 2), c);
      set = end + 1;
      continue;
    }
    if (*set == '\\' && !(flags & FNM_NOESCAPE) && set[1])
      set++;
    const int from = (unsigned char)*set;
    int to = from;
    if (set[1] == '-' && set[2] && set[2] != ']') {
      set += 2;
      if (*set == '\\' && !(flags & FNM_NOESCAPE) && set[1])
        set++;
      to = (unsigned char)*set;
    }
    *has |= (c >= from && c <= to) || (lower(c, flags) >= lower(from, flags) && lower(c, flags) <= lower(to, flags));
  }
  *has ^= is_inverse;
  return *set ? set + 1 : NULL;
}

/* A star that fails is extended by a character, the latest first: the earlier ones need no other tries, unless a slash
   stops the latest. */
int fnmatch(const char *pattern, const char *text, int flags) {
  const char *begin = text, *star = NULL, *star_text = NULL;
  for (;;) {
    const int c = (unsigned char)*text;
    const int is_hidden =
        c == '.' && (flags & FNM_PERIOD) && (text == begin || ((flags & FNM_PATHNAME) && text[-1] == '/'));
    const int is_special = (c == '/' && (flags & FNM_PATHNAME)) || is_hidden; /* no wildcard takes it */
    int matches;
    if (*pattern == '*' && !is_hidden) {
      star = ++pattern;
      star_text = text;
      continue;
    }
    if (!c && !*pattern)
      return 0;
    if (c == '/' && !*pattern && (flags & FNM_LEADING_DIR))
      return 0;
    const char *next = pattern + 1;
    if (*pattern == '?') {
      matches = c && !is_special;
    } else if (*pattern == '[' && c && (next = match_set(pattern + 1, c, flags, &matches)) != NULL) {
      matches = matches && !is_special;
    } else {
      next = pattern + 1;
      if (*pattern == '\\' && !(flags & FNM_NOESCAPE) && pattern[1])
        next = ++pattern + 1;
      matches = c && lower(c, flags) == lower((unsigned char)*pattern, flags);
    }
    if (matches) {
      pattern = next;
      text++;
      continue;
    }
    if (!star || !*star_text || (*star_text == '/' && (flags & FNM_PATHNAME)))
      return FNM_NOMATCH;
    pattern = star;
    text = ++star_text;
  }
}
