; Loads are the machine's, and so are stores and the increment where nothing but these happens to the object; other operations are
; calls of the library.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

@counted = internal global i32 0
@counters = internal global [9 x i32] zeroinitializer
@changed = internal global i32 0
@seen = internal global i32 0
@visible = global i32 0
declare void @look(ptr)

; CHECK-LABEL: increment:
; CHECK: ainc r4, %lo(counted)(r12)
; CHECK: mv r0, r4
; CHECK: ret
define i32 @increment() {
  %r = atomicrmw add ptr @counted, i32 1 seq_cst
  store atomic i32 %r, ptr @counters release, align 4
  ret i32 %r
}
; An increment whose result nobody wants is waited for before a store that may announce it.
; CHECK-LABEL: announce:
; CHECK: ainc [[OLD:r[1-9][0-9]*]], %lo(counted)
; CHECK: mv r0, [[OLD]]
; CHECK: sw
; CHECK: ret
define void @announce() {
  %r = atomicrmw add ptr @counted, i32 1 monotonic
  store atomic i32 1, ptr @counters release, align 4
  ret void
}
; CHECK-LABEL: increment_at:
; CHECK: ainc r4, %lo(counters+8)(r12)
; CHECK: mv r0, r4
; CHECK: ret
define i32 @increment_at() {
  %r = atomicrmw sub ptr getelementptr (i8, ptr @counters, i32 8), i32 -1 monotonic
  ret i32 %r
}
; CHECK-LABEL: increment_any:
; CHECK: ainc r4, %lo(counters)(r12)
; CHECK: mv r0, r4
; CHECK: ret
define i32 @increment_any(i32 %i) {
  %q = getelementptr [9 x i32], ptr @counters, i32 0, i32 %i
  %r = atomicrmw add ptr %q, i32 1 monotonic
  ret i32 %r
}
; CHECK-LABEL: increment_changed:
; CHECK: li r5, 1
; CHECK: call __atomic_fetch_add_4
; CHECK: call __atomic_store_4
; CHECK: call __atomic_fetch_sub_4
define i32 @increment_changed() {
  %r = atomicrmw add ptr @changed, i32 1 seq_cst
  store atomic i32 7, ptr @changed release, align 4
  %s = atomicrmw sub ptr @changed, i32 1 seq_cst
  ret i32 %r
}
; CHECK-LABEL: increment_seen:
; CHECK: call __atomic_fetch_add_4
; CHECK: call __atomic_fetch_add_4
; CHECK: call __atomic_fetch_add_4
define i32 @increment_seen(ptr %p) {
  call void @look(ptr @seen)
  %a = atomicrmw add ptr @seen, i32 1 seq_cst
  %b = atomicrmw add ptr @visible, i32 1 seq_cst
  %c = atomicrmw add ptr %p, i32 1 seq_cst
  ret i32 %c
}
; CHECK-LABEL: local_array:
; CHECK-NOT: {{ainc|lwnt|call}}
; CHECK: ret
define i32 @local_array(i32 %i, i32 %j) {
  %p = alloca [4 x i32]
  call void @llvm.memset.p0.i32(ptr %p, i8 0, i32 16, i1 true)
  %q = getelementptr [4 x i32], ptr %p, i32 0, i32 %i
  %a = atomicrmw add ptr %q, i32 1 monotonic
  %q2 = getelementptr [4 x i32], ptr %p, i32 0, i32 %j
  %b = load atomic i32, ptr %q2 acquire, align 4
  store atomic i32 %b, ptr %q release, align 4
  %c = add i32 %a, %b
  ret i32 %c
}
; CHECK-LABEL: increment_local:
; CHECK: sw r0, -4(r2)
; CHECK: lw r4, -4(r2)
; CHECK: addi r12, r4, 1
; CHECK: sw r12, -4(r2)
; CHECK: ret
define i32 @increment_local() {
  %p = alloca i32
  store volatile i32 0, ptr %p
  %r = atomicrmw add ptr %p, i32 1 monotonic
  ret i32 %r
}
; CHECK-LABEL: load:
; CHECK: lwnt r4, 0(r4)
; CHECK: ret
define i32 @load(ptr %p) {
  %r = load atomic i32, ptr %p acquire, align 4
  ret i32 %r
}
; CHECK-LABEL: load_byte:
; CHECK: andi r12, r4, -4
; CHECK: andi r13, r4, 3
; CHECK: lwnt r12, 0(r12)
; CHECK: slli r13, r13, 3
; CHECK: srl r12, r12, r13
; CHECK: andi r4, r12, 255
; CHECK: ret
define zeroext i8 @load_byte(ptr %p) {
  %r = load atomic i8, ptr %p monotonic, align 1
  ret i8 %r
}
; CHECK-LABEL: store:
; CHECK: sw r4, %lo(counted)(r12)
; CHECK: ret
define void @store(i32 %x) {
  store atomic i32 %x, ptr @counted seq_cst, align 4
  fence seq_cst
  ret void
}
; CHECK-LABEL: store_anywhere:
; CHECK: call __atomic_store_4
define void @store_anywhere(ptr %p, ptr %x) {
  store atomic ptr %x, ptr %p seq_cst, align 4
  ret void
}
; CHECK-LABEL: store_byte:
; CHECK: andi r5, r5, 255
; CHECK: li r6, 3
; CHECK: call __atomic_store_1
define void @store_byte(ptr %p, i8 %x) {
  store atomic i8 %x, ptr %p release, align 1
  ret void
}
; CHECK-LABEL: add_two:
; CHECK: li r5, 2
; CHECK: li r6, 5
; CHECK: call __atomic_fetch_add_4
; CHECK: ret
define i32 @add_two(ptr %p) {
  %r = atomicrmw add ptr %p, i32 2 seq_cst
  ret i32 %r
}
; CHECK-LABEL: exchange_byte:
; CHECK: andi r5, r5, 255
; CHECK: li r6, 2
; CHECK: call __atomic_exchange_1
; CHECK: ret
define zeroext i8 @exchange_byte(ptr %p, i8 %x) {
  %r = atomicrmw xchg ptr %p, i8 %x acquire
  ret i8 %r
}
; CHECK-LABEL: compare_exchange:
; CHECK: sw r5, 0(r2)
; CHECK: mv r5, r2
; CHECK: li r7, 4
; CHECK: li r8, 0
; CHECK: call __atomic_compare_exchange_4
; CHECK: ret
define i1 @compare_exchange(ptr %p, i32 %old, i32 %new) {
  %r = cmpxchg ptr %p, i32 %old, i32 %new acq_rel monotonic
  %s = extractvalue { i32, i1 } %r, 1
  ret i1 %s
}
; CHECK-LABEL: load_wide:
; CHECK: li r5, 5
; CHECK: call __atomic_load_8
; CHECK: ret
define i64 @load_wide(ptr %p) {
  %r = load atomic i64, ptr %p seq_cst, align 8
  ret i64 %r
}
; CHECK-LABEL: maximum:
; CHECK: sw r20, 8(r2)
; CHECK: sw r21, 4(r2)
; CHECK: lw r12, 0(r4)
; CHECK: mv r20, r4
; CHECK: mv r21, r5
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: max r6, r12, r21
; CHECK: mv r5, r2
; CHECK: mv r4, r20
; CHECK: li r7, 0
; CHECK: li r8, 0
; CHECK: sw r12, 0(r2)
; CHECK: call __atomic_compare_exchange_4
; CHECK: lw r12, 0(r2)
; CHECK: beqz r4, .LBB{{[0-9_]+}}
; CHECK: lw r21, 4(r2)
; CHECK: lw r20, 8(r2)
; CHECK: mv r4, r12
; CHECK: ret
define i32 @maximum(ptr %p, i32 %x) {
  %r = atomicrmw max ptr %p, i32 %x monotonic
  ret i32 %r
}

; Only this thread reaches local memory: no operation on it takes a lock.
; CHECK-LABEL: exchange_thread_local:
; CHECK-NOT: call
; CHECK: lw r{{[0-9]+}}, %abs(counter)(r0)
; CHECK: sw r{{[0-9]+}}, %abs(counter)(r0)
; CHECK: ret
@counter = thread_local global i32 0
define i32 @exchange_thread_local(i32 %mask, i32 %new) {
  %counter = call ptr @llvm.threadlocal.address.p0(ptr @counter)
  %old = atomicrmw or ptr %counter, i32 %mask seq_cst
  %pair = cmpxchg ptr %counter, i32 0, i32 %new seq_cst seq_cst
  ret i32 %old
}
declare ptr @llvm.threadlocal.address.p0(ptr)
