/* scanf from streams. */
#include "stream.h"

#include "scan.h"

static int get(struct source *from) {
  return stream_get(from->stream);
}

static int unget(struct source *from, int c) {
  FILE *stream = from->stream;
  stream->buffer[--stream->at] = (unsigned char)c; /* it was read from there */
  return c;
}

int vfscanf(FILE *restrict stream, const char *restrict format, va_list arguments) {
  if (is_stdout(stream))
    return EOF;
  lock_stream(stream);
  struct source from = {.stream = stream, .get = get, .unget = unget};
  int done = trax_stream_begin_reading(stream) ? EOF : trax_scan(&from, format, arguments);
  unlock_stream(stream);
  return done;
}

int fscanf(FILE *restrict stream, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int done = vfscanf(stream, format, arguments);
  va_end(arguments);
  return done;
}

int vscanf(const char *restrict format, va_list arguments) {
  return vfscanf(stdin, format, arguments);
}

int scanf(const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int done = vfscanf(stdin, format, arguments);
  va_end(arguments);
  return done;
}
