; A dense switch is a table of addresses; a computed goto a jump.
; RUN: %trax_llc -O2 %s -o - | FileCheck %s

declare void @g(i32)

; CHECK-LABEL: dense:
; CHECK: li r12, 5
; CHECK: bltu r12, r4, .LBB{{[0-9_]+}}
; CHECK: slli r12, r4, 2
; CHECK: lui r13, %hi(.LJTI{{[0-9_]+}})
; CHECK: add r12, r13, r12
; CHECK: lw r12, %lo(.LJTI{{[0-9_]+}})(r12)
; CHECK: jr r12
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: li r4, 10
; CHECK: j g
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: li r4, 20
; CHECK: j g
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: li r4, 40
; CHECK: j g
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: ret
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: li r4, 30
; CHECK: j g
define void @dense(i32 %x) {
  switch i32 %x, label %done [
    i32 0, label %a
    i32 1, label %b
    i32 2, label %c
    i32 3, label %a
    i32 4, label %b
    i32 5, label %d
  ]
a:
  tail call void @g(i32 10)
  ret void
b:
  tail call void @g(i32 20)
  ret void
c:
  tail call void @g(i32 30)
  ret void
d:
  tail call void @g(i32 40)
  ret void
done:
  ret void
}
; CHECK-LABEL: computed:
; CHECK: jr r4
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: li r4, 1
; CHECK: ret
; CHECK: .LBB{{[0-9_]+}}:
; CHECK: li r4, 2
; CHECK: ret
define i32 @computed(ptr %target) {
  indirectbr ptr %target, [label %a, label %b]
a:
  ret i32 1
b:
  ret i32 2
}
