; Over-aligned objects of the stack. sp is rounded down behind the saving of registers, which are found by fp at the end.
; Where sp moves as well, r31 has its rounded value and addresses what is fixed. Aggregates without an alignment of their
; own are aligned as words, and so need none of this.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

target datalayout = "e-m:e-p:32:32-i64:32-f64:32-a:0:32-n32-S32"

declare void @use(ptr, ptr)

; CHECK-LABEL: fixed:
; CHECK: addi r3, r2, [[SIZE:[0-9]+]]
; CHECK: andi r2, r2, -64
; CHECK-NOT: r31
; CHECK: call use
; CHECK: addi r2, r3, -[[SIZE]]
; CHECK: addi r2, r2, [[SIZE]]
; CHECK: ret
define void @fixed() {
  %p = alloca [128 x i8], align 64
  call void @use(ptr %p, ptr %p)
  ret void
}

; CHECK-LABEL: moving:
; CHECK: addi r3, r2, [[SIZE:[0-9]+]]
; CHECK: andi r2, r2, -64
; CHECK: mv r31, r2
; CHECK: sub [[Q:r[0-9]+]], r2
; CHECK: mv r2, [[Q]]
; CHECK: mv r4, r31
; CHECK: call use
; CHECK: addi r2, r3, -[[SIZE]]
; CHECK: lw r31
; CHECK: ret
define void @moving(i32 %n) {
  %p = alloca [128 x i8], align 64
  %q = alloca i8, i32 %n
  call void @use(ptr %p, ptr %q)
  ret void
}

; CHECK-LABEL: far:
; CHECK: srli r2, r2, 16
; CHECK: slli r2, r2, 16
; CHECK: call use
define void @far() {
  %p = alloca [4 x i8], align 65536
  call void @use(ptr %p, ptr %p)
  ret void
}

; CHECK-LABEL: words:
; CHECK-NOT: andi r2
; CHECK: call use
; CHECK: ret
define void @words() {
  %p = alloca { i64, double, [12 x i8] }
  call void @use(ptr %p, ptr %p)
  ret void
}
