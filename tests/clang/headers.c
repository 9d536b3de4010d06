// Clang's own headers, without any of the host's.
// RUN: %clang -fsyntax-only -Wall -Wextra -Werror -ffreestanding -nostdlibinc %s
// RUN: %clang -fsyntax-only -Wall -Wextra -Werror -std=c11 -pedantic -ffreestanding -nostdlibinc %s
// RUN: %clang -H -fsyntax-only -ffreestanding -nostdlibinc %s 2>&1 | FileCheck %s --implicit-check-not=/usr/include
// CHECK: clang/19/include/float.h
// CHECK: clang/19/include/stdint.h

#include <float.h>
#include <iso646.h>
#include <limits.h>
#include <stdalign.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdnoreturn.h>

_Static_assert(sizeof(int8_t) == 1 && sizeof(int16_t) == 2 && sizeof(int32_t) == 4 && sizeof(int64_t) == 8, "");
_Static_assert(sizeof(intptr_t) == 4 && sizeof(size_t) == 4 && sizeof(ptrdiff_t) == 4, "");
_Static_assert(UINTPTR_MAX == 0xFFFFFFFFu && SIZE_MAX == 0xFFFFFFFFu && INT_MAX == 2147483647 && LONG_MAX == INT_MAX, "");
_Static_assert(FLT_MANT_DIG == 24 && DBL_MANT_DIG == 53 && LDBL_MANT_DIG == 53 && FLT_EVAL_METHOD == 0, "");
_Static_assert(alignof(max_align_t) == 4, "");
_Static_assert(CHAR_MIN == -128, "");
bool flag;
_Atomic(int) counter = 0;
