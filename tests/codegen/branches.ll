; Branches on a sign, and on a constant. (comparisons.test has every comparison of two values.)
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: branch_negative:
; CHECK: bltz r4, .LBB{{[0-9_]+}}
; CHECK: ret
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: ret
define void @branch_negative(i32 %a) {
  %c = icmp slt i32 %a, 0
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_not_negative:
; CHECK: bltz r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_not_negative(i32 %a) {
  %c = icmp sgt i32 %a, -1
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_positive:
; CHECK: blez r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_positive(i32 %a) {
  %c = icmp sgt i32 %a, 0
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_not_positive:
; CHECK: blez r4, .LBB{{[0-9_]+}}
; CHECK: ret
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: ret
define void @branch_not_positive(i32 %a) {
  %c = icmp slt i32 %a, 1
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_constant:
; CHECK: li r12, 99
; CHECK: bltu r12, r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_constant(i32 %a) {
  %c = icmp ult i32 %a, 100
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
declare void @g()
