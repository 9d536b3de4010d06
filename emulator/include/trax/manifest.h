/* The manifest of a run: a folder with manifest.json, which names a program, its buffers and the machine
   (docs/manifest.md). trax-render --prepare writes one, trax-sim runs it. */
#ifndef TRAX_MANIFEST_H
#define TRAX_MANIFEST_H

#include "trax/emulator.h"
#include "trax/files.h"

#ifdef __cplusplus
extern "C" {
#endif

#pragma GCC visibility push(default) /* of the shared library */

#define TRAX_MANIFEST_NAME "manifest.json"
#define TRAX_MANIFEST_PROGRAM "program.elf"

/* --- writing: emulator/host/manifest_write.c --- */

/* The description of a buffer of the machine. */
struct trax_manifest_buffer {
  const char *symbol;
  const char *file;          /* for its bytes; NULL: they are zeros */
  const char *output;        /* for its bytes after the run; NULL: none */
  uint32_t bytes_per_thread; /* of zeros: the size on another chip; 0: the same on all */
};

struct trax_manifest_contents {
  const struct trax_manifest_buffer *buffers; /* for all symbols that may be bound */
  size_t buffer_count;
  uint64_t items;   /* the items that the program will finish; 0: unknown */
  const char *more; /* further members, which trax-sim accepts but does not read, as a JSON object; NULL: none */
};

/* Writes the loaded program and the buffers in the order in which they were bound, since addresses depend on it. */
trax_status trax_manifest_write(trax_machine *machine, const char *folder,
                                const struct trax_manifest_contents *contents, trax_error *error);

/* --- reading: emulator/host/manifest.c --- */

typedef struct trax_manifest trax_manifest;

/* Whether the path names a manifest, and not a program: it ends in .json. */
bool trax_manifest_is(const char *path);
/* Reads a manifest and checks everything except the files that it names. Messages have the file and the line or the
   key. NULL: an error. */
trax_manifest *trax_manifest_read(const char *path, trax_error *error);
void trax_manifest_release(trax_manifest *manifest); /* which may be NULL */

const char *trax_manifest_program(const trax_manifest *manifest); /* its path */
uint64_t trax_manifest_items(const trax_manifest *manifest);      /* 0: not known */
/* Adds the files that the manifest reads. */
void trax_manifest_inputs(const trax_manifest *manifest, trax_files *files);
/* The i-th buffer that is written after the run, and its file; false after the last one. */
bool trax_manifest_output(const trax_manifest *manifest, size_t i, const char **symbol, const char **path);
/* Checks that the file of such a buffer can be written, and writes it, beneath the manifest's folder. */
trax_status trax_manifest_check_output(const trax_manifest *manifest, const char *symbol, trax_error *error);
trax_status trax_manifest_put_output(const trax_manifest *manifest, const char *symbol, const void *bytes, size_t size,
                                     trax_error *error);

/* The buffer that is a picture, and its size; false if there is none, or if its members are not supported. */
bool trax_manifest_picture(const trax_manifest *manifest, const char **symbol, uint32_t *width, uint32_t *height,
                           bool *is_float);

trax_status trax_manifest_configure(const trax_manifest *manifest, trax_config *config, trax_error *error);
/* Loads the program and binds the buffers, if their files have the sizes and hashes of the manifest. */
trax_status trax_manifest_load(const trax_manifest *manifest, trax_machine *machine, trax_error *error);

#pragma GCC visibility pop

#ifdef __cplusplus
}
#endif
#endif
