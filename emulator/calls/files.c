#include "calls/internal.h"

#include "trax/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const uint64_t most_bytes = (uint64_t)1 << 32; /* of a file: more than a program can read into its memory */

/* --- the files that are kept --- */

struct trax_file *trax_file_find(const struct trax_calls *calls, const struct trax_place *place) {
  struct trax_file *file = calls->files;
  while (file && (file->place.device != place->device || file->place.inode != place->inode ||
                  strcmp(file->place.name, place->name) != 0))
    file = file->next;
  return file;
}

static void free_file(struct trax_file *file) {
  trax_place_release(&file->place);
  free(file->path);
  free(file->bytes);
  free(file);
}

void trax_file_forget(struct trax_calls *calls, struct trax_file *file) {
  struct trax_file **link = &calls->files;
  while (*link != file)
    link = &(*link)->next;
  *link = file->next;
  free_file(file);
}

/* --- contents --- */

int trax_file_resize(struct trax_file *file, uint64_t size) {
  if (size > most_bytes)
    return EFBIG;
  if (size > file->capacity) {
    const uint64_t capacity = size < 4096 ? 4096 : size + size / 2;
    uint8_t *grown = realloc(file->bytes, capacity);
    if (!grown)
      return ENOSPC;
    file->bytes = grown;
    file->capacity = capacity;
  }
  if (size > file->size)
    memset(file->bytes + file->size, 0, size - file->size);
  file->size = size;
  return 0;
}

int trax_file_write(struct trax_file *file, uint64_t offset, const uint8_t *bytes, uint32_t count) {
  if (!count)
    return 0;
  if (offset > most_bytes)
    return EFBIG;
  const int failure = offset + count > file->size ? trax_file_resize(file, offset + count) : 0;
  if (failure)
    return failure;
  memcpy(file->bytes + offset, bytes, count);
  file->changed = true;
  return 0;
}

/* Reads the host's file of the place into `file`. ENOENT: there is none. */
static int read_host_file(struct trax_file *file) {
  struct stat status;
  int failure = trax_place_stat(&file->place, &status);
  if (failure)
    return failure;
  if (!S_ISREG(status.st_mode)) /* to open a pipe or a device may wait or have effects */
    return S_ISDIR(status.st_mode) ? EISDIR : EPERM;
  const int descriptor = openat(file->place.folder, file->place.name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0)
    return errno;
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))
    failure = EPERM;
  else
    failure = trax_file_resize(file, (uint64_t)status.st_size);
  uint64_t got = 0;
  while (!failure && got < file->size) {
    const ssize_t part = read(descriptor, file->bytes + got, file->size - got);
    if (part < 0 && errno != EINTR)
      failure = errno;
    if (part == 0)
      file->size = got;
    got += part > 0 ? (uint64_t)part : 0;
  }
  close(descriptor);
  file->read = XXH3_128bits(file->bytes, file->size);
  return failure;
}

int trax_file_load(struct trax_calls *calls, struct trax_place *place, const char *path, bool create,
                   struct trax_file **file) {
  struct trax_file *fresh = calloc(1, sizeof *fresh);
  if (!fresh || !(fresh->path = strdup(path))) {
    free(fresh);
    return ENOMEM;
  }
  fresh->place = *place;
  int failure = read_host_file(fresh);
  fresh->was_there = fresh->exists = !failure;
  if (failure == ENOENT && create)
    failure = 0;
  if (failure) {
    fresh->place.folder = -1; /* still the caller's */
    free(fresh->path);
    free(fresh->bytes);
    free(fresh);
    return failure;
  }
  place->folder = -1;
  fresh->next = calls->files;
  calls->files = fresh;
  *file = fresh;
  return 0;
}

/* --- the host's files --- */

static int write_host_file(const struct trax_file *file) {
  char path[NAME_MAX + 64];
  trax_error error;
  snprintf(path, sizeof path, "/proc/self/fd/%d/%s", file->place.folder, file->place.name);
  errno = 0;
  return trax_write_file(path, file->bytes, file->size, &error) == TRAX_OK ? 0 : errno ? errno : EIO;
}

int trax_file_commit(struct trax_file *file) {
  if (!file->changed)
    return 0;
  int failure = 0;
  if (file->exists)
    failure = write_host_file(file);
  else if (file->was_there && unlinkat(file->place.folder, file->place.name, 0) != 0)
    failure = errno;
  file->changed = false;
  file->was_there = file->exists;
  return failure;
}

int trax_file_settle(struct trax_calls *calls, struct trax_file *file) {
  int failure = 0;
  if (file->opens && file->exists)
    return 0;
  if (!calls->deferred)
    failure = trax_file_commit(file);
  if (!file->opens && !file->changed)
    trax_file_forget(calls, file);
  return failure;
}

int trax_file_rename(struct trax_calls *calls, struct trax_place *from, struct trax_place *to, const char *to_path) {
  struct trax_file *source = trax_file_find(calls, from), *target = trax_file_find(calls, to);
  int failure = 0;
  if (source == target && source)
    return 0;
  if (source ? !source->exists : (failure = trax_file_load(calls, from, to_path, false, &source)) != 0)
    return failure ? failure : ENOENT;
  if (!target)
    failure = trax_file_load(calls, to, to_path, true, &target);
  if (failure) {
    trax_file_settle(calls, source);
    return failure;
  }
  failure = trax_file_resize(target, source->size);
  if (failure)
    return failure;
  if (source->size)
    memcpy(target->bytes, source->bytes, source->size);
  target->exists = target->changed = true;
  source->exists = false;
  source->changed = true;
  failure = trax_file_settle(calls, target);
  const int other = failure ? 0 : trax_file_settle(calls, source);
  return failure ? failure : other;
}
