// RUN: %clang -O1 -S -emit-llvm %s -o - | FileCheck %s
// RUN: not %clang -DINVALID -fsyntax-only %s 2>&1 | FileCheck %s --check-prefix=ERROR

// CHECK-LABEL: define{{.*}} i32 @operands(
// CHECK: call i32 asm "add $0, $1, $2", "=r,r,r"(i32 %0, i32 %1)
int operands(int a, int b) {
  int sum;
  __asm__("add %0, %1, %2" : "=r"(sum) : "r"(a), "r"(b));
  return sum;
}

// CHECK-LABEL: define{{.*}} float @floats(
// CHECK: call float asm "fadd $0, $1, $1", "=r,r"(float %0)
float floats(float a) {
  float sum;
  __asm__("fadd %0, %1, %1" : "=r"(sum) : "r"(a));
  return sum;
}

// CHECK-LABEL: define{{.*}} i32 @immediates(
// CHECK: call i32 asm "addi $0, $1, $2", "=r,r,I"(i32 %0, i32 -32768)
// CHECK: call i32 asm "lui $0, $1", "=r,i"(i32 65535)
int immediates(int a) {
  int sum, upper;
  __asm__("addi %0, %1, %2" : "=r"(sum) : "r"(a), "I"(-32768));
  __asm__("lui %0, %1" : "=r"(upper) : "i"(65535));
  return sum + upper;
}

// CHECK-LABEL: define{{.*}} i32 @other_immediates(
// CHECK: call i32 asm "lui $0, $1", "=r,K"(i32 65535)
// CHECK: call void asm sideeffect "sw ${0:z}, $1(r4)", "J,n"(i32 0, i32 4)
// CHECK: call i32 asm "lui $0, %hi($1)", "=r,s"(ptr {{.*}}@other_immediates)
int other_immediates(void) {
  int upper, address;
  __asm__("lui %0, %1" : "=r"(upper) : "K"(65535));
  __asm__ volatile("sw %z0, %1(r4)" : : "J"(0), "n"(4));
  __asm__("lui %0, %%hi(%1)" : "=r"(address) : "s"(other_immediates));
  return upper + address;
}

// Registers go by number or by their names in the ABI.
// CHECK-LABEL: define{{.*}} void @clobbers(
// CHECK: call void asm sideeffect "", "~{r4},~{r12},~{r31},~{memory}"()
void clobbers(void) { __asm__ volatile("" ::: "a0", "r12", "s11", "memory"); }

// CHECK-LABEL: define{{.*}} i32 @pinned(
// CHECK: call i32 asm "mv $0, $1", "={r4},{r11}"(i32 %0)
int pinned(int a) {
  register int result __asm__("a0");
  register int operand __asm__("r11") = a;
  __asm__("mv %0, %1" : "=r"(result) : "r"(operand));
  return result;
}

// A double word is in two registers; %H names the upper one.
// CHECK-LABEL: define{{.*}} i64 @wide(
// CHECK: call i64 asm "mv $0, ${1:H}\0A\09mv ${0:H}, $1", "=&r,r"(i64 %0)
long long wide(long long a) {
  long long swapped;
  __asm__("mv %0, %H1\n\tmv %H0, %1" : "=&r"(swapped) : "r"(a));
  return swapped;
}

// A word may share the register of a double word: its lower half.
// CHECK-LABEL: define{{.*}} i32 @lower_half(
// CHECK: call i64 asm "", "=r,0"(i64 %0)
int lower_half(long long a) {
  int low;
  __asm__("" : "=r"(low) : "0"(a));
  return low;
}

#ifdef INVALID
void invalid(int a) {
  // ERROR: inline-asm.c:[[@LINE+1]]:{{[0-9]+}}: error: value '32768' out of range for constraint 'I'
  __asm__("addi r4, r4, %0" ::"I"(32768));
  // ERROR: inline-asm.c:[[@LINE+1]]:{{[0-9]+}}: error: value '1' out of range for constraint 'J'
  __asm__("sw %z0, 0(r4)" ::"J"(1));
  // ERROR: inline-asm.c:[[@LINE+1]]:{{[0-9]+}}: error: value '-1' out of range for constraint 'K'
  __asm__("lui r4, %0" ::"K"(-1));
  // ERROR: inline-asm.c:[[@LINE+1]]:{{[0-9]+}}: error: invalid input constraint 'Q' in asm
  __asm__("addi r4, r4, %0" ::"Q"(a));
  // ERROR: inline-asm.c:[[@LINE+1]]:{{[0-9]+}}: error: unknown register name 'r32' in asm
  __asm__("" ::: "r32");
}
#endif
