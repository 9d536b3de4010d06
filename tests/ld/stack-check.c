/* The stack of compiled programs: what the compiler records is what functions take, and a program that cannot fit is refused.

   RUN: rm -rf %t && mkdir %t && cd %t
   RUN: %clang -O0 -DMAIN -c %s -o main.o && %clang -O0 -DOTHER -c %s -o other.o && llvm-ar rc lib.a other.o

   Frames as the disassembly has them. A switch and a computed goto are no calls; variable arrays have no bound; what alignment
   skips is counted (aligned: the frame, and up to 60 bytes for 64-byte alignment); static functions of one name are two.
   RUN: %clang main.o lib.a -o prog -Wl,--print-stack,--stack-check=none > report
   RUN: FileCheck %s --input-file=report
   RUN: %trax_objdump prog > code && %python %S/Inputs/frames.py prog code
   CHECK:     stack: at least [[DEPTH:[0-9]+]] bytes, of 508 (512 of local memory less 4 of thread-local data)
   CHECK-NEXT:  frame    depth  function
   CHECK-NEXT:      0        0  _start, {{.*}}crt0.o:(.text._start)
   CHECK-NEXT:                  main, main.o:(.text.main)
   CHECK-NEXT:                  select, main.o:(.text.select)
   CHECK-NEXT:                  large, lib.a(other.o):(.text.large)
   CHECK-NEXT:                  same, lib.a(other.o):(.text.same)
   CHECK-NEXT: not counted:
   CHECK-NEXT: recursion: ackermann -> ackermann, main.o:(.text.ackermann)
   CHECK-NEXT: recursion: odd -> even -> odd, main.o:(.text.odd)
   CHECK-NEXT: 1 indirect call: main, main.o:(.text.main)
   CHECK-NEXT: frame of variable size: variable, main.o:(.text.variable)
   CHECK-EMPTY:

   The same with one section for all code, and in an optimised program with tail calls.
   RUN: %clang -O0 -fno-function-sections -DMAIN -c %s -o plain.o && %clang plain.o other.o -o plain -Wl,--print-stack,--no-check-stack | \
   RUN:   FileCheck %s --check-prefix=PLAIN
   PLAIN: same, other.o:(.text.same)
   PLAIN-NEXT: not counted:
   PLAIN-NEXT: recursion: ackermann -> ackermann, plain.o:(.text
   PLAIN-NEXT: recursion: odd -> even -> odd, plain.o:(.text
   PLAIN-NEXT: 1 indirect call: main, plain.o:(.text
   PLAIN-NEXT: frame of variable size: variable, plain.o:(.text
   PLAIN-EMPTY:
   RUN: %clang -O2 -DMAIN -c %s -o fast.o && %clang fast.o other.o -o fast -Wl,--print-stack,--no-check-stack | FileCheck %s --check-prefix=FAST
   FAST: stack: at least
   FAST-NOT: odd

   Refused, with the path; there is no output then.
   RUN: not %clang -DBIG=70 %s -o no 2>&1 | FileCheck %s --check-prefix=REFUSED
   REFUSED: trax-ld: error: the stack takes [[DEPTH:[0-9]+]] bytes, there are 512 (local memory); the deepest path is
   REFUSED-NEXT: >>> frame depth function
   REFUSED-NEXT: >>> 0 0 _start, {{.*}}crt0.o:(.text._start)
   REFUSED-NEXT: >>> {{[0-9]+ [0-9]+}} main, {{.*}}.o:(.text.main)
   REFUSED-NEXT: >>> {{[0-9]+ [0-9]+}} big, {{.*}}.o:(.text.big)
   REFUSED-NEXT: >>> {{[0-9]+}} [[DEPTH]] half, {{.*}}.o:(.text.half)
   REFUSED-NEXT: >>> -mstack=global gives the stack more room, --stack-check=none links all the same
   RUN: not ls no

   --stack-check and its synonyms decide; the last one counts.
   RUN: %clang -DBIG=70 %s -o warned -Wl,--stack-check=warn 2>&1 | FileCheck %s --check-prefix=WARNED && ls warned
   WARNED: trax-ld: warning: the stack takes
   RUN: %clang -DBIG=70 %s -o one -Wl,--stack-check=none 2>&1 | count 0
   RUN: %clang -DBIG=70 %s -o two -Wl,--no-stack-check 2>&1 | count 0
   RUN: %clang -DBIG=70 %s -o two -Wl,--stack-check=none,--stack-check=error,--no-check-stack 2>&1 | count 0
   RUN: not %clang -DBIG=70 %s -o no -Wl,--stack-check=none,--stack-check=error 2>&1 | FileCheck %s --check-prefix=REFUSED

   More room, and less.
   RUN: %clang -DBIG=70 %s -o two -Wl,-z,stack-size=4096,--print-stack | FileCheck %s --check-prefix=ROOM
   ROOM: stack: at most {{[0-9]+}} bytes, of 4096 (-z stack-size)
   RUN: %clang -DBIG=70 %s -o two -mstack=global -mstack-size=0x10000 -Wl,--print-stack | FileCheck %s --check-prefix=GLOBAL
   GLOBAL: stack: at most {{[0-9]+}} bytes, of 65536 (__trax_stack_size)
   RUN: not %clang -DBIG=70 %s -o no -mstack=global -mstack-size=64 2>&1 | FileCheck %s --check-prefix=SIZE
   SIZE: trax-ld: error: the stack takes {{[0-9]+}} bytes, there are 64 (__trax_stack_size)
   SIZE: >>> -mstack-size= makes it larger, --stack-check=none links all the same
   RUN: not %clang -DBIG=20 %s -o no -Wl,-z,stack-size=64 2>&1 | FileCheck %s --check-prefix=LESS
   LESS: trax-ld: error: the stack takes {{[0-9]+}} bytes, there are 64 (-z stack-size)

   The map has it as well; a stripped program does not keep the records, and is checked all the same.
   RUN: %clang -DBIG=20 %s -o small -Wl,-Map=map && FileCheck %s --check-prefix=MAP --input-file=map
   MAP: stack: at most {{[0-9]+}} bytes, of 512
   RUN: llvm-readelf --stack-sizes small | FileCheck %s --check-prefix=KEPT
   KEPT: {{[1-9][0-9]*}} big
   RUN: %clang -DBIG=20 %s -o small -s && llvm-readelf -S small | FileCheck %s --check-prefix=STRIPPED --implicit-check-not=.stack_sizes
   STRIPPED: .text
   RUN: not %clang -DBIG=70 %s -o no -s 2>&1 | FileCheck %s --check-prefix=REFUSED

   Options that are none.
   RUN: not %clang -DBIG=20 %s -o no -Wl,--stack-check=maybe,-z,stack-size=much 2>&1 | FileCheck %s --check-prefix=WRONG
   WRONG: trax-ld: error: --stack-check=maybe: must be error, warn or none
   WRONG: trax-ld: error: -z stack-size=much: not a number of bytes
*/
#ifdef MAIN
_Thread_local int local;
int large(int);
static int same(int x) {
  volatile int a[4] = {x};
  return a[0];
}
int ackermann(int m, int n) {
  return m == 0 ? n + 1 : n == 0 ? ackermann(m - 1, 1) : ackermann(m - 1, ackermann(m, n - 1));
}
int even(unsigned n);
int odd(unsigned n) { return n == 0 ? 0 : even(n - 1); }
int even(unsigned n) { return n == 0 ? 1 : odd(n - 1); }
int variable(int n) {
  volatile int a[n];
  a[0] = n;
  return a[0];
}
int aligned(int n) {
  _Alignas(64) volatile int a[4] = {n};
  return a[0];
}
int select(int n) {
  switch (n) {
  case 0: return 3;
  case 1: return local;
  case 2: return 11;
  case 3: return large(1);
  case 4: return -7;
  case 5: return 8;
  default: return n;
  }
}
int computed(int n) {
  static const void *const places[] = {&&a, &&b};
  goto *places[n & 1];
a:
  return 1;
b:
  return local;
}
int (*volatile pointer)(int) = computed;
int main(void) {
  return pointer(1) + same(1) + ackermann(1, 1) + odd(3) + variable(3) + aligned(4) + select(3) + computed(2) + large(1);
}
#elif defined(OTHER)
static int same(int x) {
  volatile int a[40] = {x};
  return a[0];
}
int large(int x) {
  volatile int a[60] = {x};
  return same(a[0]);
}
#else
__attribute__((noinline)) int half(int n) {
  volatile int a[BIG];
  a[n] = n;
  return a[0];
}
__attribute__((noinline)) int big(int n) {
  volatile int a[BIG];
  a[n] = n;
  return half(n) + a[0];
}
int main(void) {
  return big(3) + big(4);
}
#endif
