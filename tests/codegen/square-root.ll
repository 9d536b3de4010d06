; sqrt is a function of the library, unless an approximation is allowed: then 1/sqrt(x) is the machine's instruction, and sqrt(x)
; is x times it, guarded where x is 0.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: exact:
; CHECK: call sqrtf
; CHECK: ret
define float @exact(float %a) {
  %r = call float @llvm.sqrt.f32(float %a)
  ret float %r
}
; CHECK-LABEL: fast:
; CHECK: frsqrt r12, r4
; CHECK: slli r13, r4, 1
; CHECK: fmul r12, r4, r12
; CHECK: cmovnz r4, r12, r13
; CHECK: ret
define float @fast(float %a) {
  %r = call fast float @llvm.sqrt.f32(float %a)
  ret float %r
}
; CHECK-LABEL: fast_reciprocal:
; CHECK: frsqrt r4, r4
; CHECK: ret
define float @fast_reciprocal(float %a) {
  %s = call fast float @llvm.sqrt.f32(float %a)
  %r = fdiv fast float 1.0, %s
  ret float %r
}
; CHECK-LABEL: fast_normalize:
; CHECK: frsqrt r12, r5
; CHECK: fmul r4, r4, r12
; CHECK: ret
define float @fast_normalize(float %x, float %l2) {
  %s = call fast float @llvm.sqrt.f32(float %l2)
  %r = fdiv fast float %x, %s
  ret float %r
}
declare float @llvm.sqrt.f32(float)
