/* Formatted output to standard output and to memory. */
#include "format.h"

#include "../internal/machine.h"

static struct ticket_lock output_lock;

/* The lock separates the output of threads. It protects no memory, so it needs no fence. */
void trax_lock_output(void) {
  enter(&output_lock);
}

void trax_unlock_output(void) {
  leave(&output_lock);
}

int trax_print(const char *format, va_list arguments, double_formatter *format_double) {
  struct sink out = {NULL, NULL, 0};
  trax_lock_output();
  int count = trax_format(&out, format, arguments, format_double);
  trax_unlock_output();
  return count;
}

int trax_print_to(char *to, size_t size, const char *format, va_list arguments, double_formatter *format_double) {
  static char nowhere; /* at is never NULL, and a size of 0 stores nothing */
  if (size == 0)
    to = &nowhere;
  struct sink out = {to, size ? to + size - 1 : to, 0};
  if (out.end < to) /* sprintf's size reaches past the end of memory */
    out.end = (char *)UINTPTR_MAX;
  int count = trax_format(&out, format, arguments, format_double);
  if (size)
    *out.at = 0;
  return count;
}
