/* Messages of <err.h>: the program's name, the text, the error. */
#include <err.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern __attribute__((weak)) struct {
  int count;
  char **values;
} __trax_arguments; /* of programs whose main has parameters */

const char *getprogname(void) {
  return &__trax_arguments && __trax_arguments.count > 0 ? __trax_arguments.values[0] : "program";
}

static void print(const char *format, va_list arguments, const char *error) {
  fprintf(stderr, "%s: ", getprogname());
  if (format)
    vfprintf(stderr, format, arguments);
  fprintf(stderr, "%s%s\n", format && error ? ": " : "", error ? error : "");
}

void vwarn(const char *format, va_list arguments) {
  print(format, arguments, strerror(errno));
}

void vwarnx(const char *format, va_list arguments) {
  print(format, arguments, NULL);
}

void verr(int status, const char *format, va_list arguments) {
  vwarn(format, arguments);
  exit(status);
}

void verrx(int status, const char *format, va_list arguments) {
  vwarnx(format, arguments);
  exit(status);
}

#define WITH_ARGUMENTS(CALL)                                                                                           \
  va_list arguments;                                                                                                   \
  va_start(arguments, format);                                                                                         \
  CALL;                                                                                                                \
  va_end(arguments)

void warn(const char *format, ...) {
  WITH_ARGUMENTS(vwarn(format, arguments));
}

void warnx(const char *format, ...) {
  WITH_ARGUMENTS(vwarnx(format, arguments));
}

void err(int status, const char *format, ...) {
  WITH_ARGUMENTS(verr(status, format, arguments));
}

void errx(int status, const char *format, ...) {
  WITH_ARGUMENTS(verrx(status, format, arguments));
}
