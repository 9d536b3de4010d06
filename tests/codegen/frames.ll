; Stack frames: none or below sp in leaves, ra and fp on top, sp restored from fp where it moves.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare void @use(ptr)
declare void @use2(ptr, ptr)

; CHECK-LABEL: leaf:
; CHECK: sw r4, -4(r2)
; CHECK: lw r4, -4(r2)
; CHECK: ret
define i32 @leaf(i32 %a) {
  %p = alloca i32
  store volatile i32 %a, ptr %p
  %r = load volatile i32, ptr %p
  ret i32 %r
}
; CHECK-LABEL: locals:
; CHECK: addi r2, r2, -20
; CHECK: sw r1, 16(r2)
; CHECK: mv r4, r2
; CHECK: call use
; CHECK: lw r1, 16(r2)
; CHECK: addi r2, r2, 20
; CHECK: ret
define void @locals() {
  %p = alloca [4 x i32]
  call void @use(ptr %p)
  ret void
}
; CHECK-LABEL: with_frame_pointer:
; CHECK: addi r2, r2, -12
; CHECK: sw r1, 8(r2)
; CHECK: sw r3, 4(r2)
; CHECK: addi r3, r2, 12
; CHECK: mv r4, r2
; CHECK: call use
; CHECK: lw r3, 4(r2)
; CHECK: lw r1, 8(r2)
; CHECK: addi r2, r2, 12
; CHECK: ret
define void @with_frame_pointer() "frame-pointer"="all" {
  %p = alloca i32
  call void @use(ptr %p)
  ret void
}
; CHECK-LABEL: dynamic:
; CHECK: addi r2, r2, -8
; CHECK: sw r1, 4(r2)
; CHECK: sw r3, 0(r2)
; CHECK: addi r3, r2, 8
; CHECK: slli r12, r4, 2
; CHECK: sub r4, r2, r12
; CHECK: mv r2, r4
; CHECK: call use
; CHECK: addi r2, r3, -8
; CHECK: lw r3, 0(r2)
; CHECK: lw r1, 4(r2)
; CHECK: addi r2, r2, 8
; CHECK: ret
define void @dynamic(i32 %n) {
  %p = alloca i32, i32 %n
  call void @use(ptr %p)
  ret void
}
; CHECK-LABEL: realigned:
; CHECK: addi r2, r2, -64
; CHECK: sw r1, 60(r2)
; CHECK: sw r3, 56(r2)
; CHECK: addi r3, r2, 64
; CHECK: andi r2, r2, -64
; CHECK: mv r4, r2
; CHECK: call use
; CHECK: addi r2, r3, -64
; CHECK: lw r3, 56(r2)
; CHECK: lw r1, 60(r2)
; CHECK: addi r2, r2, 64
; CHECK: ret
define void @realigned() {
  %p = alloca i32, align 64
  call void @use(ptr %p)
  ret void
}
; CHECK-LABEL: dynamic_and_realigned:
; CHECK: addi r2, r2, -32
; CHECK: sw r1, 28(r2)
; CHECK: sw r3, 24(r2)
; CHECK: sw r31, 20(r2)
; CHECK: addi r3, r2, 32
; CHECK: andi r2, r2, -32
; CHECK: slli r12, r4, 2
; CHECK: mv r31, r2
; CHECK: sub r5, r2, r12
; CHECK: mv r2, r5
; CHECK: mv r4, r31
; CHECK: call use2
; CHECK: addi r2, r3, -32
; CHECK: lw r31, 20(r2)
; CHECK: lw r3, 24(r2)
; CHECK: lw r1, 28(r2)
; CHECK: addi r2, r2, 32
; CHECK: ret
define void @dynamic_and_realigned(i32 %n) {
  %p = alloca i32, align 32
  %q = alloca i32, i32 %n
  call void @use2(ptr %p, ptr %q)
  ret void
}
; CHECK-LABEL: return_address:
; CHECK: addi r2, r2, -8
; CHECK: sw r1, 4(r2)
; CHECK: sw r20, 0(r2)
; CHECK: li r4, 0
; CHECK: mv r20, r1
; CHECK: call use
; CHECK: mv r4, r20
; CHECK: lw r20, 0(r2)
; CHECK: lw r1, 4(r2)
; CHECK: addi r2, r2, 8
; CHECK: ret
define ptr @return_address() {
  call void @use(ptr null)
  %r = call ptr @llvm.returnaddress(i32 0)
  ret ptr %r
}
; CHECK-LABEL: caller_frame:
; CHECK: addi r2, r2, -8
; CHECK: sw r1, 4(r2)
; CHECK: sw r3, 0(r2)
; CHECK: addi r3, r2, 8
; CHECK: lw r4, -8(r3)
; CHECK: lw r3, 0(r2)
; CHECK: lw r1, 4(r2)
; CHECK: addi r2, r2, 8
; CHECK: ret
define ptr @caller_frame() {
  %r = call ptr @llvm.frameaddress.p0(i32 1)
  ret ptr %r
}
; CHECK-LABEL: shrink_wrapped:
; CHECK: beqz r4, .LBB{{[0-9_]+}}
; CHECK: addi r2, r2, -4
; CHECK: sw r1, 0(r2)
; CHECK: li r4, 0
; CHECK: call use
; CHECK: li r4, 0
; CHECK: call use
; CHECK: lw r1, 0(r2)
; CHECK: addi r2, r2, 4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
define void @shrink_wrapped(i32 %c) {
  %z = icmp eq i32 %c, 0
  br i1 %z, label %done, label %slow
slow:
  call void @use(ptr null)
  call void @use(ptr null)
  br label %done
done:
  ret void
}
declare ptr @llvm.returnaddress(i32)
declare ptr @llvm.frameaddress.p0(i32)

; What returns early saves nothing: arguments stay where they are until they must survive a call.
; CHECK-LABEL: early_return:
; CHECK: blez r4, [[RETURN:.LBB[0-9_]+]]
; CHECK: addi r2, r2, -
; CHECK: sw r1,
; CHECK: call work
; CHECK: [[RETURN]]:
; CHECK-NEXT: ret
define void @early_return(i32 %count) nounwind {
entry:
  %none = icmp slt i32 %count, 1
  br i1 %none, label %end, label %loop
loop:
  %i = phi i32 [ %count, %entry ], [ %next, %loop ]
  call void @work(i32 %i)
  %next = add i32 %i, -1
  %done = icmp eq i32 %next, 0
  br i1 %done, label %end, label %loop
end:
  ret void
}
declare void @work(i32)
