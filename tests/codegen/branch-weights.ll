; The branches that one on double words, or on two conditions, becomes are as likely together as it was.
; RUN: %trax_llc -O2 -stop-after=trax-branches %s -o - | FileCheck %s

declare void @f()

; Seldom equal: the upper halves differ in half of the cases in which either half can.
; CHECK-LABEL: define void @equal(
; CHECK: br i1 {{.*}}, label %[[LOWER:.*]], label %end, !prof [[UPPER_EQUAL:![0-9]+]]
; CHECK: br i1 {{.*}}, label %call, label %end, !prof [[LOWER_EQUAL:![0-9]+]]
define void @equal(i64 %a, i64 %b) {
  %equal = icmp eq i64 %a, %b
  br i1 %equal, label %call, label %end, !prof !{!"branch_weights", i32 1, i32 100}
call:
  tail call void @f()
  ret void
end:
  ret void
}

; Either half decides for both sides as the whole did.
; CHECK-LABEL: define void @less(
; CHECK: br i1 {{.*}}, label %{{.*}}, label %{{[^,]*$}}
; CHECK: br i1 {{.*}}, label %call, label %end, !prof [[WHOLE:![0-9]+]]
; CHECK: br i1 {{.*}}, label %call, label %end, !prof [[WHOLE]]
define void @less(i64 %a, i64 %b) {
  %less = icmp slt i64 %a, %b
  br i1 %less, label %call, label %end, !prof !{!"branch_weights", i32 7, i32 3}
call:
  tail call void @f()
  ret void
end:
  ret void
}

; CHECK-LABEL: define void @both(
; CHECK: br i1 {{.*}}, label %{{.*}}, label %end, !prof [[FIRST:![0-9]+]]
define void @both(i64 %a, i64 %b, i32 %c) {
  %less = icmp slt i64 %a, %b
  %zero = icmp eq i32 %c, 0
  %both = select i1 %zero, i1 %less, i1 false
  br i1 %both, label %call, label %end, !prof !{!"branch_weights", i32 4294967295, i32 4294967295}
call:
  tail call void @f()
  ret void
end:
  ret void
}

; CHECK-DAG: [[UPPER_EQUAL]] = !{!"branch_weights", i32 102, i32 100}
; CHECK-DAG: [[LOWER_EQUAL]] = !{!"branch_weights", i32 2, i32 100}
; CHECK-DAG: [[WHOLE]] = !{!"branch_weights", i32 7, i32 3}
; CHECK-DAG: [[FIRST]] = !{!"branch_weights", i32 -{{[0-9]+}}, i32 {{[0-9]+}}}
