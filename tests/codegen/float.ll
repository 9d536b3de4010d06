; Floating point: the machine's operations, constants without memory, signs by integer operations.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: no_fma:
; CHECK: fmul r12, r4, r5
; CHECK: fadd r4, r12, r6
; CHECK: ret
define float @no_fma(float %a, float %b, float %c) {
  %p = call float @llvm.fmuladd.f32(float %a, float %b, float %c)
  ret float %p
}
; CHECK-LABEL: divide:
; CHECK: fdiv r4, r4, r5
; CHECK: ret
define float @divide(float %a, float %b) {
  %r = fdiv float %a, %b
  ret float %r
}
; CHECK-LABEL: negate:
; CHECK: lui r12, 32768
; CHECK: xor r4, r4, r12
; CHECK: ret
define float @negate(float %a) {
  %r = fneg float %a
  ret float %r
}
; CHECK-LABEL: absolute:
; CHECK: slli r12, r4, 1
; CHECK: srli r4, r12, 1
; CHECK: ret
define float @absolute(float %a) {
  %r = call float @llvm.fabs.f32(float %a)
  ret float %r
}
; CHECK-LABEL: negative_absolute:
; CHECK: lui r12, 32768
; CHECK: or r4, r4, r12
; CHECK: ret
define float @negative_absolute(float %a) {
  %b = call float @llvm.fabs.f32(float %a)
  %r = fneg float %b
  ret float %r
}
; CHECK-LABEL: half:
; CHECK: lui r4, 16128
; CHECK: ret
define float @half() {
  ret float 5.000000e-01
}
; CHECK-LABEL: tenth:
; CHECK: lui r12, 15821
; CHECK: addi r4, r12, -13107
; CHECK: ret
define float @tenth() {
  ret float 0x3FB99999A0000000
}
; CHECK-LABEL: zero:
; CHECK: li r4, 0
; CHECK: ret
define float @zero() {
  ret float 0.0
}
; CHECK-LABEL: clamp:
; CHECK: fmax r12, r4, r0
; CHECK: lui r13, 16256
; CHECK: fmin r4, r12, r13
; CHECK: ret
define float @clamp(float %a) {
  %b = call float @llvm.maxnum.f32(float %a, float 0.0)
  %r = call float @llvm.minnum.f32(float %b, float 1.0)
  ret float %r
}
; CHECK-LABEL: to_int:
; CHECK: fcvt.w.s r4, r4
; CHECK: ret
define i32 @to_int(float %a) {
  %r = fptosi float %a to i32
  ret i32 %r
}
; CHECK-LABEL: to_unsigned_saturated:
; CHECK: fcvt.wu.s r4, r4
; CHECK: ret
define i32 @to_unsigned_saturated(float %a) {
  %r = call i32 @llvm.fptoui.sat.i32.f32(float %a)
  ret i32 %r
}
; CHECK-LABEL: from_unsigned:
; CHECK: fcvt.s.wu r4, r4
; CHECK: ret
define float @from_unsigned(i32 %a) {
  %r = uitofp i32 %a to float
  ret float %r
}
; CHECK-LABEL: bits:
; CHECK-NOT: {{r[0-9]}}
; CHECK: ret
define i32 @bits(float %a) {
  %r = bitcast float %a to i32
  ret i32 %r
}
; CHECK-LABEL: floor:
; CHECK: call floorf
; CHECK: ret
define float @floor(float %a) {
  %r = call float @llvm.floor.f32(float %a)
  ret float %r
}
declare float @llvm.fmuladd.f32(float, float, float)
declare float @llvm.fabs.f32(float)
declare float @llvm.maxnum.f32(float, float)
declare float @llvm.minnum.f32(float, float)
declare float @llvm.floor.f32(float)
declare i32 @llvm.fptoui.sat.i32.f32(float)
