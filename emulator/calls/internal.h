/* Declarations that the files of emulator/calls/ share. Functions return 0 or an error number (errno.h) unless stated.

   A *folder* is one of the host that a path led through. The allowed ones are open for the whole run, the others as far
   as there are descriptors for them; they are found again by their names below an allowed one.
   A *place* is a name in a folder: device and inode of the folder, and the name. There need not be anything.
   A *file* is contents that the program reads and writes. Descriptors and names refer to it, and it lives as long as
   one of them does. It *differs* if no file of the host is known to have its contents under its names. A *name* says
   what the program finds at a place if that may not be what the host has there: a file, or nothing, because the program
   has removed it. At a place without a name the program finds what the host has. A *pending change* is a name whose
   file differs, or a name of nothing. Without checkpoints the host's names change at once, and a file that differs is
   written when its last descriptor is closed. With checkpoints all changes wait for trax_calls_commit. New files are
   complete on the host before names change, a name changes by one rename, and what the host has at a place goes only
   after the file that was there is at its new place. A checkpoint has all names and descriptors, and the contents of
   each file that the host does not have: those that differ, and those without a name. An earlier checkpoint or commit
   does not matter. */
#ifndef TRAX_CALLS_INTERNAL_H
#define TRAX_CALLS_INTERNAL_H

#include "calls/calls.h"
#include "calls/contents.h"

#include <limits.h>
#include <sys/stat.h>
#include <sys/types.h>

/* --- folders.c: what the user allowed --- */

struct trax_folder {
  struct trax_folder *next, *parent; /* NULL: the user allowed it */
  char *name;                        /* in the parent. Of an allowed one without "./" and slashes at its end */
  dev_t device;
  ino_t inode;
  int descriptor; /* -1: to be opened again */
  uint64_t used;  /* when the descriptor was used */
  unsigned references;
};

enum trax_last { TRAX_LAST_NAME, TRAX_LAST_HERE, TRAX_LAST_ABOVE };

/* The place that a path names; nothing need be there. */
struct trax_place {
  struct trax_folder *folder; /* a reference of the place's own; NULL: released */
  enum trax_last last;        /* a name, "." or ".." */
  bool slash;                 /* after the name: it must be a folder */
  char name[NAME_MAX + 2]; /* "." for the folder itself; one byte longer than the host allows if the name is too long */
};

enum trax_follow {
  TRAX_FOLLOW_NONE,  /* a link as the last part is not followed */
  TRAX_FOLLOW_SLASH, /* only before a slash */
  TRAX_FOLLOW_NAMES, /* only without a slash */
  TRAX_FOLLOW_ALL
};

/* Finds the place that a path of the program names. No path leads out of the allowed folders, by no link either. */
int trax_place_find(struct trax_calls *calls, const char *path, enum trax_follow follow, struct trax_place *place);
void trax_place_release(struct trax_calls *calls, struct trax_place *place);
/* lstat of the host. */
int trax_place_stat(struct trax_calls *calls, const struct trax_place *place, struct stat *status);
/* Goes into the folder at the place, which then is the folder itself. */
int trax_place_enter(struct trax_calls *calls, struct trax_place *place);
/* The path below an allowed folder that leads the program to the place; from malloc. */
char *trax_place_path(const struct trax_place *place);
/* The folder's descriptor, which the next two calls leave open, or an error number times -1. */
int trax_folder_descriptor(struct trax_calls *calls, struct trax_folder *folder);
void trax_folder_refer(struct trax_folder *folder);
void trax_folder_release(struct trax_calls *calls, struct trax_folder *folder);
/* A folder of the host has another place now. */
void trax_folder_moved(struct trax_calls *calls, const struct stat *status, const struct trax_place *to);

/* --- files.c: files, and names of them --- */

struct trax_file {
  struct trax_file *next;
  struct trax_contents contents;
  uint64_t number; /* for the program: differs between files */
  /* The host's file that it was read from; inode 0: none. */
  dev_t device;
  ino_t inode;
  struct timespec changed;
  mode_t mode;        /* 0: a new file's */
  bool writable;      /* the user may */
  bool differs;       /* no file of the host is known to have the contents under its names */
  XXH128_hash_t read; /* with checkpoints: digest of the contents as they were read */
  unsigned opens, names;
  /* While changes are committed: */
  bool complete, failed;  /* the temporary file is complete; something failed */
  bool orphaned;          /* the temporary file is the only copy */
  char temporary[24];     /* "": none */
  struct trax_name *home; /* in its folder is the temporary file; later, the first name that was given to it */
};

struct trax_name {
  struct trax_name *next;
  struct trax_place place;
  struct trax_file *file; /* NULL: removed */
  /* With checkpoints: the host's file when the program first changed the place. */
  bool was_there;
  XXH128_hash_t digest;
  struct trax_file *was; /* NULL: nothing, or a file that is no more */
  bool committed;        /* while changes are committed */
};

/* The name at a place; NULL: there is none. */
struct trax_name *trax_name_at(const struct trax_calls *calls, const struct trax_folder *folder, const char *name);
/* Sets the kind of what the program finds at a place (S_IFMT of stat's mode; 0: nothing) and its name (NULL: none). */
int trax_name_look(struct trax_calls *calls, const struct trax_place *place, mode_t *kind, struct trax_name **name);
/* Finds the name of the file at a place, where the program finds one, or reads the host's. `empty`: without its
   contents, which are about to be replaced. */
int trax_name_take(struct trax_calls *calls, const struct trax_place *place, bool empty, struct trax_name **name);
/* Makes the place's name refer to the file, NULL for nothing. The former one loses the name. NULL: out of memory. */
struct trax_name *trax_name_set(struct trax_calls *calls, const struct trax_place *place, struct trax_file *file);
/* A new file without contents. */
int trax_file_create(struct trax_calls *calls, const struct trax_place *place, struct trax_file **file);
/* The number of the file at a place without a name. */
uint64_t trax_file_number(const struct trax_calls *calls, const struct trax_place *place);
/* Forgets names and files that nothing needs any more. */
void trax_files_forget(struct trax_calls *calls);

/* --- names.c --- */

/* The user may make and remove names in the folder. */
int trax_folder_check(struct trax_calls *calls, struct trax_folder *folder);
int trax_name_remove(struct trax_calls *calls, const struct trax_place *place);
int trax_name_rename(struct trax_calls *calls, const struct trax_place *from, const struct trax_place *to);
int trax_folder_make(struct trax_calls *calls, const struct trax_place *place);
int trax_folder_remove(struct trax_calls *calls, const struct trax_place *place);

/* --- list.c --- */

/* Lists the folder at a place as the program sees it, in the order of the names' bytes: for each name its kind (f: a
   file, d: a folder, l: a link, o: another), the name and a NUL. *names is from malloc. */
int trax_folder_list(struct trax_calls *calls, const struct trax_place *place, char **names, size_t *size);

/* --- commit.c --- */

/* Reads the host's file at a place. ENOENT: there is none. EPERM: something else, which is not opened. */
int trax_host_read(struct trax_calls *calls, const struct trax_place *place, struct trax_contents *contents,
                   struct stat *status);
/* Makes pending changes those of the host: of one file, or all of files that no descriptor refers to, or all.
   Returns the first failure; *path, from malloc, says where. Changes that failed are still pending. */
int trax_commit_file(struct trax_calls *calls, struct trax_file *file);
int trax_commit_all(struct trax_calls *calls, bool open_ones, char **path);

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

enum { TRAX_MOST_DESCRIPTORS = 256 };

enum trax_opened_kind {
  TRAX_OPENED_FILE,
  TRAX_OPENED_INPUT,
  TRAX_OPENED_OUTPUT,
  TRAX_OPENED_ERRORS,
  TRAX_OPENED_NOTHING,
  TRAX_OPENED_FOLDER
};

/* The object of one or more descriptors: a file, a folder, a standard stream, or nothing (/dev/null). */
struct trax_opened {
  enum trax_opened_kind kind;
  uint32_t flags;
  struct trax_file *file;
  struct trax_folder *folder; /* a reference */
  uint64_t offset;
  unsigned references; /* descriptors; 0: not in use */
};

struct trax_calls {
  struct trax_machine *machine;
  struct trax_calls_streams streams;
  struct trax_folder *folders;
  uint64_t folder_uses;
  struct trax_file *files;
  struct trax_name *names;
  struct trax_opened opened[TRAX_MOST_DESCRIPTORS];
  struct trax_opened *descriptors[TRAX_MOST_DESCRIPTORS]; /* NULL: not in use */
  struct trax_stream_input input;
  bool deferred; /* changes wait for trax_calls_commit */
  bool used;     /* a call has been made */
};

/* Returns the descriptor's object; NULL: the descriptor is not in use. */
struct trax_opened *trax_descriptor_find(struct trax_calls *calls, uint32_t number);
/* The lowest free descriptor from `number` on. */
uint32_t trax_descriptor_free(const struct trax_calls *calls, uint32_t number);
/* Refers the descriptor to a new trax_opened, whose fields are set but for `references`. */
void trax_descriptor_open(struct trax_calls *calls, uint32_t number, const struct trax_opened *open);
/* Refers it to what another one refers to. */
void trax_descriptor_share(struct trax_calls *calls, uint32_t number, struct trax_opened *open);
/* The first three are the standard streams; or none is in use. */
void trax_descriptors_begin(struct trax_calls *calls);
void trax_descriptors_forget(struct trax_calls *calls);

/* The calls that take a descriptor: the result, or an error number times -1. */
struct trax_host_call;
int32_t trax_serve_close(struct trax_calls *calls, const struct trax_host_call *call);
int32_t trax_serve_duplicate(struct trax_calls *calls, const struct trax_host_call *call);
int32_t trax_serve_read(struct trax_calls *calls, const struct trax_host_call *call);
int32_t trax_serve_write(struct trax_calls *calls, const struct trax_host_call *call);
int32_t trax_serve_seek(struct trax_calls *calls, const struct trax_host_call *call);
int32_t trax_serve_truncate(struct trax_calls *calls, const struct trax_host_call *call);
int32_t trax_serve_terminal(struct trax_calls *calls, const struct trax_host_call *call);

/* --- serve.c --- */

/* Serves a call by its number. */
int32_t trax_calls_serve(void *calls, struct trax_host_call *call);

#endif
