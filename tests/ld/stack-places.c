/* Objects for stacks in different places are no program: what one takes for a thread's own, others change.

   RUN: rm -rf %t && mkdir %t && cd %t
   RUN: %clang -O1 -DMAIN -c %s -o main.o && %clang -O1 -mstack=global -DMAIN -c %s -o main-global.o && %clang -O1 -c %s -o part.o
   RUN: %clang -O1 -mstack=global -c %s -o part-global.o && %clang -O1 -mstack=either -c %s -o part-either.o
   RUN: %clang -O1 -S %s -o part.s && %clang -mstack=global -c part.s -o assembled.o && cmp assembled.o part.o
   RUN: llvm-readelf -h main.o part-global.o part-either.o | FileCheck %s --check-prefix=FLAGS
   FLAGS: Flags: 0x1
   FLAGS: Flags: 0x2
   FLAGS: Flags: 0x0

   RUN: not %clang main.o part-global.o -o out 2>&1 | FileCheck %s --check-prefix=LOCAL
   RUN: llvm-ar rcs libpart.a part-global.o && not %clang main.o -L. -lpart -o out 2>&1 | FileCheck %s --check-prefix=LOCAL
   LOCAL: trax-ld: error: {{.*}}part-global.o{{.*}}: is for stacks in global memory, main.o for stacks in local memory: compile and link both with the same -mstack
   LOCAL-NOT: trax-ld: error
   RUN: not %clang -mstack=global main.o part-global.o -o out 2>&1 | FileCheck %s --check-prefix=GLOBAL
   RUN: not %clang -mstack=global main.o assembled.o part-global.o -o out 2>&1 | FileCheck %s --check-prefix=GLOBAL
   GLOBAL: trax-ld: error: main.o: is for stacks in local memory, part-global.o for stacks in global memory
   RUN: not %clang main-global.o part-global.o -o out 2>&1 | FileCheck %s --check-prefix=START
   START: trax-ld: error: main-global.o: is for stacks in global memory, {{.*}}crt0.o for stacks in local memory
   RUN: not test -e out

   Without a start file there is still the stack's size.
   RUN: not %trax_ld -e main main-global.o part-global.o -L%runtime -lc -o out 2>&1 | FileCheck %s --check-prefix=SIZE
   SIZE: trax-ld: error: part-global.o: is for stacks in global memory, but __trax_stack_size is not defined
   RUN: not %trax_ld -e main main.o part.o -L%runtime -lc --defsym=__trax_stack_size=4096 -o out 2>&1 | FileCheck %s --check-prefix=NO-SIZE
   NO-SIZE: trax-ld: error: part.o: is for stacks in local memory, but __trax_stack_size is defined

   The program says what all of them say.
   RUN: %clang -mstack=global main-global.o part-either.o -o out && llvm-readelf -h out | FileCheck %s --check-prefix=MERGED && %trax_sim out
   RUN: %clang -mstack=global part-either.o main-global.o -o out && llvm-readelf -h out | FileCheck %s --check-prefix=MERGED && %trax_sim out
   MERGED: Flags: 0x2

   What belongs together, and objects for either place, which all of the library's are.
   RUN: %clang main.o part.o -o out && %trax_sim out && %clang main.o part-either.o -o out && %trax_sim out
   RUN: %clang -mstack=global main-global.o part-global.o -o out && %trax_sim out
   RUN: llvm-readelf -h %runtime/libc.a | FileCheck %s --check-prefix=LIBRARY
   LIBRARY-NOT: Flags: 0x{{[^0]}}

   The emulator compares the flags with the symbol.
   RUN: %python -c "d = bytearray(open('out', 'rb').read()); d[36] = 1; open('out', 'wb').write(d)"
   RUN: not %trax_sim out 2>&1 | FileCheck %s --check-prefix=LOADER
   LOADER: out: is for stacks in local memory, but has a symbol __trax_stack_size
*/
#include <stdatomic.h>

int add(atomic_int *number);

#ifdef MAIN
int main(void) {
  atomic_int number = 1;
  return add(&number) - 1;
}
#else
int add(atomic_int *number) {
  return atomic_fetch_add(number, 1);
}
#endif
