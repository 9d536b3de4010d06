#include "trax/input.h"

#include "trax/beneath.h"
#include "trax/reads.h"
#include "trax/signals.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { POLL_MS = 100, FIRST = 1 << 16 };

static trax_status interrupted(const trax_input *input, trax_error *error) {
  trax_fail(error, "%s: interrupted while it was read", input->path);
  return TRAX_INTERRUPTED;
}

/* Without O_NONBLOCK, open would wait for the writer of a pipe, and a signal that arrives just before open would not
   interrupt the wait. */
enum { FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY };

static trax_status begin(trax_input *input, const char *path, int descriptor, trax_error *error) {
  *input = (trax_input){.path = path, .descriptor = descriptor};
  struct stat status;
  if (input->descriptor < 0 || fstat(input->descriptor, &status) != 0)
    return trax_fail(error, "%s: cannot be read: %s", path, strerror(errno));
  if (S_ISDIR(status.st_mode))
    return trax_fail(error, "%s: cannot be read: %s", path, strerror(EISDIR));
  trax_reads_note(&status);
  input->is_regular = S_ISREG(status.st_mode);
  input->expected = input->is_regular ? (size_t)status.st_size : 0;
  return TRAX_OK;
}

trax_status trax_input_open(trax_input *input, const char *path, trax_error *error) {
  return begin(input, path, open(path, FLAGS), error);
}

trax_status trax_input_open_beneath(trax_input *input, int folder, const char *path, const char *shown,
                                    trax_error *error) {
  const int descriptor = trax_beneath_open(folder, path, FLAGS);
  if (descriptor < 0 && errno == EXDEV) {
    *input = (trax_input){.path = shown, .descriptor = -1};
    return trax_fail(error, "%s: cannot be read: leaves its folder", shown);
  }
  return begin(input, shown, descriptor, error);
}

/* Makes room for one more byte and the NUL. */
static bool grow(trax_input *input, size_t most) {
  if (input->size < input->capacity)
    return true;
  size_t capacity = input->capacity ? input->capacity * 2 : input->expected < FIRST ? FIRST : input->expected + 1;
  capacity = capacity < most ? capacity : most;
  uint8_t *bytes = realloc(input->bytes, capacity + 1);
  if (!bytes)
    return false;
  input->bytes = bytes;
  input->capacity = capacity;
  return true;
}

trax_status trax_input_read(trax_input *input, size_t size, trax_error *error) {
  while (input->size < size) {
    if (!grow(input, size))
      return trax_fail(error, "%s: out of memory after %zu bytes", input->path, input->size);
    struct pollfd wait = {.fd = input->descriptor, .events = POLLIN};
    const int ready = poll(&wait, 1, POLL_MS);
    if (trax_signal)
      return interrupted(input, error);
    if (ready <= 0)
      continue;
    const size_t room = input->capacity < size ? input->capacity : size;
    const ssize_t got = read(input->descriptor, input->bytes + input->size, room - input->size);
    if (got == 0)
      break;
    if (got < 0 && errno != EINTR && errno != EAGAIN)
      return trax_fail(error, "%s: cannot be read: %s", input->path, strerror(errno));
    input->size += got > 0 ? (size_t)got : 0;
  }
  if (!input->bytes && !(input->bytes = malloc(1)))
    return trax_fail(error, "%s: out of memory", input->path);
  input->bytes[input->size] = 0;
  return TRAX_OK;
}

void trax_input_close(trax_input *input) {
  if (input->descriptor >= 0)
    close(input->descriptor);
  free(input->bytes);
  *input = (trax_input){.descriptor = -1};
}

trax_status trax_input_read_all(trax_input *input, trax_status opened, size_t limit, uint8_t **bytes, size_t *size,
                                trax_error *error) {
  trax_status status = opened;
  if (status == TRAX_OK && input->expected <= limit)
    status = trax_input_read(input, limit + 1, error); /* one byte more proves that the file is too large */
  if (status == TRAX_OK && (input->expected > limit || input->size > limit))
    status = trax_fail(error, "%s: more than %zu bytes", input->path, limit);
  if (status == TRAX_OK) {
    *bytes = input->bytes;
    *size = input->size;
    input->bytes = NULL;
  }
  trax_input_close(input);
  return status;
}

trax_status trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error) {
  trax_input input;
  const trax_status opened = trax_input_open(&input, path, error);
  return trax_input_read_all(&input, opened, limit, bytes, size, error);
}
