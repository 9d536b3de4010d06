; A branch on double words compares their halves: the lower ones where the upper ones are equal.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare void @f()

; CHECK-LABEL: less:
; CHECK: b{{eq|ne}} r5, r7
; CHECK-NOT: slt
; CHECK: b{{lt|ge}}u r4, r6
; CHECK: b{{lt|ge}} r5, r7
define void @less(i64 %a, i64 %b) {
  %less = icmp slt i64 %a, %b
  br i1 %less, label %call, label %end
call:
  tail call void @f()
  ret void
end:
  ret void
}

; The upper half of a word that was extended is 0.
; CHECK-LABEL: word:
; CHECK: b{{eq|ne}}z r5
; CHECK: b{{lt|ge}}u r4, r6
; CHECK-NOT: b{{lt|ge|eq|ne}}
; CHECK: .cfi_endproc
define void @word(i64 %a, i32 %w) {
  %b = zext i32 %w to i64
  %less = icmp ult i64 %a, %b
  br i1 %less, label %call, label %end
call:
  tail call void @f()
  ret void
end:
  ret void
}

; Two conditions are two branches, and phis have their values on the new edges.
; CHECK-LABEL: both:
; CHECK-DAG: b{{eq|ne}} r{{.*}}, r6
; CHECK-DAG: b{{eq|ne}} r5, r7
; CHECK-DAG: b{{eq|ne}}z r8
; CHECK-NOT: xor
; CHECK: .cfi_endproc
define i32 @both(i64 %a, i64 %b, i32 %c) {
entry:
  %same = icmp eq i64 %a, %b
  %set = icmp ne i32 %c, 0
  %both = select i1 %set, i1 %same, i1 false
  br i1 %both, label %call, label %end
call:
  call void @f()
  br label %end
end:
  %result = phi i32 [ 3, %entry ], [ %c, %call ]
  ret i32 %result
}

; One half decides.
; CHECK-LABEL: sign:
; CHECK: b{{lt|ge}}z r5
; CHECK-NOT: b{{lt|ge|eq|ne}}
; CHECK: .cfi_endproc
define void @sign(i64 %a) {
  %less = icmp slt i64 %a, 0
  br i1 %less, label %call, label %end
call:
  tail call void @f()
  ret void
end:
  ret void
}

; What a branch has found to be 0 need not be set to 0.
; CHECK-LABEL: known:
; CHECK-NOT: li r
; CHECK: ret
define i32 @known(i32 %a, ptr %p) {
entry:
  %zero = icmp eq i32 %a, 0
  br i1 %zero, label %end, label %load
load:
  %b = load i32, ptr %p
  br label %end
end:
  %result = phi i32 [ 0, %entry ], [ %b, %load ]
  ret i32 %result
}
