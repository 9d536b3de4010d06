/* What the files of emulator/calls/ share. Functions return 0 or an error number (errno.h) unless they say otherwise.
 */
#ifndef TRAX_CALLS_INTERNAL_H
#define TRAX_CALLS_INTERNAL_H

#include "calls/calls.h"

#include <limits.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <xxhash.h>

/* --- folders.c: what the user allowed --- */

struct trax_folder {
  char *host, *name; /* as given; name without "./" and slashes at its end, "" for the folder the program begins in */
  int descriptor;
};

/* A name in a folder; it need not exist. */
struct trax_place {
  int folder; /* a descriptor of the place's own */
  dev_t device;
  ino_t inode;             /* of the folder */
  char name[NAME_MAX + 1]; /* "." for the folder itself */
};

/* Finds the place that a path of the program names. No path leads out of the allowed folders, by no link either.
   follow: if the last part is a symbolic link, the place is what it names. */
int trax_place_find(const struct trax_calls *calls, const char *path, bool follow, struct trax_place *place);
void trax_place_release(struct trax_place *place);
/* lstat of the place. */
int trax_place_stat(const struct trax_place *place, struct stat *status);

/* --- files.c: contents --- */

struct trax_file {
  struct trax_file *next;
  struct trax_place place;
  char *path; /* by which the program opened it, for messages and checkpoints */
  uint8_t *bytes;
  uint64_t size, capacity;
  XXH128_hash_t read; /* digest of the contents as they were read from the host, if it had such a file */
  bool was_there;     /* the host has a file here, as far as it is known */
  bool exists;        /* false: the program has removed it */
  bool changed;       /* the host's file must be written or removed */
  unsigned opens;     /* descriptors */
};

/* Finds the file of a place among those that are kept. NULL: there is none. */
struct trax_file *trax_file_find(const struct trax_calls *calls, const struct trax_place *place);
/* Keeps the file of a place, which it takes over if it succeeds, with the contents that the host has; `create`: there
   may be none. */
int trax_file_load(struct trax_calls *calls, struct trax_place *place, const char *path, bool create,
                   struct trax_file **file);
int trax_file_write(struct trax_file *file, uint64_t offset, const uint8_t *bytes, uint32_t count);
int trax_file_resize(struct trax_file *file, uint64_t size);
/* Makes the host's file what this one is. */
int trax_file_commit(struct trax_file *file);
/* To be called after a descriptor was closed, a file removed or renamed: commits the file and forgets it, as far as
   nothing needs it any more. */
int trax_file_settle(struct trax_calls *calls, struct trax_file *file);
void trax_file_forget(struct trax_calls *calls, struct trax_file *file);
int trax_file_rename(struct trax_calls *calls, struct trax_place *from, struct trax_place *to, const char *to_path);

/* --- input.c --- */

struct trax_stream_input {
  uint8_t *bytes; /* read from the host and not by the program: [at, end) */
  size_t at, end;
  uint64_t taken;       /* bytes that the program has read */
  XXH3_state_t *digest; /* of them */
  bool ended;
};

/* Reads at most `count` bytes of standard input, up to the end of a line. *got is 0 at the input's end. */
int trax_input_take(struct trax_calls *calls, uint8_t *bytes, uint32_t count, uint32_t *got);

/* --- descriptors.c --- */

enum { TRAX_FIRST_DESCRIPTOR = 3, TRAX_MOST_DESCRIPTORS = 256 };

struct trax_descriptor {
  struct trax_file *file; /* NULL: not in use */
  uint64_t offset;
  uint32_t flags;
};

struct trax_calls {
  struct trax_machine *machine;
  struct trax_calls_streams streams;
  struct trax_folder *folders;
  size_t folder_count;
  struct trax_file *files;
  struct trax_descriptor descriptors[TRAX_MOST_DESCRIPTORS];
  bool closed[TRAX_FIRST_DESCRIPTOR]; /* of standard input, output and errors */
  struct trax_stream_input input;
  bool deferred;
  bool used; /* a call has been made */
};

struct trax_host_call;
/* Serves a call: the result, or an error number times -1. */
int32_t trax_calls_serve(void *calls, struct trax_host_call *call);

#endif
