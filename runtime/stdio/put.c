/* Unformatted output. Functions of a stream are weak: these know standard output alone, and stream.c has others for
   programs with other streams. */
#include "format.h"

#include "../internal/machine.h"

#include <stdio.h>

#define WEAK __attribute__((weak))

int putchar(int c) {
  machine_put_char(c);
  return (unsigned char)c;
}

WEAK int putc(int c, FILE *stream) {
  (void)stream;
  return putchar(c);
}

WEAK int fputc(int c, FILE *stream) {
  (void)stream;
  return putchar(c);
}

/* If the host can read the string, it prints it in one call. */
static void put_string(const char *s) {
  if (machine_is_local(s))
    while (*s)
      machine_put_char(*s++);
  else
    machine_put_string(s);
}

int puts(const char *string) {
  trax_lock_output();
  put_string(string);
  machine_put_char('\n');
  trax_unlock_output();
  return 1;
}

WEAK int fputs(const char *restrict string, FILE *restrict stream) {
  (void)stream;
  trax_lock_output();
  put_string(string);
  trax_unlock_output();
  return 1;
}

WEAK size_t fwrite(const void *restrict memory, size_t size, size_t count, FILE *restrict stream) {
  (void)stream;
  size_t bytes;
  if (__builtin_mul_overflow(size, count, &bytes)) /* no object has as many */
    return 0;
  trax_lock_output();
  const char *end = (const char *)memory + bytes;
  for (const char *p = memory; p != end; p++)
    machine_put_char(*p);
  trax_unlock_output();
  return size ? count : 0;
}

WEAK int fflush(FILE *stream) {
  (void)stream;
  return 0;
}
