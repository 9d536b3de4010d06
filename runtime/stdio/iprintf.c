/* printf's relatives without floating-point conversions. */
#include "format.h"

#include <stdio.h>

int iprintf(const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print(format, arguments, NULL);
  va_end(arguments);
  return count;
}

__attribute__((weak)) int fiprintf(FILE *restrict stream, const char *restrict format, ...) {
  (void)stream;
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print(format, arguments, NULL);
  va_end(arguments);
  return count;
}

int sniprintf(char *restrict to, size_t size, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print_to(to, size, format, arguments, NULL);
  va_end(arguments);
  return count;
}

int siprintf(char *restrict to, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print_to(to, (size_t)-1, format, arguments, NULL);
  va_end(arguments);
  return count;
}
