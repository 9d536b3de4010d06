#define _GNU_SOURCE /* memfd_create, F_GET_SEALS */
#include "trax/reads.h"

#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

/* The list is a file in memory, to which every process appends whole records: they need no lock. */
struct record {
  uint64_t device, inode;
  uint64_t changed; /* its change time in ns: a later file may have the inode of one that is gone */
  uint64_t kind;
};

enum { READ = 1, DROPPED, SIGNATURE };
static const char variable[] = "TRAX_READS"; /* the descriptor of a list that another process shares */
enum { FIRST_DESCRIPTOR = 64 };              /* above those that a user gives as /dev/fd/N */

static const struct record first = {.device = UINT64_C(0x7372656164207874), .kind = SIGNATURE};

static bool has_begun;

void trax_reads_begin(void) {
  has_begun = true;
}

/* Returns the descriptor in the environment, if it is still a list; else -1. */
static int shared_list(void) {
  const char *text = getenv(variable);
  const int descriptor = text ? atoi(text) : -1;
  struct record found;
  const bool valid = descriptor >= FIRST_DESCRIPTOR && fcntl(descriptor, F_GET_SEALS) >= 0 && /* a file in memory */
                     pread(descriptor, &found, sizeof found, 0) == sizeof found && found.device == first.device &&
                     found.kind == SIGNATURE;
  return valid ? descriptor : -1;
}

/* Returns -1 if there is no memory for a list: the files that the command line names are compared even then. */
static int list_descriptor(void) {
  static int list = -2;
  if (list != -2)
    return list;
  list = shared_list();
  const int fresh = list < 0 ? memfd_create("trax-reads", MFD_CLOEXEC | MFD_ALLOW_SEALING) : -1;
  if (fresh < 0)
    return list;
  list = fcntl(fresh, F_DUPFD_CLOEXEC, FIRST_DESCRIPTOR);
  close(fresh);
  if (list >= 0 && (fcntl(list, F_SETFL, O_APPEND) != 0 || write(list, &first, sizeof first) != sizeof first)) {
    close(list);
    list = -1;
  }
  return list;
}

static uint64_t change_time(const struct stat *file) {
  return (uint64_t)file->st_ctim.tv_sec * 1000000000u + (uint64_t)file->st_ctim.tv_nsec;
}

static void append(const struct stat *file, uint64_t kind) {
  const struct record added = {file->st_dev, file->st_ino, change_time(file), kind};
  if (!has_begun || !S_ISREG(file->st_mode) || list_descriptor() < 0)
    return;
  if (write(list_descriptor(), &added, sizeof added) != sizeof added)
    return;
}

void trax_reads_note(const struct stat *file) {
  append(file, READ);
}

void trax_reads_drop(const struct stat *file) {
  append(file, DROPPED);
}

void trax_reads_drop_path(const char *path) {
  struct stat file;
  if (stat(path, &file) == 0)
    append(&file, DROPPED);
}

bool trax_reads_has(const struct stat *file) {
  struct record records[256];
  ssize_t got;
  bool found = false;
  if (!has_begun || !S_ISREG(file->st_mode) || list_descriptor() < 0)
    return false;
  for (off_t at = 0; (got = pread(list_descriptor(), records, sizeof records, at)) > 0; at += got)
    for (size_t i = 0; i < (size_t)got / sizeof *records; i++)
      if (records[i].device == file->st_dev && records[i].inode == file->st_ino)
        found = records[i].kind == READ && (found || records[i].changed == change_time(file));
  return found;
}

void trax_reads_share(void) {
  char number[16];
  const int list = list_descriptor();
  if (list < 0 || fcntl(list, F_SETFD, 0) != 0)
    return;
  snprintf(number, sizeof number, "%d", list);
  setenv(variable, number, 1);
}
