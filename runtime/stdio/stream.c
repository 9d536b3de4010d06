/* Streams, and the functions of output to a stream. put.c, printf.c and iprintf.c define these functions weakly, for
   standard output alone. The linker takes those here for programs that open files, read, or name stderr. */
#include "stream.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "../internal/host.h"
#include "format.h"

static unsigned char error_buffer[128];
struct trax_stream __trax_stderr = {
    .descriptor = 2, .flags = STREAM_WRITES | STREAM_AT_ONCE, .buffer = error_buffer, .capacity = sizeof error_buffer};
struct trax_stream *trax_streams;
struct ticket_lock trax_streams_lock;

/* --- buffers --- */

static int fail(FILE *stream, int number) {
  stream->flags |= STREAM_FAILED;
  errno = number;
  return EOF;
}

/* Prepares a stream before its first use. Without memory for a buffer, the buffer is one character. */
static void need_buffer(FILE *stream) {
  if (stream->buffer)
    return;
  stream->buffer = malloc(STREAM_BACK + BUFSIZ);
  stream->capacity = STREAM_BACK + BUFSIZ;
  stream->flags |= STREAM_OWNS_BUFFER;
  if (!stream->buffer) {
    stream->buffer = stream->last_resort;
    stream->capacity = sizeof stream->last_resort;
    stream->flags &= ~(unsigned)STREAM_OWNS_BUFFER;
  }
}

static int write_all(FILE *stream, const unsigned char *bytes, unsigned count) {
  while (count) {
    int wrote = host_call(TRAX_HOST_WRITE, (unsigned)stream->descriptor, (uintptr_t)bytes, count);
    if (wrote < 0)
      return fail(stream, -wrote);
    bytes += wrote;
    count -= (unsigned)wrote;
  }
  return 0;
}

int trax_stream_flush(FILE *stream) {
  if (stream->flags & STREAM_IS_READING)
    return 0;
  unsigned count = stream->at;
  stream->at = 0;
  return count ? write_all(stream, stream->buffer, count) : 0;
}

int trax_stream_begin_reading(FILE *stream) {
  if (stream->flags & STREAM_IS_READING)
    return 0;
  if (!(stream->flags & STREAM_READS))
    return fail(stream, EBADF);
  if (trax_stream_flush(stream))
    return EOF;
  need_buffer(stream);
  stream->flags |= STREAM_IS_READING;
  stream->at = stream->end = STREAM_BACK;
  return 0;
}

/* Moves the file's position back by the bytes that were read and not used. */
int trax_stream_begin_writing(FILE *stream) {
  if (!(stream->flags & STREAM_WRITES))
    return fail(stream, EBADF);
  need_buffer(stream);
  if (!(stream->flags & STREAM_IS_READING))
    return 0;
  long long back = (long long)stream->at - stream->end;
  if (back)
    host_call(TRAX_HOST_SEEK, (unsigned)stream->descriptor, (uintptr_t)&back, TRAX_SEEK_HERE);
  stream->flags &= ~(unsigned)(STREAM_IS_READING | STREAM_ENDED);
  stream->at = stream->end = 0;
  return 0;
}

int trax_stream_fill(FILE *stream) {
  if (trax_stream_begin_reading(stream))
    return EOF;
  if (stream->at != stream->end)
    return 0;
  int got;
  do
    got = host_call(TRAX_HOST_READ, (unsigned)stream->descriptor, (uintptr_t)(stream->buffer + STREAM_BACK),
                    stream->capacity - STREAM_BACK);
  while (got == -EINTR); /* the run was interrupted, and continues from a checkpoint */
  if (got < 0)
    return fail(stream, -got);
  stream->at = STREAM_BACK;
  stream->end = STREAM_BACK + (unsigned)got;
  if (got == 0)
    stream->flags |= STREAM_ENDED;
  return got ? 0 : EOF;
}

size_t trax_stream_write(FILE *stream, const char *bytes, size_t count) {
  if (count == 0 || trax_stream_begin_writing(stream))
    return 0;
  if (count >= stream->capacity) {
    if (trax_stream_flush(stream) || write_all(stream, (const unsigned char *)bytes, count))
      return 0;
    return count;
  }
  if (stream->capacity - stream->at < count && trax_stream_flush(stream))
    return 0;
  memcpy(stream->buffer + stream->at, bytes, count);
  stream->at += count;
  if ((stream->flags & STREAM_BY_LINE) && memchr(bytes, '\n', count) && trax_stream_flush(stream))
    return 0;
  return count;
}

/* --- the end --- */

static int flush_all(void) {
  int result = 0;
  lock(&trax_streams_lock);
  for (FILE *stream = trax_streams; stream; stream = stream->next) {
    lock_stream(stream);
    result |= trax_stream_flush(stream);
    unlock_stream(stream);
  }
  unlock(&trax_streams_lock);
  return result;
}

#ifdef __trax__
__attribute__((destructor)) static void end(void) {
  flush_all();
  for (FILE *stream = trax_streams; stream; stream = stream->next)
    host_call(TRAX_HOST_CLOSE, (unsigned)stream->descriptor, 0, 0);
}
#endif

int fflush(FILE *stream) {
  if (!stream)
    return flush_all();
  if (is_stdout(stream))
    return 0;
  lock_stream(stream);
  int result = trax_stream_flush(stream);
  unlock_stream(stream);
  return result;
}

/* --- output --- */

/* Writes with one host call. */
static size_t write_stdout(const char *bytes, size_t count) {
  enum { FEW = 4 };
  trax_lock_output();
  if (count > FEW)
    host_call(TRAX_HOST_WRITE, 1, (uintptr_t)bytes, count);
  else
    for (size_t i = 0; i < count; i++)
      machine_put_char(bytes[i]);
  trax_unlock_output();
  return count;
}

static size_t write_stream(FILE *stream, const char *bytes, size_t count) {
  if (is_stdout(stream))
    return write_stdout(bytes, count);
  lock_stream(stream);
  size_t wrote = trax_stream_write(stream, bytes, count);
  if ((stream->flags & STREAM_AT_ONCE) && trax_stream_flush(stream))
    wrote = 0;
  unlock_stream(stream);
  return wrote;
}

size_t fwrite(const void *restrict memory, size_t size, size_t count, FILE *restrict stream) {
  size_t bytes;
  if (__builtin_mul_overflow(size, count, &bytes)) { /* no object has as many */
    if (!is_stdout(stream))
      fail(stream, EFAULT);
    errno = EFAULT;
    return 0;
  }
  if (bytes == 0)
    return 0;
  size_t wrote = write_stream(stream, memory, bytes);
  return wrote == bytes ? count : wrote / size;
}

int fputs(const char *restrict string, FILE *restrict stream) {
  size_t count = strlen(string);
  return write_stream(stream, string, count) == count ? 1 : EOF;
}

int fputc(int c, FILE *stream) {
  if (is_stdout(stream)) {
    machine_put_char(c);
    return (unsigned char)c;
  }
  lock_stream(stream);
  int result = (unsigned char)c;
  if (!(stream->flags & (STREAM_BY_LINE | STREAM_AT_ONCE | STREAM_IS_READING)) && stream->buffer &&
      stream->at < stream->capacity && (stream->flags & STREAM_WRITES)) {
    stream->buffer[stream->at++] = (unsigned char)c;
  } else {
    char byte = (char)c;
    if (trax_stream_write(stream, &byte, 1) != 1 || ((stream->flags & STREAM_AT_ONCE) && trax_stream_flush(stream)))
      result = EOF;
  }
  unlock_stream(stream);
  return result;
}

int putc(int c, FILE *stream) {
  return fputc(c, stream);
}

/* --- formatted output --- */

/* Formats into the rest of the buffer. Returns the count of characters, or -1. */
static int format_to_buffer(FILE *stream, const char *format, va_list arguments, double_formatter *format_double) {
  va_list copy;
  va_copy(copy, arguments);
  struct sink out = {(char *)stream->buffer + stream->at, (char *)stream->buffer + stream->capacity, 0};
  int count = trax_format(&out, format, copy, format_double);
  va_end(copy);
  return count;
}

/* Text that does not fit is formatted again: into the empty buffer, or into memory for it alone. */
static int print_stream(FILE *stream, const char *format, va_list arguments, double_formatter *format_double) {
  if (trax_stream_begin_writing(stream))
    return -1;
  int count = format_to_buffer(stream, format, arguments, format_double);
  if (count > 0 && (unsigned)count > stream->capacity - stream->at) {
    if (trax_stream_flush(stream))
      return -1;
    if ((unsigned)count <= stream->capacity)
      format_to_buffer(stream, format, arguments, format_double);
  }
  if (count <= 0)
    return count;
  if ((unsigned)count <= stream->capacity) {
    const char *text = (const char *)stream->buffer + stream->at;
    stream->at += (unsigned)count;
    if ((stream->flags & STREAM_BY_LINE) && memchr(text, '\n', (size_t)count) && trax_stream_flush(stream))
      return -1;
    return count;
  }
  char *text = malloc((size_t)count + 1);
  if (!text)
    return fail(stream, ENOMEM);
  trax_print_to(text, (size_t)count + 1, format, arguments, format_double);
  size_t wrote = trax_stream_write(stream, text, (size_t)count);
  free(text);
  return wrote == (size_t)count ? count : -1;
}

static int print(FILE *stream, const char *format, va_list arguments, double_formatter *format_double) {
  if (is_stdout(stream))
    return trax_print(format, arguments, format_double);
  lock_stream(stream);
  int count = print_stream(stream, format, arguments, format_double);
  if ((stream->flags & STREAM_AT_ONCE) && trax_stream_flush(stream))
    count = -1;
  unlock_stream(stream);
  return count;
}

int vfprintf(FILE *restrict stream, const char *restrict format, va_list arguments) {
  return print(stream, format, arguments, trax_format_double);
}

int fprintf(FILE *restrict stream, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = print(stream, format, arguments, trax_format_double);
  va_end(arguments);
  return count;
}

int fiprintf(FILE *restrict stream, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = print(stream, format, arguments, NULL);
  va_end(arguments);
  return count;
}
