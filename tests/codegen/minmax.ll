; Integer minimum and maximum, as the optimizer writes them and as selections, also of floats that are compared as integers.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s --implicit-check-not=slt --implicit-check-not=cmov

declare i32 @llvm.smin.i32(i32, i32)
declare i32 @llvm.smax.i32(i32, i32)
declare i32 @llvm.umin.i32(i32, i32)
declare i32 @llvm.umax.i32(i32, i32)
declare i32 @llvm.abs.i32(i32, i1)
declare i32 @llvm.usub.sat.i32(i32, i32)
declare i16 @llvm.smin.i16(i16, i16)

; CHECK-LABEL: smin:
; CHECK: min r4, r4, r5
define i32 @smin(i32 %a, i32 %b) {
  %r = call i32 @llvm.smin.i32(i32 %a, i32 %b)
  ret i32 %r
}
; CHECK-LABEL: smax:
; CHECK: max r4, r4, r5
define i32 @smax(i32 %a, i32 %b) {
  %r = call i32 @llvm.smax.i32(i32 %a, i32 %b)
  ret i32 %r
}
; CHECK-LABEL: umin:
; CHECK: minu r4, r4, r5
define i32 @umin(i32 %a, i32 %b) {
  %r = call i32 @llvm.umin.i32(i32 %a, i32 %b)
  ret i32 %r
}
; CHECK-LABEL: umax:
; CHECK: maxu r4, r4, r5
define i32 @umax(i32 %a, i32 %b) {
  %r = call i32 @llvm.umax.i32(i32 %a, i32 %b)
  ret i32 %r
}
; CHECK-LABEL: select:
; CHECK: min r4, r4, r5
define i32 @select(i32 %a, i32 %b) {
  %c = icmp slt i32 %a, %b
  %r = select i1 %c, i32 %a, i32 %b
  ret i32 %r
}
; CHECK-LABEL: half:
; CHECK: min r4, r{{[0-9]+}}, r{{[0-9]+}}
define signext i16 @half(i16 signext %a, i16 signext %b) {
  %r = call i16 @llvm.smin.i16(i16 %a, i16 %b)
  ret i16 %r
}
; CHECK-LABEL: magnitude:
; CHECK: neg [[NEGATIVE:r[0-9]+]], r4
; CHECK: max r4, r4, [[NEGATIVE]]
define i32 @magnitude(i32 %a) {
  %r = call i32 @llvm.abs.i32(i32 %a, i1 false)
  ret i32 %r
}
; CHECK-LABEL: saturated:
; CHECK: maxu [[GREATER:r[0-9]+]], r4, r5
; CHECK: sub r4, [[GREATER]], r5
define i32 @saturated(i32 %a, i32 %b) {
  %r = call i32 @llvm.usub.sat.i32(i32 %a, i32 %b)
  ret i32 %r
}
; CHECK-LABEL: less_float:
; CHECK: min r4, r4, r5
define float @less_float(float %a, float %b) {
  %x = bitcast float %a to i32
  %y = bitcast float %b to i32
  %c = icmp slt i32 %x, %y
  %r = select i1 %c, float %a, float %b
  ret float %r
}
; CHECK-LABEL: greater_float:
; CHECK: max r4, r4, r5
define float @greater_float(float %a, float %b) {
  %x = bitcast float %a to i32
  %y = bitcast float %b to i32
  %c = icmp sle i32 %x, %y
  %r = select i1 %c, float %b, float %a
  ret float %r
}
