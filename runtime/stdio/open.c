/* Opening and closing streams. */
#include "stream.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "../internal/host.h"

/* The flags of the host call and of the stream for a mode of fopen. -1: there is no such mode. */
static int read_mode(const char *mode, unsigned *flags) {
  int both = strchr(mode, '+') != NULL, how;
  switch (mode[0]) {
  case 'r':
    how = 0;
    *flags = STREAM_READS;
    break;
  case 'w':
    how = TRAX_OPEN_CREATE | TRAX_OPEN_TRUNCATE;
    *flags = STREAM_WRITES;
    break;
  case 'a':
    how = TRAX_OPEN_CREATE | TRAX_OPEN_APPEND;
    *flags = STREAM_WRITES | STREAM_APPENDS;
    break;
  default:
    errno = EINVAL;
    return -1;
  }
  if (strchr(mode, 'x'))
    how |= TRAX_OPEN_NEW;
  if (both)
    *flags |= STREAM_READS | STREAM_WRITES;
  return how | (both ? TRAX_OPEN_BOTH : mode[0] == 'r' ? TRAX_OPEN_READ : TRAX_OPEN_WRITE);
}

static void enter_list(FILE *stream) {
  lock(&trax_streams_lock);
  stream->next = trax_streams;
  stream->link = &trax_streams;
  if (stream->next)
    stream->next->link = &stream->next;
  trax_streams = stream;
  unlock(&trax_streams_lock);
}

static void leave_list(FILE *stream) {
  if (!stream->link) /* a standard stream as it was at start */
    return;
  lock(&trax_streams_lock);
  *stream->link = stream->next;
  if (stream->next)
    stream->next->link = stream->link;
  stream->link = NULL;
  unlock(&trax_streams_lock);
}

static FILE *make(int descriptor, unsigned flags) {
  FILE *stream = calloc(1, sizeof *stream);
  if (!stream) {
    errno = ENOMEM;
    return NULL;
  }
  stream->descriptor = descriptor;
  stream->flags = flags;
  enter_list(stream);
  return stream;
}

FILE *fopen(const char *restrict path, const char *restrict mode) {
  unsigned flags;
  int how = read_mode(mode, &flags);
  int descriptor = how < 0 ? -1 : host_result(host_call(TRAX_HOST_OPEN, (uintptr_t)path, (unsigned)how, 0));
  if (descriptor < 0)
    return NULL;
  FILE *stream = make(descriptor, flags);
  if (!stream)
    host_call(TRAX_HOST_CLOSE, (unsigned)descriptor, 0, 0);
  return stream;
}

FILE *fdopen(int descriptor, const char *mode) {
  unsigned flags;
  if (descriptor == 1)
    return stdout;
  if (read_mode(mode, &flags) < 0 || host_result(host_call(TRAX_HOST_TERMINAL, (unsigned)descriptor, 0, 0)) < 0)
    return NULL;
  return make(descriptor, flags);
}

static int finish(FILE *stream) {
  lock_stream(stream);
  int result = trax_stream_flush(stream);
  int closed = host_result(host_call(TRAX_HOST_CLOSE, (unsigned)stream->descriptor, 0, 0));
  if (stream->flags & STREAM_OWNS_BUFFER)
    free(stream->buffer);
  stream->buffer = NULL;
  unlock_stream(stream);
  return result || closed < 0 ? EOF : 0;
}

/* A standard stream stays, and is closed. */
static void release(FILE *stream) {
  if (stream != stdin && stream != stderr)
    free(stream);
  else
    stream->flags = 0;
}

int fclose(FILE *stream) {
  if (is_stdout(stream))
    return 0;
  leave_list(stream);
  int result = finish(stream);
  release(stream);
  return result;
}

/* The host gives the file to descriptor 1, where the text of standard output goes. */
static FILE *reopen_stdout(const char *path, int how) {
  host_call(TRAX_HOST_CLOSE, 1, 0, 0);
  const int opened = host_result(host_call(TRAX_HOST_OPEN, (uintptr_t)path, (unsigned)how, 0));
  if (opened < 0 || opened == 1)
    return opened < 0 ? NULL : stdout;
  const int moved = host_result(host_call(TRAX_HOST_DUPLICATE, (unsigned)opened, 1, 1));
  host_call(TRAX_HOST_CLOSE, (unsigned)opened, 0, 0);
  return moved < 0 ? NULL : stdout;
}

/* A stream that cannot be opened again is closed, as C requires. Without a path the mode may be given again, for those
   that want standard streams to be binary. */
FILE *freopen(const char *restrict path, const char *restrict mode, FILE *restrict stream) {
  unsigned flags;
  int how = read_mode(mode, &flags);
  if (how < 0) {
    errno = EINVAL;
    return NULL;
  }
  if (!path) {
    if (is_stdout(stream) ? flags & STREAM_WRITES : (flags & ~stream->flags & (STREAM_READS | STREAM_WRITES)) == 0)
      return stream;
    errno = EBADF;
    return NULL;
  }
  if (is_stdout(stream))
    return reopen_stdout(path, how);
  finish(stream);
  int descriptor = host_result(host_call(TRAX_HOST_OPEN, (uintptr_t)path, (unsigned)how, 0));
  if (descriptor < 0) {
    leave_list(stream);
    release(stream);
    return NULL;
  }
  if (!stream->link)
    enter_list(stream);
  stream->descriptor = descriptor;
  stream->flags = flags;
  stream->at = stream->end = 0;
  return stream;
}

int setvbuf(FILE *restrict stream, char *restrict buffer, int mode, size_t size) {
  (void)buffer;
  (void)size;
  if (is_stdout(stream))
    return 0;
  lock_stream(stream);
  stream->flags &= ~(unsigned)(STREAM_BY_LINE | STREAM_AT_ONCE);
  stream->flags |= mode == _IONBF ? STREAM_AT_ONCE : mode == _IOLBF ? STREAM_BY_LINE : 0;
  unlock_stream(stream);
  return 0;
}

void setbuf(FILE *restrict stream, char *restrict buffer) {
  setvbuf(stream, buffer, buffer ? _IOFBF : _IONBF, BUFSIZ);
}

void setbuffer(FILE *stream, char *buffer, size_t size) {
  setvbuf(stream, buffer, buffer ? _IOFBF : _IONBF, size);
}

void setlinebuf(FILE *stream) {
  setvbuf(stream, NULL, _IOLBF, 0);
}

int fileno(FILE *stream) {
  return is_stdout(stream) ? 1 : stream->descriptor;
}
