#define _GNU_SOURCE /* memrchr */
#include "trax/compare.h"
#include "trax/signals.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

trax_status trax_become_eval(char **arguments, trax_error *error) {
  char path[PATH_MAX + sizeof "trax-eval"];
  const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
  char *slash = length > 0 && length < PATH_MAX ? memrchr(path, '/', (size_t)length) : NULL;
  if (slash) {
    strcpy(slash + 1, "trax-eval");
    execv(path, arguments);
  }
  return trax_fail(error, "%s cannot be started: %s (it needs Python 3)", slash ? path : "trax-eval", strerror(errno));
}

/* Reads the child's message, without the end of its last line. */
static void read_text(FILE *said, char *text, size_t size) {
  rewind(said);
  text[fread(text, 1, size - 1, said)] = 0;
  text[strcspn(text, "\n")] = 0;
}

trax_status trax_compare_add(const char *other, const char *page, const volatile int *interrupt, trax_error *error) {
  char *words[] = {"trax-eval", "compare", "--add", "--", (char *)other, (char *)page, NULL};
  FILE *said = tmpfile();
  if (!said)
    return trax_fail(error, "no temporary file: %s", strerror(errno));
  const pid_t child = trax_fork(SIGTERM);
  if (child == 0) {
    trax_error reason;
    dup2(fileno(said), STDERR_FILENO);
    trax_become_eval(words, &reason);
    dprintf(STDERR_FILENO, "%s\n", reason.message);
    _exit(127);
  }
  int status = 0;
  char text[160];
  trax_status result = child < 0 ? TRAX_ERROR : trax_wait_for_child(child, SIGTERM, interrupt, &status);
  read_text(said, text, sizeof text);
  if (result == TRAX_ERROR)
    trax_fail(error, "the comparison does not start: %s", strerror(errno));
  else if (result == TRAX_OK && (!WIFEXITED(status) || WEXITSTATUS(status)))
    result = trax_fail(error, "%s: the differences to %s are missing: %s", page, other, text);
  fclose(said);
  return result;
}
