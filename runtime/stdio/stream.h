/* Streams: those of fopen, standard input and standard error. Standard output has none: its bytes go to the host at
   once, so that none is lost when a program faults. */
#ifndef TRAX_RUNTIME_STREAM_H
#define TRAX_RUNTIME_STREAM_H

#include <stdio.h>

#include "../internal/machine.h"

enum {
  STREAM_READS = 1,
  STREAM_WRITES = 2,
  STREAM_IS_READING = 4, /* the buffer has what was read; else what is to be written */
  STREAM_ENDED = 8,      /* feof */
  STREAM_FAILED = 16,    /* ferror */
  STREAM_BY_LINE = 32,   /* written at the end of a line */
  STREAM_AT_ONCE = 64,   /* written at the end of a call */
  STREAM_APPENDS = 128,
  STREAM_OWNS_BUFFER = 256, /* from malloc */
};

enum { STREAM_BACK = 8 /* characters that ungetc takes at least: room before what was read */ };

struct trax_stream {
  int descriptor;
  unsigned flags;
  unsigned char *buffer; /* NULL before the first use */
  unsigned capacity;
  unsigned at, end; /* reading: [at, end) is left; writing: [0, at) waits */
  struct ticket_lock lock;
  struct trax_stream *next, **link; /* in the list of open streams */
  unsigned char last_resort[STREAM_BACK + 1];
};
#ifdef __trax__
_Static_assert(sizeof(struct trax_stream) == 13 * 4, "as <stdio.h> has it");
#endif

extern struct trax_stream *trax_streams;
extern struct ticket_lock trax_streams_lock;

/* Whether the stream is standard output. */
static inline int is_stdout(const FILE *stream) {
  return stream == stdout;
}

/* A single thread needs no lock: the lock costs an access to memory. */
static inline void lock_stream(FILE *stream) {
#ifdef __trax__
  if (trax_threads() != 1)
#endif
    lock(&stream->lock);
}
static inline void unlock_stream(FILE *stream) {
#ifdef __trax__
  if (trax_threads() != 1)
#endif
    unlock(&stream->lock);
}

/* With the lock held. 0, or EOF after an error, which errno and the stream then have. */
int trax_stream_begin_reading(FILE *stream);
int trax_stream_begin_writing(FILE *stream);
int trax_stream_flush(FILE *stream);
/* Gets the next characters from the host. EOF: an error or the end. */
int trax_stream_fill(FILE *stream);
/* Writes characters to the stream. Returns how many. */
size_t trax_stream_write(FILE *stream, const char *bytes, size_t count);

static inline int stream_get(FILE *stream) {
  if ((stream->at == stream->end || !(stream->flags & STREAM_IS_READING)) && trax_stream_fill(stream) == EOF)
    return EOF;
  return stream->buffer[stream->at++];
}

#endif
