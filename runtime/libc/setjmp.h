/* Jumps out of functions: ra, sp, fp and the twelve saved registers. */
#ifndef TRAX_SETJMP_H
#define TRAX_SETJMP_H

#include <trax/names.h>

#ifdef __cplusplus
extern "C" {
#endif
typedef unsigned jmp_buf[15];

__attribute__((returns_twice)) int setjmp(jmp_buf environment);
__attribute__((noreturn)) void longjmp(jmp_buf environment, int value);
#ifdef __TRAX_ALL_NAMES
/* Nothing masks signals. */
typedef jmp_buf sigjmp_buf;
#define sigsetjmp(environment, mask) setjmp(environment)
#define siglongjmp longjmp
#define _setjmp setjmp
#define _longjmp longjmp
#endif

#ifdef __cplusplus
}
#endif

#endif
