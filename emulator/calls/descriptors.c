/* Descriptors, what they refer to, and the calls that take one. */
#include "calls/internal.h"

#include "machine/machine.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

/* Prints what a trap gives to descriptor 1, which is not the run's output. */
static void print(void *calls, const uint8_t *bytes, size_t count);

struct trax_opened *trax_descriptor_find(struct trax_calls *calls, uint32_t number) {
  return number < TRAX_MOST_DESCRIPTORS ? calls->descriptors[number] : NULL;
}

/* The host's stream; NULL: there is none. */
static FILE *stream_of(const struct trax_calls *calls, const struct trax_opened *opened) {
  return opened->kind == TRAX_OPENED_INPUT    ? calls->streams.input
         : opened->kind == TRAX_OPENED_OUTPUT ? calls->streams.output
         : opened->kind == TRAX_OPENED_ERRORS ? calls->streams.errors
                                              : NULL;
}

uint32_t trax_descriptor_free(const struct trax_calls *calls, uint32_t number) {
  while (number < TRAX_MOST_DESCRIPTORS && calls->descriptors[number])
    number++;
  return number;
}

void trax_descriptor_share(struct trax_calls *calls, uint32_t number, struct trax_opened *opened) {
  opened->references++;
  calls->descriptors[number] = opened;
  if (number == STDOUT_FILENO) /* what traps print goes where the descriptor does */
    calls->machine->calls.print = opened->kind == TRAX_OPENED_OUTPUT ? NULL : print;
}

void trax_descriptor_open(struct trax_calls *calls, uint32_t number, const struct trax_opened *opened) {
  struct trax_opened *place = calls->opened; /* there are as many as descriptors */
  while (place->references)
    place++;
  *place = *opened;
  place->references = 0;
  if (place->file)
    place->file->opens++;
  if (place->folder)
    trax_folder_refer(place->folder);
  trax_descriptor_share(calls, number, place);
}

static int close_descriptor(struct trax_calls *calls, uint32_t number) {
  struct trax_opened *opened = calls->descriptors[number];
  struct trax_file *file = opened->file;
  int failure = 0;
  calls->descriptors[number] = NULL;
  if (number == STDOUT_FILENO)
    calls->machine->calls.print = print;
  if (--opened->references)
    return 0;
  trax_folder_release(calls, opened->folder);
  if (!file)
    return 0;
  if (--file->opens == 0 && !calls->deferred) {
    failure = trax_commit_file(calls, file);
    file->differs = false; /* what could not be written is lost; the former file stays */
  }
  trax_files_forget(calls);
  return failure;
}

void trax_descriptors_begin(struct trax_calls *calls) {
  for (uint32_t i = STDIN_FILENO; i <= STDERR_FILENO; i++)
    trax_descriptor_open(
        calls, i, &(struct trax_opened){.kind = TRAX_OPENED_INPUT + i, .flags = i ? TRAX_OPEN_WRITE : TRAX_OPEN_READ});
}

void trax_descriptors_forget(struct trax_calls *calls) {
  for (uint32_t i = 0; i < TRAX_MOST_DESCRIPTORS; i++)
    if (calls->opened[i].references) {
      trax_folder_release(calls, calls->opened[i].folder);
      calls->opened[i].references = 0;
    }
  memset(calls->descriptors, 0, sizeof calls->descriptors);
  calls->machine->calls.print = print;
}

/* --- calls --- */

int32_t trax_serve_close(struct trax_calls *calls, const struct trax_host_call *call) {
  return trax_descriptor_find(calls, call->words[1]) ? -close_descriptor(calls, call->words[1]) : -EBADF;
}

int32_t trax_serve_duplicate(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  uint32_t number = call->words[2];
  int failure = 0;
  if (!opened)
    return -EBADF;
  if (number >= TRAX_MOST_DESCRIPTORS)
    return call->words[3] ? -EBADF : -EINVAL;
  if (!call->words[3])
    number = trax_descriptor_free(calls, number);
  else if (calls->descriptors[number] == opened)
    return (int32_t)number;
  else if (calls->descriptors[number])
    failure = close_descriptor(calls, number);
  if (number == TRAX_MOST_DESCRIPTORS)
    return -EMFILE;
  trax_descriptor_share(calls, number, opened);
  return failure ? -failure : (int32_t)number;
}

/* The bytes of an open file that `count` bytes from its offset have. */
static uint32_t left_of(const struct trax_opened *opened, uint32_t count) {
  if (opened->kind != TRAX_OPENED_FILE || opened->offset >= opened->file->contents.size)
    return 0;
  const uint64_t left = opened->file->contents.size - opened->offset;
  return left < count ? (uint32_t)left : count;
}

int32_t trax_serve_read(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t count = call->words[3] <= INT32_MAX ? call->words[3] : INT32_MAX;
  struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  if (!opened || (opened->flags & 3) == TRAX_OPEN_WRITE)
    return -EBADF;
  if (opened->folder)
    return -EISDIR;
  if (opened->offset > (uint64_t)INT64_MAX - count)
    return -EINVAL;
  uint32_t got = left_of(opened, count);
  uint8_t *bytes = trax_host_call_bytes(call, call->words[2], opened->kind == TRAX_OPENED_INPUT ? count : got, true);
  if (!bytes)
    return -EFAULT;
  if (opened->kind == TRAX_OPENED_INPUT) {
    if (calls->streams.output) /* a prompt precedes its answer */
      fflush(calls->streams.output);
    const int failure = trax_input_take(calls, bytes, count, &got);
    return failure ? -failure : (int32_t)got;
  }
  if (got)
    trax_contents_read(&opened->file->contents, opened->offset, bytes, got);
  opened->offset += got;
  return (int32_t)got;
}

static int32_t write_file(struct trax_opened *opened, const uint8_t *bytes, uint32_t count) {
  struct trax_file *file = opened->file;
  const uint64_t offset = opened->flags & TRAX_OPEN_APPEND ? file->contents.size : opened->offset;
  if (!count)
    return 0;
  if (opened->offset > (uint64_t)INT64_MAX - count)
    return -EINVAL;
  if (offset >= trax_contents_most)
    return -EFBIG;
  if (count > trax_contents_most - offset)
    count = (uint32_t)(trax_contents_most - offset);
  const int failure = trax_contents_write(&file->contents, offset, bytes, count);
  if (failure)
    return -failure;
  file->differs = true;
  opened->offset = offset + count;
  return (int32_t)count;
}

/* Writes to a descriptor that is open for writing. Returns the result of the call. */
static int32_t write_opened(struct trax_calls *calls, struct trax_opened *opened, const uint8_t *bytes,
                            uint32_t count) {
  if (opened->kind == TRAX_OPENED_FILE)
    return write_file(opened, bytes, count);
  FILE *const stream = stream_of(calls, opened), *const output = calls->streams.output;
  if (opened->kind == TRAX_OPENED_ERRORS && stream != output && output)
    fflush(output); /* on a terminal both are in the order in which they were written */
  if (stream) {
    fwrite(bytes, 1, count, stream); /* its owner reports a failure at the end */
    fflush(stream);
  }
  return (int32_t)count;
}

int32_t trax_serve_write(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t count = call->words[3] <= INT32_MAX ? call->words[3] : INT32_MAX;
  struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  if (!opened || (opened->flags & 3) == TRAX_OPEN_READ)
    return -EBADF;
  const uint8_t *bytes = trax_host_call_bytes(call, call->words[2], count, false);
  return bytes ? write_opened(calls, opened, bytes, count) : -EFAULT;
}

static void print(void *context, const uint8_t *bytes, size_t count) {
  struct trax_calls *calls = context;
  struct trax_opened *opened = calls->descriptors[STDOUT_FILENO];
  if (opened && (opened->flags & 3) != TRAX_OPEN_READ)
    write_opened(calls, opened, bytes, (uint32_t)count);
}

int32_t trax_serve_seek(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  if (!opened)
    return -EBADF;
  if (opened->kind != TRAX_OPENED_FILE && opened->kind != TRAX_OPENED_NOTHING && !opened->folder)
    return -ESPIPE;
  uint8_t *bytes = trax_host_call_bytes(call, call->words[2], 8, true);
  int64_t offset;
  if (!bytes)
    return -EFAULT;
  memcpy(&offset, bytes, sizeof offset);
  const uint64_t origins[] = {0, opened->offset, opened->file ? opened->file->contents.size : 0};
  if (call->words[3] > TRAX_SEEK_END)
    return -EINVAL;
  const uint64_t result = origins[call->words[3]] + (uint64_t)offset; /* both are below 2^63 */
  if (result > INT64_MAX && opened->file)
    return -EINVAL;
  opened->offset = opened->file ? result : 0;
  memcpy(bytes, &opened->offset, sizeof opened->offset);
  return 0;
}

int32_t trax_serve_truncate(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  const uint8_t *bytes = trax_host_call_bytes(call, call->words[2], 8, false);
  int64_t size;
  if (!bytes)
    return -EFAULT;
  memcpy(&size, bytes, sizeof size);
  if (size < 0)
    return -EINVAL;
  if (!opened)
    return -EBADF;
  if (!opened->file || (opened->flags & 3) == TRAX_OPEN_READ)
    return -EINVAL;
  const int failure = trax_contents_resize(&opened->file->contents, (uint64_t)size);
  opened->file->differs |= !failure;
  return -failure;
}

int32_t trax_serve_terminal(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  FILE *const stream = opened ? stream_of(calls, opened) : NULL;
  return !opened ? -EBADF : stream && fileno(stream) >= 0 && isatty(fileno(stream));
}
