; Loops count in instructions: pointers that end at a pointer, no counter beside them, no extension of what a byte load brought.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: sum:
; CHECK: .LBB0_{{[0-9]+}}:
; CHECK-NEXT: lw [[X:r[0-9]+]], 0(r4)
; CHECK-NEXT: addi r4, r4, 4
; CHECK-NEXT: add [[SUM:r[0-9]+]], {{r[0-9]+}}, [[X]]
; CHECK-NEXT: bne r4, [[END:r[0-9]+]], .LBB0_
define i32 @sum(ptr %values, i32 %count) nounwind {
entry:
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %loop ]
  %sum = phi i32 [ 0, %entry ], [ %more, %loop ]
  %address = getelementptr inbounds i32, ptr %values, i32 %i
  %value = load i32, ptr %address
  %more = add i32 %sum, %value
  %next = add nuw nsw i32 %i, 1
  %done = icmp eq i32 %next, %count
  br i1 %done, label %end, label %loop
end:
  ret i32 %more
}

; CHECK-LABEL: same:
; CHECK-NOT: andi
; CHECK: ret
define i32 @same(ptr %a, ptr %b) nounwind {
entry:
  %first = load i8, ptr %b
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %more ]
  %y = phi i8 [ %first, %entry ], [ %y.next, %more ]
  %at.a = getelementptr inbounds i8, ptr %a, i32 %i
  %x = load i8, ptr %at.a
  %differ = icmp ne i8 %x, %y
  br i1 %differ, label %end, label %more
more:
  %next = add nuw nsw i32 %i, 1
  %at.b = getelementptr inbounds i8, ptr %b, i32 %next
  %y.next = load i8, ptr %at.b
  %done = icmp eq i8 %y.next, 0
  br i1 %done, label %end, label %loop
end:
  %result = phi i32 [ 0, %loop ], [ 1, %more ]
  ret i32 %result
}
