; A mask of low bits that no immediate holds: two shifts where it is taken once, a register in a loop, and never more than
; that where size counts.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

; CHECK-LABEL: once:
; CHECK: slli r12, r4, 1
; CHECK-NEXT: srli r4, r12, 1
; CHECK-NEXT: ret
define float @once(float %x) {
  %r = call float @llvm.fabs.f32(float %x)
  ret float %r
}

; CHECK-LABEL: greatest_magnitude:
; CHECK-DAG: lui [[HALF:r[0-9]+]], 32768
; CHECK-DAG: addi [[MASK:r[0-9]+]], [[HALF]], -1
; CHECK: .LBB1_1:
; CHECK-NOT: lui
; CHECK: and r{{[0-9]+}}, r{{[0-9]+}}, [[MASK]]
; CHECK-NOT: s{{[lr]}}li
; CHECK: bnez
define i32 @greatest_magnitude(ptr %values, i32 %count) {
entry:
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %loop ]
  %greatest = phi i32 [ 0, %entry ], [ %greater, %loop ]
  %address = getelementptr i32, ptr %values, i32 %i
  %value = load i32, ptr %address
  %size = and i32 %value, 2147483647
  %more = icmp sgt i32 %size, %greatest
  %greater = select i1 %more, i32 %size, i32 %greatest
  %next = add i32 %i, 1
  %done = icmp eq i32 %next, %count
  br i1 %done, label %end, label %loop
end:
  ret i32 %greater
}

; CHECK-LABEL: sum_of_magnitudes:
; CHECK: addi [[MASK:r[0-9]+]], r{{[0-9]+}}, -1
; CHECK: .LBB2_1:
; CHECK: and r{{[0-9]+}}, r{{[0-9]+}}, [[MASK]]
define float @sum_of_magnitudes(ptr %values, i32 %count) {
entry:
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %loop ]
  %sum = phi float [ 0.0, %entry ], [ %more, %loop ]
  %address = getelementptr float, ptr %values, i32 %i
  %value = load float, ptr %address
  %size = call float @llvm.fabs.f32(float %value)
  %more = fadd float %sum, %size
  %next = add i32 %i, 1
  %done = icmp eq i32 %next, %count
  br i1 %done, label %end, label %loop
end:
  ret float %more
}

; CHECK-LABEL: small:
; CHECK: slli [[UP:r[0-9]+]], [[VALUE:r[0-9]+]], 12
; CHECK: srli r{{[0-9]+}}, [[UP]], 12
define void @small(ptr %values, i32 %count) optsize {
entry:
  br label %loop
loop:
  %i = phi i32 [ 0, %entry ], [ %next, %loop ]
  %address = getelementptr i32, ptr %values, i32 %i
  %value = load i32, ptr %address
  %size = and i32 %value, 1048575
  store i32 %size, ptr %address
  %next = add i32 %i, 1
  %done = icmp eq i32 %next, %count
  br i1 %done, label %end, label %loop
end:
  ret void
}
declare float @llvm.fabs.f32(float)
