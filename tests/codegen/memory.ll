; Addresses: what folds into a load's or store's immediate.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

@global = global i32 0
@record = global [3 x i32] zeroinitializer, align 4
@aligned = global [4 x i32] zeroinitializer, align 16
@page = global [131072 x i8] zeroinitializer, align 65536
@table = global [10 x i32] zeroinitializer, align 4
@local = thread_local global [4 x i32] zeroinitializer
@elsewhere = external thread_local global i32

; CHECK-LABEL: sizes:
; CHECK: lhu r13, 2(r4)
; CHECK: lb r12, 0(r4)
; CHECK: add r12, r12, r13
; CHECK: sh r13, -8(r4)
; CHECK: mv r4, r12
; CHECK: ret
define i32 @sizes(ptr %p) {
  %a = load i8, ptr %p
  %as = sext i8 %a to i32
  %q = getelementptr i8, ptr %p, i32 2
  %b = load i16, ptr %q
  %bz = zext i16 %b to i32
  %r = add i32 %as, %bz
  %s = getelementptr i8, ptr %p, i32 -8
  store i16 %b, ptr %s
  ret i32 %r
}
; CHECK-LABEL: far:
; CHECK: lui r12, 2
; CHECK: add r12, r4, r12
; CHECK: lw r4, -31072(r12)
; CHECK: ret
define i32 @far(ptr %p) {
  %q = getelementptr i8, ptr %p, i32 100000
  %r = load i32, ptr %q
  ret i32 %r
}
; CHECK-LABEL: store_zero:
; CHECK: sw r0, 0(r4)
; CHECK: ret
define void @store_zero(ptr %p) {
  store float 0.0, ptr %p
  ret void
}
; CHECK-LABEL: of_global:
; CHECK: lui r12, %hi(global)
; CHECK: lw r4, %lo(global)(r12)
; CHECK: ret
define i32 @of_global() {
  %r = load i32, ptr @global
  ret i32 %r
}
; CHECK-LABEL: field:
; CHECK: lui r12, %hi(record+8)
; CHECK: lw r4, %lo(record+8)(r12)
; CHECK: ret
define i32 @field() {
  %r = load i32, ptr getelementptr (i8, ptr @record, i32 8)
  ret i32 %r
}
; CHECK-LABEL: two_fields_within_alignment:
; CHECK: lui r12, %hi(aligned)
; CHECK: lw r13, %lo(aligned)(r12)
; CHECK: lw r12, %lo(aligned+12)(r12)
; CHECK: add r4, r13, r12
; CHECK: ret
define i32 @two_fields_within_alignment() {
  %a = load i32, ptr @aligned
  %b = load i32, ptr getelementptr (i8, ptr @aligned, i32 12)
  %r = add i32 %a, %b
  ret i32 %r
}
; However large the alignment, %hi is shared only up to the next odd multiple of 32 KiB, where %lo changes its sign.
; CHECK-LABEL: two_fields_far_apart:
; CHECK: lui [[HI:r[0-9]+]], %hi(page)
; CHECK-DAG: lbu {{r[0-9]+}}, %lo(page)([[HI]])
; CHECK-DAG: lbu {{r[0-9]+}}, %lo(page+32767)([[HI]])
; CHECK-NOT: %lo(page+{{32768|36864|65535}})
; CHECK: ret
define i32 @two_fields_far_apart() {
  %a = load i8, ptr @page
  %b = load i8, ptr getelementptr (i8, ptr @page, i32 32767)
  %c = load i8, ptr getelementptr (i8, ptr @page, i32 32768)
  %d = load i8, ptr getelementptr (i8, ptr @page, i32 36864)
  %e = load i8, ptr getelementptr (i8, ptr @page, i32 65535)
  %ab = xor i8 %a, %b
  %cd = xor i8 %c, %d
  %abcd = xor i8 %ab, %cd
  %abcde = xor i8 %abcd, %e
  %r = zext i8 %abcde to i32
  ret i32 %r
}
; CHECK-LABEL: element:
; CHECK: slli r12, r4, 2
; CHECK: lui r13, %hi(table)
; CHECK: add r12, r13, r12
; CHECK: lw r4, %lo(table)(r12)
; CHECK: ret
define i32 @element(i32 %i) {
  %p = getelementptr i32, ptr @table, i32 %i
  %r = load i32, ptr %p
  ret i32 %r
}
; CHECK-LABEL: address:
; CHECK: lui r4, %hi(global)
; CHECK: addi r4, r4, %lo(global)
; CHECK: ret
define ptr @address() {
  ret ptr @global
}
; CHECK-LABEL: thread_local_field:
; CHECK: lw r4, %abs(local+4)(r0)
; CHECK: ret
define i32 @thread_local_field() {
  %r = load i32, ptr getelementptr (i8, ptr @local, i32 4)
  ret i32 %r
}
; CHECK-LABEL: thread_local_address:
; CHECK: li r4, %abs(elsewhere)
; CHECK: ret
define ptr @thread_local_address() {
  ret ptr @elsewhere
}
; CHECK-LABEL: absolute:
; CHECK: lui r12, 1
; CHECK: lbu r13, 9030(r12)
; CHECK: lbu r14, 9029(r12)
; CHECK: lbu r15, 9031(r12)
; CHECK: lbu r12, 9032(r12)
; CHECK: slli r13, r13, 8
; CHECK: slli r12, r12, 24
; CHECK: or r13, r13, r14
; CHECK: slli r14, r15, 16
; CHECK: or r12, r12, r14
; CHECK: or r4, r12, r13
; CHECK: ret
define i32 @absolute() {
  %r = load i32, ptr inttoptr (i32 74565 to ptr), align 1
  ret i32 %r
}
; CHECK-LABEL: unaligned:
; CHECK: lbu r12, 1(r4)
; CHECK: lbu r13, 0(r4)
; CHECK: slli r12, r12, 8
; CHECK: or r4, r12, r13
; CHECK: ret
define i32 @unaligned(ptr %p) {
  %r = load i16, ptr %p, align 1
  %z = zext i16 %r to i32
  ret i32 %z
}
