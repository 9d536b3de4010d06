/* The routines that the compiler calls for operations that the machine lacks. Names and meaning are those of libgcc and
   of LLVM's runtime library interface. */
#ifndef TRAX_RUNTIME_BUILTINS_H
#define TRAX_RUNTIME_BUILTINS_H

#include "../internal/bits.h"

/* 32-bit division. The quotient by 0 is unspecified, as C has it; nothing traps. */
uint32_t __udivsi3(uint32_t n, uint32_t d);
uint32_t __umodsi3(uint32_t n, uint32_t d);
uint32_t __udivmodsi4(uint32_t n, uint32_t d, uint32_t *remainder);
int32_t __divsi3(int32_t n, int32_t d);
int32_t __modsi3(int32_t n, int32_t d);
int32_t __divmodsi4(int32_t n, int32_t d, int32_t *remainder);

/* 64-bit division. */
uint64_t __udivdi3(uint64_t n, uint64_t d);
uint64_t __umoddi3(uint64_t n, uint64_t d);
uint64_t __udivmoddi4(uint64_t n, uint64_t d, uint64_t *remainder);
int64_t __divdi3(int64_t n, int64_t d);
int64_t __moddi3(int64_t n, int64_t d);
int64_t __divmoddi4(int64_t n, int64_t d, int64_t *remainder);

/* 64-bit shifts (count 0 to 63), product, comparison (0 less, 1 equal, 2 greater), negation. */
uint64_t __ashldi3(uint64_t a, int n);
uint64_t __lshrdi3(uint64_t a, int n);
int64_t __ashrdi3(int64_t a, int n);
uint64_t __muldi3(uint64_t a, uint64_t b);
int64_t __mulodi4(int64_t a, int64_t b, int *overflow); /* wraps, and sets *overflow */
int __cmpdi2(int64_t a, int64_t b);
int __ucmpdi2(uint64_t a, uint64_t b);
uint64_t __negdi2(uint64_t a);

/* Bits: leading and trailing zeros (not of 0), find first set, population count, parity, byte swap. */
int __clzsi2(uint32_t a);
int __clzdi2(uint64_t a);
int __ctzsi2(uint32_t a);
int __ctzdi2(uint64_t a);
int __ffssi2(uint32_t a);
int __ffsdi2(uint64_t a);
int __popcountsi2(uint32_t a);
int __popcountdi2(uint64_t a);
int __paritysi2(uint32_t a);
int __paritydi2(uint64_t a);
uint32_t __bswapsi2(uint32_t a);
uint64_t __bswapdi2(uint64_t a);

/* binary64 arithmetic, rounded to nearest even; every NaN result is the canonical one. */
double __adddf3(double a, double b);
double __subdf3(double a, double b);
double __muldf3(double a, double b);
double __divdf3(double a, double b);
double __negdf2(double a);

/* Comparisons: the sign of the result compares with 0 as the name says. With a NaN only `ne` is true. */
int __eqdf2(double a, double b);
int __nedf2(double a, double b);
int __ltdf2(double a, double b);
int __ledf2(double a, double b);
int __gtdf2(double a, double b);
int __gedf2(double a, double b);
int __cmpdf2(double a, double b);
int __unorddf2(double a, double b);
int __eqsf2(float a, float b);
int __nesf2(float a, float b);
int __ltsf2(float a, float b);
int __lesf2(float a, float b);
int __gtsf2(float a, float b);
int __gesf2(float a, float b);
int __unordsf2(float a, float b);

/* Conversions. To integer: towards zero; saturating, NaN gives 0, as the machine's own conversions do. */
double __extendsfdf2(float a);
float __truncdfsf2(double a);
int32_t __fixdfsi(double a);
uint32_t __fixunsdfsi(double a);
int64_t __fixdfdi(double a);
uint64_t __fixunsdfdi(double a);
int64_t __fixsfdi(float a);
uint64_t __fixunssfdi(float a);
double __floatsidf(int32_t a);
double __floatunsidf(uint32_t a);
double __floatdidf(int64_t a);
double __floatundidf(uint64_t a);
float __floatdisf(int64_t a);
float __floatundisf(uint64_t a);

/* binary16, passed in the low half of a word. The second names are older ones for the first two. */
float __extendhfsf2(uint16_t x);
uint16_t __truncsfhf2(float x);
uint16_t __truncdfhf2(double x);
float __gnu_h2f_ieee(uint16_t x);
uint16_t __gnu_f2h_ieee(float x);

/* Powers with an integer exponent. */
float __powisf2(float a, int n);
double __powidf2(double a, int n);

#endif
