/* Formatted output to memory from malloc, and to a descriptor. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int vasprintf(char **restrict to, const char *restrict format, va_list arguments) {
  va_list copy;
  va_copy(copy, arguments);
  int count = vsnprintf(NULL, 0, format, copy);
  va_end(copy);
  *to = count < 0 ? NULL : malloc((size_t)count + 1);
  return *to ? vsnprintf(*to, (size_t)count + 1, format, arguments) : -1;
}

int asprintf(char **restrict to, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = vasprintf(to, format, arguments);
  va_end(arguments);
  return count;
}

int vdprintf(int descriptor, const char *restrict format, va_list arguments) {
  char *text;
  int count = vasprintf(&text, format, arguments);
  if (count > 0 && write(descriptor, text, (size_t)count) != count)
    count = -1;
  free(text);
  return count;
}

int dprintf(int descriptor, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = vdprintf(descriptor, format, arguments);
  va_end(arguments);
  return count;
}
