// RUN: rm -rf %t && mkdir %t && %clang -O2 -mstack=global %s -o %t/program && cd %t && %trax_sim --engine functional --dir .::d program | cmp - %S/stream_limits.expected
// Counts of bytes that do not fit a size_t, streams without memory for buffers, and reopening. (Expected output by hand.)
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int main(void) {
  volatile size_t huge = 0x40000001, overflows = 0x80000000;
  char b[16];
  errno = 0;
  printf("fwrite to output %d\n", (int)fwrite("abcd", huge, 4, stdout));
  FILE *f = fopen("d/x", "w+");
  fputs("abcdefgh", f);
  rewind(f);
  printf("fread %d, then at %ld\n", (int)fread(b, huge, 4, f), ftell(f));
  rewind(f);
  printf("fread %d %.8s\n", (int)fread(b, 1, overflows, f), b);
  rewind(f);
  printf("fread %d\n", (int)fread(b, 3, overflows, f));
  fseek(f, 0, SEEK_SET);
  errno = 0;
  printf("fwrite %d %d %d\n", (int)fwrite("abcd", huge, 4, f), ferror(f) != 0, errno == EFAULT);
  fclose(f);

  /* A stream that cannot be reopened is closed. */
  const int kept = dup(1);
  const int is_open = freopen("d/missing/y", "w", stdout) != NULL;
  puts("lost");
  dup2(kept, 1);
  printf("freopen %d\n", is_open);
  printf("in binary %d %d\n", freopen(NULL, "wb", stdout) == stdout, freopen(NULL, "rb", stdin) == stdin);
  for (int i = 0; i < 2000; i++) { /* each would keep its memory */
    f = fopen("d/x", "r");
    if (!f || freopen("d/missing/z", "r", f))
      return 1;
  }
  f = freopen("d/x", "r", stdin);
  printf("stdin %d %c\n", f == stdin, getchar());
  printf("stdin %d\n", freopen("d/missing/z", "r", stdin) != NULL);
  printf("stdin %d\n", getchar());
  f = freopen("d/x", "r", stdin);
  printf("stdin %c\n", getchar());
  printf("closed %d %d\n", fclose(stdin), getchar());

  /* Without memory each stream has a buffer of its own. */
  FILE *one = fopen("d/one", "w+"), *two = fopen("d/two", "w+");
  void *(*volatile allocate)(size_t) = malloc;
  for (size_t size = 1 << 28; size >= 8; size /= 2)
    while (allocate(size))
      ;
  for (const char *p = "12345678"; *p; p++) {
    putc(*p, one);
    putc(*p + 16, two);
  }
  rewind(one);
  rewind(two);
  for (int c; (c = getc(one)) != EOF;)
    putchar(c), putchar(getc(two));
  putchar('\n');
  return fclose(one) | fclose(two);
}
