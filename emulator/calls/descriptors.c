/* The calls one by one: descriptors and names. */
#include "calls/internal.h"

#include "machine/host_call.h"

#include <errno.h>
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

static int find_place(struct trax_calls *calls, const struct trax_host_call *call, unsigned word,
                      enum trax_follow follow, struct trax_place *place) {
  char path[PATH_MAX];
  place->folder = NULL;
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

/* Whether a file at the place, of the kind that is there, may be opened so. */
static int check_open(struct trax_calls *calls, const struct trax_place *place, uint32_t flags, mode_t kind) {
  const bool creates = flags & TRAX_OPEN_CREATE, writes = (flags & 3) != TRAX_OPEN_READ || flags & TRAX_OPEN_TRUNCATE;
  if (!kind && !creates)
    return ENOENT;
  if (kind && creates && (flags & TRAX_OPEN_NEW))
    return EEXIST;
  if (S_ISDIR(kind))
    return EISDIR;
  if (kind && place->slash)
    return ENOTDIR;
  if (kind && !S_ISREG(kind))
    return EPERM;
  return writes || !kind ? trax_folder_check(calls, place->folder) : 0; /* where it will be replaced */
}

static int find_or_create(struct trax_calls *calls, const struct trax_place *place, uint32_t flags,
                          struct trax_file **file) {
  const bool writes = (flags & 3) != TRAX_OPEN_READ || flags & TRAX_OPEN_TRUNCATE;
  struct trax_name *name = NULL;
  mode_t kind;
  if (place->last != TRAX_LAST_NAME)
    return flags & TRAX_OPEN_CREATE && flags & TRAX_OPEN_NEW ? EEXIST : EISDIR;
  if (flags & TRAX_OPEN_CREATE && place->slash)
    return EISDIR;
  int failure = trax_name_look(calls, place, &kind, &name);
  if (!failure)
    failure = check_open(calls, place, flags, kind);
  if (failure)
    return failure;
  if (!kind) {
    failure = trax_file_create(calls, place, file);
    if (!failure && !trax_name_set(calls, place, *file))
      failure = ENOMEM;
    if (!failure)
      (*file)->differs = true;
    return failure;
  }
  failure = trax_name_take(calls, place, flags & TRAX_OPEN_TRUNCATE, &name);
  if (!failure && writes && !name->file->writable)
    failure = EACCES;
  if (failure)
    return failure;
  *file = name->file;
  if (flags & TRAX_OPEN_TRUNCATE) {
    trax_contents_resize(&(*file)->contents, 0);
    (*file)->differs = true;
  }
  return 0;
}

static int32_t open_file(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t flags = call->words[2];
  const bool creates = flags & TRAX_OPEN_CREATE, is_new = creates && flags & TRAX_OPEN_NEW;
  const enum trax_follow follow = is_new ? TRAX_FOLLOW_NONE : creates ? TRAX_FOLLOW_NAMES : TRAX_FOLLOW_ALL;
  struct trax_place place;
  struct trax_file *file;
  uint32_t number = TRAX_FIRST_DESCRIPTOR;
  while (number < TRAX_MOST_DESCRIPTORS && calls->descriptors[number].file)
    number++;
  if (number == TRAX_MOST_DESCRIPTORS)
    return -EMFILE;
  if ((flags & 3) == 3)
    return -EINVAL;
  int failure = find_place(calls, call, 1, follow, &place);
  if (!failure)
    failure = find_or_create(calls, &place, flags, &file);
  if (!failure) {
    file->opens++;
    calls->descriptors[number] = (struct trax_descriptor){.file = file, .flags = flags};
  }
  trax_files_forget(calls);
  trax_place_release(calls, &place);
  return failure ? -failure : (int32_t)number;
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
  int failure = 0;
  descriptor->file = NULL;
  if (--file->opens == 0 && !calls->deferred) {
    failure = trax_commit_file(calls, file);
    file->differs = false; /* what could not be written is lost; the former file stays */
  }
  trax_files_forget(calls);
  return -failure;
}

static int32_t read_bytes(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t number = call->words[1], count = call->words[3] <= INT32_MAX ? call->words[3] : INT32_MAX;
  struct trax_descriptor *descriptor = descriptor_of(calls, number);
  bool is_stream;
  stream_of(calls, number, &is_stream);
  if (is_stream ? number != STDIN_FILENO : !descriptor || (descriptor->flags & 3) == TRAX_OPEN_WRITE)
    return -EBADF;
  uint32_t got = 0;
  if (!is_stream && descriptor->offset > (uint64_t)INT64_MAX - count)
    return -EINVAL;
  if (!is_stream && descriptor->offset < descriptor->file->contents.size) {
    const uint64_t left = descriptor->file->contents.size - descriptor->offset;
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
    trax_contents_read(&descriptor->file->contents, descriptor->offset, bytes, got);
  descriptor->offset += got;
  return (int32_t)got;
}

static int32_t write_file(struct trax_descriptor *descriptor, const uint8_t *bytes, uint32_t count) {
  struct trax_file *file = descriptor->file;
  const uint64_t offset = descriptor->flags & TRAX_OPEN_APPEND ? file->contents.size : descriptor->offset;
  if (!count)
    return 0;
  if (descriptor->offset > (uint64_t)INT64_MAX - count)
    return -EINVAL;
  if (offset >= trax_contents_most)
    return -EFBIG;
  if (count > trax_contents_most - offset)
    count = (uint32_t)(trax_contents_most - offset);
  const int failure = trax_contents_write(&file->contents, offset, bytes, count);
  if (failure)
    return -failure;
  file->differs = true;
  descriptor->offset = offset + count;
  return (int32_t)count;
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
  if (!is_stream)
    return write_file(descriptor, bytes, count);
  if (stream == calls->streams.errors && stream != calls->streams.output && calls->streams.output)
    fflush(calls->streams.output); /* on a terminal both are in the order in which they were written */
  if (stream) {
    fwrite(bytes, 1, count, stream); /* its owner reports a failure at the end */
    fflush(stream);
  }
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
  const uint64_t origins[] = {0, descriptor->offset, descriptor->file->contents.size};
  if (call->words[3] > TRAX_SEEK_END)
    return -EINVAL;
  const uint64_t result = origins[call->words[3]] + (uint64_t)offset; /* both are below 2^63 */
  if (result > INT64_MAX)
    return -EINVAL;
  descriptor->offset = result;
  memcpy(bytes, &result, sizeof result);
  return 0;
}

static int32_t truncate_file(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_descriptor *descriptor = descriptor_of(calls, call->words[1]);
  const uint8_t *bytes = trax_host_call_bytes(call, call->words[2], 8, false);
  bool is_stream;
  int64_t size;
  stream_of(calls, call->words[1], &is_stream);
  if (!bytes)
    return -EFAULT;
  memcpy(&size, bytes, sizeof size);
  if (size < 0)
    return -EINVAL;
  if (!descriptor)
    return is_stream ? -EINVAL : -EBADF;
  if ((descriptor->flags & 3) == TRAX_OPEN_READ)
    return -EINVAL;
  const int failure = trax_contents_resize(&descriptor->file->contents, (uint64_t)size);
  descriptor->file->differs |= !failure;
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
  return put_stat(call, TRAX_MODE_FILE | (file->mode ? file->mode & 0700 : 0600), file->contents.size, file->number);
}

static int32_t put_host_stat(struct trax_calls *calls, const struct trax_host_call *call,
                             const struct trax_place *place) {
  struct stat status;
  const int failure = trax_place_stat(calls, place, &status);
  if (failure)
    return -failure;
  if (place->slash && !S_ISDIR(status.st_mode))
    return -ENOTDIR;
  const uint32_t kind = S_ISREG(status.st_mode)   ? TRAX_MODE_FILE
                        : S_ISDIR(status.st_mode) ? TRAX_MODE_FOLDER
                        : S_ISLNK(status.st_mode) ? TRAX_MODE_LINK
                                                  : TRAX_MODE_OTHER;
  return put_stat(call, kind | (status.st_mode & 0700), (uint64_t)(kind == TRAX_MODE_FILE ? status.st_size : 0),
                  trax_file_number(calls, place));
}

static int32_t stat_path(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_place place;
  struct trax_name *name = NULL;
  mode_t kind;
  int failure = find_place(calls, call, 1, call->words[3] ? TRAX_FOLLOW_ALL : TRAX_FOLLOW_SLASH, &place);
  if (!failure && place.last == TRAX_LAST_NAME)
    failure = trax_name_look(calls, &place, &kind, &name);
  if (!failure && name)
    failure = name->file ? place.slash ? ENOTDIR : -put_file_stat(call, name->file) : ENOENT;
  else if (!failure)
    failure = -put_host_stat(calls, call, &place);
  trax_files_forget(calls);
  trax_place_release(calls, &place);
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

static int32_t change_name(struct trax_calls *calls, const struct trax_host_call *call,
                           int (*change)(struct trax_calls *calls, const struct trax_place *place)) {
  struct trax_place place;
  int failure = find_place(calls, call, 1, TRAX_FOLLOW_NONE, &place);
  if (!failure)
    failure = change(calls, &place);
  trax_place_release(calls, &place);
  return -failure;
}

static int32_t rename_file(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_place from, to = {.folder = NULL};
  int failure = find_place(calls, call, 1, TRAX_FOLLOW_NONE, &from);
  if (!failure)
    failure = find_place(calls, call, 2, TRAX_FOLLOW_NONE, &to);
  if (!failure)
    failure = trax_name_rename(calls, &from, &to);
  trax_place_release(calls, &from);
  trax_place_release(calls, &to);
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
    return change_name(calls, call, trax_name_remove);
  case TRAX_HOST_RENAME:
    return rename_file(calls, call);
  case TRAX_HOST_MAKE_FOLDER:
    return change_name(calls, call, trax_folder_make);
  case TRAX_HOST_REMOVE_FOLDER:
    return change_name(calls, call, trax_folder_remove);
  default:
    return -TRAX_HOST_NO_CALL;
  }
}
