; A value that a branch has found to be 0 need not be set to 0.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: known:
; CHECK-NOT: li r
; CHECK: ret
define i32 @known(i32 %a, ptr %p) {
entry:
  %zero = icmp eq i32 %a, 0
  br i1 %zero, label %end, label %load
load:
  %b = load i32, ptr %p
  br label %end
end:
  %result = phi i32 [ 0, %entry ], [ %b, %load ]
  ret i32 %result
}
