// RUN: %run_c %s %t
// Formatting into memory of limited size.
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static char buffer[32];

__attribute__((noinline)) static int forward(size_t size, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(buffer, size, format, list);
  va_end(list);
  return n;
}

int main(void) {
  for (size_t size = 0; size < 12; size += 3) {
    memset(buffer, '.', 15);
    buffer[15] = 0;
    int n = forward(size, "%d-%s-%c", 123, "abc", 'x');
    printf("%d %s|%s\n", n, buffer, buffer + size);
  }
  printf("%d\n", snprintf(NULL, 0, "%08.3f", 3.14159));
  sprintf(buffer, "%x/%5s", 48879, "z");
  puts(buffer);
  return 0;
}
