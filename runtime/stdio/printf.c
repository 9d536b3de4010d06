/* printf and its relatives. They alone name the code that formats doubles: a program that uses only those of iprintf.c
   does not contain it. Those of a stream are weak, as in put.c. */
#include "format.h"

#include <stdio.h>

int vprintf(const char *restrict format, va_list arguments) {
  return trax_print(format, arguments, trax_format_double);
}

int printf(const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print(format, arguments, trax_format_double);
  va_end(arguments);
  return count;
}

__attribute__((weak)) int vfprintf(FILE *restrict stream, const char *restrict format, va_list arguments) {
  (void)stream;
  return trax_print(format, arguments, trax_format_double);
}

__attribute__((weak)) int fprintf(FILE *restrict stream, const char *restrict format, ...) {
  (void)stream;
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print(format, arguments, trax_format_double);
  va_end(arguments);
  return count;
}

int vsnprintf(char *restrict to, size_t size, const char *restrict format, va_list arguments) {
  return trax_print_to(to, size, format, arguments, trax_format_double);
}

int snprintf(char *restrict to, size_t size, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print_to(to, size, format, arguments, trax_format_double);
  va_end(arguments);
  return count;
}

int vsprintf(char *restrict to, const char *restrict format, va_list arguments) {
  return trax_print_to(to, (size_t)-1, format, arguments, trax_format_double);
}

int sprintf(char *restrict to, const char *restrict format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int count = trax_print_to(to, (size_t)-1, format, arguments, trax_format_double);
  va_end(arguments);
  return count;
}
