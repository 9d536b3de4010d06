/* Calls that change names. */
#define _GNU_SOURCE /* faccessat with AT_EACCESS */
#include "calls/internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int trax_folder_check(struct trax_calls *calls, struct trax_folder *folder) {
  const int descriptor = trax_folder_descriptor(calls, folder);
  if (descriptor < 0)
    return -descriptor;
  return faccessat(descriptor, ".", W_OK, AT_EACCESS) == 0 ? 0 : errno;
}

/* The kind of what the host has at the place; 0: nothing. */
static int look_at_host(struct trax_calls *calls, const struct trax_place *place, mode_t *kind) {
  struct stat status;
  const int failure = trax_place_stat(calls, place, &status);
  *kind = failure ? 0 : status.st_mode & S_IFMT;
  return failure == ENOENT ? 0 : failure;
}

/* Removes the host's name at once. */
static int unlink_host(struct trax_calls *calls, const struct trax_place *place) {
  const int folder = trax_folder_descriptor(calls, place->folder);
  if (folder < 0)
    return -folder;
  return unlinkat(folder, place->name, 0) == 0 ? 0 : errno;
}

int trax_name_remove(struct trax_calls *calls, const struct trax_place *place) {
  struct trax_name *name;
  mode_t kind, on_host;
  int failure = place->last == TRAX_LAST_NAME ? trax_name_look(calls, place, &kind, &name) : EISDIR;
  if (!failure && !kind)
    failure = ENOENT;
  if (!failure && place->slash)
    failure = S_ISDIR(kind) ? EISDIR : ENOTDIR;
  if (!failure)
    failure = trax_folder_check(calls, place->folder);
  if (!failure && S_ISDIR(kind))
    failure = EISDIR;
  if (!failure && !S_ISREG(kind) && (!S_ISLNK(kind) || calls->deferred))
    failure = EPERM;
  if (failure)
    return failure;
  if (calls->deferred) {
    failure = trax_name_take(calls, place, false, &name);
  } else {
    failure = look_at_host(calls, place, &on_host);
    if (!failure && on_host == kind) /* else it is a new file, or another process has put something there */
      failure = unlink_host(calls, place);
  }
  if (!failure && name)
    trax_name_set(calls, place, NULL);
  trax_files_forget(calls);
  return failure;
}

/* --- rename --- */

/* True if the host's folder at the place is on the way to the other folder. */
static bool is_above(struct trax_calls *calls, const struct trax_place *place, const struct trax_folder *folder) {
  struct stat status;
  if (trax_place_stat(calls, place, &status) != 0)
    return false;
  while (folder && (folder->device != status.st_dev || folder->inode != status.st_ino))
    folder = folder->parent;
  return folder;
}

/* Whether the kinds fit, and the user may; `is_same`: nothing is to be done. */
static int check_rename(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to,
                        mode_t kind, mode_t to_kind, bool is_same) {
  if (!S_ISDIR(kind) && (from->slash || to->slash))
    return ENOTDIR;
  if (S_ISDIR(kind) && is_above(calls, from, to->folder))
    return EINVAL;
  if (S_ISDIR(to_kind) && is_above(calls, to, from->folder))
    return ENOTEMPTY;
  int failure = is_same ? 0 : trax_folder_check(calls, from->folder);
  if (!failure && !is_same)
    failure = trax_folder_check(calls, to->folder);
  if (failure || is_same)
    return failure;
  if (S_ISDIR(kind))
    return to_kind && !S_ISDIR(to_kind) ? ENOTDIR : 0;
  if (S_ISDIR(to_kind))
    return EISDIR;
  return (S_ISREG(kind) || S_ISLNK(kind)) && (!to_kind || S_ISREG(to_kind) || S_ISLNK(to_kind)) ? 0 : EPERM;
}

/* The program's new files in a folder, which the host does not have yet, keep it from being empty. */
static int check_empty(struct trax_calls *calls, const struct trax_place *place) {
  struct stat status;
  if (trax_place_stat(calls, place, &status) != 0)
    return 0; /* the host says why */
  for (const struct trax_name *it = calls->names; it; it = it->next)
    if (it->file && it->place.folder->device == status.st_dev && it->place.folder->inode == status.st_ino)
      return ENOTEMPTY;
  return 0;
}

static int rename_host(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to) {
  const int from_folder = trax_folder_descriptor(calls, from->folder);
  const int to_folder = trax_folder_descriptor(calls, to->folder);
  if (from_folder < 0 || to_folder < 0)
    return from_folder < 0 ? -from_folder : -to_folder;
  return renameat(from_folder, from->name, to_folder, to->name) == 0 ? 0 : errno;
}

static int rename_folder(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to) {
  struct stat status;
  if (calls->deferred)
    return EPERM;
  int failure = check_empty(calls, to);
  if (!failure)
    failure = trax_place_stat(calls, from, &status);
  if (!failure)
    failure = rename_host(calls, from, to);
  if (!failure)
    trax_folder_moved(calls, &status, to);
  return failure;
}

/* True if both places have the same file of the host. */
static bool has_same_file(struct trax_calls *calls, const struct trax_place *a, const struct trax_place *b) {
  struct stat first, second;
  return trax_place_stat(calls, a, &first) == 0 && trax_place_stat(calls, b, &second) == 0 &&
         first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

/* Renames the host's file if there is one. A file that the host does not have yet will replace the file at `to`. */
static int rename_at_once(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to,
                          mode_t kind, mode_t to_kind, bool is_named) {
  mode_t on_host;
  const int failure = look_at_host(calls, from, &on_host);
  if (failure)
    return failure;
  if (on_host == kind) /* two names of one file, one of which will get a new one: rename would do nothing */
    return has_same_file(calls, from, to) ? unlink_host(calls, from) : rename_host(calls, from, to);
  if (!is_named)
    return ENOENT;
  if (from->folder->device != to->folder->device)
    return EXDEV;
  return S_ISLNK(to_kind) ? unlink_host(calls, to) : 0;
}

/* Reads both files, so that a checkpoint has them. */
static int rename_later(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to,
                        mode_t kind, mode_t to_kind, struct trax_name **name) {
  struct trax_name *replaced;
  if (!S_ISREG(kind) || S_ISLNK(to_kind))
    return EPERM;
  if (from->folder->device != to->folder->device)
    return EXDEV;
  int failure = trax_name_take(calls, from, false, name);
  if (!failure && to_kind)
    failure = trax_name_take(calls, to, false, &replaced);
  if (!failure)
    (*name)->file->differs = true;
  return failure;
}

static int rename_file(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to,
                       mode_t kind, mode_t to_kind, struct trax_name *name, const struct trax_name *to_name) {
  const int failure = calls->deferred ? rename_later(calls, from, to, kind, to_kind, &name)
                                      : rename_at_once(calls, from, to, kind, to_kind, name != NULL);
  if (failure)
    return failure;
  if (!name) { /* the host has it now where the program finds it */
    if (to_name)
      trax_name_set(calls, to, NULL);
    return 0;
  }
  if (!trax_name_set(calls, to, name->file))
    return ENOMEM;
  trax_name_set(calls, from, NULL);
  return 0;
}

int trax_name_rename(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to) {
  struct trax_name *name, *to_name;
  mode_t kind, to_kind;
  bool is_same = false;
  if (from->last != TRAX_LAST_NAME || to->last != TRAX_LAST_NAME)
    return EBUSY;
  int failure = trax_name_look(calls, from, &kind, &name);
  if (!failure && !kind)
    failure = ENOENT;
  if (!failure)
    failure = trax_name_look(calls, to, &to_kind, &to_name);
  if (!failure && (name || to_name))
    is_same = name && to_name && name->file == to_name->file;
  else if (!failure)
    is_same = kind == to_kind && has_same_file(calls, from, to);
  if (!failure)
    failure = check_rename(calls, from, to, kind, to_kind, is_same);
  if (!failure && !is_same)
    failure =
        S_ISDIR(kind) ? rename_folder(calls, from, to) : rename_file(calls, from, to, kind, to_kind, name, to_name);
  trax_files_forget(calls);
  return failure;
}

/* --- folders --- */

/* Folders are made and removed at once, which a resumed run would do again. */
int trax_folder_make(struct trax_calls *calls, const struct trax_place *place) {
  struct trax_name *name;
  mode_t kind = S_IFDIR;
  const int failure = place->last == TRAX_LAST_NAME ? trax_name_look(calls, place, &kind, &name) : 0;
  if (failure || kind)
    return failure ? failure : EEXIST;
  const int folder = trax_folder_descriptor(calls, place->folder);
  if (calls->deferred || folder < 0)
    return folder < 0 ? -folder : EPERM;
  return mkdirat(folder, place->name, 0777) == 0 ? 0 : errno;
}

int trax_folder_remove(struct trax_calls *calls, const struct trax_place *place) {
  struct trax_name *name;
  mode_t kind;
  if (place->last != TRAX_LAST_NAME)
    return place->last == TRAX_LAST_HERE ? EINVAL : ENOTEMPTY;
  int failure = trax_name_look(calls, place, &kind, &name);
  if (!failure)
    failure = kind ? trax_folder_check(calls, place->folder) : ENOENT;
  if (!failure && !S_ISDIR(kind))
    failure = ENOTDIR;
  if (!failure)
    failure = calls->deferred ? EPERM : check_empty(calls, place);
  if (failure)
    return failure;
  const int folder = trax_folder_descriptor(calls, place->folder);
  if (folder < 0)
    return -folder;
  return unlinkat(folder, place->name, AT_REMOVEDIR) == 0 ? 0 : errno;
}
