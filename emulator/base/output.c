#define _GNU_SOURCE /* mkostemp */
#include "trax/output.h"

#include "trax/reads.h"
#include "trax/signals.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Runs before main in every program. Opens closed standard streams: a file would get the number of one, and the program
   would print into it. Ignores SIGXFSZ: a file beyond the size limit is an error of writing, and does not end the
   program. */
__attribute__((constructor)) static void prepare_process(void) {
  signal(SIGXFSZ, SIG_IGN);
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
    if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0)
      return;
}

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

/* Returns 0, or errno: the descriptor is closed or only for reading. */
static int refusal_of(int descriptor) {
  const int flags = fcntl(descriptor, F_GETFL);
  return flags < 0 ? errno : (flags & O_ACCMODE) == O_RDONLY ? EBADF : 0;
}

/* NULL with errno: there is no stream, and the descriptor, which may be negative, is closed. */
static FILE *stream_of(int descriptor, const char *mode) {
  FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, mode);
  if (!file && descriptor >= 0) {
    const int code = errno;
    close(descriptor);
    errno = code;
  }
  return file;
}

static trax_status fail_closed(trax_output *output, int code, trax_error *error) {
  trax_status status = trax_fail(error, "%s: cannot be written: %s", output->path, strerror(code));
  trax_output_discard(output);
  return status;
}

char *trax_link_target(const char *path) {
  char target[PATH_MAX];
  const ssize_t length = readlink(path, target, sizeof target - 1);
  if (length <= 0 || length == sizeof target - 1)
    return NULL;
  target[length] = '\0';
  const char *slash = strrchr(path, '/');
  const size_t folder = target[0] == '/' || !slash ? 0 : (size_t)(slash - path) + 1;
  char *joined = malloc(folder + (size_t)length + 1);
  if (joined)
    strcpy(memcpy(joined, path, folder) + folder, target);
  return joined;
}

/* Returns the path to which all symbolic links lead, whether a file is there or not; NULL with errno: there is none. */
static char *behind_links(const char *path) {
  char *at = strdup(path);
  for (int links = 0; at; links++) {
    char *target = trax_link_target(at);
    if (!target && errno != ENOMEM)
      return at;
    free(at);
    at = target;
    if (at && links == TRAX_MOST_LINKS) {
      free(at);
      errno = ELOOP;
      return NULL;
    }
  }
  errno = ENOMEM;
  return NULL;
}

/* Returns the name of a temporary file beside the target, whatever the length of the target's name. */
static char *temporary_name(const char *target) {
  static const char ending[] = ".XXXXXX";
  const char *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
  const size_t most = NAME_MAX + 1 - sizeof ending, length = strlen(name) < most ? strlen(name) : most;
  char *temporary = malloc((size_t)(name - target) + length + sizeof ending);
  if (temporary)
    strcpy(memcpy(temporary, target, (size_t)(name - target) + length) + (name - target) + length, ending);
  return temporary;
}

static trax_status refuse_input(trax_output *output, trax_error *error) {
  trax_status status = trax_fail(error, "%s: is an input and the output", output->path);
  trax_output_discard(output);
  return status;
}

/* Opens the temporary file. */
static trax_status open_temporary(trax_output *output, mode_t mode, trax_error *error) {
  output->temporary = temporary_name(output->target);
  if (!output->temporary)
    return fail_closed(output, ENOMEM, error);
  const int descriptor = mkostemp(output->temporary, O_CLOEXEC);
  if (descriptor < 0) {
    int code = errno;
    free(output->temporary);
    output->temporary = NULL;
    return fail_closed(output, code, error);
  }
  fchmod(descriptor, mode);
  output->file = stream_of(descriptor, "wb");
  return output->file ? TRAX_OK : fail_closed(output, errno, error);
}

trax_status trax_output_open(trax_output *output, const char *path, trax_error *error) {
  *output = (trax_output){.path = strdup(path)};
  if (!output->path)
    return trax_fail(error, "%s: out of memory", path);
  const int shared = trax_output_descriptor(path), refusal = shared < 0 ? 0 : refusal_of(shared);
  if (refusal)
    return fail_closed(output, refusal, error);
  if (shared == STDOUT_FILENO) {
    output->file = stdout;
    return TRAX_OK;
  }
  if (shared >= 0) { /* to open it again would overwrite a file from its beginning */
    output->file = stream_of(dup(shared), "ab");
    return output->file ? TRAX_OK : fail_closed(output, errno, error);
  }
  struct stat existing;
  const bool exists = stat(path, &existing) == 0;
  if (exists && !S_ISREG(existing.st_mode)) {
    if (S_ISDIR(existing.st_mode))
      return fail_closed(output, EISDIR, error);
    /* creates nothing if it is gone meanwhile */
    output->file = stream_of(open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY), "wb");
    return output->file ? TRAX_OK : fail_closed(output, errno, error);
  }
  if (exists && trax_reads_has(&existing))
    return refuse_input(output, error);
  /* If path is a symbolic link, the file that it refers to is written, not the link. */
  output->target = behind_links(path);
  if (!output->target || (exists && access(path, W_OK) != 0))
    return fail_closed(output, errno, error);
  return open_temporary(output, exists ? existing.st_mode & 07777 : usual_mode(0666), error);
}

/* Makes the file executable for everyone whom the umask permits. */
static void make_executable(trax_output *output) {
  struct stat status;
  const int descriptor = fileno(output->file);
  if (output->temporary && fstat(descriptor, &status) == 0)
    fchmod(descriptor, (status.st_mode & 07777) | usual_mode(0111));
}

/* Flushes the stream. Returns 0, or the errno of what could not be written since it was opened. */
static int flush(FILE *file) {
  if (!ferror(file))
    return fflush(file) == 0 ? 0 : errno;
  clearerr(file); /* errno of that failure may be lost: another write fails for the same reason */
  return fputc('\n', file) == EOF || fflush(file) != 0 ? errno : EIO;
}

trax_status trax_output_commit(trax_output *output, trax_error *error) {
  int failure = flush(output->file);
  if (output->file == stdout) {
    if (failure == EPIPE) /* the reader has closed the pipe; main reports that by its exit status */
      failure = 0;
  } else {
    struct stat written;
    if (output->temporary && fstat(fileno(output->file), &written) == 0)
      trax_reads_drop(&written);
    if (fclose(output->file) != 0 && !failure)
      failure = errno;
    output->file = NULL;
  }
  struct stat existing;
  if (!failure && output->temporary && lstat(output->target, &existing) == 0) { /* what it has become meanwhile */
    if (trax_reads_has(&existing))
      return refuse_input(output, error);
    failure = S_ISREG(existing.st_mode) ? 0 : S_ISDIR(existing.st_mode) ? EISDIR : EEXIST;
  }
  if (!failure && output->temporary) {
    if (renameat(AT_FDCWD, output->temporary, AT_FDCWD, output->target) != 0) {
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
    unlinkat(AT_FDCWD, output->temporary, 0);
  free(output->temporary);
  free(output->target);
  free(output->path);
  *output = (trax_output){0};
}

trax_status trax_output_flush(trax_error *error) {
  const int failure = flush(stdout);
  return failure ? trax_fail(error, "standard output cannot be written: %s", strerror(failure)) : TRAX_OK;
}

trax_status trax_output_check(const char *path, trax_error *error) {
  struct stat existing;
  const int shared = trax_output_descriptor(path), refusal = shared < 0 ? 0 : refusal_of(shared);
  if (shared >= 0)
    return refusal ? trax_fail(error, "%s: cannot be written: %s", path, strerror(refusal)) : TRAX_OK;
  /* Opening a pipe or a device may wait or have effects, so only its permissions are checked. */
  if (stat(path, &existing) == 0 && !S_ISREG(existing.st_mode) && !S_ISDIR(existing.st_mode))
    return access(path, W_OK) == 0 ? TRAX_OK : trax_fail(error, "%s: cannot be written: %s", path, strerror(errno));
  trax_output output;
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK)
    trax_output_discard(&output);
  return status;
}

trax_status trax_write_whole(const char *path, const void *bytes, size_t size, bool executable, trax_error *error) {
  struct stat existing;
  trax_output output;
  sigset_t before;
  /* Signals are held only for a regular file: a pipe or device may keep the writer waiting, and leaves nothing. */
  const bool is_replaced =
      trax_output_descriptor(path) < 0 && (stat(path, &existing) != 0 || S_ISREG(existing.st_mode));
  if (is_replaced)
    trax_hold_signals(&before);
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    if (executable)
      make_executable(&output);
    fwrite(bytes, 1, size, output.file); /* trax_output_commit reports a failure */
    status = trax_output_commit(&output, error);
  }
  if (is_replaced)
    trax_allow_signals(&before);
  return status;
}

trax_status trax_write_file(const char *path, const void *bytes, size_t size, trax_error *error) {
  return trax_write_whole(path, bytes, size, false, error);
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
