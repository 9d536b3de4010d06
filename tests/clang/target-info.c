// The sizes, alignments and macros of docs/abi.md.
// RUN: %clang -fsyntax-only -Xclang -verify %s
// RUN: %clang -fsyntax-only -Xclang -verify -x c++ %s
// RUN: %clang -dM -E %s | FileCheck %s --check-prefix=MACRO
// RUN: %clang -dM -E %s | FileCheck %s --check-prefix=ABSENT
// RUN: %clang -DVALID -S -emit-llvm %s -o - | FileCheck %s --check-prefix=IR

// MACRO-DAG: #define __ATOMIC_RELAXED 0
// MACRO-DAG: #define __BITINT_MAXWIDTH__ 64
// MACRO-DAG: #define __BYTE_ORDER__ __ORDER_LITTLE_ENDIAN__
// MACRO-DAG: #define __CHAR_BIT__ 8
// MACRO-DAG: #define __ELF__ 1
// MACRO-DAG: #define __GCC_ATOMIC_INT_LOCK_FREE 2
// MACRO-DAG: #define __GCC_ATOMIC_LLONG_LOCK_FREE 1
// MACRO-DAG: #define __ILP32__ 1
// MACRO-DAG: #define __STDC_HOSTED__ 1
// MACRO-DAG: #define __STDC_VERSION__ 201710L
// MACRO-DAG: #define __TRAX__ 1
// MACRO-DAG: #define __trax__ 1
// MACRO-DAG: #define __LDBL_MANT_DIG__ 53

// ABSENT-NOT: __SIZEOF_INT128__
// ABSENT-NOT: __PIC__
// ABSENT-NOT: __PIE__
// ABSENT-NOT: __SSP
// ABSENT-NOT: __FLT16_MAX__
// ABSENT-NOT: __linux__
// ABSENT-NOT: __x86_64__

// IR: target datalayout = "e-m:e-p:32:32-i64:32-f64:32-a:0:32-n32-S32"
// IR: target triple = "trax"

#ifdef __cplusplus
#define SAME(A, B) __is_same(A, B)
#define ASSERT static_assert
#else
#define SAME(A, B) __builtin_types_compatible_p(A, B)
#define ASSERT _Static_assert
#endif
#define IS(TYPE, SIZE, ALIGN) ASSERT(sizeof(TYPE) == SIZE && __alignof__(TYPE) == ALIGN, #TYPE)

IS(char, 1, 1);
IS(short, 2, 2);
IS(int, 4, 4);
IS(long, 4, 4);
IS(long long, 8, 4);
IS(float, 4, 4);
IS(double, 8, 4);
IS(long double, 8, 4);
IS(void *, 4, 4);
IS(__builtin_va_list, 4, 4);
IS(_Complex float, 8, 4);
IS(_Complex double, 16, 4);
struct char_double { char c; double d; };
IS(struct char_double, 12, 4);
enum small { SMALL };
IS(enum small, 4, 4);

ASSERT(SAME(__SIZE_TYPE__, unsigned int), "size_t");
ASSERT(SAME(__PTRDIFF_TYPE__, int), "ptrdiff_t");
ASSERT(SAME(__INTPTR_TYPE__, int), "intptr_t");
ASSERT(SAME(__WCHAR_TYPE__, int), "wchar_t");
ASSERT(SAME(__INT32_TYPE__, int), "int32_t");
ASSERT(SAME(__INT64_TYPE__, long long int), "int64_t");
ASSERT(SAME(__INTMAX_TYPE__, long long int), "intmax_t");
ASSERT((char)-1 < 0, "char is signed");
ASSERT(SAME(__builtin_va_list, void *), "va_list");
#ifndef __cplusplus
IS(_Atomic(int), 4, 4);
IS(_Atomic(long long), 8, 4);
ASSERT(__atomic_always_lock_free(4, 0), "words");
ASSERT(!__atomic_always_lock_free(8, 0), "double words");
#endif

#ifndef VALID
__int128 wide;            // expected-error {{__int128 is not supported on this target}}
__float128 quad;          // expected-error {{__float128 is not supported on this target}}
unsigned _BitInt(65) odd; // expected-error {{unsigned _BitInt of bit sizes greater than 64 not supported}}
unsigned _BitInt(37) fine;
#endif
