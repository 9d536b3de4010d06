/* The compiler's builtins as functions (docs/compiler.md, "Builtins"), for tools that do not know them: a stock clangd or
   clang-tidy, with stock-clang.cfg. */
#ifndef TRAX_BUILTINS_H
#define TRAX_BUILTINS_H

#if !__has_builtin(__builtin_trax_rsqrt)
#ifdef __cplusplus
extern "C" {
#endif
float __builtin_trax_rsqrt(float x);
unsigned __builtin_trax_rdsr(unsigned number);
void __builtin_trax_trap(unsigned operand, unsigned code);
__attribute__((noreturn)) void __builtin_trax_halt(void);
unsigned __builtin_trax_ainc(unsigned *word);
#ifdef __cplusplus
}
#endif
#endif

#endif
