// The C library's headers in every C++ from 98 on and in every C from 99 on, and the library linked to both.
// RUN: %clangxx -std=c++98 -fsyntax-only -Wall -Wextra -Werror -Wno-c++11-long-long %s
// RUN: %clangxx -std=gnu++98 -fsyntax-only -Wall -Wextra -Werror %s
// RUN: %clangxx -std=c++11 -fsyntax-only -Wall -Wextra -Werror %s
// RUN: %clangxx -std=c++20 -fsyntax-only -Wall -Wextra -Werror %s
// RUN: %clang -x c -std=c99 -D_DEFAULT_SOURCE -fsyntax-only -Wall -Wextra -Werror %s
// RUN: %clang -x c -std=c11 -pedantic -D_XOPEN_SOURCE=700 -fsyntax-only -Wall -Wextra -Werror %s
// RUN: %clang -x c -std=c23 -D_GNU_SOURCE -fsyntax-only -Wall -Wextra -Werror %s
// The address of a thread's errno is a constant in C++ too: no wrapper is called.
// RUN: %clangxx -O1 -S %s -o - | FileCheck %s --implicit-check-not=_ZTW
// RUN: %clangxx -O1 %s -o %t && %trax_sim %t | FileCheck %s --check-prefix=OUTPUT
// RUN: %clang -x c -O1 %s -o %t && %trax_sim %t | FileCheck %s --check-prefix=OUTPUT

#include <alloca.h>
#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __cplusplus
extern "C" int set(void);
#else
int set(void);
#endif

// CHECK-LABEL: set:
// CHECK: sw {{.*}}%abs(errno)
// CHECK: sw {{.*}}%abs(signgam)
int set(void) {
  errno = ERANGE;
  signgam = 1;
  return 0;
}

// OUTPUT: 34 1 1.500000
int main(void) {
  set();
  printf("%d %d %f\n", errno, signgam, fabs(-1.5));
  return 0;
}
