/* -r: several objects become one, which links and runs as they do.

   RUN: rm -rf %t && mkdir %t && cd %t
   RUN: %clang -g -O1 -DPART=1 -c %s -o a.o && %clang -g -O1 -DPART=2 -c %s -o b.o && %clangxx -g -O1 -x c++ -DPART=3 -c %s -o c.o
   RUN: %clangxx -g -O1 -x c++ -DPART=4 -c %s -o d.o
   RUN: %clang a.o b.o c.o d.o -o direct -Wl,--print-stack | cut -d, -f1 > direct.stack && %trax_sim direct > direct.out
   RUN: FileCheck %s --check-prefix=OUTPUT --input-file=direct.out
   OUTPUT: 7 11 12 30 42 1 1 5 local sum 6

   All into one; in two steps; by the driver; with the library's members.
   RUN: %trax_ld -r a.o b.o c.o d.o -o one.o && %clang one.o -o one -Wl,--print-stack | cut -d, -f1 > one.stack
   RUN: %trax_sim one | cmp - direct.out && cmp one.stack direct.stack
   RUN: %trax_ld --relocatable a.o b.o -o ab.o && %trax_ld -r d.o ab.o -o abd.o && %clang abd.o c.o -o two && %trax_sim two | cmp - direct.out
   RUN: %clang -r a.o b.o c.o d.o -o three.o && cmp three.o one.o && %clang three.o -o three && %trax_sim three | cmp - direct.out
   RUN: %trax_ld -r %runtime/crt0.o a.o b.o c.o d.o %runtime/libc.a -o whole.o && %trax_ld whole.o -o four && %trax_sim four | cmp - direct.out
   RUN: %trax_ld --gc-sections whole.o -o five && %trax_sim five | cmp - direct.out
   RUN: not test -x one.o

   What is in it: sections of one name once, groups with their members, section symbols and sizes; debug information that holds.
   RUN: llvm-readelf -hSsgW one.o > elf && FileCheck %s --check-prefix=ELF --input-file=elf
   ELF: Type: REL
   ELF: Entry point address: 0x0
   ELF: Number of program headers: 0
   ELF-COUNT-1: .text.same PROGBITS
   ELF-NOT: .text.same PROGBITS
   ELF: .tbss.before NOBITS {{.*}} WAT
   ELF: .rela.text.same RELA {{.*}} I
   ELF: 4 OBJECT GLOBAL DEFAULT COM common
   ELF: COMDAT group section [{{ *[0-9]+}}] `.group' [_Z5twiceIiET_S0_] contains 3 sections:
   ELF: .text._Z5twiceIiET_S0_
   ELF: .stack_sizes
   ELF: .rela.stack_sizes
   ELF-NOT: [_Z5twiceIiET_S0_]
   RUN: llvm-dwarfdump --verify one && llvm-dwarfdump --verify direct
   RUN: llvm-symbolizer --obj=direct 0x1000 > /dev/null

   Undefined symbols stay so, --defsym and --wrap work, a map is made; what has no meaning is refused.
   RUN: %trax_ld -r a.o --defsym=alias=main+4 --defsym=number=12 --wrap=sum -o defs.o -Map=map && llvm-readelf -sW defs.o | FileCheck %s --check-prefix=DEFS
   DEFS-DAG: {{0+}}4 0 NOTYPE GLOBAL DEFAULT {{[0-9]+}} alias
   DEFS-DAG: {{0+}}c 0 NOTYPE GLOBAL DEFAULT ABS number
   DEFS-DAG: 0 NOTYPE GLOBAL DEFAULT UND __wrap_sum
   RUN: FileCheck %s --check-prefix=MAP --input-file=map
   MAP: a.o:(.text.main)
   RUN: not %trax_ld -r a.o --gc-sections -o no.o 2>&1 | FileCheck %s --check-prefix=GC
   GC: trax-ld: error: -r and --gc-sections cannot be combined
   RUN: not %trax_ld -r a.o -s -o no.o 2>&1 | FileCheck %s --check-prefix=STRIP
   STRIP: trax-ld: error: -r and --strip-all cannot be combined
   RUN: not %trax_ld -r a.o --print-stack -o no.o 2>&1 | FileCheck %s --check-prefix=STACK
   STACK: trax-ld: error: -r and --print-stack cannot be combined
   RUN: not %trax_ld -r a.o --print-memory-usage -o no.o 2>&1 | FileCheck %s --check-prefix=MEMORY
   MEMORY: trax-ld: error: -r and --print-memory-usage cannot be combined
   RUN: not ls no.o

   -S leaves out the debug information but what the stack's check needs.
   RUN: %trax_ld -r -S a.o b.o c.o d.o -o bare.o && llvm-readelf -S bare.o | FileCheck %s --check-prefix=BARE --implicit-check-not=.debug
   BARE: .stack_sizes
   RUN: %clang bare.o -o bare -Wl,--print-stack | cut -d, -f1 | cmp - direct.stack

   RUN: not %trax_ld -r a.o a.o -o no.o 2>&1 | FileCheck %s --check-prefix=TWICE
   TWICE: duplicate symbol 'main'
*/
#ifndef __cplusplus
#include <stdio.h>
#else
extern "C" int in_c(int), in_d(int);
template <typename T> __attribute__((noinline)) T twice(T x) { return x + x; }
#endif

#if PART == 1
extern _Thread_local int thread;
int sum(const int *, int), in_b(int), in_c(int), in_d(int), choose(int);
const char *name(void);
__attribute__((common)) int common;
static int constructed;
__attribute__((constructor)) static void construct(void) { constructed = 1; }
__attribute__((noinline)) static int same(int x) { return x + thread - 37; }
int absent(void) __attribute__((weak));
static const int numbers[] = {1, 2, 3};
int main(void) {
  thread = 42;
  common += 1;
  printf("%d %d %d %d %d %d %d %d %s %s %d\n", same(2), in_b(1), in_c(6), in_d(15), thread, constructed, common, choose(3),
         name(), "sum", sum(numbers, 3) + (absent ? absent() : 0));
  return 0;
}
#elif PART == 2
_Thread_local int before, thread;
__attribute__((common)) int common;
__attribute__((noinline)) static int same(int x) { return x + 52 - thread; }
int in_b(int x) { return same(x); }
const char *name(void) { return "local"; }
int sum(const int *v, int n) {
  int total = 0;
  while (n--)
    total += *v++;
  return total;
}
int choose(int x) {
  switch (x) {
  case 0: return sum(0, 0);
  case 1: return in_b(4);
  case 2: return 17;
  case 3: return 5;
  case 4: return -8;
  case 5: return name()[0];
  default: return 0;
  }
}
#elif PART == 3
int in_c(int x) { return twice(x); }
#else
int in_d(int x) { return twice(x); }
#endif
