; Accesses marked nontemporal go past the data cache, except where the address is known to be local memory.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

@local = thread_local global i32 0

; CHECK-LABEL: load:
; CHECK: lwnt r4, 12(r4)
; CHECK: ret
define i32 @load(ptr %p) {
  %q = getelementptr i8, ptr %p, i32 12
  %r = load i32, ptr %q, !nontemporal !0
  ret i32 %r
}
; CHECK-LABEL: store:
; CHECK: swnt r5, 0(r4)
; CHECK: ret
define void @store(ptr %p, float %x) {
  store float %x, ptr %p, !nontemporal !0
  ret void
}
; CHECK-LABEL: store_byte:
; CHECK: sb r5, 0(r4)
; CHECK: ret
define void @store_byte(ptr %p, i8 %x) {
  store i8 %x, ptr %p, !nontemporal !0
  ret void
}
; CHECK-LABEL: store_thread_local:
; CHECK: sw r4, %abs(local)(r0)
; CHECK: ret
define void @store_thread_local(i32 %x) {
  store i32 %x, ptr @local, !nontemporal !0
  ret void
}
; CHECK-LABEL: store_stack:
; CHECK: sw r4, -4(r2)
; CHECK: ret
define void @store_stack(i32 %x) {
  %p = alloca i32
  store volatile i32 %x, ptr %p, !nontemporal !0
  ret void
}
; An aggregate that is passed in memory is on the caller's stack.
; CHECK-LABEL: load_argument:
; CHECK: lw r4, 4(r2)
; CHECK: ret
define i32 @load_argument(ptr byval([2 x i32]) %p) {
  %q = getelementptr i8, ptr %p, i32 4
  %r = load i32, ptr %q, !nontemporal !0
  ret i32 %r
}
!0 = !{i32 1}
