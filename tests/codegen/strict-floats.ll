; The machine rounds to nearest and has no flags: a constrained operation is the plain one. canonicalize makes a NaN the one
; that the machine gives.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s
; RUN: %trax_llc -O0 %s -o - > %t.0
; RUN: sed s/tonearest/upward/ %s | not %trax_llc - -o %t.1 2>&1 | FileCheck %s --check-prefix=UPWARD
; UPWARD: error: {{.*}}the machine rounds to nearest

; CHECK-LABEL: less:
; CHECK: flt r4, r4, r5
define i1 @less(float %a, float %b) strictfp {
  %c = call i1 @llvm.experimental.constrained.fcmps.f32(float %a, float %b, metadata !"olt", metadata !"fpexcept.strict") strictfp
  ret i1 %c
}

; CHECK-LABEL: quiet:
; CHECK: __ltdf2
define i1 @quiet(double %a, double %b) strictfp {
  %c = call i1 @llvm.experimental.constrained.fcmp.f64(double %a, double %b, metadata !"olt", metadata !"fpexcept.strict") strictfp
  ret i1 %c
}

; CHECK-LABEL: fma:
; CHECK: call fmaf
define float @fma(float %a, float %b, float %c) strictfp {
  %r = call float @llvm.experimental.constrained.fma.f32(float %a, float %b, float %c, metadata !"round.dynamic", metadata !"fpexcept.strict") strictfp
  ret float %r
}

; CHECK-LABEL: convert:
; CHECK: fcvt.w.s r4, r4
define i32 @convert(float %a) strictfp {
  %r = call i32 @llvm.experimental.constrained.fptosi.i32.f32(float %a, metadata !"fpexcept.strict") strictfp
  ret i32 %r
}

; CHECK-LABEL: canonical:
; CHECK: fmin r4, r4, r4
define float @canonical(float %a) {
  %r = call float @llvm.canonicalize.f32(float %a)
  ret float %r
}

; CHECK-LABEL: canonical_double:
; CHECK: __unorddf2
define double @canonical_double(double %a) {
  %r = call double @llvm.canonicalize.f64(double %a)
  ret double %r
}

; CHECK-LABEL: canonical_half:
; CHECK: __gnu_f2h_ieee
define half @canonical_half(half %a) {
  %b = fadd half %a, %a
  %r = call half @llvm.canonicalize.f16(half %b)
  ret half %r
}

; CHECK-LABEL: canonical_vector:
; CHECK-COUNT-2: fmin
define <2 x float> @canonical_vector(<2 x float> %a) {
  %r = call <2 x float> @llvm.canonicalize.v2f32(<2 x float> %a)
  ret <2 x float> %r
}

; CHECK-LABEL: rounded:
; CHECK: __truncdfsf2
define float @rounded(double %a) {
  %r = call float @llvm.fptrunc.round.f32.f64(double %a, metadata !"round.tonearest")
  ret float %r
}

; CHECK-LABEL: sum_bfloat:
; CHECK: fadd
define bfloat @sum_bfloat(bfloat %a, bfloat %b) {
  %r = fadd bfloat %a, %b
  ret bfloat %r
}

; CHECK-LABEL: rounded_half:
; CHECK: lrintf
define i32 @rounded_half(half %a) {
  %f = call half @llvm.arithmetic.fence.f16(half %a)
  %r = call i32 @llvm.lrint.i32.f16(half %f)
  ret i32 %r
}
