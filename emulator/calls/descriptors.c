/* The calls one by one: descriptors and names. */
#define _GNU_SOURCE /* faccessat with AT_EACCESS */
#include "calls/internal.h"

#include "machine/host_call.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

/* --- the program's memory --- */

/* Copies a path. */
static int read_path(const struct trax_host_call *call, uint32_t address, char path[PATH_MAX]) {
  for (uint32_t i = 0; i < PATH_MAX; i++) {
    const uint8_t *byte = trax_host_call_bytes(call, address + i, 1, false);
    if (!byte)
      return EFAULT;
    path[i] = (char)*byte;
    if (!path[i])
      return 0;
  }
  return ENAMETOOLONG;
}

static int find_place(const struct trax_calls *calls, const struct trax_host_call *call, unsigned word, bool follow,
                      char path[PATH_MAX], struct trax_place *place) {
  place->folder = -1;
  const int failure = read_path(call, call->words[word], path);
  return failure ? failure : trax_place_find(calls, path, follow, place);
}

/* --- descriptors --- */

static struct trax_descriptor *descriptor_of(struct trax_calls *calls, uint32_t number) {
  return number < TRAX_MOST_DESCRIPTORS && calls->descriptors[number].file ? &calls->descriptors[number] : NULL;
}

/* The stream of standard input, output or errors; NULL: it is another descriptor, or closed. *is: it is one. */
static FILE *stream_of(const struct trax_calls *calls, uint32_t number, bool *is) {
  FILE *const streams[] = {calls->streams.input, calls->streams.output, calls->streams.errors};
  *is = number < TRAX_FIRST_DESCRIPTOR && !calls->closed[number];
  return *is ? streams[number] : NULL;
}

static int32_t open_file(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t flags = call->words[2], access_mode = flags & 3;
  char path[PATH_MAX];
  struct trax_place place;
  uint32_t number = TRAX_FIRST_DESCRIPTOR;
  while (number < TRAX_MOST_DESCRIPTORS && calls->descriptors[number].file)
    number++;
  if (number == TRAX_MOST_DESCRIPTORS)
    return -EMFILE;
  if (access_mode == 3)
    return -EINVAL;
  const bool is_new = (flags & TRAX_OPEN_CREATE) && (flags & TRAX_OPEN_NEW);
  int failure = find_place(calls, call, 1, !is_new, path, &place);
  struct trax_file *file = failure ? NULL : trax_file_find(calls, &place);
  if (!failure && access_mode != TRAX_OPEN_READ &&
      (faccessat(place.folder, ".", W_OK, AT_EACCESS) != 0 ||
       (faccessat(place.folder, place.name, W_OK, AT_EACCESS) != 0 && errno != ENOENT)))
    failure = errno;
  if (!failure && !file)
    failure = trax_file_load(calls, &place, path, flags & TRAX_OPEN_CREATE, &file);
  trax_place_release(&place);
  if (!failure && file->exists && is_new)
    failure = EEXIST;
  if (!failure && !file->exists && !(flags & TRAX_OPEN_CREATE))
    failure = ENOENT;
  if (failure) {
    if (file && !file->opens && !file->changed)
      trax_file_forget(calls, file);
    return -failure;
  }
  if (!file->exists || ((flags & TRAX_OPEN_TRUNCATE) && access_mode != TRAX_OPEN_READ)) {
    file->exists = file->changed = true;
    file->size = 0;
  }
  file->opens++;
  calls->descriptors[number] = (struct trax_descriptor){.file = file, .flags = flags};
  return (int32_t)number;
}

static int32_t close_file(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_descriptor *descriptor = descriptor_of(calls, call->words[1]);
  bool is_stream;
  stream_of(calls, call->words[1], &is_stream);
  if (is_stream) {
    calls->closed[call->words[1]] = true;
    return 0;
  }
  if (!descriptor)
    return -EBADF;
  struct trax_file *file = descriptor->file;
  descriptor->file = NULL;
  file->opens--;
  return -trax_file_settle(calls, file);
}

static int32_t read_bytes(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t number = call->words[1], count = call->words[3] <= INT32_MAX ? call->words[3] : INT32_MAX;
  struct trax_descriptor *descriptor = descriptor_of(calls, number);
  bool is_stream;
  stream_of(calls, number, &is_stream);
  if (is_stream ? number != STDIN_FILENO : !descriptor || (descriptor->flags & 3) == TRAX_OPEN_WRITE)
    return -EBADF;
  uint32_t got = 0;
  if (!is_stream && descriptor->offset < descriptor->file->size) {
    const uint64_t left = descriptor->file->size - descriptor->offset;
    got = left < count ? (uint32_t)left : count;
  }
  uint8_t *bytes = trax_host_call_bytes(call, call->words[2], is_stream ? count : got, true);
  if (!bytes)
    return -EFAULT;
  if (is_stream) {
    if (calls->streams.output) /* a prompt precedes its answer */
      fflush(calls->streams.output);
    const int failure = trax_input_take(calls, bytes, count, &got);
    return failure ? -failure : (int32_t)got;
  }
  if (got)
    memcpy(bytes, descriptor->file->bytes + descriptor->offset, got);
  descriptor->offset += got;
  return (int32_t)got;
}

static int32_t write_bytes(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t number = call->words[1], count = call->words[3] <= INT32_MAX ? call->words[3] : INT32_MAX;
  struct trax_descriptor *descriptor = descriptor_of(calls, number);
  bool is_stream;
  FILE *stream = stream_of(calls, number, &is_stream);
  if (is_stream ? number == STDIN_FILENO : !descriptor || (descriptor->flags & 3) == TRAX_OPEN_READ)
    return -EBADF;
  const uint8_t *bytes = trax_host_call_bytes(call, call->words[2], count, false);
  if (!bytes)
    return -EFAULT;
  if (is_stream) {
    if (stream == calls->streams.errors && stream != calls->streams.output && calls->streams.output)
      fflush(calls->streams.output); /* on a terminal both are in the order in which they were written */
    if (stream) {
      fwrite(bytes, 1, count, stream); /* its owner reports a failure at the end */
      fflush(stream);
    }
    return (int32_t)count;
  }
  if (descriptor->flags & TRAX_OPEN_APPEND)
    descriptor->offset = descriptor->file->size;
  const int failure = trax_file_write(descriptor->file, descriptor->offset, bytes, count);
  if (failure)
    return -failure;
  descriptor->offset += count;
  return (int32_t)count;
}

static int32_t seek(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_descriptor *descriptor = descriptor_of(calls, call->words[1]);
  bool is_stream;
  stream_of(calls, call->words[1], &is_stream);
  if (!descriptor)
    return is_stream ? -ESPIPE : -EBADF;
  uint8_t *bytes = trax_host_call_bytes(call, call->words[2], 8, true);
  int64_t offset;
  if (!bytes)
    return -EFAULT;
  memcpy(&offset, bytes, sizeof offset);
  const uint64_t origins[] = {0, descriptor->offset, descriptor->file->size};
  if (call->words[3] > TRAX_SEEK_END || offset < -INT64_C(0x4000000000000000) || offset > INT64_C(0x4000000000000000))
    return -EINVAL;
  offset += (int64_t)origins[call->words[3]];
  if (offset < 0)
    return -EINVAL;
  descriptor->offset = (uint64_t)offset;
  memcpy(bytes, &offset, sizeof offset);
  return 0;
}

static int32_t truncate_file(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_descriptor *descriptor = descriptor_of(calls, call->words[1]);
  const uint8_t *bytes = trax_host_call_bytes(call, call->words[2], 8, false);
  int64_t size;
  if (!descriptor || (descriptor->flags & 3) == TRAX_OPEN_READ)
    return descriptor ? -EINVAL : -EBADF;
  if (!bytes)
    return -EFAULT;
  memcpy(&size, bytes, sizeof size);
  if (size < 0)
    return -EINVAL;
  const int failure = trax_file_resize(descriptor->file, (uint64_t)size);
  descriptor->file->changed |= !failure;
  return -failure;
}

static int32_t is_terminal(const struct trax_calls *calls, const struct trax_host_call *call) {
  bool is_stream;
  FILE *stream = stream_of(calls, call->words[1], &is_stream);
  if (is_stream)
    return stream && fileno(stream) >= 0 && isatty(fileno(stream));
  return call->words[1] < TRAX_MOST_DESCRIPTORS && calls->descriptors[call->words[1]].file ? 0 : -EBADF;
}

/* --- struct trax_host_stat --- */

static int32_t put_stat(const struct trax_host_call *call, uint32_t mode, uint64_t size, uint64_t number) {
  uint8_t *bytes = trax_host_call_bytes(call, call->words[2], TRAX_STAT_WORDS * sizeof(uint32_t), true);
  const uint32_t words[TRAX_STAT_WORDS] = {mode, (uint32_t)size, (uint32_t)(size >> 32), (uint32_t)number,
                                           (uint32_t)(number >> 32)};
  if (!bytes)
    return -EFAULT;
  memcpy(bytes, words, sizeof words);
  return 0;
}

static int32_t put_file_stat(const struct trax_host_call *call, const struct trax_file *file) {
  return put_stat(call, TRAX_MODE_FILE | 0600, file->size, XXH3_64bits(file->path, strlen(file->path)));
}

static int32_t stat_path(const struct trax_calls *calls, const struct trax_host_call *call) {
  char path[PATH_MAX];
  struct trax_place place;
  struct stat status;
  int failure = find_place(calls, call, 1, call->words[3] != 0, path, &place);
  const struct trax_file *file = failure ? NULL : trax_file_find(calls, &place);
  if (!failure && file)
    failure = file->exists ? -put_file_stat(call, file) : ENOENT;
  else if (!failure && !(failure = trax_place_stat(&place, &status))) {
    const uint32_t kind = S_ISREG(status.st_mode)   ? TRAX_MODE_FILE
                          : S_ISDIR(status.st_mode) ? TRAX_MODE_FOLDER
                          : S_ISLNK(status.st_mode) ? TRAX_MODE_LINK
                                                    : TRAX_MODE_OTHER;
    failure = -put_stat(call, kind | (status.st_mode & 0700), (uint64_t)(kind == TRAX_MODE_FILE ? status.st_size : 0),
                        XXH3_64bits(path, strlen(path)));
  }
  trax_place_release(&place);
  return -failure;
}

static int32_t stat_descriptor(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_descriptor *descriptor = descriptor_of(calls, call->words[1]);
  bool is_stream;
  stream_of(calls, call->words[1], &is_stream);
  if (is_stream)
    return put_stat(call, TRAX_MODE_OTHER | 0600, 0, call->words[1]);
  return descriptor ? put_file_stat(call, descriptor->file) : -EBADF;
}

/* --- names --- */

static int32_t remove_file(struct trax_calls *calls, const struct trax_host_call *call) {
  char path[PATH_MAX];
  struct trax_place place;
  struct stat status;
  int failure = find_place(calls, call, 1, false, path, &place);
  struct trax_file *file = failure ? NULL : trax_file_find(calls, &place);
  if (!failure && !file && !(failure = trax_place_stat(&place, &status)) && S_ISLNK(status.st_mode)) {
    failure = calls->deferred ? EPERM : unlinkat(place.folder, place.name, 0) != 0 ? errno : 0;
    trax_place_release(&place);
    return -failure;
  }
  if (!failure && !file)
    failure = trax_file_load(calls, &place, path, false, &file);
  trax_place_release(&place);
  if (!failure && !file->exists)
    failure = ENOENT;
  if (!failure) {
    file->exists = false;
    file->changed = true;
    failure = trax_file_settle(calls, file);
  }
  return -failure;
}

static int32_t rename_file(struct trax_calls *calls, const struct trax_host_call *call) {
  char from_path[PATH_MAX], to_path[PATH_MAX];
  struct trax_place from, to = {.folder = -1};
  int failure = find_place(calls, call, 1, false, from_path, &from);
  if (!failure)
    failure = find_place(calls, call, 2, false, to_path, &to);
  if (!failure)
    failure = trax_file_rename(calls, &from, &to, to_path);
  trax_place_release(&from);
  trax_place_release(&to);
  return -failure;
}

/* Folders are made and removed at once, which a resumed run would do again. */
static int32_t change_folder(const struct trax_calls *calls, const struct trax_host_call *call, bool make) {
  char path[PATH_MAX];
  struct trax_place place;
  int failure = find_place(calls, call, 1, false, path, &place);
  if (!failure && calls->deferred)
    failure = EPERM;
  if (!failure &&
      (make ? mkdirat(place.folder, place.name, 0777) : unlinkat(place.folder, place.name, AT_REMOVEDIR)) != 0)
    failure = errno;
  trax_place_release(&place);
  return -failure;
}

int32_t trax_calls_serve(void *context, struct trax_host_call *call) {
  struct trax_calls *calls = context;
  calls->used = true;
  switch (call->words[0]) {
  case TRAX_HOST_OPEN:
    return open_file(calls, call);
  case TRAX_HOST_CLOSE:
    return close_file(calls, call);
  case TRAX_HOST_READ:
    return read_bytes(calls, call);
  case TRAX_HOST_WRITE:
    return write_bytes(calls, call);
  case TRAX_HOST_SEEK:
    return seek(calls, call);
  case TRAX_HOST_STAT:
    return stat_path(calls, call);
  case TRAX_HOST_FSTAT:
    return stat_descriptor(calls, call);
  case TRAX_HOST_TRUNCATE:
    return truncate_file(calls, call);
  case TRAX_HOST_TERMINAL:
    return is_terminal(calls, call);
  case TRAX_HOST_REMOVE:
    return remove_file(calls, call);
  case TRAX_HOST_RENAME:
    return rename_file(calls, call);
  case TRAX_HOST_MAKE_FOLDER:
    return change_folder(calls, call, true);
  case TRAX_HOST_REMOVE_FOLDER:
    return change_folder(calls, call, false);
  default:
    return -TRAX_HOST_NO_CALL;
  }
}
