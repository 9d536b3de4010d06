/* Files, and the names that refer to them. */
#define _GNU_SOURCE /* AT_EACCESS */
#include "calls/internal.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- names --- */

struct trax_name *trax_name_at(const struct trax_calls *calls, const struct trax_folder *folder, const char *name) {
  struct trax_name *it = calls->names;
  while (it && (it->place.folder->device != folder->device || it->place.folder->inode != folder->inode ||
                strcmp(it->place.name, name) != 0))
    it = it->next;
  return it;
}

struct trax_name *trax_name_set(struct trax_calls *calls, const struct trax_place *place, struct trax_file *file) {
  struct trax_name *name = trax_name_at(calls, place->folder, place->name);
  if (!name) {
    if (!(name = calloc(1, sizeof *name)))
      return NULL;
    name->place = *place;
    name->place.slash = false;
    trax_folder_refer(place->folder);
    name->next = calls->names;
    calls->names = name;
  }
  if (file)
    file->names++;
  if (name->file && --name->file->names == 0)
    name->file->inode = 0; /* the host may give the number to another file */
  name->file = file;
  return name;
}

/* Names the file of the host at the place. */
static struct trax_name *add_host_name(struct trax_calls *calls, const struct trax_place *place,
                                       struct trax_file *file) {
  struct trax_name *name = trax_name_set(calls, place, file);
  if (name && calls->deferred) {
    name->was_there = true;
    name->digest = file->read;
    name->was = file;
  }
  return name;
}

static bool is_needed(const struct trax_calls *calls, const struct trax_name *name) {
  return name->file ? name->file->differs || name->file->opens : calls->deferred && name->was_there;
}

void trax_files_forget(struct trax_calls *calls) {
  for (struct trax_name **link = &calls->names, *name; (name = *link);) {
    if (is_needed(calls, name)) {
      link = &name->next;
      continue;
    }
    *link = name->next;
    if (name->file)
      name->file->names--;
    trax_folder_release(calls, name->place.folder);
    free(name);
  }
  for (struct trax_file **link = &calls->files, *file; (file = *link);) {
    if (file->opens || file->names) {
      link = &file->next;
      continue;
    }
    *link = file->next;
    for (struct trax_name *it = calls->names; it; it = it->next)
      if (it->was == file)
        it->was = NULL;
    trax_contents_free(&file->contents);
    free(file);
  }
}

/* --- files --- */

uint64_t trax_file_number(const struct trax_calls *calls, const struct trax_place *place) {
  char *path = trax_place_path(place);
  uint64_t number = path ? XXH3_64bits(path, strlen(path)) : 0;
  free(path);
  for (const struct trax_file *it = calls->files; it;) { /* a file that has had this name may still be there */
    const bool is_other = it->number != number;
    number = is_other ? number : XXH3_64bits(&number, sizeof number);
    it = is_other ? it->next : calls->files;
  }
  return number;
}

int trax_file_create(struct trax_calls *calls, const struct trax_place *place, struct trax_file **file) {
  const uint64_t number = trax_file_number(calls, place);
  if (!(*file = calloc(1, sizeof **file)))
    return ENOMEM;
  (*file)->number = number;
  (*file)->writable = true;
  (*file)->next = calls->files;
  calls->files = *file;
  return 0;
}

static bool is_file_of(const struct trax_file *file, const struct stat *status) {
  return file->inode && file->inode == status->st_ino && file->device == status->st_dev &&
         file->changed.tv_sec == status->st_ctim.tv_sec && file->changed.tv_nsec == status->st_ctim.tv_nsec;
}

int trax_name_look(struct trax_calls *calls, const struct trax_place *place, mode_t *kind, struct trax_name **name) {
  struct stat status;
  *kind = 0;
  *name = trax_name_at(calls, place->folder, place->name);
  if (*name) {
    *kind = (*name)->file ? S_IFREG : 0;
    return 0;
  }
  const int failure = trax_place_stat(calls, place, &status);
  if (failure)
    return failure == ENOENT ? 0 : failure;
  *kind = status.st_mode & S_IFMT;
  for (struct trax_file *it = calls->files; it && S_ISREG(status.st_mode); it = it->next)
    if (is_file_of(it, &status) && !(*name = add_host_name(calls, place, it))) /* another name of it */
      return ENOMEM;
  return 0;
}

/* Names the file's other names in the folder, which the program may use later. */
static void find_links(struct trax_calls *calls, const struct trax_place *place, struct trax_file *file) {
  const int folder = trax_folder_descriptor(calls, place->folder);
  const int listed = folder < 0 ? -1 : openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR *list = listed < 0 ? NULL : fdopendir(listed);
  if (!list) { /* the program may not list it, so it will not find them by chance */
    if (listed >= 0)
      close(listed);
    return;
  }
  for (const struct dirent *entry; (entry = readdir(list));) {
    struct trax_place other = {.folder = place->folder};
    struct stat status;
    if (entry->d_ino != file->inode || strlen(entry->d_name) > NAME_MAX)
      continue;
    strcpy(other.name, entry->d_name);
    if (!trax_name_at(calls, place->folder, other.name) && trax_place_stat(calls, &other, &status) == 0 &&
        is_file_of(file, &status))
      add_host_name(calls, &other, file);
  }
  closedir(list);
}

/* Reads the host's file into `file`. */
static int read_host(struct trax_calls *calls, const struct trax_place *place, bool empty, struct trax_file *file) {
  struct stat status;
  int failure = empty && !calls->deferred ? trax_place_stat(calls, place, &status)
                                          : trax_host_read(calls, place, &file->contents, &status);
  const int folder = trax_folder_descriptor(calls, place->folder);
  if (!failure && folder < 0)
    failure = -folder;
  if (failure)
    return failure;
  file->device = status.st_dev;
  file->inode = status.st_ino;
  file->changed = status.st_ctim;
  file->mode = status.st_mode;
  file->writable = faccessat(folder, place->name, W_OK, AT_EACCESS) == 0;
  if (calls->deferred)
    file->read = trax_contents_digest(&file->contents);
  if (!add_host_name(calls, place, file))
    return ENOMEM;
  if (status.st_nlink > 1)
    find_links(calls, place, file);
  return 0;
}

int trax_name_take(struct trax_calls *calls, const struct trax_place *place, bool empty, struct trax_name **name) {
  mode_t kind;
  struct trax_file *file;
  int failure = trax_name_look(calls, place, &kind, name);
  if (!failure && !kind)
    failure = ENOENT;
  if (failure || *name)
    return failure;
  failure = trax_file_create(calls, place, &file);
  if (!failure)
    failure = read_host(calls, place, empty, file);
  *name = failure ? NULL : trax_name_at(calls, place->folder, place->name);
  return failure;
}
