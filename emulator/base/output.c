#include "trax/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* The permissions that open would set. mkstemp makes private files. */
static mode_t usual_mode(mode_t wanted) {
  mode_t mask = umask(0);
  umask(mask);
  return wanted & ~mask;
}

int trax_output_descriptor(const char *path) {
  static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
  if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0)
    return STDOUT_FILENO;
  if (strcmp(path, "/dev/stderr") == 0)
    return STDERR_FILENO;
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
    const char *number = path + strlen(folders[i]);
    if (strncmp(path, folders[i], strlen(folders[i])) == 0 && *number && strlen(number) < 8 &&
        strspn(number, "0123456789") == strlen(number))
      return atoi(number);
  }
  return -1;
}

static trax_status fail_closed(trax_output *output, int code, trax_error *error) {
  trax_status status = trax_fail(error, "%s: cannot be written: %s", output->path, strerror(code));
  trax_output_discard(output);
  return status;
}

trax_status trax_output_open(trax_output *output, const char *path, trax_error *error) {
  *output = (trax_output){.path = strdup(path)};
  if (!output->path)
    return trax_fail(error, "%s: out of memory", path);
  const int shared = trax_output_descriptor(path);
  if (shared == STDOUT_FILENO) {
    output->file = stdout;
    return TRAX_OK;
  }
  if (shared >= 0) { /* to open it again would overwrite a file from its beginning */
    const int copy = dup(shared);
    output->file = copy < 0 ? NULL : fdopen(copy, "ab");
    return output->file ? TRAX_OK : fail_closed(output, errno, error);
  }
  struct stat existing;
  if (stat(path, &existing) == 0 && !S_ISREG(existing.st_mode)) {
    if (S_ISDIR(existing.st_mode))
      return fail_closed(output, EISDIR, error);
    output->file = fopen(path, "wb");
    return output->file ? TRAX_OK : fail_closed(output, errno, error);
  }
  /* If path is a symbolic link, the file that it refers to is replaced, not the link. */
  output->target = realpath(path, NULL);
  const bool exists = output->target != NULL;
  if (exists ? access(path, W_OK) != 0 : !(output->target = strdup(path)))
    return fail_closed(output, errno, error);
  output->temporary = malloc(strlen(output->target) + sizeof ".XXXXXX");
  if (!output->temporary)
    return fail_closed(output, ENOMEM, error);
  strcat(strcpy(output->temporary, output->target), ".XXXXXX");
  int descriptor = mkstemp(output->temporary);
  if (descriptor < 0) {
    int code = errno;
    free(output->temporary);
    output->temporary = NULL;
    return fail_closed(output, code, error);
  }
  fchmod(descriptor, exists ? existing.st_mode & 07777 : usual_mode(0666));
  output->file = fdopen(descriptor, "wb");
  if (!output->file) {
    int code = errno;
    close(descriptor);
    return fail_closed(output, code, error);
  }
  return TRAX_OK;
}

void trax_output_make_executable(trax_output *output) {
  struct stat status;
  const int descriptor = fileno(output->file);
  if (output->temporary && fstat(descriptor, &status) == 0)
    fchmod(descriptor, (status.st_mode & 07777) | usual_mode(0111));
}

trax_status trax_output_commit(trax_output *output, trax_error *error) {
  int failure = 0;
  if (ferror(output->file)) { /* errno of that failure may be lost: another write fails for the same reason */
    clearerr(output->file);
    failure = fputc('\n', output->file) == EOF || fflush(output->file) != 0 ? errno : EIO;
  } else if (fflush(output->file) != 0) {
    failure = errno;
  }
  if (output->file == stdout) {
    if (failure == EPIPE) /* the reader has closed the pipe; main reports that by its exit status */
      failure = 0;
  } else {
    if (fclose(output->file) != 0 && !failure)
      failure = errno;
    output->file = NULL;
  }
  if (!failure && output->temporary) {
    if (rename(output->temporary, output->target) != 0) {
      failure = errno;
    } else {
      free(output->temporary);
      output->temporary = NULL;
    }
  }
  if (failure)
    return fail_closed(output, failure, error);
  trax_output_discard(output);
  return TRAX_OK;
}

void trax_output_discard(trax_output *output) {
  if (output->file && output->file != stdout)
    fclose(output->file);
  if (output->temporary)
    unlink(output->temporary);
  free(output->temporary);
  free(output->target);
  free(output->path);
  *output = (trax_output){0};
}

trax_status trax_output_flush(trax_error *error) {
  return fflush(stdout) == 0 && !ferror(stdout)
             ? TRAX_OK
             : trax_fail(error, "standard output cannot be written: %s", strerror(errno));
}

trax_status trax_output_check(const char *path, trax_error *error) {
  struct stat existing;
  const int shared = trax_output_descriptor(path);
  if (shared >= 0)
    return fcntl(shared, F_GETFL) >= 0 ? TRAX_OK : trax_fail(error, "%s: cannot be written: %s", path, strerror(errno));
  /* To open a pipe or a device may wait or have effects, so only its permissions are checked. */
  if (stat(path, &existing) == 0 && !S_ISREG(existing.st_mode) && !S_ISDIR(existing.st_mode))
    return access(path, W_OK) == 0 ? TRAX_OK : trax_fail(error, "%s: cannot be written: %s", path, strerror(errno));
  trax_output output;
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK)
    trax_output_discard(&output);
  return status;
}

trax_status trax_write_file(const char *path, const void *bytes, size_t size, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  fwrite(bytes, 1, size, output.file); /* trax_output_commit reports a failure */
  return trax_output_commit(&output, error);
}

/* Returns the ending, without its dot; NULL if there is none. */
static const char *ending_of(const char *path) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
  return dot && dot > name ? dot + 1 : NULL;
}

bool trax_output_has_ending(const char *path, const char *ending) {
  const char *own = ending_of(path);
  return own && strcasecmp(own, ending) == 0;
}

trax_status trax_output_name_check(const char *path, const char *endings, trax_error *error) {
  const char *ending = ending_of(path);
  struct stat existing;
  if (!ending || trax_output_descriptor(path) >= 0 ||
      (stat(path, &existing) == 0 && !S_ISREG(existing.st_mode) && !S_ISDIR(existing.st_mode)))
    return TRAX_OK;
  char allowed[64] = "";
  size_t used = 0;
  for (const char *at = endings; *at && used < sizeof allowed;) {
    const size_t length = strcspn(at, " ");
    if (strlen(ending) == length && strncasecmp(ending, at, length) == 0)
      return TRAX_OK;
    const char *separator = at == endings ? "" : at[length] ? ", " : " and ";
    used += (size_t)snprintf(allowed + used, sizeof allowed - used, "%s.%.*s", separator, (int)length, at);
    at += length + (at[length] == ' ');
  }
  return trax_fail(error, "%s: there is no writer for .%s, only for %s", path, ending, allowed);
}
