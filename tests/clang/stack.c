// -mstack=global: another start file, the size of each stack for the loader, and atomics that other threads see.
// RUN: %clang -### %s 2>&1 | FileCheck %s --check-prefix=LOCAL
// RUN: %clang -### %s -mstack=global -mstack=local 2>&1 | FileCheck %s --check-prefix=LOCAL
// LOCAL-NOT: global-stack
// LOCAL-NOT: __trax_stack_size
// LOCAL: "{{[^"]*}}lib/trax/crt0.o"
// RUN: %clang -### %s -mstack=global 2>&1 | FileCheck %s --check-prefixes=GLOBAL,DEFAULT
// RUN: %clang -### %s -mstack=global -mstack-size=1000 2>&1 | FileCheck %s --check-prefixes=GLOBAL,BYTES
// RUN: %clang -### %s -mstack=global -mstack-size=16k 2>&1 | FileCheck %s --check-prefixes=GLOBAL,KILO
// RUN: %clang -### %s -mstack=global -mstack-size=0x40 -mstack-size=2M 2>&1 | FileCheck %s --check-prefixes=GLOBAL,MEGA
// GLOBAL: "-cc1" {{.*}} "-target-feature" "+global-stack"
// GLOBAL: trax-ld" {{.*}} "{{[^"]*}}lib/trax/crt0-global-stack.o"
// DEFAULT-SAME: "--defsym=__trax_stack_size=65536"
// BYTES-SAME: "--defsym=__trax_stack_size=1024"
// KILO-SAME: "--defsym=__trax_stack_size=16384"
// MEGA-SAME: "--defsym=__trax_stack_size=2097152"

// RUN: not %clang -c %s -mstack=heap -mstack-size=4x 2>&1 | FileCheck %s --check-prefix=WRONG
// WRONG: error: unsupported argument 'heap' to option '-mstack=' for target 'trax': there are 'local', 'global' and 'either'
// WRONG: error: invalid value '4x' in '-mstack-size='
// RUN: not %clang -c %s -mstack=global -mstack-size=4G 2>&1 | FileCheck %s --check-prefix=HUGE
// RUN: not %clang -c %s -mstack=global -mstack-size=4096M 2>&1 | FileCheck %s --check-prefix=HUGE
// RUN: not %clang -c %s -mstack=global -mstack-size= 2>&1 | FileCheck %s --check-prefix=HUGE
// RUN: not %clang -c %s -mstack=global -mstack-size=0 2>&1 | FileCheck %s --check-prefix=HUGE
// RUN: not %clang -c %s -mstack=global -mstack-size=1kM 2>&1 | FileCheck %s --check-prefix=HUGE
// HUGE: error: invalid value '{{.*}}' in '-mstack-size='
// RUN: %clang -c %s -mstack-size=4k -o %t.o 2>&1 | FileCheck %s --check-prefix=UNUSED
// UNUSED: warning: argument unused during compilation: '-mstack-size=4k'
// RUN: not %host_clang -c %s -mstack=global 2>&1 | FileCheck %s --check-prefix=HOST
// HOST: error: unsupported option '-mstack=' for target 'x86_64

// RUN: echo '--target=trax -O1' > %t.cfg
// RUN: %host_clang --config %t.cfg -mstack=global -### %s 2>&1 | FileCheck %s --check-prefixes=GLOBAL,DEFAULT
// RUN: echo '--target=trax -mstack=global -mstack-size=16k' > %t.cfg
// RUN: %host_clang --config %t.cfg -### %s 2>&1 | FileCheck %s --check-prefixes=GLOBAL,KILO
// RUN: %clang --help | FileCheck %s --check-prefix=HELP
// HELP: -mstack=<place>{{.*}}'local'{{.*}}'global'

// RUN: %clang -O2 -S %s -o %t.s 2> %t.txt && FileCheck %s --check-prefix=LOCAL-CODE < %t.s
// RUN: FileCheck %s --check-prefix=FRAME < %t.txt
// RUN: %clang -O2 -S %s -mstack=global -o - 2>&1 | FileCheck %s --check-prefix=GLOBAL-CODE --implicit-check-not=warning
void use(_Atomic int *);

// LOCAL-CODE-LABEL: {{^}}counter:
// LOCAL-CODE-NOT: ainc
// LOCAL-CODE-NOT: lwnt
// LOCAL-CODE-NOT: has_macro
// GLOBAL-CODE-LABEL: {{^}}counter:
// GLOBAL-CODE: __atomic_fetch_add_4
// GLOBAL-CODE: lwnt
int counter(void) {
  _Atomic int n = 0;
  use(&n);
  n++;
  return n;
}

// FRAME: warning: stack frame size ({{[0-9]+}}) exceeds limit (512) in 'large'
// FRAME: note: -mstack=global puts the stack into global memory
void fill(int *);
int large(void) {
  int a[1000];
  fill(a);
  return a[3];
}

#ifdef __trax_global_stack__
// GLOBAL-CODE: .globl has_macro
int has_macro;
#endif
