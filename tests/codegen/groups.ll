; Instructions that read groups of registers: what a loop keeps stays in its group, what is loaded is loaded into one, and
; a group that must survive a call goes to the stack and back as a whole.
; RUN: %trax_llc -O2 -verify-machineinstrs %s -o - | FileCheck %s
; RUN: %trax_llc -O0 -verify-machineinstrs %s -o - | FileCheck %s --check-prefix=O0

declare float @__builtin_trax_box(float, float, float, float, float, float, float, float, float, float, float, float, float)
declare float @__builtin_trax_triangle(float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float)
declare void @other()

; Six registers of arguments are a group as they are.
; CHECK-LABEL: box:
; CHECK-NOT: mv
; CHECK: fbox r4, r5, r11
; O0-LABEL: box:
; O0: fbox
define float @box(float %l, float %a, float %b, float %c, float %d, float %e, float %f, float %g, float %h, float %i, float %j, float %k, float %m) {
  %r = call float @__builtin_trax_box(float %l, float %a, float %b, float %c, float %d, float %e, float %f, float %g, float %h, float %i, float %j, float %k, float %m)
  ret float %r
}

; CHECK-LABEL: nearest:
; CHECK: .LBB1_1:
; CHECK-NOT: mv
; CHECK-COUNT-6: lw
; CHECK-NOT: mv
; CHECK: fbox
define float @nearest(ptr %ray, ptr %boxes, ptr %end, float %limit) {
entry:
  %r0 = load float, ptr %ray
  %p1 = getelementptr float, ptr %ray, i32 1
  %r1 = load float, ptr %p1
  br label %loop
loop:
  %box = phi ptr [ %boxes, %entry ], [ %next, %loop ]
  %best = phi float [ %limit, %entry ], [ %new, %loop ]
  %b0 = load float, ptr %box
  %q1 = getelementptr float, ptr %box, i32 1
  %b1 = load float, ptr %q1
  %q2 = getelementptr float, ptr %box, i32 2
  %b2 = load float, ptr %q2
  %q3 = getelementptr float, ptr %box, i32 3
  %b3 = load float, ptr %q3
  %q4 = getelementptr float, ptr %box, i32 4
  %b4 = load float, ptr %q4
  %q5 = getelementptr float, ptr %box, i32 5
  %b5 = load float, ptr %q5
  %new = call float @__builtin_trax_box(float %best, float %r0, float %r1, float %r0, float %r1, float %r1, float %r0, float %b0, float %b1, float %b2, float %b3, float %b4, float %b5)
  %next = getelementptr float, ptr %box, i32 6
  %more = icmp ne ptr %next, %end
  br i1 %more, label %loop, label %done
done:
  ret float %new
}

; An instruction whose result nobody wants goes; two that are the same are one.
; CHECK-LABEL: same:
; CHECK: ftri
; CHECK-NOT: {{fbox|ftri}}
; CHECK: fadd
define float @same(float %a, float %b) {
  %u = call float @__builtin_trax_box(float %a, float %b, float %b, float %b, float %b, float %b, float %b, float %b, float %b, float %b, float %b, float %b, float %b)
  %x = call float @__builtin_trax_triangle(float %a, float %a, float %b, float %a, float %b, float %a, float %b, float %b, float %b, float %b, float %a, float %b, float %b, float %b, float %b, float %b)
  %y = call float @__builtin_trax_triangle(float %a, float %a, float %b, float %a, float %b, float %a, float %b, float %b, float %b, float %b, float %a, float %b, float %b, float %b, float %b, float %b)
  %r = fadd float %x, %y
  ret float %r
}
