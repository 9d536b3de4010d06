; Comparisons as values and as conditions of selections: no inversion where the other conditional move will do.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: eq:
; CHECK: xor r12, r4, r5
; CHECK: seqz r4, r12
; CHECK: ret
define i32 @eq(i32 %a, i32 %b) {
  %c = icmp eq i32 %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: ne_imm:
; CHECK: addi r12, r4, -5
; CHECK: snez r4, r12
; CHECK: ret
define i32 @ne_imm(i32 %a) {
  %c = icmp ne i32 %a, 5
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: sge:
; CHECK: slt r12, r4, r5
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @sge(i32 %a, i32 %b) {
  %c = icmp sge i32 %a, %b
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: ugt_imm:
; CHECK: sltiu r12, r4, 10
; CHECK: xori r4, r12, 1
; CHECK: ret
define i32 @ugt_imm(i32 %a) {
  %c = icmp ugt i32 %a, 9
  %r = zext i1 %c to i32
  ret i32 %r
}
; CHECK-LABEL: select_eq:
; CHECK: xor r12, r4, r5
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_eq(i32 %a, i32 %b, i32 %t, i32 %f) {
  %c = icmp eq i32 %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: select_sge:
; CHECK: slt r12, r4, r5
; CHECK: cmovnz r6, r7, r12
; CHECK: mv r4, r6
; CHECK: ret
define i32 @select_sge(i32 %a, i32 %b, i32 %t, i32 %f) {
  %c = icmp sge i32 %a, %b
  %r = select i1 %c, i32 %t, i32 %f
  ret i32 %r
}
; CHECK-LABEL: max:
; CHECK: max r4, r4, r5
; CHECK-NEXT: ret
define i32 @max(i32 %a, i32 %b) {
  %r = call i32 @llvm.smax.i32(i32 %a, i32 %b)
  ret i32 %r
}
; CHECK-LABEL: select_float:
; CHECK: cmovnz r5, r6, r4
; CHECK: mv r4, r5
; CHECK: ret
define float @select_float(i32 %c, float %t, float %f) {
  %z = icmp eq i32 %c, 0
  %r = select i1 %z, float %t, float %f
  ret float %r
}
declare i32 @llvm.smax.i32(i32, i32)

; A choice between constants that differ by a power of two is a shifted comparison; what remains goes into the address.
; CHECK-LABEL: choose:
; CHECK: slt [[LESS:r[0-9]+]], r4, r5
; CHECK-NEXT: slli [[LESS]], [[LESS]], 3
; CHECK-NEXT: ori r4, [[LESS]], 20
; CHECK-NEXT: ret
define i32 @choose(i32 %a, i32 %b) nounwind {
  %less = icmp slt i32 %a, %b
  %r = select i1 %less, i32 28, i32 20
  ret i32 %r
}
; CHECK-LABEL: child:
; CHECK: slt [[LESS:r[0-9]+]], r5, r6
; CHECK-NEXT: slli [[LESS]], [[LESS]], 2
; CHECK-NEXT: sub [[AT:r[0-9]+]], r4, [[LESS]]
; CHECK-NEXT: lw r4, 8([[AT]])
; CHECK-NEXT: ret
define i32 @child(ptr %node, i32 %a, i32 %b) nounwind {
  %less = icmp slt i32 %a, %b
  %offset = select i1 %less, i32 4, i32 8
  %address = getelementptr i8, ptr %node, i32 %offset
  %r = load i32, ptr %address
  ret i32 %r
}
