/* The engine behind all of scanf's relatives. */
#ifndef TRAX_RUNTIME_SCAN_H
#define TRAX_RUNTIME_SCAN_H

#include <stdarg.h>

/* Where characters come from: text, or a stream whose lock is held. */
struct source {
  const char *at; /* NULL: the stream */
  void *stream;
  int (*get)(struct source *from); /* the next character, or EOF */
  int (*unget)(struct source *from, int c);
  int count; /* characters so far */
};

int trax_scan(struct source *from, const char *format, va_list arguments);

#endif
