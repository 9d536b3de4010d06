; Arguments and results (docs/abi.md).
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

%big = type { [6 x i32] }
declare i32 @callee(i32, i32)
declare void @big_by_value(ptr byval(%big) align 4)
declare void @many(i32, i32, i32, i32, i32, i32, i32, i64, i32)
declare i32 @variadic(i32, ...)

; CHECK-LABEL: call:
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: li r5, 3
; CHECK: call callee
; CHECK: lw r1, 0(r2)
; CHECK: addi r4, r4, 1
; CHECK: addi r2, r2, 4
; CHECK: ret
define i32 @call(i32 %a) {
  %r = call i32 @callee(i32 %a, i32 3)
  %s = add i32 %r, 1
  ret i32 %s
}
; CHECK-LABEL: tail:
; CHECK: mv r5, r4
; CHECK: li r4, 3
; CHECK: j callee
define i32 @tail(i32 %a) {
  %r = tail call i32 @callee(i32 3, i32 %a)
  ret i32 %r
}
; CHECK-LABEL: indirect:
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: mv r12, r4
; CHECK: li r4, 1
; CHECK: jalr r12
; CHECK: lw r1, 0(r2)
; CHECK: addi r4, r4, 1
; CHECK: addi r2, r2, 4
; CHECK: ret
define i32 @indirect(ptr %f) {
  %r = call i32 %f(i32 1)
  %s = add i32 %r, 1
  ret i32 %s
}
; CHECK-LABEL: tail_indirect:
; CHECK: mv r12, r4
; CHECK: li r4, 1
; CHECK: jr r12
define i32 @tail_indirect(ptr %f) {
  %r = tail call i32 %f(i32 1)
  ret i32 %r
}
; CHECK-LABEL: vec3:
; CHECK: fmul r4, r4, r7
; CHECK: mv r5, r6
; CHECK: ret
define { float, float, float } @vec3({ float, float, float } %a, float %s) {
  %x = extractvalue { float, float, float } %a, 0
  %z = extractvalue { float, float, float } %a, 2
  %xs = fmul float %x, %s
  %r = insertvalue { float, float, float } %a, float %xs, 0
  %t = insertvalue { float, float, float } %r, float %z, 1
  ret { float, float, float } %t
}
; CHECK-LABEL: split_between_register_and_stack:
; CHECK: addi r2, r2, -12
; CHECK: sw r1, 8(r2)
; CHECK: mv r12, r5
; CHECK: mv r11, r4
; CHECK: li r13, 9
; CHECK: li r4, 1
; CHECK: li r5, 2
; CHECK: li r6, 3
; CHECK: li r7, 4
; CHECK: li r8, 5
; CHECK: li r9, 6
; CHECK: li r10, 7
; CHECK: sw r13, 4(r2)
; CHECK: sw r12, 0(r2)
; CHECK: call many
; CHECK: lw r1, 8(r2)
; CHECK: addi r2, r2, 12
; CHECK: ret
define void @split_between_register_and_stack(i64 %x) {
  call void @many(i32 1, i32 2, i32 3, i32 4, i32 5, i32 6, i32 7, i64 %x, i32 9)
  ret void
}
; CHECK-LABEL: split_argument:
; CHECK: lw r5, 0(r2)
; CHECK: mv r4, r11
; CHECK: ret
define i64 @split_argument(i32 %a, i32 %b, i32 %c, i32 %d, i32 %e, i32 %f, i32 %g, i64 %x, i32 %i) {
  ret i64 %x
}
; CHECK-LABEL: pass_big:
; CHECK: addi r2, r2, -28
; CHECK: sw r1, 24(r2)
; CHECK: lw r12, 20(r4)
; CHECK: sw r12, 20(r2)
; CHECK: lw r12, 16(r4)
; CHECK: sw r12, 16(r2)
; CHECK: lw r12, 12(r4)
; CHECK: sw r12, 12(r2)
; CHECK: lw r12, 8(r4)
; CHECK: sw r12, 8(r2)
; CHECK: lw r12, 4(r4)
; CHECK: sw r12, 4(r2)
; CHECK: lw r12, 0(r4)
; CHECK: sw r12, 0(r2)
; CHECK: call big_by_value
; CHECK: lw r1, 24(r2)
; CHECK: addi r2, r2, 28
; CHECK: ret
define void @pass_big(ptr %p) {
  call void @big_by_value(ptr byval(%big) align 4 %p)
  ret void
}
; CHECK-LABEL: take_big:
; CHECK: lw r12, 20(r2)
; CHECK: add r4, r12, r4
; CHECK: ret
define i32 @take_big(ptr byval(%big) align 4 %p, i32 %x) {
  %q = getelementptr i8, ptr %p, i32 20
  %r = load i32, ptr %q
  %s = add i32 %r, %x
  ret i32 %s
}
; CHECK-LABEL: return_big:
; CHECK: sw r5, 0(r4)
; CHECK: ret
define void @return_big(ptr sret(%big) %r, i32 %x) {
  store i32 %x, ptr %r
  ret void
}
; CHECK-LABEL: return_in_memory:
; CHECK: sw r5, 16(r4)
; CHECK: sw r0, 12(r4)
; CHECK: sw r0, 8(r4)
; CHECK: sw r0, 4(r4)
; CHECK: sw r0, 0(r4)
; CHECK: ret
define [5 x i32] @return_in_memory(i32 %x) {
  %r = insertvalue [5 x i32] zeroinitializer, i32 %x, 4
  ret [5 x i32] %r
}
; CHECK-LABEL: call_variadic:
; CHECK: addi r2, r2, -16
; CHECK: sw r1, 12(r2)
; CHECK: sw r4, 4(r2)
; CHECK: li r12, 2
; CHECK: li r4, 1
; CHECK: sw r5, 8(r2)
; CHECK: sw r12, 0(r2)
; CHECK: call variadic
; CHECK: lw r1, 12(r2)
; CHECK: addi r2, r2, 16
; CHECK: ret
define i32 @call_variadic(i64 %x) {
  %r = call i32 (i32, ...) @variadic(i32 1, i32 2, i64 %x)
  ret i32 %r
}
; CHECK-LABEL: unnamed_aggregate:
; CHECK: addi r2, r2, -32
; CHECK: sw r1, 28(r2)
; CHECK: lw r12, 20(r4)
; CHECK: sw r12, 24(r2)
; CHECK: lw r12, 16(r4)
; CHECK: sw r12, 20(r2)
; CHECK: lw r12, 12(r4)
; CHECK: sw r12, 16(r2)
; CHECK: lw r12, 8(r4)
; CHECK: sw r12, 12(r2)
; CHECK: lw r12, 4(r4)
; CHECK: sw r12, 8(r2)
; CHECK: lw r12, 0(r4)
; CHECK: li r4, 1
; CHECK: sw r12, 4(r2)
; CHECK: addi r12, r2, 4
; CHECK: sw r12, 0(r2)
; CHECK: call variadic
; CHECK: lw r1, 28(r2)
; CHECK: addi r2, r2, 32
; CHECK: ret
define i32 @unnamed_aggregate(ptr %p) {
  %r = call i32 (i32, ...) @variadic(i32 1, ptr byval(%big) align 4 %p)
  ret i32 %r
}
; CHECK-LABEL: take_variadic:
; CHECK: addi r14, r2, 20
; CHECK: lw r12, 0(r2)
; CHECK: lw r13, 8(r2)
; CHECK: sw r14, -4(r2)
; CHECK: lw r14, 12(r2)
; CHECK: add r12, r12, r13
; CHECK: add r4, r12, r14
; CHECK: ret
define i32 @take_variadic(i32 %n, ...) {
  %list = alloca ptr
  call void @llvm.va_start(ptr %list)
  %a = va_arg ptr %list, i32
  %b = va_arg ptr %list, { i32, i32 }
  %c = va_arg ptr %list, i64
  call void @llvm.va_end(ptr %list)
  %b1 = extractvalue { i32, i32 } %b, 1
  %c1 = trunc i64 %c to i32
  %s = add i32 %a, %b1
  %t = add i32 %s, %c1
  ret i32 %t
}
declare void @llvm.va_start(ptr)
declare void @llvm.va_end(ptr)
