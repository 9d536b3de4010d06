; A pointer steps in loops around others, a counter is compared after its increment, and a load leaves a loop whose stores are beyond it.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

@a = global [20 x [20 x i32]] zeroinitializer

; a[j][i] /= a[i][i] for j > i, with another loop between: the address steps by a row.
; CHECK-LABEL: column:
; CHECK: lw [[DIVISOR:r[0-9]+]], 0(
; CHECK: addi [[END:r[0-9]+]], r5, 1
; CHECK: .LBB0_1:
; CHECK-NOT: mul
; CHECK: lw [[SUM:r[0-9]+]], 0([[ROW:r[0-9]+]])
; CHECK: bne {{.*}} .LBB0_2
; CHECK: sub [[LESS:r[0-9]+]], [[SUM]], [[DIVISOR]]
; CHECK-NEXT: addi [[J:r[0-9]+]], [[J]], 1
; CHECK-NEXT: sw [[LESS]], 0([[ROW]])
; CHECK-NEXT: addi [[ROW]], [[ROW]], 80
; CHECK-NEXT: bne [[J]], [[END]], .LBB0_1
define void @column(i32 %i, i32 %n, ptr %v) nounwind {
entry:
  %pivot = getelementptr inbounds [20 x [20 x i32]], ptr @a, i32 0, i32 %i, i32 %i
  %first = add nsw i32 %i, 1
  br label %outer
outer:
  %j = phi i32 [ %first, %entry ], [ %j.next, %latch ]
  %place = getelementptr inbounds [20 x [20 x i32]], ptr @a, i32 0, i32 %j, i32 %i
  %old = load i32, ptr %place
  br label %inner
inner:
  %k = phi i32 [ 0, %outer ], [ %k.next, %inner ]
  %sum = phi i32 [ %old, %outer ], [ %more, %inner ]
  %element = getelementptr inbounds i32, ptr %v, i32 %k
  %value = load i32, ptr %element
  %more = add i32 %sum, %value
  %k.next = add nuw nsw i32 %k, 1
  %k.done = icmp eq i32 %k.next, %n
  br i1 %k.done, label %latch, label %inner
latch:
  %divisor = load i32, ptr %pivot
  %less = sub i32 %more, %divisor
  store i32 %less, ptr %place
  %j.next = add nsw i32 %j, 1
  %j.done = icmp eq i32 %j, %n
  br i1 %j.done, label %end, label %outer
end:
  ret void
}

; The first store is to the load's own word: the load stays.
; CHECK-LABEL: itself:
; CHECK: .LBB1_1:
; CHECK: lw {{r[0-9]+}}, 0(r4)
; CHECK: bne {{.*}} .LBB1_1
define void @itself(ptr %pivot, i32 %n) nounwind {
entry:
  br label %loop
loop:
  %j = phi i32 [ 0, %entry ], [ %j.next, %loop ]
  %place = getelementptr inbounds [20 x i32], ptr %pivot, i32 %j
  %old = load i32, ptr %place
  %other = load i32, ptr %pivot
  %less = sub i32 %old, %other
  store i32 %less, ptr %place
  %j.next = add nsw i32 %j, 1
  %j.done = icmp eq i32 %j.next, %n
  br i1 %j.done, label %end, label %loop
end:
  ret void
}
