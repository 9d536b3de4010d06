/* The TP's binary32 arithmetic once more: exact integers, rounded once, from the definitions of IEEE 754-2019 and
   docs/isa.md. No floating point of the host or of a library is used, and nothing of the arithmetic that the emulator
   executes, so the two can be compared. Written to be read; a result takes some ten to a hundred nanoseconds.

   Operands and results are the words in a TP's registers. Every function is total and has no state. A result that is a
   NaN is 0x7FC00000. References in brackets are clauses of IEEE 754-2019. */
#ifndef TRAX_ISA_ORACLE_H
#define TRAX_ISA_ORACLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Correctly rounded, ties to even [4.3.1, 5.4.1, 6.3, 7.2, 7.3]. */
uint32_t oracle_fadd(uint32_t a, uint32_t b);
uint32_t oracle_fsub(uint32_t a, uint32_t b);
uint32_t oracle_fmul(uint32_t a, uint32_t b);
uint32_t oracle_fdiv(uint32_t a, uint32_t b);

/* minimumNumber and maximumNumber [9.6]: -0 is less than +0, and a number wins over any NaN. */
uint32_t oracle_fmin(uint32_t a, uint32_t b);
uint32_t oracle_fmax(uint32_t a, uint32_t b);

/* 1 if the relation holds, else 0; 0 if either is a NaN; zeros are equal [5.11]. */
uint32_t oracle_feq(uint32_t a, uint32_t b);
uint32_t oracle_flt(uint32_t a, uint32_t b);
uint32_t oracle_fle(uint32_t a, uint32_t b);

/* rSqrt [9.2.1] and squareRoot [5.4.1], correctly rounded. The TP has no instruction for the second: it is what the
   library's sqrtf must return. */
uint32_t oracle_frsqrt(uint32_t a);
uint32_t oracle_fsqrt_rounded(uint32_t a);

/* To int32_t and uint32_t: towards zero, saturating, a NaN gives 0. */
uint32_t oracle_fcvt_w_s(uint32_t a);
uint32_t oracle_fcvt_wu_s(uint32_t a);

/* From int32_t and uint32_t, correctly rounded. */
uint32_t oracle_fcvt_s_w(uint32_t a);
uint32_t oracle_fcvt_s_wu(uint32_t a);

/* The result `value` of a unit of `bits` significant bits, 1 to 24 (docs/timing.md, special.precision_bits): a normal
   number is rounded to nearest, ties to even; all else passes. With one bit there is no even neighbour, and a
   tie goes to the greater magnitude [4.3.1]. */
uint32_t oracle_reduce(uint32_t value, unsigned bits);

#ifdef __cplusplus
}
#endif

#endif
