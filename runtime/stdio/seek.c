/* Positions and states of streams. */
#include "stream.h"

#include <errno.h>
#include <limits.h>
#include <stdint.h>

#include "../internal/host.h"

/* Moves the file's position; the new one, or -1. */
static long long seek_host(const FILE *stream, long long offset, unsigned origin) {
  int result = host_call(TRAX_HOST_SEEK, (unsigned)stream->descriptor, (uintptr_t)&offset, origin);
  return host_result(result) < 0 ? -1 : offset;
}

int fseeko(FILE *stream, off_t offset, int origin) {
  if (is_stdout(stream)) {
    errno = ESPIPE;
    return -1;
  }
  lock_stream(stream);
  int result = trax_stream_flush(stream);
  if (!result) {
    if (origin == SEEK_CUR && (stream->flags & STREAM_IS_READING))
      offset -= stream->end - stream->at;
    result = seek_host(stream, offset, (unsigned)origin) < 0 ? -1 : 0;
  }
  if (!result) {
    stream->flags &= ~(unsigned)(STREAM_IS_READING | STREAM_ENDED);
    stream->at = stream->end = 0;
  }
  unlock_stream(stream);
  return result;
}

off_t ftello(FILE *stream) {
  if (is_stdout(stream)) {
    errno = ESPIPE;
    return -1;
  }
  lock_stream(stream);
  int is_reading = (stream->flags & STREAM_IS_READING) != 0;
  /* Appended data go to the end, independent of the position. */
  int appends = !is_reading && stream->at && (stream->flags & STREAM_APPENDS);
  long long position = seek_host(stream, 0, appends ? SEEK_END : SEEK_CUR);
  if (position >= 0)
    position += is_reading ? (long long)stream->at - stream->end : stream->at;
  unlock_stream(stream);
  return position;
}

int fseek(FILE *stream, long offset, int origin) {
  return fseeko(stream, offset, origin);
}

long ftell(FILE *stream) {
  off_t position = ftello(stream);
  if (position > LONG_MAX) {
    errno = EOVERFLOW;
    return -1;
  }
  return (long)position;
}

void rewind(FILE *stream) {
  fseek(stream, 0, SEEK_SET);
  clearerr(stream);
}

int fgetpos(FILE *restrict stream, fpos_t *restrict position) {
  *position = ftello(stream);
  return *position < 0 ? -1 : 0;
}

int fsetpos(FILE *stream, const fpos_t *position) {
  return fseeko(stream, *position, SEEK_SET);
}

int feof(FILE *stream) {
  return !is_stdout(stream) && (stream->flags & STREAM_ENDED);
}

int ferror(FILE *stream) {
  return !is_stdout(stream) && (stream->flags & STREAM_FAILED);
}

void clearerr(FILE *stream) {
  if (!is_stdout(stream))
    stream->flags &= ~(unsigned)(STREAM_ENDED | STREAM_FAILED);
}

int remove(const char *path) {
  int result = host_call(TRAX_HOST_REMOVE, (uintptr_t)path, 0, 0);
  if (result == -EISDIR)
    result = host_call(TRAX_HOST_REMOVE_FOLDER, (uintptr_t)path, 0, 0);
  return host_result(result);
}

int rename(const char *from, const char *to) {
  return host_result(host_call(TRAX_HOST_RENAME, (uintptr_t)from, (uintptr_t)to, 0));
}

/* There is no folder for temporary files. */
FILE *tmpfile(void) {
  errno = ENOSYS;
  return NULL;
}

char *tmpnam(char *name) {
  (void)name;
  return NULL;
}
