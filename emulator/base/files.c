#include "trax/files.h"
#include "trax/grow.h"

#include "trax/output.h"
#include "trax/reads.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct trax_file_use {
  char *path, *option; /* option: NULL if no message needs to name it */
  bool is_output;
  /* ANY_NUMBER: may be written any number of times; STREAM: a standard stream redirected to a file. */
  enum { ANY_NUMBER, STREAM, REGULAR } kind;
  dev_t device; /* of the file, or of its nearest folder that exists */
  ino_t inode;
  struct timespec changed; /* its change time */
  char *rest;              /* the part of the path below that folder, which does not exist yet; "" if the file exists */
};

/* --- which file a path names --- */

static char *joined(const char *folder, size_t length, const char *name) {
  char *path = malloc(length + strlen(name) + 2);
  if (!path)
    return NULL;
  memcpy(path, folder, length);
  path[length] = '/';
  strcpy(path + length + 1, name);
  return path;
}

/* Identifies a path that does not exist by its nearest existing folder and the rest of it. False: out of memory. */
static bool find_folder(struct trax_file_use *use, const char *path) {
  char *folder = strdup(path), *rest = strdup(""), *target;
  for (unsigned links = 0; folder && rest;) {
    struct stat status;
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
      folder[--length] = '\0';
    if (stat(*folder ? folder : ".", &status) == 0) {
      use->device = status.st_dev;
      use->inode = status.st_ino;
      use->rest = rest;
      free(folder);
      return true;
    }
    if (links < TRAX_MOST_LINKS && ((target = trax_link_target(folder)) || errno == ENOMEM)) {
      /* a link to a file that does not exist */
      free(folder);
      folder = target;
      links++;
      continue;
    }
    if (!*folder) { /* not even the current folder can be searched: no file is opened by this path */
      use->kind = ANY_NUMBER;
      use->rest = rest;
      free(folder);
      return true;
    }
    char *slash = strrchr(folder, '/'), *name = slash ? slash + 1 : folder;
    char *longer = strcmp(name, ".") == 0 ? strdup(rest) : joined(name, strlen(name), rest);
    free(rest);
    rest = longer;
    if (slash == folder)
      folder[1] = '\0';
    else
      *(slash ? slash : folder) = '\0';
  }
  free(folder);
  free(rest);
  return false;
}

static bool identify(struct trax_file_use *use) {
  struct stat status;
  int stream = trax_output_descriptor(use->path);
  if (!use->is_output && strcmp(use->path, "-") == 0)
    stream = STDIN_FILENO;
  if (stream >= 0 ? fstat(stream, &status) != 0 : stat(use->path, &status) != 0) {
    use->kind = stream < 0 ? REGULAR : ANY_NUMBER;
    return stream >= 0 || find_folder(use, use->path);
  }
  use->kind = !S_ISREG(status.st_mode) ? ANY_NUMBER : stream >= 0 ? STREAM : REGULAR;
  use->device = status.st_dev;
  use->inode = status.st_ino;
  use->changed = status.st_ctim;
  if (!use->is_output)
    trax_reads_note(&status);
  return (use->rest = strdup("")) != NULL;
}

static bool same_file(const struct trax_file_use *a, const struct trax_file_use *b) {
  return a->kind != ANY_NUMBER && b->kind != ANY_NUMBER && a->device == b->device && a->inode == b->inode &&
         strcmp(a->rest, b->rest) == 0;
}

/* --- the list --- */

static void release(struct trax_file_use *use) {
  free(use->path);
  free(use->option);
  free(use->rest);
}

static void add(trax_files *files, const char *option, const char *path, bool is_output) {
  if (!path)
    return;
  if (!trax_grow((void **)&files->uses, files->count, &files->capacity, sizeof *files->uses)) {
    files->out_of_memory = true;
    return;
  }
  struct trax_file_use *use = &files->uses[files->count];
  *use = (struct trax_file_use){.path = strdup(path), .option = option ? strdup(option) : NULL, .is_output = is_output};
  if (use->path && (use->option || !option) && identify(use)) {
    files->count++;
  } else {
    files->out_of_memory = true;
    release(use);
  }
}

void trax_files_input(trax_files *files, const char *option, const char *path) {
  add(files, option, path, false);
}

void trax_files_output(trax_files *files, const char *option, const char *path) {
  add(files, option, path, true);
}

void trax_files_release(trax_files *files) {
  for (size_t i = 0; i < files->count; i++)
    release(&files->uses[i]);
  free(files->uses);
  *files = (trax_files){0};
}

/* --- the check --- */

static trax_status refuse_input(const struct trax_file_use *input, const struct trax_file_use *output,
                                trax_error *error) {
  const bool spelled = strcmp(input->path, output->path) != 0;
  const bool clear = !output->option || strcmp(output->option, "-o") == 0 || strcmp(output->option, "--output") == 0;
  return trax_fail(error, "%.300s: is an input and the output%s%.40s%s%.300s", output->path, clear ? "" : " of ",
                   clear ? "" : output->option, spelled ? "; it is the same file as " : "", spelled ? input->path : "");
}

static trax_status refuse_output(const struct trax_file_use *first, const struct trax_file_use *second,
                                 trax_error *error) {
  const char *a = first->option ? first->option : "", *b = second->option ? second->option : "";
  const bool spelled = strcmp(first->path, second->path) != 0, named = *a && *b && strcmp(a, b) != 0;
  return trax_fail(error, "%.300s: is written twice%s%.40s%s%.40s%s%.300s", first->path, named ? ", by " : "",
                   named ? a : "", named ? " and by " : "", named ? b : "", spelled ? " as " : "",
                   spelled ? second->path : "");
}

trax_status trax_files_check(const trax_files *files, trax_error *error) {
  if (files->out_of_memory)
    return trax_fail(error, "out of memory");
  for (size_t i = 0; i < files->count; i++) {
    const struct trax_file_use *output = &files->uses[i];
    const struct stat file = {
        .st_dev = output->device, .st_ino = output->inode, .st_ctim = output->changed, .st_mode = S_IFREG};
    const bool exists = output->kind == REGULAR && !*output->rest;
    for (size_t j = 0; output->is_output && j < files->count; j++) {
      const struct trax_file_use *other = &files->uses[j];
      if (other == output || !same_file(output, other))
        continue;
      if (!other->is_output)
        return refuse_input(other, output, error);
      if (output->kind != STREAM || other->kind != STREAM)
        return refuse_output(j < i ? other : output, j < i ? output : other, error);
    }
    if (output->is_output && exists && trax_reads_has(&file)) /* read before, such as a response file */
      return refuse_input(output, output, error);
  }
  return TRAX_OK;
}

trax_status trax_files_check_input(const trax_files *files, const char *path, trax_error *error) {
  struct trax_file_use input = {.path = (char *)path};
  if (!files || files->count == 0)
    return TRAX_OK;
  if (!identify(&input))
    return trax_fail(error, "out of memory");
  trax_status status = TRAX_OK;
  for (size_t i = 0; i < files->count && status == TRAX_OK; i++)
    if (files->uses[i].is_output && same_file(&files->uses[i], &input))
      status = refuse_input(&input, &files->uses[i], error);
  free(input.rest);
  return status;
}
