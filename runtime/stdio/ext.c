/* The state of streams, as in glibc and musl. Standard output is always written at once. */

#include "stream.h"

#include <stdio_ext.h>

/* Read only, or the last operation was a read. */
int __freading(FILE *stream) {
  return !is_stdout(stream) && (stream->flags & STREAM_IS_READING || !(stream->flags & STREAM_WRITES));
}

/* Write only, or the last operation was a write. */
int __fwriting(FILE *stream) {
  return is_stdout(stream) || !(stream->flags & STREAM_READS) ||
         (stream->flags & STREAM_WRITES && stream->buffer && !(stream->flags & STREAM_IS_READING));
}

int __freadable(FILE *stream) {
  return !is_stdout(stream) && (stream->flags & STREAM_READS) != 0;
}

int __fwritable(FILE *stream) {
  return is_stdout(stream) || (stream->flags & STREAM_WRITES) != 0;
}

int __flbf(FILE *stream) {
  return !is_stdout(stream) && (stream->flags & STREAM_BY_LINE) != 0;
}

size_t __fbufsize(FILE *stream) {
  return is_stdout(stream) ? 0 : stream->capacity;
}

size_t __fpending(FILE *stream) {
  return is_stdout(stream) || stream->flags & STREAM_IS_READING ? 0 : stream->at;
}

void __fpurge(FILE *stream) {
  if (!is_stdout(stream))
    stream->at = stream->end = stream->flags & STREAM_IS_READING ? stream->end : 0;
}

void __fseterr(FILE *stream) {
  if (!is_stdout(stream))
    stream->flags |= STREAM_FAILED;
}

void _flushlbf(void) {
  fflush(NULL);
}
