; Registers are saved on the paths that need it, and no path saves them twice or restores them where they were not saved.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare void @use()
declare void @fail() noreturn

; Loads and stores behind a call are none of the stack: no address of it is in a register.
; CHECK-LABEL: pointers:
; CHECK-NOT: sw
; CHECK: bnez r{{[0-9]+}}, [[END:\.LBB[0-9_]+]]
; CHECK: sw r1,
; CHECK: call use
; CHECK: lw r1,
; CHECK: [[END]]:
; CHECK-NOT: r2
; CHECK: ret
define i32 @pointers(ptr %list, i32 %found) nounwind {
  %skip = icmp ne i32 %found, 0
  br i1 %skip, label %end, label %slow
slow:
  call void @use()
  br label %end
end:
  %answer = phi i32 [ 1, %0 ], [ 2, %slow ]
  %next = load ptr, ptr @head
  %value = load i32, ptr %next
  %sum = add i32 %value, %answer
  ret i32 %sum
}
@head = external global ptr

; A path that does not return needs no place to restore registers, but the frame to its end.
; CHECK-LABEL: fails:
; CHECK-NOT: sw
; CHECK: ret
; CHECK: addi r2, r2, -8
; CHECK: call use
; CHECK: beqz r{{[0-9]+}}, [[FAILED:\.LBB[0-9_]+]]
; CHECK: addi r2, r2, 8
; CHECK: ret
; CHECK: [[FAILED]]:
; CHECK-NEXT: .cfi_def_cfa_offset 8
; CHECK-NEXT: .cfi_offset r1, -4
; CHECK-NOT: addi r2
; CHECK: call fail
define i32 @fails(i32 %fast, ptr %state) {
  %skip = icmp ne i32 %fast, 0
  br i1 %skip, label %end, label %slow
slow:
  call void @use()
  %bad = load i32, ptr %state
  %is.bad = icmp eq i32 %bad, 0
  br i1 %is.bad, label %failed, label %end
failed:
  call void @fail()
  unreachable
end:
  %answer = phi i32 [ 1, %0 ], [ 2, %slow ]
  ret i32 %answer
}

; Only what fails needs the frame.
; CHECK-LABEL: checks:
; CHECK-NOT: sw
; CHECK: ret
; CHECK: sw r1,
; CHECK: call fail
define i32 @checks(i32 %n) nounwind {
  %bad = icmp slt i32 %n, 0
  br i1 %bad, label %failed, label %end
failed:
  call void @fail()
  unreachable
end:
  ret i32 %n
}

; Two ways to the end that called and one that did not: the former restore on their way.
; CHECK-LABEL: joins:
; CHECK-NOT: sw
; CHECK: bnez r{{[0-9]+}}, [[END:\.LBB[0-9_]+]]
; CHECK: sw r1,
; CHECK: call use
; CHECK: call use
; CHECK: lw r1,
; CHECK: [[END]]:
; CHECK-NOT: r2
; CHECK: ret
define i32 @joins(i32 %fast, ptr %state) nounwind {
  %skip = icmp ne i32 %fast, 0
  br i1 %skip, label %end, label %slow
slow:
  call void @use()
  %more = load i32, ptr %state
  %is.more = icmp eq i32 %more, 0
  br i1 %is.more, label %twice, label %end
twice:
  call void @use()
  br label %end
end:
  %answer = phi i32 [ 1, %0 ], [ 2, %slow ], [ 3, %twice ]
  %next = load ptr, ptr @head
  store i32 %answer, ptr %next
  ret i32 %answer
}

; Not within a loop: there, they would be saved in each round.
; CHECK-LABEL: loops:
; CHECK: sw r1,
; CHECK: .LBB
; CHECK: call use
; CHECK: lw r1,
define void @loops(i32 %n) nounwind {
  br label %loop
loop:
  %i = phi i32 [ 0, %0 ], [ %next, %step ]
  %odd = and i32 %i, 1
  %skip = icmp eq i32 %odd, 0
  br i1 %skip, label %step, label %slow
slow:
  call void @use()
  br label %step
step:
  %next = add i32 %i, 1
  %done = icmp uge i32 %next, %n
  br i1 %done, label %end, label %loop
end:
  ret void
}

; A loop that seldom begins is a loop all the same: its registers are saved before it, though one block uses them.
; CHECK-LABEL: rare_loop:
; CHECK-NOT: addi r2
; CHECK: ret
; CHECK: addi r2, r2, -4
; CHECK: .LBB
; CHECK: call use
; CHECK-NOT: addi r2, r2, -4
; CHECK: addi r2, r2, 4
; CHECK-NOT: call
define i32 @rare_loop(i32 %fast) nounwind {
  %skip = icmp ne i32 %fast, 0
  br i1 %skip, label %end, label %loop, !prof !{!"branch_weights", i32 1000000, i32 1}
loop:
  %item = load volatile i32, ptr inttoptr (i32 2048 to ptr)
  %pass = icmp eq i32 %item, 0
  br i1 %pass, label %step, label %slow
slow:
  call void @use()
  br label %step
step:
  %left = load volatile i32, ptr inttoptr (i32 2052 to ptr)
  %more = icmp ne i32 %left, 0
  br i1 %more, label %loop, label %end
end:
  %answer = phi i32 [ 1, %0 ], [ 2, %step ]
  %next = load ptr, ptr @head
  store i32 %answer, ptr %next
  ret i32 %answer
}

; An address of the stack is in memory: the last load may be of the stack, so the frame is still there.
; CHECK-LABEL: escapes:
; CHECK: addi r2, r2, -
; CHECK: {{b(ne|eq)z}}
; CHECK: addi r2, r2,
; CHECK-NOT: lw {{r[0-9]+}}, 0(
; CHECK: ret
define i32 @escapes(i32 %fast) nounwind {
  %local = alloca i32
  %skip = icmp ne i32 %fast, 0
  br i1 %skip, label %end, label %slow
slow:
  store ptr %local, ptr @head
  call void @use()
  br label %end
end:
  %next = load ptr, ptr @head
  %value = load i32, ptr %next
  ret i32 %value
}
