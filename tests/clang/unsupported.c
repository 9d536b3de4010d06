// Features of other ELF targets that do not exist here are refused, with their place.
// RUN: not %clang -DIFUNC -fsyntax-only %s 2>&1 | FileCheck %s --check-prefix=IFUNC
// RUN: not %clangxx -x c++ -DIFUNC -fsyntax-only %s 2>&1 | FileCheck %s --check-prefixes=IFUNC,LINKAGE
// RUN: not %clang -DEH -c %s -o %t.o 2>&1 | FileCheck %s --check-prefix=EH
// RUN: not %clang -DREGISTER -c %s -o %t.o 2>&1 | FileCheck %s --check-prefix=REGISTER
// RUN: not %clang -DWIDE -fsyntax-only %s 2>&1 | FileCheck %s --check-prefix=WIDE
// RUN: not %clang -DTAIL -c %s -o %t.o 2>&1 | FileCheck %s --check-prefix=TAIL
// RUN: %clang -DATTRIBUTES -fsyntax-only %s 2>&1 | FileCheck %s --check-prefix=ATTRIBUTES
// RUN: not %clang -DATTRIBUTES -Werror -fsyntax-only %s
// Other targets are unchanged.
// RUN: clang --target=x86_64-linux-gnu -DIFUNC -fsyntax-only %s

#ifdef IFUNC
#ifdef __cplusplus
extern "C" {
#endif
void f(void) {}
void (*choose(void))(void) { return f; }
// IFUNC: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: ifunc is not supported: nothing resolves functions at start
void chosen(void) __attribute__((ifunc("choose")));
#ifdef __cplusplus
}
namespace inner {
extern "C" void (*choose_other(void))(void) { return f; }
// LINKAGE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: ifunc is not supported
extern "C" void other(void) __attribute__((ifunc("choose_other")));
}
#endif
#endif

#ifdef EH
// EH: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: there is no unwinder to return from
void unwind(int a, void *b) { __builtin_eh_return(a, b); }
#endif

#ifdef REGISTER
register int in_s5 __asm__("s5");
// REGISTER: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: global register variable needs a reserved register: zero or sp
int take(void) { return in_s5; }
#endif

#ifdef WIDE
// WIDE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: __int128 is not supported on this target
__int128 a;
// WIDE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: signed _BitInt of bit sizes greater than 64 not supported
_BitInt(65) b;
// WIDE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: _Float16 is not supported on this target
_Float16 c;
// WIDE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: __float128 is not supported on this target
__float128 d;
// WIDE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: GNU decimal type extension not supported
_Decimal64 e;
// WIDE: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: error: __bf16 is not supported on this target
__bf16 f;
#endif

#ifdef TAIL
int nine(int, int, int, int, int, int, int, int, int);
int caller(int a, int b, int c, int d, int e, int f, int g, int h, int i) {
  // TAIL: unsupported.c:[[@LINE-1]]:{{[0-9]+}}: error: this call cannot be a tail call: arguments or result need the stack
  __attribute__((musttail)) return nine(i, h, g, f, e, d, c, b, a);
}
#endif

#ifdef ATTRIBUTES
// ATTRIBUTES: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: warning: unknown attribute 'interrupt' ignored
__attribute__((interrupt)) void handler(void);
// ATTRIBUTES: unsupported.c:[[@LINE+1]]:{{[0-9]+}}: warning: 'vectorcall' calling convention is not supported for this target
__attribute__((vectorcall)) void call(void);
#endif
