; Behind an epilogue in the middle of a function, the frame information says again what the frame is.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare i32 @g(i32)

; CHECK-LABEL: f:
; CHECK: .cfi_def_cfa_offset [[SIZE:[0-9]+]]
; CHECK: .cfi_offset r1, -4
; CHECK: .cfi_def_cfa_offset 0
; CHECK: .cfi_restore r1
; CHECK: ret
; CHECK: .cfi_def_cfa_offset [[SIZE]]
; CHECK: .cfi_offset r1, -4
; CHECK-NOT: remember
; CHECK: call g
define i32 @f(i32 %a, ptr %p) !prof !1 {
entry:
  %first = call i32 @g(i32 %a)
  %c = icmp eq i32 %first, 0
  br i1 %c, label %rare, label %often, !prof !0
often:
  store i32 %first, ptr %p
  ret i32 %first
rare:
  %second = call i32 @g(i32 %first)
  %third = add i32 %second, 5
  store i32 %third, ptr %p
  %fourth = call i32 @g(i32 %third)
  ret i32 %fourth
}

!0 = !{!"branch_weights", i32 1, i32 1000}
!1 = !{!"function_entry_count", i64 1000}
