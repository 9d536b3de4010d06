/* The engine of all functions like scanf. */
#ifndef TRAX_RUNTIME_SCAN_H
#define TRAX_RUNTIME_SCAN_H

#include <stdarg.h>
#include <stdio.h>

/* The source of characters: text, or a stream whose lock is held. */
struct source {
  const char *at; /* NULL: the stream */
  void *stream;
  int (*get)(struct source *from); /* the next character, or EOF */
  int (*unget)(struct source *from, int c);
  int count; /* characters so far */
};

struct directive {
  char letter, length; /* length: 'H' for hh, 'q' for ll and L, else the letter itself or 0 */
  unsigned char discards, has_width;
  int width;
};

static inline int trax_scan_next(struct source *from) {
  int c = from->get(from);
  from->count += c != EOF;
  return c;
}

static inline void trax_scan_back(struct source *from, int c) {
  if (c == EOF)
    return;
  from->unget(from, c);
  from->count--;
}

/* Whether a set ("a-z]", "^]x]") has the character. *end receives what follows the set. */
int trax_scan_set_has(const char *set, int c, int is_wide, const char **end);
/* One conversion of s, c or [: 1, 0 if the input does not match, EOF at its end. */
int trax_scan_text(struct source *from, const struct directive *how, const char *set, void *to);
int trax_scan(struct source *from, const char *format, va_list arguments);

#endif
