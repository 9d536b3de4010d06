// RUN: %clang -O1 -g -w %s -o %t
// RUN: not %trax_sim %t 2>&1 | FileCheck --check-prefix=PRINTF %s
// RUN: %clang -O1 -g -w -DWIDTHS %s -o %t
// RUN: not %trax_sim %t 2>&1 | FileCheck --check-prefix=PLACE %s
// RUN: %clang -O1 -g -w -DSMALL %s -o %t
// RUN: not %trax_sim %t 2>&1 | FileCheck --check-prefix=SMALL %s
// A conversion that printf does not know stops the program, where it stands; iprintf knows none of doubles.
#include <stdio.h>

int main(void) {
  const volatile int one = 1;
#if defined SMALL
  iprintf("%d %.3f %d\n", one, 2.0, 3);
#elif defined WIDTHS
  char text[16];
  snprintf(text, sizeof text, "%1$d %s\n", one, "text");
#else
  printf("%d %-5y %s\n", one, 2, "text");
#endif
  printf("not reached\n");
  return 0;
}
// PRINTF-NOT: reached
// PRINTF: fault: abort
// PRINTF-NEXT: message printf: unknown conversion: %-5y
// PRINTF: called by main{{.*}}abort_conversion.c:[[@LINE-8]]:
// PLACE: message printf: unknown conversion: %1$
// PLACE: called by main{{.*}}abort_conversion.c:[[@LINE-12]]:
// SMALL: message iprintf formats no doubles: %.3f
// SMALL: called by main{{.*}}abort_conversion.c:[[@LINE-17]]:
