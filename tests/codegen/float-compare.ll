; Every comparison of floats in a branch, as a value and in a selection. The ordered ones and their opposites take one feq, flt
; or fle; one and ueq take two.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: set_oeq:
; CHECK: feq r4, r4, r5
; CHECK: ret
define i32 @set_oeq(float %a, float %b) {
  %c = fcmp oeq float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_oeq:
; CHECK: feq r12, r4, r5
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_oeq(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp oeq float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_oeq:
; CHECK: feq r12, r4, r5
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_oeq(float %a, float %b) {
  %c = fcmp oeq float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_une:
; CHECK: feq r12, r4, r5
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_une(float %a, float %b) {
  %c = fcmp une float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_une:
; CHECK: feq r12, r4, r5
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_une(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp une float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_une:
; CHECK: feq r12, r4, r5
; CHECK: bnez r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_une(float %a, float %b) {
  %c = fcmp une float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_olt:
; CHECK: flt r4, r4, r5
; CHECK: ret
define i32 @set_olt(float %a, float %b) {
  %c = fcmp olt float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_olt:
; CHECK: flt r12, r4, r5
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_olt(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp olt float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_olt:
; CHECK: flt r12, r4, r5
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_olt(float %a, float %b) {
  %c = fcmp olt float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ugt:
; CHECK: fle r12, r4, r5
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_ugt(float %a, float %b) {
  %c = fcmp ugt float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ugt:
; CHECK: fle r12, r4, r5
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ugt(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ugt float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ugt:
; CHECK: fle r12, r4, r5
; CHECK: bnez r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ugt(float %a, float %b) {
  %c = fcmp ugt float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ole:
; CHECK: fle r4, r4, r5
; CHECK: ret
define i32 @set_ole(float %a, float %b) {
  %c = fcmp ole float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ole:
; CHECK: fle r12, r4, r5
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ole(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ole float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ole:
; CHECK: fle r12, r4, r5
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ole(float %a, float %b) {
  %c = fcmp ole float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_uge:
; CHECK: flt r12, r4, r5
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_uge(float %a, float %b) {
  %c = fcmp uge float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_uge:
; CHECK: flt r12, r4, r5
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_uge(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp uge float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_uge:
; CHECK: flt r12, r4, r5
; CHECK: bnez r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_uge(float %a, float %b) {
  %c = fcmp uge float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ogt:
; CHECK: flt r4, r5, r4
; CHECK: ret
define i32 @set_ogt(float %a, float %b) {
  %c = fcmp ogt float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ogt:
; CHECK: flt r12, r5, r4
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ogt(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ogt float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ogt:
; CHECK: flt r12, r5, r4
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ogt(float %a, float %b) {
  %c = fcmp ogt float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_oge:
; CHECK: fle r4, r5, r4
; CHECK: ret
define i32 @set_oge(float %a, float %b) {
  %c = fcmp oge float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_oge:
; CHECK: fle r12, r5, r4
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_oge(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp oge float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_oge:
; CHECK: fle r12, r5, r4
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_oge(float %a, float %b) {
  %c = fcmp oge float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_one:
; CHECK: flt r12, r5, r4
; CHECK: flt r13, r4, r5
; CHECK: or r4, r13, r12
; CHECK: ret
define i32 @set_one(float %a, float %b) {
  %c = fcmp one float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_one:
; CHECK: flt r12, r5, r4
; CHECK: flt r13, r4, r5
; CHECK: or r12, r13, r12
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_one(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp one float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_one:
; CHECK: flt r12, r5, r4
; CHECK: flt r13, r4, r5
; CHECK: or r12, r13, r12
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_one(float %a, float %b) {
  %c = fcmp one float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ueq:
; CHECK: flt r12, r5, r4
; CHECK: flt r13, r4, r5
; CHECK: or r12, r13, r12
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_ueq(float %a, float %b) {
  %c = fcmp ueq float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ueq:
; CHECK: flt r12, r5, r4
; CHECK: flt r13, r4, r5
; CHECK: or r12, r13, r12
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ueq(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ueq float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ueq:
; CHECK: flt r12, r5, r4
; CHECK: flt r13, r4, r5
; CHECK: or r12, r13, r12
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: ret
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: ret
define void @branch_ueq(float %a, float %b) {
  %c = fcmp ueq float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ord:
; CHECK: feq r12, r5, r5
; CHECK: feq r13, r4, r4
; CHECK: and r4, r13, r12
; CHECK: ret
define i32 @set_ord(float %a, float %b) {
  %c = fcmp ord float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ord:
; CHECK: feq r12, r5, r5
; CHECK: feq r13, r4, r4
; CHECK: and r12, r13, r12
; CHECK: cmovz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ord(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ord float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ord:
; CHECK: feq r12, r5, r5
; CHECK: feq r13, r4, r4
; CHECK: and r12, r13, r12
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ord(float %a, float %b) {
  %c = fcmp ord float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_uno:
; CHECK: feq r12, r5, r5
; CHECK: feq r13, r4, r4
; CHECK: and r12, r13, r12
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_uno(float %a, float %b) {
  %c = fcmp uno float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_uno:
; CHECK: feq r12, r5, r5
; CHECK: feq r13, r4, r4
; CHECK: and r12, r13, r12
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_uno(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp uno float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_uno:
; CHECK: feq r12, r5, r5
; CHECK: feq r13, r4, r4
; CHECK: and r12, r13, r12
; CHECK: beqz r12, .LBB{{[0-9_]+}}
; CHECK: ret
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: ret
define void @branch_uno(float %a, float %b) {
  %c = fcmp uno float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ult:
; CHECK: fle r12, r5, r4
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_ult(float %a, float %b) {
  %c = fcmp ult float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ult:
; CHECK: fle r12, r5, r4
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ult(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ult float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ult:
; CHECK: fle r12, r5, r4
; CHECK: bnez r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ult(float %a, float %b) {
  %c = fcmp ult float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
; CHECK-LABEL: set_ule:
; CHECK: flt r12, r5, r4
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @set_ule(float %a, float %b) {
  %c = fcmp ule float %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_ule:
; CHECK: flt r12, r5, r4
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_ule(float %a, float %b, i32 %t, i32 %f) {
  %c = fcmp ule float %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: branch_ule:
; CHECK: flt r12, r5, r4
; CHECK: bnez r12, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: call g
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @branch_ule(float %a, float %b) {
  %c = fcmp ule float %a, %b
  br i1 %c, label %yes, label %no
yes:
  call void @g()
  br label %no
no:
  ret void
}
declare void @g()
