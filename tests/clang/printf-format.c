// -Wformat knows the library's printf: every conversion that would stop the program is a warning, and none that works is.
// RUN: %clang -fsyntax-only -Wall -Wextra -Xclang -verify %s
// RUN: %clang -fsyntax-only -Wall -Wextra -Xclang -verify -fno-builtin -ffreestanding %s
// RUN: %clangxx -x c++ -fsyntax-only -Wall -Wextra -Xclang -verify %s
// RUN: %clang -fsyntax-only -Werror -Wno-format %s
// RUN: %clang -fsyntax-only -w %s
// RUN: not %clang -fsyntax-only -Werror=format %s
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

__attribute__((format(printf, 2, 3))) void own(int level, const char *format, ...);

void good(signed char *c, short *s, int *n, long *l, long long *ll, intmax_t *j, size_t z, ptrdiff_t *t, char *text,
          const wchar_t *wide) {
  printf("%hhn%hn%n%ln%lln%jn%tn", c, s, n, l, ll, j, t);
  printf("%ls %lc %.3ls %-5lc %S %C", wide, (__WINT_TYPE__)L'x', wide, (__WINT_TYPE__)L'y', wide, (__WINT_TYPE__)L'z');
  printf("%b %#B %'d %qd %zu %jd %td %p %% %hhx %5.*f %-*a", 1u, 2u, 3, 4LL, z, *j, *t, (void *)c, 5, 6, 7.0, 8, 9.0);
  iprintf("%d %s %ls %lc %n", 1, text, wide, (__WINT_TYPE__)L'x', n);
  sniprintf(text, z, "%x", 1u);
  own(1, "%d %f", 1, 2.0);
}

void bad(char *text, size_t size, int which, float x) {
  printf("%d %y", 1);                 // expected-warning {{invalid conversion specifier 'y'}}
  printf("%k", 1);                    // expected-warning {{invalid conversion specifier 'k'}}
  printf("%D", 1);                    // expected-warning {{invalid conversion specifier 'D'}}
  printf("%m %d", 1);                 // expected-warning {{invalid conversion specifier 'm'}}
  printf("%2$d %1$d", 1, 2);          // expected-warning {{specifier '2$d'}} expected-warning {{specifier '1$d'}}
  printf("%2$*1$d", 1, 2);            // expected-warning {{invalid conversion specifier '2$*1$d'}}
  printf("%");                        // expected-warning {{incomplete format specifier}}
  fprintf(stderr, "%m");              // expected-warning {{invalid conversion specifier 'm'}}
  sprintf(text, "%m");                // expected-warning {{invalid conversion specifier 'm'}}
  snprintf(text, size, "%1$d", 1);    // expected-warning {{invalid conversion specifier '1$d'}}
  iprintf("%d %.2f", 1, x);           // expected-warning {{invalid conversion specifier 'f'}}
  iprintf(which ? "%d" : ("%a"), which); // expected-warning {{invalid conversion specifier 'a'}} \
                                         // expected-warning {{format specifies type 'double'}}
  fiprintf(stdout, "%g", x);          // expected-warning {{invalid conversion specifier 'g'}}
  siprintf(text, "%E", x);            // expected-warning {{invalid conversion specifier 'E'}}
  sniprintf(text, size, "%la", x);    // expected-warning {{invalid conversion specifier 'a'}}
  own(1, "%d"                         // (the literal goes on)
         "%m",                        // expected-warning {{invalid conversion specifier 'm'}}
      1);
  printf("%n", text);                 // expected-warning {{format specifies type 'int *'}}
  printf("%ls", text);                // expected-warning {{format specifies type 'wchar_t *'}}
  printf("%s %d", 1.0, 2);            // expected-warning {{format specifies type 'char *'}}
}

void with_list(char *text, va_list list) {
  vprintf("%d %m", list);             // expected-warning {{invalid conversion specifier 'm'}}
  vfprintf(stdout, "%1$d", list);     // expected-warning {{invalid conversion specifier '1$d'}}
  vsprintf(text, "%y", list);         // expected-warning {{invalid conversion specifier 'y'}}
  vsnprintf(text, 99, "%f %m", list);  // expected-warning {{invalid conversion specifier 'm'}}
}

#ifdef __cplusplus
struct Log {
  __attribute__((format(printf, 2, 3))) void write(const char *format, ...);
  __attribute__((format(printf, 1, 2))) static void print(const char *format, ...);
};
template <class T> void generic(T x) {
  printf("%m %d", x); // expected-warning {{invalid conversion specifier 'm'}}
}
void members(Log &log) {
  log.write("%d %m", 1);      // expected-warning {{invalid conversion specifier 'm'}}
  Log::print("%f %1$d", 1.0); // expected-warning {{invalid conversion specifier '1$d'}} expected-warning {{cannot mix positional}}
  generic(1);
}
#endif
