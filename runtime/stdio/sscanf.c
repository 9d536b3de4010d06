/* scanf from text. */
#include "scan.h"

#include <stdio.h>

static int get(struct source *from) {
  return *from->at ? (unsigned char)*from->at++ : EOF;
}

static int unget(struct source *from, int c) {
  from->at--;
  return c;
}

int vsscanf(const char *restrict text, const char *restrict format, va_list arguments) {
  struct source from = {.at = text, .get = get, .unget = unget};
  return trax_scan(&from, format, arguments);
}

int sscanf(const char *restrict text, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int done = vsscanf(text, format, arguments);
  va_end(arguments);
  return done;
}
