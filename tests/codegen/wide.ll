; 64-bit integers are two registers, the low word first.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: add:
; CHECK: add r12, r4, r6
; CHECK: add r13, r5, r7
; CHECK: sltu r14, r12, r4
; CHECK: mv r4, r12
; CHECK: add r5, r13, r14
; CHECK: ret
define i64 @add(i64 %a, i64 %b) {
  %r = add i64 %a, %b
  ret i64 %r
}
; CHECK-LABEL: sub:
; CHECK: sltu r12, r4, r6
; CHECK: sub r13, r5, r7
; CHECK: sub r4, r4, r6
; CHECK: sub r5, r13, r12
; CHECK: ret
define i64 @sub(i64 %a, i64 %b) {
  %r = sub i64 %a, %b
  ret i64 %r
}
; CHECK-LABEL: mul:
; CHECK: mul r12, r4, r7
; CHECK: mulhu r13, r4, r6
; CHECK: mul r4, r4, r6
; CHECK: add r12, r13, r12
; CHECK: mul r13, r5, r6
; CHECK: add r5, r12, r13
; CHECK: ret
define i64 @mul(i64 %a, i64 %b) {
  %r = mul i64 %a, %b
  ret i64 %r
}
; CHECK-LABEL: square:
; CHECK: mul r12, r4, r4
; CHECK: mulh r5, r4, r4
; CHECK: mv r4, r12
; CHECK: ret
define i64 @square(i32 %a) {
  %w = sext i32 %a to i64
  %r = mul i64 %w, %w
  ret i64 %r
}
; CHECK-LABEL: shift:
; CHECK: slli r12, r5, 28
; CHECK: srli r13, r4, 4
; CHECK: srli r5, r5, 4
; CHECK: or r4, r13, r12
; CHECK: ret
define i64 @shift(i64 %a) {
  %r = lshr i64 %a, 4
  ret i64 %r
}
; CHECK-LABEL: divide:
; CHECK: call __divdi3
; CHECK: ret
define i64 @divide(i64 %a, i64 %b) {
  %r = sdiv i64 %a, %b
  ret i64 %r
}
; CHECK-LABEL: less:
; CHECK: sltu r13, r4, r6
; CHECK: xor r12, r5, r7
; CHECK: slt r4, r5, r7
; CHECK: cmovz r4, r13, r12
; CHECK: ret
define i32 @less(i64 %a, i64 %b) {
  %c = icmp slt i64 %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: soft:
; CHECK: call __muldf3
; CHECK: ret
define double @soft(double %a, double %b) {
  %r = fmul double %a, %b
  ret double %r
}
; CHECK-LABEL: narrow:
; CHECK: call __truncdfsf2
; CHECK: ret
define float @narrow(double %a) {
  %r = fptrunc double %a to float
  ret float %r
}
; By any amount, without a call unless nothing but size counts.
; CHECK-LABEL: shift_left_any:
; CHECK-DAG: srli [[HALF:r[0-9]+]], r4, 1
; CHECK-DAG: not [[REST:r[0-9]+]], r6
; CHECK-DAG: sll [[UP:r[0-9]+]], r5, r6
; CHECK-DAG: andi [[LARGE:r[0-9]+]], r6, 32
; CHECK-DAG: srl [[CARRIED:r[0-9]+]], [[HALF]], [[REST]]
; CHECK-DAG: or r5, [[UP]], [[CARRIED]]
; CHECK: cmovnz r5, r4, [[LARGE]]
; CHECK: cmovnz r4, r0, [[LARGE]]
; CHECK-NEXT: ret
define i64 @shift_left_any(i64 %a, i64 %n) {
  %r = shl i64 %a, %n
  ret i64 %r
}
; CHECK-LABEL: shift_right_any:
; CHECK-NOT: call
; CHECK: srai r5, r5, 31
; CHECK: cmovz r5,
; CHECK-NEXT: ret
define i64 @shift_right_any(i64 %a, i64 %n) {
  %r = ashr i64 %a, %n
  ret i64 %r
}
; CHECK-LABEL: shift_small:
; CHECK: call __lshrdi3
define i64 @shift_small(i64 %a, i64 %n) minsize optsize {
  %r = lshr i64 %a, %n
  %s = add i64 %r, 1
  ret i64 %s
}
; CHECK-LABEL: bit:
; CHECK: andi [[BIT:r[0-9]+]], r4, 8
; CHECK-NEXT: cmov{{n?z}} r{{[0-9]+}}, r{{[0-9]+}}, [[BIT]]
; CHECK-NEXT: {{ret|mv}}
define float @bit(i32 %a, float %b, float %c) {
  %m = and i32 %a, 8
  %d = icmp ne i32 %m, 0
  %r = select i1 %d, float %b, float %c
  ret float %r
}
