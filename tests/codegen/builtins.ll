; Clang's builtins arrive as calls and leave as instructions: the function stays a leaf.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare float @__builtin_trax_rsqrt(float)
declare i32 @__builtin_trax_rdsr(i32)
declare void @__builtin_trax_trap(i32, i32)
declare void @__builtin_trax_halt()
declare i32 @__builtin_trax_ainc(ptr)
declare i32 @__builtin_trax_opaque(i32)

; CHECK-LABEL: rsqrt:
; CHECK: frsqrt r4, r4
; CHECK: ret
define float @rsqrt(float %x) {
  %r = call float @__builtin_trax_rsqrt(float %x)
  ret float %r
}
; CHECK-LABEL: thread:
; CHECK: rdsr r4, thread
; CHECK: ret
define i32 @thread() {
  %r = call i32 @__builtin_trax_rdsr(i32 0)
  ret i32 %r
}
; CHECK-LABEL: elapsed:
; CHECK: rdsr r12, cycle
; CHECK: rdsr r13, cycle
; CHECK: sub r4, r13, r12
; CHECK: ret
define i32 @elapsed() {
  %a = call i32 @__builtin_trax_rdsr(i32 4)
  %b = call i32 @__builtin_trax_rdsr(i32 4)
  %r = sub i32 %b, %a
  ret i32 %r
}
; CHECK-LABEL: cycles:
; CHECK: rdsr r12, cycleh
; CHECK: rdsr r4, cycle
; CHECK: rdsr r5, cycleh
; CHECK: xor r12, r12, r5
; CHECK: cmovnz r4, r0, r12
; CHECK: ret
define i64 @cycles() {
  %r = call i64 @llvm.readcyclecounter()
  ret i64 %r
}
; CHECK-LABEL: put:
; CHECK: trap r4, putc
; CHECK: ret
define void @put(i32 %c) {
  call void @__builtin_trax_trap(i32 %c, i32 1)
  ret void
}
; CHECK-LABEL: halt:
; CHECK: halt
define void @halt() {
  call void @__builtin_trax_halt()
  unreachable
}
; CHECK-LABEL: halt_that_seems_to_return:
; CHECK: halt
; CHECK: ret
define void @halt_that_seems_to_return() {
  call void @__builtin_trax_halt()
  ret void
}
; CHECK-LABEL: ainc:
; CHECK: ainc r4, 4(r4)
; CHECK: ret
define i32 @ainc(ptr %p) {
  %q = getelementptr i8, ptr %p, i32 4
  %r = call i32 @__builtin_trax_ainc(ptr %q)
  ret i32 %r
}
; CHECK-LABEL: abort:
; CHECK: trap r0, abort
define void @abort() {
  call void @llvm.trap()
  unreachable
}
; The comparison of the words stays one, though both are floats', and no copy is left.
; CHECK-LABEL: opaque:
; CHECK-NOT: mv
; CHECK: xor r12, r4, r5
; CHECK: srli r4, r12, 31
; CHECK-NEXT: ret
define i32 @opaque(float %a, float %b) {
  %x = bitcast float %a to i32
  %y = bitcast float %b to i32
  %p = call i32 @__builtin_trax_opaque(i32 %x)
  %q = call i32 @__builtin_trax_opaque(i32 %y)
  %d = xor i32 %p, %q
  %c = icmp slt i32 %d, 0
  %r = zext i1 %c to i32
  ret i32 %r
}
; What is known of the operand is not known of the result.
; CHECK-LABEL: opaque_constant:
; CHECK: li r12, 5
; CHECK: addi r4, r12, 1
define i32 @opaque_constant() {
  %p = call i32 @__builtin_trax_opaque(i32 5)
  %r = add i32 %p, 1
  ret i32 %r
}
; CHECK-LABEL: address_taken:
; CHECK: lui r4, %hi(__builtin_trax_ainc)
; CHECK: addi r4, r4, %lo(__builtin_trax_ainc)
; CHECK: ret
define ptr @address_taken() {
  ret ptr @__builtin_trax_ainc
}
declare i64 @llvm.readcyclecounter()
declare void @llvm.trap()
