/* Standard input. A read ends with a line or with the input, whatever the host gives at a time: so what a program gets
   follows from the contents alone. */
#include "calls/internal.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CAPACITY = 1 << 16, PATIENCE = 100 /* ms between looks at the interrupt flag */ };

static bool interrupted(const struct trax_calls *calls) {
  return calls->streams.interrupt && *calls->streams.interrupt;
}

/* Reads a stream without a descriptor (fmemopen) up to the end of a line, since it cannot be polled. */
static int refill_by_stdio(struct trax_stream_input *input, FILE *stream) {
  for (int byte = 0; input->end < CAPACITY && byte != '\n';) {
    byte = getc(stream);
    if (byte == EOF) {
      input->ended = true;
      return ferror(stream) ? EIO : 0;
    }
    input->bytes[input->end++] = (uint8_t)byte;
  }
  return 0;
}

/* Appends the bytes that can be read at once to the kept ones, which are fewer than CAPACITY. */
static int refill(struct trax_calls *calls) {
  struct trax_stream_input *input = &calls->input;
  const int descriptor = fileno(calls->streams.input);
  if (!input->bytes && !(input->bytes = malloc(CAPACITY)))
    return ENOMEM;
  memmove(input->bytes, input->bytes + input->at, input->end - input->at);
  input->end -= input->at;
  input->at = 0;
  if (descriptor < 0)
    return refill_by_stdio(input, calls->streams.input);
  struct pollfd ready = {.fd = descriptor, .events = POLLIN};
  int count;
  do {
    count = poll(&ready, 1, PATIENCE);
    if (interrupted(calls)) /* before poll, or in it */
      return EINTR;
  } while (count <= 0);
  const ssize_t got = read(descriptor, input->bytes + input->end, CAPACITY - input->end);
  if (got < 0)
    return errno == EINTR && !interrupted(calls) ? 0 : errno;
  input->ended = got == 0;
  input->end += (size_t)got;
  return 0;
}

int trax_input_take(struct trax_calls *calls, uint8_t *bytes, uint32_t count, uint32_t *got) {
  struct trax_stream_input *input = &calls->input;
  *got = 0;
  if (count > CAPACITY)
    count = CAPACITY;
  while (true) {
    const size_t kept = input->end - input->at, most = kept < count ? kept : count;
    const uint8_t *end = most ? memchr(input->bytes + input->at, '\n', most) : NULL;
    if (end || most == count || input->ended || !calls->streams.input) {
      *got = (uint32_t)(end ? (size_t)(end + 1 - (input->bytes + input->at)) : most);
      break;
    }
    const int failure = refill(calls);
    if (failure)
      return failure;
  }
  if (*got == 0) {
    input->ended = input->ended && count == 0; /* a terminal may go on after its end */
    return 0;
  }
  if (!input->digest) {
    if (!(input->digest = XXH3_createState()))
      return ENOMEM;
    XXH3_128bits_reset(input->digest);
  }
  memcpy(bytes, input->bytes + input->at, *got);
  XXH3_128bits_update(input->digest, bytes, *got);
  input->at += *got;
  input->taken += *got;
  return 0;
}
