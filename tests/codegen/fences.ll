; What docs/abi.md, "Atomics", says of each order: fences before and behind the machine's own accesses, none for what is this thread's.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s --implicit-check-not="fence {{[rw]}}"
; RUN: %trax_llc -O0 %s -o - | FileCheck %s --implicit-check-not="fence {{[rw]}}"

@x = internal global i32 0
@own = thread_local global i32 0

; CHECK-LABEL: {{^}}load_relaxed:
; CHECK: lwnt
; CHECK: ret
define i32 @load_relaxed(ptr %p) {
  %r = load atomic i32, ptr %p monotonic, align 4
  ret i32 %r
}
; CHECK-LABEL: {{^}}load_acquire:
; CHECK: lwnt
; CHECK: fence r
; CHECK: ret
define i32 @load_acquire(ptr %p) {
  %r = load atomic i32, ptr %p acquire, align 4
  ret i32 %r
}
; CHECK-LABEL: {{^}}load_both:
; CHECK: lwnt
; CHECK: fence r
; CHECK: lwnt
; CHECK: fence r
; CHECK: ret
define i32 @load_both(ptr %p, ptr %q) {
  %r = load atomic i32, ptr %p seq_cst, align 4
  %s = load atomic i8, ptr %q acquire, align 1
  %t = zext i8 %s to i32
  %u = add i32 %r, %t
  ret i32 %u
}
; CHECK-LABEL: {{^}}store_relaxed:
; CHECK: sw
; CHECK: ret
define void @store_relaxed(i32 %v) {
  store atomic i32 %v, ptr @x monotonic, align 4
  ret void
}
; CHECK-LABEL: {{^}}store_release:
; CHECK: fence w
; CHECK: sw
; CHECK: ret
define void @store_release(i32 %v) {
  store atomic i32 %v, ptr @x release, align 4
  ret void
}
; CHECK-LABEL: {{^}}store_seq_cst:
; CHECK: fence w
; CHECK: sw
; CHECK: fence w
; CHECK: ret
define void @store_seq_cst(i32 %v) {
  store atomic i32 %v, ptr @x seq_cst, align 4
  ret void
}
; Fences without an access between them are one.
; CHECK-LABEL: {{^}}twice:
; CHECK: fence w
; CHECK: sw
; CHECK: fence w
; CHECK: sw
; CHECK: fence rw
; CHECK: ret
define void @twice() {
  store atomic i32 1, ptr @x seq_cst, align 4
  store atomic i32 2, ptr @x seq_cst, align 4
  fence acquire
  fence release
  ret void
}
; CHECK-LABEL: {{^}}increments:
; CHECK: ainc
; CHECK: mv r0,
; CHECK: ainc
; CHECK: mv r0,
; CHECK: fence r
; CHECK: fence w
; CHECK: ainc
; CHECK: mv r0,
; CHECK: fence rw
; CHECK: ainc
; CHECK: mv r0,
; CHECK: fence r
; CHECK: ret
define i32 @increments() {
  %a = atomicrmw add ptr @x, i32 1 monotonic
  %b = atomicrmw add ptr @x, i32 1 acquire
  store volatile i32 %a, ptr @own
  %c = atomicrmw add ptr @x, i32 1 acq_rel
  %d = atomicrmw add ptr @x, i32 1 seq_cst
  ret i32 %d
}
; CHECK-LABEL: {{^}}alone:
; CHECK: fence r
; CHECK: ret
define void @alone() {
  fence acquire
  fence acquire
  ret void
}
; CHECK-LABEL: {{^}}release:
; CHECK: fence w
; CHECK: ret
define void @release() {
  fence release
  ret void
}
; CHECK-LABEL: {{^}}both:
; CHECK: fence rw
; CHECK: ret
define void @both() {
  fence acq_rel
  ret void
}
; CHECK-LABEL: {{^}}all:
; CHECK: fence rw
; CHECK: ret
define void @all() {
  fence seq_cst
  ret void
}
; The thread sees its own accesses in their order.
; CHECK-LABEL: {{^}}signal:
; CHECK: ret
define void @signal() {
  fence syncscope("singlethread") seq_cst
  ret void
}
; CHECK-LABEL: {{^}}private:
; CHECK: ret
define i32 @private() {
  %p = alloca i32
  store atomic i32 1, ptr %p seq_cst, align 4
  %r = load atomic i32, ptr %p seq_cst, align 4
  store atomic i32 %r, ptr @own release, align 4
  %s = load atomic i32, ptr @own acquire, align 4
  ret i32 %s
}
; What is ordered stays on its side.
; CHECK-LABEL: {{^}}message:
; CHECK: sw {{.*}}(r4)
; CHECK: fence w
; CHECK: sw
; CHECK: lwnt
; CHECK: fence r
; CHECK: lw {{.*}}(r
; CHECK: ret
define i32 @message(ptr %data, ptr %flag) {
  store i32 7, ptr %data
  store atomic i32 1, ptr @x release, align 4
  %f = load atomic i32, ptr %flag acquire, align 4
  %d = load i32, ptr %flag
  %r = add i32 %f, %d
  ret i32 %r
}
