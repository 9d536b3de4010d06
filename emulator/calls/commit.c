/* Pending changes become those of the host. */
#define _GNU_SOURCE /* O_PATH */
#include "calls/internal.h"
#include "trax/reads.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <unistd.h>

/* --- reading --- */

/* Opens the file that `found`, a descriptor without rights, refers to. Without /proc it is opened by its name. */
static int open_regular(int folder, const char *name, int found, struct stat *status) {
  char path[32];
  if (fstat(found, status) != 0)
    return -errno;
  if (!S_ISREG(status->st_mode)) /* to open a pipe or a device may wait or have effects */
    return S_ISDIR(status->st_mode) ? -EISDIR : -EPERM;
  snprintf(path, sizeof path, "/proc/self/fd/%d", found);
  int opened = open(path, O_RDONLY | O_CLOEXEC);
  if (opened < 0 && errno == ENOENT)
    opened = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  return opened < 0 ? -errno : opened;
}

int trax_host_read(struct trax_calls *calls, const struct trax_place *place, struct trax_contents *contents,
                   struct stat *status) {
  const int folder = trax_folder_descriptor(calls, place->folder);
  if (folder < 0)
    return -folder;
  const int found = openat(folder, place->name, O_PATH | O_NOFOLLOW | O_CLOEXEC);
  if (found < 0)
    return errno;
  const int descriptor = open_regular(folder, place->name, found, status);
  close(found);
  if (descriptor < 0)
    return -descriptor;
  trax_reads_note(status); /* no output of the simulator may replace a file of the program */
  const int failure = trax_contents_load(contents, descriptor);
  close(descriptor);
  return failure;
}

/* --- writing --- */

/* Makes a name that no file of the folder should have. It is short, so the folder can have it whatever the file's. */
static void make_temporary_name(char name[24]) {
  static unsigned count;
  unsigned number;
  if (getrandom(&number, sizeof number, GRND_NONBLOCK) != sizeof number)
    number = (unsigned)getpid() * 1000003u + ++count;
  snprintf(name, 24, ".trax-%08x", number);
}

static int remove_temporary(int folder, char name[24]) {
  const int failure = *name && unlinkat(folder, name, 0) != 0 ? errno : 0;
  *name = '\0';
  return failure;
}

/* Writes the file's contents beside the place of its first name. */
static int write_temporary(struct trax_calls *calls, struct trax_name *name) {
  struct trax_file *file = name->file;
  const int folder = trax_folder_descriptor(calls, name->place.folder);
  const mode_t mode = file->mode ? file->mode & 0777 : 0666;
  int descriptor = -1;
  if (folder < 0)
    return -folder;
  for (unsigned i = 0; i < 100 && descriptor < 0 && (i == 0 || errno == EEXIST); i++) {
    make_temporary_name(file->temporary);
    descriptor = openat(folder, file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  }
  if (descriptor < 0) {
    file->temporary[0] = '\0';
    return errno;
  }
  int failure = file->mode && fchmod(descriptor, mode) != 0 ? errno : 0;
  if (!failure)
    failure = trax_contents_store(&file->contents, descriptor);
  if (close(descriptor) != 0 && !failure)
    failure = errno;
  if (failure)
    remove_temporary(folder, file->temporary);
  file->home = name;
  file->complete = !failure;
  return failure;
}

/* A link, a pipe, a device or a folder that another process has put to the place is neither followed nor replaced. */
static int check_target(struct trax_calls *calls, const struct trax_place *place) {
  struct stat status;
  const int failure = trax_place_stat(calls, place, &status);
  if (failure)
    return failure == ENOENT ? 0 : failure;
  return S_ISREG(status.st_mode) ? 0 : S_ISDIR(status.st_mode) ? EISDIR : EPERM;
}

static void note_written(int folder, const char *name) {
  struct stat status;
  if (fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) == 0)
    trax_reads_note(&status);
}

/* Gives the host's file the name. The first one takes the temporary file, the others are links. */
static int commit_name(struct trax_calls *calls, struct trax_name *name) {
  struct trax_file *file = name->file;
  int failure = check_target(calls, &name->place);
  if (failure)
    return failure;
  const int from = trax_folder_descriptor(calls, file->home->place.folder);
  const int to = trax_folder_descriptor(calls, name->place.folder);
  if (from < 0 || to < 0)
    return from < 0 ? -from : -to;
  if (file->temporary[0]) {
    if (renameat(from, file->temporary, to, name->place.name) != 0)
      return errno;
    file->temporary[0] = '\0';
    file->home = name;
    note_written(to, name->place.name);
    return 0;
  }
  char link[24];
  make_temporary_name(link);
  if (linkat(from, file->home->place.name, to, link, 0) != 0)
    return errno;
  if (renameat(to, link, to, name->place.name) != 0) {
    failure = errno;
    remove_temporary(to, link);
  }
  note_written(to, name->place.name); /* the new name has changed the file's time, and so its record */
  return failure;
}

/* Removes the host's file, if it is the one that the program removed. */
static int commit_removal(struct trax_calls *calls, struct trax_name *name) {
  struct trax_contents contents = {0};
  struct stat status;
  int failure = trax_host_read(calls, &name->place, &contents, &status);
  if (failure) {
    trax_contents_free(&contents);
    return failure == ENOENT || failure == EISDIR || failure == EPERM ? 0 : failure; /* another process's */
  }
  const XXH128_hash_t digest = trax_contents_digest(&contents);
  const int folder = trax_folder_descriptor(calls, name->place.folder);
  trax_contents_free(&contents);
  if (folder < 0)
    return -folder;
  if (XXH128_isEqual(digest, name->digest) && unlinkat(folder, name->place.name, 0) != 0 && errno != ENOENT)
    failure = errno;
  return failure;
}

/* --- in an order that loses nothing --- */

struct commit {
  struct trax_calls *calls;
  const struct trax_file *only; /* NULL: all */
  bool open_ones;
  int failure; /* the first */
  char **path;
};

static void fail(struct commit *commit, const struct trax_name *name, int failure) {
  if (!commit->failure && commit->path)
    *commit->path = trax_place_path(&name->place);
  commit->failure = commit->failure ? commit->failure : failure;
}

static bool is_ready(const struct commit *commit, const struct trax_file *file) {
  return file->differs && (!commit->only || file == commit->only) && (!file->opens || commit->open_ones);
}

/* The only copy of another file, which has other names now, is at the place. */
static bool holds_another(const struct trax_name *name) {
  const struct trax_file *was = name->was;
  return was && was != name->file && was->names && was->differs;
}

/* Tries a name. False: it is not its turn. */
static bool commit_in_turn(struct commit *commit, struct trax_name *name, bool force) {
  struct trax_file *file = name->file;
  if (name->committed || (file && !file->complete) || (!file && commit->only))
    return false;
  if (holds_another(name) && !(force && name->was->complete && !name->was->failed))
    return false;
  const int failure = file ? commit_name(commit->calls, name) : commit_removal(commit->calls, name);
  if (!failure && holds_another(name))
    name->was->orphaned = true;
  name->committed = true;
  if (!failure && !file)
    name->was_there = false;
  if (failure && file)
    file->failed = true;
  if (failure)
    fail(commit, name, failure);
  return true;
}

/* True if all names of the file are the host's. */
static bool is_committed(const struct trax_calls *calls, const struct trax_file *file) {
  for (const struct trax_name *it = calls->names; it; it = it->next)
    if (it->file == file && !it->committed)
      return false;
  return file->complete && !file->failed;
}

static void begin_commit(struct commit *commit) {
  for (struct trax_file *it = commit->calls->files; it; it = it->next)
    it->complete = it->failed = it->orphaned = false;
  for (struct trax_name *it = commit->calls->names; it; it = it->next) {
    it->committed = false;
    if (!it->file || !is_ready(commit, it->file) || it->file->complete || it->file->failed)
      continue;
    const int failure = write_temporary(commit->calls, it);
    it->file->failed = failure != 0;
    if (failure)
      fail(commit, it, failure);
  }
}

/* Two files may exchange places, so that each waits for the other. Then one of them goes first: the former contents of
   its place are complete in a temporary file. */
static void run_commit(struct commit *commit) {
  for (bool progress = true, force = false; progress || !force;) {
    force = !progress;
    progress = false;
    for (struct trax_name *it = commit->calls->names; it && !(force && progress); it = it->next) {
      if (!commit_in_turn(commit, it, force))
        continue;
      progress = true;
      if (it->file && is_committed(commit->calls, it->file))
        it->file->differs = false;
    }
  }
}

/* Removes the file's temporary file, but for one that has the only copy. */
static void end_commit(struct commit *commit, struct trax_file *file) {
  const int folder = trax_folder_descriptor(commit->calls, file->home->place.folder);
  char *path = NULL;
  if (file->orphaned) {
    if (commit->path && asprintf(&path, "%s (complete in %s)", *commit->path, file->temporary) >= 0) {
      free(*commit->path);
      *commit->path = path;
    }
  } else if (folder >= 0) {
    remove_temporary(folder, file->temporary);
  }
  file->temporary[0] = '\0';
}

static int commit_changes(struct commit commit) {
  begin_commit(&commit);
  run_commit(&commit);
  for (struct trax_file *it = commit.calls->files; it; it = it->next) {
    if (it->temporary[0])
      end_commit(&commit, it);
    it->home = NULL;
  }
  return commit.failure;
}

int trax_commit_file(struct trax_calls *calls, struct trax_file *file) {
  return commit_changes((struct commit){.calls = calls, .only = file});
}

int trax_commit_all(struct trax_calls *calls, bool open_ones, char **path) {
  *path = NULL;
  const int failure = commit_changes((struct commit){.calls = calls, .open_ones = open_ones, .path = path});
  trax_files_forget(calls);
  return failure;
}
