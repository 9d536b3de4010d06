/* In place of the real trax/semantics.h, which it includes: the operations of floating point with the mutant in force.
 */
#ifndef TRAX_TESTS_ISA_MUTATED_SEMANTICS_H
#define TRAX_TESTS_ISA_MUTATED_SEMANTICS_H

#define trax_fadd trax_true_fadd
#define trax_fsub trax_true_fsub
#define trax_fmul trax_true_fmul
#define trax_fdiv trax_true_fdiv
#define trax_fmin trax_true_fmin
#define trax_fmax trax_true_fmax
#define trax_feq trax_true_feq
#define trax_flt trax_true_flt
#define trax_fle trax_true_fle
#define trax_fcvt_w_s trax_true_fcvt_w_s
#define trax_fcvt_wu_s trax_true_fcvt_wu_s
#define trax_fcvt_s_w trax_true_fcvt_s_w
#define trax_fcvt_s_wu trax_true_fcvt_s_wu
#define trax_frsqrt trax_true_frsqrt
#include_next "trax/semantics.h"
#undef trax_fadd
#undef trax_fsub
#undef trax_fmul
#undef trax_fdiv
#undef trax_fmin
#undef trax_fmax
#undef trax_feq
#undef trax_flt
#undef trax_fle
#undef trax_fcvt_w_s
#undef trax_fcvt_wu_s
#undef trax_fcvt_s_w
#undef trax_fcvt_s_wu
#undef trax_frsqrt

uint32_t trax_fadd(uint32_t a, uint32_t b);
uint32_t trax_fsub(uint32_t a, uint32_t b);
uint32_t trax_fmul(uint32_t a, uint32_t b);
uint32_t trax_fdiv(uint32_t a, uint32_t b);
uint32_t trax_fmin(uint32_t a, uint32_t b);
uint32_t trax_fmax(uint32_t a, uint32_t b);
uint32_t trax_feq(uint32_t a, uint32_t b);
uint32_t trax_flt(uint32_t a, uint32_t b);
uint32_t trax_fle(uint32_t a, uint32_t b);
uint32_t trax_fcvt_w_s(uint32_t a);
uint32_t trax_fcvt_wu_s(uint32_t a);
uint32_t trax_fcvt_s_w(uint32_t a);
uint32_t trax_fcvt_s_wu(uint32_t a);
uint32_t trax_frsqrt(uint32_t a);

#endif
