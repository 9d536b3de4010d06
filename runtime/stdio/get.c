/* Input. */
#include "stream.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct trax_stream __trax_stdin = {.flags = STREAM_READS};

int fgetc(FILE *stream) {
  if (is_stdout(stream))
    return EOF;
  lock_stream(stream);
  int c = stream_get(stream);
  unlock_stream(stream);
  return c;
}

int getc(FILE *stream) {
  return fgetc(stream);
}

int getchar(void) {
  return fgetc(stdin);
}

int getc_unlocked(FILE *stream) {
  return is_stdout(stream) ? EOF : stream_get(stream);
}

int getchar_unlocked(void) {
  return stream_get(stdin);
}

int ungetc(int c, FILE *stream) {
  if (c == EOF || is_stdout(stream))
    return EOF;
  lock_stream(stream);
  int result = EOF;
  if (!trax_stream_begin_reading(stream) && stream->at > 0) {
    stream->buffer[--stream->at] = (unsigned char)c;
    stream->flags &= ~(unsigned)STREAM_ENDED;
    result = (unsigned char)c;
  }
  unlock_stream(stream);
  return result;
}

/* Copies at most `count` characters, ending with the first `last` if that is a character. Returns how many. */
static size_t copy(FILE *stream, char *to, size_t count, int last) {
  size_t done = 0;
  while (done < count && (stream->at != stream->end || trax_stream_fill(stream) != EOF)) {
    size_t part = stream->end - stream->at, left = count - done;
    if (part > left)
      part = left;
    const unsigned char *from = stream->buffer + stream->at;
    const unsigned char *found = last == EOF ? NULL : memchr(from, last, part);
    if (found)
      part = (size_t)(found + 1 - from);
    memcpy(to + done, from, part);
    stream->at += part;
    done += part;
    if (found)
      break;
  }
  return done;
}

/* Switches the stream to reading, and writes out its buffer. With the lock held. */
static int begin(FILE *stream) {
  return is_stdout(stream) ? EOF : trax_stream_begin_reading(stream);
}

size_t fread(void *restrict memory, size_t size, size_t count, FILE *restrict stream) {
  if (size == 0 || count == 0 || is_stdout(stream))
    return 0;
  size_t bytes;
  if (__builtin_mul_overflow(size, count, &bytes))
    bytes = (size_t)-1; /* reads to the end of the stream */
  lock_stream(stream);
  size_t done = begin(stream) ? 0 : copy(stream, memory, bytes, EOF);
  unlock_stream(stream);
  return done / size;
}

char *fgets(char *restrict to, int size, FILE *restrict stream) {
  if (size <= 0 || is_stdout(stream))
    return NULL;
  lock_stream(stream);
  unsigned failed = stream->flags & STREAM_FAILED;
  size_t done = begin(stream) ? 0 : copy(stream, to, (size_t)size - 1, '\n');
  int is_wrong = (stream->flags & STREAM_FAILED) && !failed;
  unlock_stream(stream);
  if (is_wrong || (done == 0 && size > 1))
    return NULL;
  to[done] = 0;
  return to;
}

ssize_t getdelim(char **restrict line, size_t *restrict capacity, int last, FILE *restrict stream) {
  size_t length = 0;
  if (!line || !capacity || is_stdout(stream)) {
    errno = EINVAL;
    return -1;
  }
  lock_stream(stream);
  while (!begin(stream)) {
    if (!*line || *capacity - length < 2) {
      size_t larger = *line && *capacity > 60 ? 2 * *capacity : 120;
      char *grown = realloc(*line, larger);
      if (!grown) {
        errno = ENOMEM;
        stream->flags |= STREAM_FAILED;
        length = 0;
        break;
      }
      *line = grown;
      *capacity = larger;
    }
    size_t part = copy(stream, *line + length, *capacity - length - 1, last);
    length += part;
    if (part == 0 || (unsigned char)(*line)[length - 1] == (unsigned char)last)
      break;
  }
  unlock_stream(stream);
  if (length == 0)
    return -1;
  (*line)[length] = 0;
  return (ssize_t)length;
}

ssize_t getline(char **restrict line, size_t *restrict capacity, FILE *restrict stream) {
  return getdelim(line, capacity, '\n', stream);
}
