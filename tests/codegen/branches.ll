; Every comparison of integers in a branch, fused with it.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: branch_eq:
; CHECK: bne r4, r5, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_eq(i32 %a, i32 %b) {
  %c = icmp eq i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_ne:
; CHECK: beq r4, r5, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ne(i32 %a, i32 %b) {
  %c = icmp ne i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_slt:
; CHECK: bge r4, r5, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_slt(i32 %a, i32 %b) {
  %c = icmp slt i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_sge:
; CHECK: blt r4, r5, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_sge(i32 %a, i32 %b) {
  %c = icmp sge i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_sgt:
; CHECK: bge r5, r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_sgt(i32 %a, i32 %b) {
  %c = icmp sgt i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_sle:
; CHECK: blt r5, r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_sle(i32 %a, i32 %b) {
  %c = icmp sle i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_ult:
; CHECK: bgeu r4, r5, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ult(i32 %a, i32 %b) {
  %c = icmp ult i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_uge:
; CHECK: bltu r4, r5, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_uge(i32 %a, i32 %b) {
  %c = icmp uge i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_ugt:
; CHECK: bgeu r5, r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ugt(i32 %a, i32 %b) {
  %c = icmp ugt i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: branch_ule:
; CHECK: bltu r5, r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ule(i32 %a, i32 %b) {
  %c = icmp ule i32 %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
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
