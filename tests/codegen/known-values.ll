; A phi takes a value that a branch has found to be a constant, not the constant: no register is set to it.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: known:
; CHECK: beqz r4, [[END:.LBB[0-9_]+]]
; CHECK-NEXT: lw r4, 0(r5)
; CHECK-NEXT: [[END]]:
; CHECK-NEXT: ret
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
