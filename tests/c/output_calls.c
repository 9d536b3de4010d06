// RUN: %run_c %s %t --turns -O0,-O2
// Every way to print, in turn: the order is that of the calls, whatever the machine does for each.
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

__attribute__((format(printf, 1, 2))) static int report(const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vprintf(format, list);
  va_end(list);
  return n;
}

int main(void) {
  char local[12];
  putchar('a');
  puts("b");
  fputs("c", stdout);
  printf("d");
  putc('e', stdout);
  fprintf(stdout, "%s%c", "f", 'g');
  fputc('\n', stdout);
  strcpy(local, "local"); /* in local memory */
  puts(local);
  fputs(local, stdout);
  printf("%s\n", local);
  int items = (int)fwrite("12345\n", 2, 3, stdout), letter = putchar(0x141);
  printf("%d %d %d\n", items, letter == 'A', fputs("", stdout) >= 0);
  puts("");
  int printed = report("%s-%d-%c\n", "list", 7, 'x');
  printf("%d\n", printed);
  putchar(0);
  putchar('\xff');
  printf("%c|%%|%5c|%-3c|\n", 0, 'r', 'l');
  puts("1 long line of text, longer than any buffer of the machine is likely "
       "to be: 0123456789012345678901234567890123456789");
  return fflush(stdout);
}
