; A frame beyond the local memory is worth a warning. Offsets beyond an immediate compile all the same.
; RUN: %trax_llc -O2 %s -o - 2>%t.err | FileCheck %s
; RUN: FileCheck %s --check-prefix=WARNING < %t.err

; WARNING: warning: {{.*}}stack frame size (604) exceeds limit (512) in function 'large'
; WARNING-NEXT: note: -mstack=global puts the stack into global memory
; WARNING: warning: {{.*}}stack frame size ({{100[0-9]+}}) exceeds limit (512) in function 'very_large'

declare void @use(ptr)

; CHECK-LABEL: large:
; CHECK: addi r2, r2, -604
; CHECK: addi r2, r2, 604
define void @large() {
  %p = alloca [150 x i32]
  call void @use(ptr %p)
  ret void
}

; CHECK-LABEL: very_large:
; CHECK: addi r2, r2, -32768
; CHECK: addi r2, r2, -32768
; CHECK: addi r2, r2, -32768
; CHECK: lui [[R:r[0-9]+]], 2
; CHECK: add [[R]], [[R]], r2
; CHECK: sw r1, {{-?[0-9]+}}([[R]])
; CHECK: call use
; CHECK: ret
define void @very_large() {
  %p = alloca [100000 x i8]
  call void @use(ptr %p)
  ret void
}
