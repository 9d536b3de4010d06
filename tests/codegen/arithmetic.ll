; Integer arithmetic: what one instruction does, constants of every size, and what takes several.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: add:
; CHECK: add r4, r4, r5
; CHECK: ret
define i32 @add(i32 %a, i32 %b) {
  %r = add i32 %a, %b
  ret i32 %r
}
; CHECK-LABEL: add_imm:
; CHECK: addi r4, r4, -32768
; CHECK: ret
define i32 @add_imm(i32 %a) {
  %r = add i32 %a, -32768
  ret i32 %r
}
; CHECK-LABEL: add_imm17:
; CHECK: addi r12, r4, 20000
; CHECK: addi r4, r12, 20000
; CHECK: ret
define i32 @add_imm17(i32 %a) {
  %r = add i32 %a, 40000
  ret i32 %r
}
; CHECK-LABEL: sub_const:
; CHECK: li r12, 7
; CHECK: sub r4, r12, r4
; CHECK: ret
define i32 @sub_const(i32 %a) {
  %r = sub i32 7, %a
  ret i32 %r
}
; CHECK-LABEL: constant_small:
; CHECK: li r4, -7
; CHECK: ret
define i32 @constant_small() {
  ret i32 -7
}
; CHECK-LABEL: constant_upper:
; CHECK: lui r4, 4660
; CHECK: ret
define i32 @constant_upper() {
  ret i32 305397760
}
; CHECK-LABEL: constant_full:
; CHECK: lui r12, 4661
; CHECK: addi r4, r12, -21555
; CHECK: ret
define i32 @constant_full() {
  ret i32 305441741
}
; CHECK-LABEL: mask_byte:
; CHECK: andi r4, r4, 255
; CHECK: ret
define i32 @mask_byte(i32 %a) {
  %r = and i32 %a, 255
  ret i32 %r
}
; CHECK-LABEL: mask_half:
; CHECK: slli r12, r4, 16
; CHECK: srli r4, r12, 16
; CHECK: ret
define i32 @mask_half(i32 %a) {
  %r = and i32 %a, 65535
  ret i32 %r
}
; CHECK-LABEL: shift_masked:
; CHECK: sll r4, r4, r5
; CHECK: ret
define i32 @shift_masked(i32 %a, i32 %n) {
  %m = and i32 %n, 31
  %r = shl i32 %a, %m
  ret i32 %r
}
; CHECK-LABEL: rotate:
; CHECK: neg r13, r5
; CHECK: sll r12, r4, r5
; CHECK: srl r13, r4, r13
; CHECK: or r4, r12, r13
; CHECK: ret
define i32 @rotate(i32 %a, i32 %n) {
  %r = call i32 @llvm.fshl.i32(i32 %a, i32 %a, i32 %n)
  ret i32 %r
}
; CHECK-LABEL: sext8:
; CHECK: slli r12, r4, 24
; CHECK: srai r4, r12, 24
; CHECK: ret
define signext i8 @sext8(i32 %a) {
  %t = trunc i32 %a to i8
  ret i8 %t
}
declare i32 @llvm.fshl.i32(i32, i32, i32)
