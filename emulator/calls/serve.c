/* The calls with paths, and the choice of the call by its number. */
#define _GNU_SOURCE /* faccessat with AT_EACCESS */
#include "calls/internal.h"

#include "machine/machine.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
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

/* The path of the file that takes everything and gives nothing, which is there without the host's. */
static bool is_nothing(const char *path) {
  return strcmp(path, "/dev/null") == 0;
}

static int find_place(struct trax_calls *calls, const struct trax_host_call *call, unsigned word,
                      enum trax_follow follow, struct trax_place *place) {
  char path[PATH_MAX];
  place->folder = NULL;
  const int failure = read_path(call, call->words[word], path);
  return failure ? failure : trax_place_find(calls, path, follow, place);
}

/* --- open --- */

/* Whether a file at the place, of the kind that is there, may be opened so. */
static int check_open(struct trax_calls *calls, const struct trax_place *place, uint32_t flags, mode_t kind) {
  const bool creates = flags & TRAX_OPEN_CREATE, writes = (flags & 3) != TRAX_OPEN_READ || flags & TRAX_OPEN_TRUNCATE;
  if (!kind && !creates)
    return ENOENT;
  if (kind && creates && (flags & TRAX_OPEN_NEW))
    return EEXIST;
  if (S_ISDIR(kind))
    return EISDIR;
  if (kind && flags & TRAX_OPEN_FOLDER)
    return ENOTDIR;
  if (S_ISLNK(kind))
    return ELOOP;
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

/* Opens the folder at the place, which then is the folder itself. */
static int open_folder(struct trax_calls *calls, uint32_t number, uint32_t flags, struct trax_place *place) {
  int failure = trax_place_enter(calls, place);
  if (failure)
    return failure;
  /* From the folder itself, "." would also need the right to look up names in it. */
  struct trax_folder *const folder = place->folder, *const parent = folder->parent;
  const int descriptor = trax_folder_descriptor(calls, parent ? parent : folder);
  if (descriptor < 0)
    return -descriptor;
  if (faccessat(descriptor, parent ? folder->name : ".", R_OK, AT_EACCESS) != 0)
    return errno;
  const struct trax_opened opened = {.kind = TRAX_OPENED_FOLDER, .flags = flags, .folder = folder};
  trax_descriptor_open(calls, number, &opened);
  return 0;
}

static int32_t open_file(struct trax_calls *calls, const struct trax_host_call *call) {
  const uint32_t flags = call->words[2];
  const bool creates = flags & TRAX_OPEN_CREATE, is_new = creates && flags & TRAX_OPEN_NEW;
  const bool no_link = flags & TRAX_OPEN_NO_LINK;
  const enum trax_follow follow = is_new || (creates && no_link) ? TRAX_FOLLOW_NONE
                                  : creates                      ? TRAX_FOLLOW_NAMES
                                  : no_link                      ? TRAX_FOLLOW_SLASH
                                                                 : TRAX_FOLLOW_ALL;
  struct trax_place place;
  struct trax_file *file;
  char path[PATH_MAX];
  const uint32_t number = trax_descriptor_free(calls, 0);
  if (number == TRAX_MOST_DESCRIPTORS)
    return -EMFILE;
  if ((flags & 3) == 3 || (creates && flags & TRAX_OPEN_FOLDER))
    return -EINVAL;
  int failure = read_path(call, call->words[1], path);
  if (!failure && is_nothing(path)) {
    if (is_new || flags & TRAX_OPEN_FOLDER)
      return is_new ? -EEXIST : -ENOTDIR;
    trax_descriptor_open(calls, number, &(struct trax_opened){.kind = TRAX_OPENED_NOTHING, .flags = flags});
    return (int32_t)number;
  }
  place.folder = NULL;
  if (!failure)
    failure = trax_place_find(calls, path, follow, &place);
  if (!failure)
    failure = find_or_create(calls, &place, flags, &file);
  if (failure == EISDIR && (flags & (3 | TRAX_OPEN_CREATE | TRAX_OPEN_TRUNCATE)) == TRAX_OPEN_READ)
    failure = open_folder(calls, number, flags, &place);
  else if (!failure)
    trax_descriptor_open(calls, number, &(struct trax_opened){.file = file, .flags = flags});
  trax_files_forget(calls);
  trax_place_release(calls, &place);
  return failure ? -failure : (int32_t)number;
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

/* The stat of a standard stream or of /dev/null. */
static int32_t put_other_stat(const struct trax_host_call *call, enum trax_opened_kind kind) {
  return put_stat(call, TRAX_MODE_OTHER | (kind == TRAX_OPENED_NOTHING ? 0666 : 0600), 0, kind - TRAX_OPENED_INPUT);
}

static int32_t put_file_stat(const struct trax_host_call *call, const struct trax_file *file) {
  return put_stat(call, TRAX_MODE_FILE | (file->mode ? file->mode & 0700 : 0600), file->contents.size, file->number);
}

static int32_t put_host_stat(struct trax_calls *calls, const struct trax_host_call *call,
                             const struct trax_place *place, const struct stat *status) {
  const uint32_t kind = S_ISREG(status->st_mode)   ? TRAX_MODE_FILE
                        : S_ISDIR(status->st_mode) ? TRAX_MODE_FOLDER
                        : S_ISLNK(status->st_mode) ? TRAX_MODE_LINK
                                                   : TRAX_MODE_OTHER;
  return put_stat(call, kind | (status->st_mode & 0700), (uint64_t)(kind == TRAX_MODE_FILE ? status->st_size : 0),
                  trax_file_number(calls, place));
}

/* Writes the stat of the host's file at the place. */
static int32_t put_place_stat(struct trax_calls *calls, const struct trax_host_call *call,
                              const struct trax_place *place) {
  struct stat status;
  const int failure = trax_place_stat(calls, place, &status);
  if (failure)
    return -failure;
  if (place->slash && !S_ISDIR(status.st_mode))
    return -ENOTDIR;
  return put_host_stat(calls, call, place, &status);
}

/* Writes the stat of an open folder. */
static int32_t put_folder_stat(struct trax_calls *calls, const struct trax_host_call *call,
                               struct trax_folder *folder) {
  const struct trax_place place = {.folder = folder, .last = TRAX_LAST_HERE, .name = "."};
  const int descriptor = trax_folder_descriptor(calls, folder);
  struct stat status;
  if (descriptor < 0)
    return descriptor;
  return fstat(descriptor, &status) == 0 ? put_host_stat(calls, call, &place, &status) : -errno;
}

static int32_t stat_path(struct trax_calls *calls, const struct trax_host_call *call) {
  struct trax_place place;
  struct trax_name *name = NULL;
  char path[PATH_MAX];
  mode_t kind;
  int failure = read_path(call, call->words[1], path);
  if (!failure && is_nothing(path))
    return put_other_stat(call, TRAX_OPENED_NOTHING);
  place.folder = NULL;
  if (!failure)
    failure = trax_place_find(calls, path, call->words[3] ? TRAX_FOLLOW_ALL : TRAX_FOLLOW_SLASH, &place);
  if (!failure && place.last == TRAX_LAST_NAME)
    failure = trax_name_look(calls, &place, &kind, &name);
  if (!failure && name)
    failure = name->file ? place.slash ? ENOTDIR : -put_file_stat(call, name->file) : ENOENT;
  else if (!failure)
    failure = -put_place_stat(calls, call, &place);
  trax_files_forget(calls);
  trax_place_release(calls, &place);
  return -failure;
}

static int32_t stat_descriptor(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  if (!opened)
    return -EBADF;
  return opened->folder ? put_folder_stat(calls, call, opened->folder)
         : opened->file ? put_file_stat(call, opened->file)
                        : put_other_stat(call, opened->kind);
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

/* Writes bytes to the program if they fit; how many there are, or an error number times -1. */
static int32_t put_bytes(const struct trax_host_call *call, const char *from, size_t size) {
  if (size > INT32_MAX)
    return -EOVERFLOW;
  if (size <= call->words[3]) {
    uint8_t *bytes = trax_host_call_bytes(call, call->words[2], (uint32_t)size, true);
    if (!bytes)
      return -EFAULT;
    memcpy(bytes, from, size);
  }
  return (int32_t)size;
}

static int32_t list_folder(struct trax_calls *calls, const struct trax_host_call *call) {
  char *names = NULL;
  struct trax_place place;
  size_t size = 0;
  int failure = find_place(calls, call, 1, TRAX_FOLLOW_ALL, &place);
  if (!failure)
    failure = trax_folder_list(calls, &place, &names, &size);
  const int32_t result = failure ? -failure : put_bytes(call, names, size);
  free(names);
  trax_place_release(calls, &place);
  return result;
}

/* The path of an open folder. ENOENT: it has been removed, or another one has its name. */
static int32_t folder_path(struct trax_calls *calls, const struct trax_host_call *call) {
  const struct trax_opened *opened = trax_descriptor_find(calls, call->words[1]);
  const struct trax_folder *folder = opened ? opened->folder : NULL;
  struct trax_place place = {.folder = opened ? opened->folder : NULL, .name = "."};
  struct stat status;
  if (!folder)
    return opened ? -ENOTDIR : -EBADF;
  if (folder->parent) {
    place.folder = folder->parent;
    snprintf(place.name, sizeof place.name, "%s", folder->name);
    const int failure = trax_place_stat(calls, &place, &status);
    if (failure || status.st_dev != folder->device || status.st_ino != folder->inode)
      return failure ? -failure : -ENOENT;
  }
  char *path = trax_place_path(&place);
  const int32_t result = path ? put_bytes(call, path, strlen(path) + 1) : -ENOMEM;
  free(path);
  return result;
}

int32_t trax_calls_serve(void *context, struct trax_host_call *call) {
  struct trax_calls *calls = context;
  calls->used = true;
  switch (call->words[0]) {
  case TRAX_HOST_OPEN:
    return open_file(calls, call);
  case TRAX_HOST_CLOSE:
    return trax_serve_close(calls, call);
  case TRAX_HOST_READ:
    return trax_serve_read(calls, call);
  case TRAX_HOST_WRITE:
    return trax_serve_write(calls, call);
  case TRAX_HOST_SEEK:
    return trax_serve_seek(calls, call);
  case TRAX_HOST_STAT:
    return stat_path(calls, call);
  case TRAX_HOST_FSTAT:
    return stat_descriptor(calls, call);
  case TRAX_HOST_TRUNCATE:
    return trax_serve_truncate(calls, call);
  case TRAX_HOST_TERMINAL:
    return trax_serve_terminal(calls, call);
  case TRAX_HOST_REMOVE:
    return change_name(calls, call, trax_name_remove);
  case TRAX_HOST_RENAME:
    return rename_file(calls, call);
  case TRAX_HOST_MAKE_FOLDER:
    return change_name(calls, call, trax_folder_make);
  case TRAX_HOST_REMOVE_FOLDER:
    return change_name(calls, call, trax_folder_remove);
  case TRAX_HOST_LIST:
    return list_folder(calls, call);
  case TRAX_HOST_DUPLICATE:
    return trax_serve_duplicate(calls, call);
  case TRAX_HOST_FOLDER:
    return folder_path(calls, call);
  default:
    return -TRAX_HOST_NO_CALL;
  }
}
